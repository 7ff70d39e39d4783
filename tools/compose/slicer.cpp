#include "tools/compose/slicer.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <fcntl.h>
#include <unistd.h>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace kinebus::compose {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string tail(const std::string& text) {
  return text.size() > 1500 ? text.substr(text.size() - 1500) : text;
}

/// Runs a program without a shell, its output into a file. Returns its exit status, or -1.
int run_program(const std::vector<std::string>& arguments, const std::string& log) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions{};
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child = -1;
  const int error = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return -1;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

Slicer::Slicer(SlicerOptions options, std::string folder)
    : options_(std::move(options)), folder_(std::move(folder)) {
  if (!options_.config.empty()) return;
  // The same for pieces and for the uncut part that they are compared with: one speed for like strands, and
  // infill of the same density in small sections as in large ones.
  std::ofstream out(folder_ + "/settings.ini");
  out << fmt::format(
      "bed_shape = -200x-200,200x-200,200x200,-200x200\nmax_print_height = 400\ngcode_flavor = marlin\n"
      "nozzle_diameter = 0.4\nfilament_diameter = {3}\nlayer_height = {0}\nfirst_layer_height = {0}\n"
      "temperature = {1}\nfirst_layer_temperature = {1}\nbed_temperature = {2}\nfirst_layer_bed_temperature "
      "= {2}\n"
      "skirts = 0\nbrim_width = 0\nperimeters = 2\nfill_density = 15%\nfill_pattern = grid\n"
      "elefant_foot_compensation = 0\nuse_relative_e_distances = 0\nretract_length = 0.8\nretract_speed = "
      "35\n"
      "retract_lift = 0.3\nwipe = 0\nperimeter_speed = 60\nexternal_perimeter_speed = 35\ninfill_speed = 80\n"
      "solid_infill_speed = 80\ntop_solid_infill_speed = 40\ngap_fill_speed = 40\nsmall_perimeter_speed = "
      "35\n"
      "support_material_speed = 60\nsupport_material_spacing = 2.5\nsupport_material_interface_layers = 3\n"
      "slowdown_below_layer_time = 5\nsolid_infill_below_area = 0\n"
      "travel_speed = 150\nfirst_layer_speed = 25\nstart_gcode =\nend_gcode =\n",
      options_.layer_mm, options_.hotend_celsius, options_.bed_celsius, options_.filament_diameter_mm);
  if (!out.flush()) throw std::runtime_error(folder_ + "/settings.ini: could not be written");
  options_.config = folder_ + "/settings.ini";
}

void Slicer::run(const std::string& arguments, const std::string& what) const {
  std::vector<std::string> list{options_.program};
  std::istringstream split(arguments);
  for (std::string word; std::getline(split, word, '\n');) list.push_back(word);
  const std::string log = folder_ + "/slicer.log";
  const int status = run_program(list, log);
  if (status < 0)
    throw std::runtime_error(options_.program +
                             ": could not be started (Debian package prusa-slicer, or name "
                             "another by --slicer)");
  if (status != 0)
    throw std::runtime_error(
        fmt::format("{}: the slicer failed ({}):\n{}", what, status, tail(read_text(log))));
}

std::string Slicer::slice(const TriangleMesh& piece, const std::string& name, bool support) const {
  const std::string stl = folder_ + "/" + name + ".stl", gcode = folder_ + "/" + name + ".gcode";
  write_stl(piece, stl);
  std::string arguments =
      fmt::format("--export-gcode\n--load\n{}\n--dont-arrange\n--output\n{}\n", options_.config, gcode);
  if (support)
    arguments += fmt::format("--support-material\n--support-material-threshold\n{}\n",
                             static_cast<int>(options_.support_threshold_deg));
  run(arguments + stl, name);
  std::string text = read_text(gcode);
  if (text.empty())
    throw std::runtime_error(name + ": the slicer wrote no G-code:\n" +
                             tail(read_text(folder_ + "/slicer.log")));
  return text;
}

std::string Slicer::to_stl(const std::string& path) const {
  std::string stl = folder_ + "/converted.stl";
  run("--export-stl\n--dont-arrange\n--output\n" + stl + "\n" + path, path);
  return stl;
}

std::optional<double> stated_filament_mm(const std::string& gcode) {
  const std::string key = "; filament used [mm] = ";
  const std::size_t at = gcode.rfind(key);
  if (at == std::string::npos) return {};
  return std::strtod(gcode.c_str() + at + key.size(), nullptr);
}

}  // namespace kinebus::compose
