// kinebus-heat-study: a step of filament through a hot end under PID, under the model, and heated ahead.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include "protocol/host/guarded_main.hpp"
#include "tools/heat_study/picture.hpp"

namespace {

using namespace kinebus::heat_study;

/// Heated ahead, the block stays within this.
constexpr double kWithin_k = 1;

int study(const Scene& scene, const std::string& picture) {
  std::array<Run, kControls.size()> runs;
  fmt::print("0 to {:.0f} mm3/s for {:.0f} s and back, at {:.0f} C: the block, off its target\n",
             scene.flow_mm3_per_s, scene.flowing_s, scene.target_c);
  fmt::print("{:22} {:>8} {:>8}\n", "", "lowest", "highest");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i] = flow_step(scene, kControls[i]);
    fmt::print("{:22} {:>6.2f} K {:>+6.2f} K\n", words(kControls[i]), runs[i].lowest_k, runs[i].highest_k);
  }
  if (!picture.empty()) {
    std::ofstream file(picture);
    file << draw_flow_step(scene, runs);
    if (!file.flush()) throw std::runtime_error(picture + " cannot be written");
    fmt::print("{}\n", picture);
  }
  const Run& ahead = runs.back();
  if (std::max(-ahead.lowest_k, ahead.highest_k) <= kWithin_k) return 0;
  fmt::print(stderr, "kinebus-heat-study: heated ahead it is not within {:.0f} K\n", kWithin_k);
  return 1;
}

int run(int argc, char** argv) {
  CLI::App app("A step of filament through a hot end: what the block does under each control");
  Scene scene;
  std::string picture;
  app.add_option("--flow", scene.flow_mm3_per_s, "mm3/s")->check(CLI::Range(0.0, 30.0));
  app.add_option("--temperature", scene.target_c, "C")->check(CLI::Range(150.0, 260.0));
  app.add_option("--picture", picture, "SVG to be written");
  CLI11_PARSE(app, argc, argv);
  return study(scene, picture);
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-heat-study", [&] { return run(argc, argv); });
}
