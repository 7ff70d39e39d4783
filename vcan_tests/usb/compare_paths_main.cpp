// kinebus-compare-paths LOG LOG [--skip N]: whether two logs of the bus command the same path.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "vcan_tests/usb/path_trace.hpp"

int main(int argc, char** argv) try {
  std::string first, second;
  std::size_t skip = 0;
  // Records are fitted to half a count, and each run begins where the one before left half a count.
  double same = 2;
  // A planned stop leaves the corners around it unrounded: within the blend tolerance of 5 um, 6.4 counts,
  // and the merge tolerance.
  double near = 10;
  CLI::App app("Compares the paths of two bus logs (candump -L)");
  app.add_option("first", first)->required();
  app.add_option("second", second)->required();
  app.add_option("--skip", skip, "Runs at the beginning of both that are not compared");
  app.add_option("--same", same, "Allowed difference in counts when both have the same stops");
  app.add_option("--near", near, "Allowed difference in counts when one stopped where the other did not");
  CLI11_PARSE(app, argc, argv);
  const auto a = kinebus::read_trace(first), b = kinebus::read_trace(second);
  if (!a || !b) {
    std::fprintf(stderr, "%s\n", (!a ? a.error() : b.error()).c_str());
    return 2;
  }
  const auto difference = kinebus::compare(*a, *b, skip);
  std::printf("%zu and %zu runs, %lld instants compared %s: largest difference %.3f counts\n", a->runs.size(),
              b->runs.size(), static_cast<long long>(difference.compared),
              difference.same_runs ? "at equal path times" : "by shape (one path has more stops)",
              difference.largest_counts);
  return difference.largest_counts <= (difference.same_runs ? same : near) && difference.compared > 1000 ? 0
                                                                                                         : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
