// kinebus-make-job: writes the jobs of demo, tests and benchmarks.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "protocol/host/guarded_main.hpp"
#include "tools/simulation/job_generator.hpp"

namespace {

int make_job(int argc, char** argv) {
  CLI::App app("kinebus-make-job: write a G-code job for demo, test or benchmark");
  std::string kind, path;
  std::uint32_t lines = 0;
  std::vector<std::string> names;
  std::string kinds = "one of:";
  for (const auto& k : kinebus::job_kinds()) {
    names.push_back(k.name);
    kinds += fmt::format(" {} ({})", k.name, k.description);
  }
  app.add_option("kind", kind, kinds)->required()->check(CLI::IsMember(names));
  app.add_option("-o,--output", path, "File to write (default: standard output)");
  app.add_option("--lines", lines, "About so many lines (0: as usual for the kind)");
  CLI11_PARSE(app, argc, argv);

  std::ofstream file;
  if (!path.empty()) {
    file.open(path, std::ios::binary);
    if (!file) {
      fmt::print(stderr, "kinebus-make-job: {} cannot be written\n", path);
      return 1;
    }
  }
  const auto sink = [&](std::string_view text) {
    if (path.empty())
      std::fwrite(text.data(), 1, text.size(), stdout);
    else
      file.write(text.data(), static_cast<std::streamsize>(text.size()));
  };
  for (const auto& k : kinebus::job_kinds())
    if (k.name == kind) k.write(sink, lines != 0 ? lines : k.default_lines);
  return path.empty() || file.flush() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-make-job", [&] { return make_job(argc, argv); });
}
