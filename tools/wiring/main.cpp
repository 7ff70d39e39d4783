// kinebus-wiring: the pictures of the boards' pins, from the tables of their firmware.

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/usage.hpp"
#include "tools/wiring/wiring.hpp"

namespace {

using namespace kinebus;

int run(int argc, char** argv) {
  CLI::App app(
      "kinebus-wiring: the pictures in every board's port folder, from the pin table that its firmware has.");
  std::string root = ".";
  bool check = false;
  app.add_option("root", root, "The repository")->check(CLI::ExistingDirectory)->capture_default_str();
  app.add_flag("--check", check, "Write nothing: status 1 when a picture is not the one of its table");
  if (const auto end = parse_arguments(app, argc, argv)) return *end;
  int old = 0;
  for (const WiringPage& page : wiring_pages()) {
    const std::filesystem::path file = std::filesystem::path(root) / page.folder / page.file;
    const std::string picture = draw_wiring(page);
    std::ifstream in(file, std::ios::binary);
    std::ostringstream there;
    there << in.rdbuf();
    if (in && there.str() == picture) continue;
    if (check) {
      fmt::print(stderr, "{} is not the picture of its board's pins: kinebus-wiring draws it anew\n",
                 file.string());
      ++old;
      continue;
    }
    std::ofstream out(file, std::ios::binary);
    out << picture << std::flush;
    if (!out) return fmt::print(stderr, "{} cannot be written\n", file.string()), 1;
    fmt::print("{}\n", file.string());
  }
  return old == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-wiring", [&] { return run(argc, argv); });
}
