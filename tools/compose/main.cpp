// kinebus-compose: from a part with overhangs to one five-axis job without support.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "gateway/description/machine_file.hpp"
#include "protocol/host/guarded_main.hpp"
#include "protocol/host/usage.hpp"
#include "tools/compose/composer.hpp"
#include "tools/compose/example_parts.hpp"
#include "tools/compose/job_description.hpp"
#include "tools/compose/picture.hpp"
#include "tools/compose/print_picture.hpp"

namespace kinebus::compose {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr double kRad = std::numbers::pi / 180;

struct Arguments {
  std::string input, output, machine, config, program = "prusa-slicer", report, picture, printing, work,
                                              nozzle;
  std::vector<std::string> planes;
  double max_overhang_deg = 45, max_tilt_deg = 45, layer_mm = 0.2, clearance_mm = 20, table_radius_mm = 100;
  bool keep_position = false, no_support_comparison = false;
};

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(path + ": cannot be read");
  return text.str();
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error(path + ": cannot be written");
}

MachineDescription machine_of(const Arguments& arguments) {
  if (arguments.machine.empty()) return default_m1();
  auto machine = load_machine(arguments.machine);
  if (!machine) throw std::runtime_error(to_string(machine.error()));
  return *machine;
}

std::vector<double> numbers(const std::string& text, std::size_t count, const char* option) {
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) {
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != word.size() || !std::isfinite(value))
      throw std::runtime_error(fmt::format("{}: '{}' is not a number in '{}'", option, word, text));
    out.push_back(value);
  }
  if (out.size() != count)
    throw std::runtime_error(
        fmt::format("{}: expected {} numbers with commas, found '{}'", option, count, text));
  return out;
}

Plane plane_of(const std::string& text) {
  const std::vector<double> n = numbers(text, 4, "--plane");
  const Vector normal(n[0], n[1], n[2]);
  if (normal.norm() < 1e-9) throw std::runtime_error("--plane: the normal is 0, 0, 0");
  return {normal.normalized(), n[3] / normal.norm()};
}

/// "height:radius,height:radius,..." from the tip up.
Nozzle nozzle_of(const std::string& text) {
  Nozzle out;
  if (text.empty()) return out;
  out.profile.clear();
  std::istringstream in(text);
  for (std::string corner; std::getline(in, corner, ',');) {
    const std::size_t colon = corner.find(':');
    if (colon == std::string::npos)
      throw std::runtime_error("--nozzle: expected height:radius, found '" + corner + "'");
    const double height = numbers(corner.substr(0, colon), 1, "--nozzle")[0];
    const double radius = numbers(corner.substr(colon + 1), 1, "--nozzle")[0];
    if (radius < 0 || (!out.profile.empty() &&
                       (height <= out.profile.back().height_mm || radius < out.profile.back().radius_mm)))
      throw std::runtime_error("--nozzle: heights have to rise and radii not to fall, from the tip up");
    out.profile.push_back({height, radius});
  }
  if (out.profile.empty() || out.profile.front().height_mm != 0)
    throw std::runtime_error("--nozzle: the first corner is the tip, at height 0");
  return out;
}

ComposeOptions options_of(const Arguments& arguments) {
  ComposeOptions out;
  out.decompose.max_overhang_rad = arguments.max_overhang_deg * kRad;
  out.decompose.max_tilt_rad = arguments.max_tilt_deg * kRad;
  out.slicer.program = arguments.program;
  out.slicer.config = arguments.config;
  out.slicer.layer_mm = arguments.layer_mm;
  out.slicer.support_threshold_deg = arguments.max_overhang_deg;
  out.join.clearance_mm = arguments.clearance_mm;
  out.sweep.table_radius_mm = arguments.table_radius_mm;
  out.sweep.nozzle = nozzle_of(arguments.nozzle);
  out.decompose.nozzle = out.sweep.nozzle;
  out.decompose.table_radius_mm = out.sweep.table_radius_mm;
  out.keep_position = arguments.keep_position;
  out.compare_support = !arguments.no_support_comparison;
  for (const std::string& text : arguments.planes) out.planes.push_back(plane_of(text));
  return out;
}

/// Removes itself, unless the user named the folder.
class WorkFolder {
 public:
  explicit WorkFolder(const std::string& named) : path_(named), keep_(!named.empty()) {
    if (keep_) {
      fs::create_directories(path_);
      return;
    }
    std::string name = (fs::temp_directory_path() / "kinebus-compose-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(name + ": the work folder could not be made");
    path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!keep_) fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  bool keep_;
};

void print_verification(const std::string& job, const Verification& v) {
  for (const Problem& p : v.problems.all())
    fmt::print("{}:{}: {}: {}\n", job, p.line, p.severity == Problem::Severity::kError ? "error" : "warning",
               p.words);
  fmt::print("pre-flight        {} errors, {} warnings\n", v.problems.errors(), v.problems.warnings());
  fmt::print("layer to normal   {:.3f} deg at worst\n", v.worst_layer_tilt_deg);
  if (v.worst_overlap_mm > 0)
    fmt::print("nozzle            meets printed material or table by {:.1f} mm, line {}\n",
               v.worst_overlap_mm, v.worst_overlap_line);
  else
    fmt::print("nozzle            never nearer than {:.1f} mm to earlier pieces and table (swept)\n",
               -v.worst_overlap_mm);
  fmt::print("job time          {:.0f} s, filament {:.0f} mm\n", v.job_time_s, v.filament_mm);
}

json to_json(const Composed& c) {
  json pieces = json::array();
  for (const PieceReport& p : c.pieces)
    pieces.push_back({{"name", p.name},
                      {"tilt_deg", p.tilt_deg},
                      {"layers_off_square_deg", p.layers_off_square_deg},
                      {"azimuth_deg", p.azimuth_deg},
                      {"volume_mm3", p.volume_mm3},
                      {"overhang_mm2", p.overhang_mm2},
                      {"unheld_mm2", p.unheld_mm2},
                      {"filament_mm", p.filament_mm},
                      {"layers", p.layers}});
  json out{{"pieces", pieces},
           {"job_time_s", c.verification.job_time_s},
           {"filament_mm", c.verification.filament_mm},
           {"errors", c.verification.problems.errors()},
           {"warnings", c.verification.problems.warnings()},
           {"worst_layer_tilt_deg", c.verification.worst_layer_tilt_deg},
           {"worst_nozzle_overlap_mm", c.verification.worst_overlap_mm},
           {"good", c.verification.good()}};
  if (c.support)
    out["uncut_with_support"] = {{"support_filament_mm", c.support->support_filament_mm},
                                 {"support_mm3", c.support->support_mm3},
                                 {"job_time_s", c.support->time_s}};
  return out;
}

/// Beside the pieces' meshes and G-code: how they go together.
void describe_pieces(const std::string& folder, const Composed& made) {
  std::vector<DescribedPiece> pieces;
  for (std::size_t i = 0; i < made.joined.size(); ++i) {
    const std::string& name = made.joined[i].name;
    write_stl(made.meshes[i], (fs::path(folder) / (name + "-in-part.stl")).string());
    pieces.push_back({name + ".gcode", name + "-in-part.stl", made.joined[i].frame});
  }
  write_text((fs::path(folder) / "pieces.toml").string(), describe_job(pieces));
}

int compose_part(const Arguments& arguments) {
  const WorkFolder work(arguments.work);
  ComposeOptions options = options_of(arguments);
  options.work_folder = work.path();
  std::string path = arguments.input;
  if (fs::path(path).extension() == ".3mf" || fs::path(path).extension() == ".3MF")
    path = Slicer(options.slicer, work.path()).to_stl(path);
  const auto [part, repair] = read_mesh(path);
  fmt::print("{}: {} faces; {}\n", arguments.input, part.faces.size(), repair.words());
  const Composed result = compose(part, options, machine_of(arguments));
  write_text(arguments.output, result.job.text);
  fmt::print("{:<10} {:>8} {:>9} {:>9} {:>11} {:>12} {:>7} {:>12}\n", "piece", "tilt", "azimuth", "off axis",
             "volume", "overhang", "layers", "filament");
  bool hangs = false;
  for (const PieceReport& p : result.pieces) {
    fmt::print("{:<10} {:>4.1f} deg {:>5.0f} deg {:>5.1f} deg {:>7.0f} mm3 {:>8.2f} mm2 {:>7} {:>9.0f} mm\n",
               p.name, p.tilt_deg, p.azimuth_deg, p.layers_off_square_deg, p.volume_mm3,
               p.overhang_mm2 + p.unheld_mm2, p.layers, p.filament_mm);
    hangs = hangs || p.overhang_mm2 > options.decompose.allowed_mm2 ||
            p.unheld_mm2 > options.decompose.allowed_mm2;
  }
  print_verification(arguments.output, result.verification);
  if (result.support)
    fmt::print(
        "support saved     {:.0f} mm of filament ({:.0f} mm3); the uncut part with support takes {:.0f} s\n",
        result.support->support_filament_mm, result.support->support_mm3, result.support->time_s);
  if (!arguments.report.empty()) write_text(arguments.report, to_json(result).dump(2) + "\n");
  const std::string name = "Part " + fs::path(arguments.input).stem().string();
  if (!arguments.picture.empty()) {
    std::vector<DrawnPiece> drawn;
    for (std::size_t i = 0; i < result.meshes.size(); ++i)
      drawn.push_back(
          {result.meshes[i], result.joined[i].frame,
           i == 0 ? std::string("upright") : fmt::format("tilt {:.0f}°", result.pieces[i].tilt_deg)});
    write_text(arguments.picture, picture(name, drawn));
  }
  if (!arguments.work.empty()) describe_pieces(arguments.work, result);
  if (!arguments.printing.empty()) {
    PrintPictureOptions look;
    look.nozzle = options.sweep.nozzle;
    look.table_radius_mm = options.sweep.table_radius_mm;
    write_text(arguments.printing,
               print_picture(name + ", being printed", result.job, machine_of(arguments), look));
  }
  fmt::print("job               {}\n", arguments.output);
  if (hangs)
    fmt::print(stderr,
               "kinebus-compose: a piece still overhangs; allow more tilt or overhang, or give planes\n");
  return result.verification.good() && !hangs ? 0 : 1;
}

int join_pieces(const Arguments& arguments) {
  std::vector<JoinPiece> pieces;
  std::vector<TriangleMesh> meshes;
  for (const DescribedPiece& described : read_job_description(arguments.input)) {
    JoinPiece piece{fs::path(described.gcode_path).stem().string(),
                    described.frame,
                    read_sliced(read_text(described.gcode_path), described.gcode_path),
                    {}};
    meshes.emplace_back();
    if (!described.mesh_path.empty()) meshes.back() = read_mesh(described.mesh_path).first;
    piece.box = bounds(meshes.back());
    for (const auto& [command, count] : piece.gcode.left_out)
      fmt::print("{}: left out {} x {}: it belongs to a job of its own\n", piece.name, count, command);
    pieces.push_back(std::move(piece));
  }
  const ComposeOptions options = options_of(arguments);
  const JoinedJob job = join(pieces, options.join);
  write_text(arguments.output, job.text);
  const Verification result = verify(job, pieces, meshes, machine_of(arguments), options.sweep);
  print_verification(arguments.output, result);
  return result.good() ? 0 : 1;
}

void common_options(CLI::App& command, Arguments& arguments) {
  command.add_option("-o,--output", arguments.output, "The job to write")->required();
  command.add_option("--machine", arguments.machine, "Machine file (default: M1)")->check(CLI::ExistingFile);
  command.add_option("--clearance-mm", arguments.clearance_mm, "Tool over everything while the table turns")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  command.add_option("--table-radius-mm", arguments.table_radius_mm, "The table's, for the nozzle check")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command.add_option("--nozzle", arguments.nozzle, "Its profile, height:radius,... in mm from the tip up");
}

int run(int argc, char** argv) {
  CLI::App app(
      "kinebus-compose: cuts a part so that every piece prints without support, slices the pieces with\n"
      "PrusaSlicer in their own tilted frames, and joins them into one verified five-axis job.");
  app.require_subcommand(1);
  Arguments arguments;
  int exit_code = 0;
  auto* part = app.add_subcommand("part", "A mesh to a job");
  part->add_option("mesh", arguments.input, "STL, OBJ or 3MF, mm, z up")
      ->required()
      ->check(CLI::ExistingFile);
  common_options(*part, arguments);
  part->add_option("--max-overhang-deg", arguments.max_overhang_deg,
                   "From the wall, that prints without support")
      ->check(CLI::Range(10.0, 80.0))
      ->capture_default_str();
  part->add_option("--max-tilt-deg", arguments.max_tilt_deg, "Of the table")
      ->check(CLI::Range(1.0, 89.0))
      ->capture_default_str();
  part->add_option("--layer-mm", arguments.layer_mm, "Layer height")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  part->add_option("--plane", arguments.planes,
                   "A cut of your own: nx,ny,nz,height (several: applied in turn)");
  part->add_option("--slicer", arguments.program, "PrusaSlicer's program")->capture_default_str();
  part->add_option("--slicer-config", arguments.config, "Your PrusaSlicer settings (.ini)")
      ->check(CLI::ExistingFile);
  part->add_option("--report", arguments.report, "Also write the report as JSON");
  part->add_option("--picture", arguments.picture, "Also draw the pieces (SVG)");
  part->add_option("--printing", arguments.printing, "Also draw it being printed (SVG)");
  part->add_option("--work", arguments.work,
                   "Keep the pieces' meshes, G-code and description (pieces.toml) in this folder");
  part->add_flag("--keep-position", arguments.keep_position, "Leave the part where its coordinates put it");
  part->add_flag("--no-support-comparison", arguments.no_support_comparison, "Do not slice the uncut part");
  part->callback([&] { exit_code = compose_part(arguments); });
  auto* joined =
      app.add_subcommand("join", "G-codes sliced elsewhere to a job, by a small job description (TOML)");
  joined->add_option("description", arguments.input, "See tools/README.md")
      ->required()
      ->check(CLI::ExistingFile);
  common_options(*joined, arguments);
  joined->callback([&] { exit_code = join_pieces(arguments); });
  auto* example = app.add_subcommand("example", "Writes a part to try: t, y, hook, table or two-piece");
  example->add_option("name", arguments.input)->required()->check(CLI::IsMember(example_names()));
  example->add_option("-o,--output", arguments.output, "STL file")->required();
  example->callback([&] { write_stl(example_part(arguments.input), arguments.output); });
  if (const auto end = kinebus::parse_arguments(app, argc, argv)) return *end;
  return exit_code;
}

}  // namespace
}  // namespace kinebus::compose

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-compose", [&] { return kinebus::compose::run(argc, argv); });
}
