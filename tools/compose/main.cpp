// kinebus-compose: from a part with overhangs to one five-axis job without support.

#include <fmt/format.h>

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <sstream>

#include "protocol/host/guarded_main.hpp"
#include "protocol/host/step_line.hpp"
#include "protocol/host/usage.hpp"
#include "tools/compose/arguments.hpp"
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

json number_or_null(const std::optional<double>& value) {
  return value ? json(*value) : json(nullptr);
}

json to_json(const Composed& c) {
  json pieces = json::array();
  for (const PieceReport& p : c.pieces)
    pieces.push_back({{"name", p.name},
                      {"tilt_deg", p.tilt_deg},
                      {"layers_off_square_deg", number_or_null(p.layers_off_square_deg)},
                      {"arm_leans_deg", number_or_null(p.arm_leans_deg)},
                      {"tilted_to_limit", p.tilted_to_limit},
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
                                 {"job_time_s", c.support->time_s},
                                 {"unsupported_time_s", c.support->unsupported_time_s}};
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

/// "-" for none; never "-0".
std::string degrees(const std::optional<double>& deg, int digits) {
  if (!deg) return "-";
  const double scale = digits == 0 ? 1 : 10;
  return fmt::format("{:.{}f} deg", std::round(*deg * scale) / scale + 0.0, digits);
}

int compose_part(const Arguments& arguments) {
  const WorkFolder work(arguments.work);
  const MachineDescription machine = machine_of(arguments);
  StepLine steps;
  ComposeOptions options = options_of(arguments, machine);
  require_tilt(options);
  options.work_folder = work.path();
  options.on_step = [&](const std::string& words) { steps.show(words); };
  std::string path = arguments.input;
  if (fs::path(path).extension() == ".3mf" || fs::path(path).extension() == ".3MF")
    path = Slicer(options.slicer, work.path()).to_stl(path);
  const auto [part, repair] = read_mesh(path);
  fmt::print("{}: {} faces; {}\n", arguments.input, part.faces.size(), repair.words());
  const Composed result = compose(part, options, machine);
  steps.clear();
  write_text(arguments.output, result.job.text);
  fmt::print("{:<10} {:>8} {:>8} {:>8} {:>9} {:>11} {:>11} {:>6} {:>10}\n", "piece", "tilt", "azimuth", "arm",
             "off axis", "volume", "overhang", "layers", "filament");
  bool hangs = false;
  for (const PieceReport& p : result.pieces) {
    fmt::print("{:<10} {:>8} {:>8} {:>8} {:>9} {:>7.0f} mm3 {:>7.2f} mm2 {:>6} {:>7.0f} mm{}\n", p.name,
               degrees(p.tilt_deg, 1), degrees(p.azimuth_deg, 0), degrees(p.arm_leans_deg, 1),
               degrees(p.layers_off_square_deg, 1), p.volume_mm3, p.overhang_mm2 + p.unheld_mm2, p.layers,
               p.filament_mm, p.tilted_to_limit ? "  tilted as far as the machine does" : "");
    hangs = hangs || p.overhang_mm2 > options.decompose.allowed_mm2 ||
            p.unheld_mm2 > options.decompose.allowed_mm2;
  }
  print_verification(arguments.output, result.verification);
  if (result.support)
    fmt::print(
        "support saved     {:.0f} mm of filament ({:.0f} mm3); the uncut part with support takes {:.0f} s, "
        "{:.2f} "
        "times as long\n"
        "                  (cutting for nothing would give {:.2f}: with its support left out it takes {:.0f} "
        "s)\n",
        result.support->support_filament_mm, result.support->support_mm3, result.support->time_s,
        result.support->time_s / result.verification.job_time_s,
        result.support->time_s / result.support->unsupported_time_s, result.support->unsupported_time_s);
  if (!arguments.report.empty()) write_text(arguments.report, to_json(result).dump(2) + "\n");
  const std::string name = "Part " + fs::path(arguments.input).stem().string();
  if (!arguments.picture.empty()) {
    std::vector<DrawnPiece> drawn;
    for (std::size_t i = 0; i < result.meshes.size(); ++i)
      drawn.push_back({result.meshes[i], result.joined[i].frame,
                       result.pieces[i].tilt_deg < 0.5
                           ? std::string("upright")
                           : fmt::format("tilt {:.0f}°", result.pieces[i].tilt_deg)});
    write_text(arguments.picture, picture(name, drawn));
  }
  if (!arguments.work.empty()) describe_pieces(arguments.work, result);
  if (!arguments.printing.empty()) {
    PrintPictureOptions look;
    look.nozzle = options.sweep.nozzle;
    look.table_radius_mm = options.sweep.table_radius_mm;
    write_text(arguments.printing, print_picture(name + ", being printed", result.job, machine, look));
  }
  fmt::print("job               {}\n", arguments.output);
  if (hangs)
    fmt::print(stderr,
               "kinebus-compose: a piece still overhangs; allow more tilt or overhang, or give planes\n");
  return result.verification.good() && !hangs ? 0 : 1;
}

/// The example parts one after the other: tilt, layers to the arm, and time, as a table.
int compose_examples(const Arguments& arguments) {
  const MachineDescription machine = machine_of(arguments);
  ComposeOptions options = options_of(arguments, machine);
  const WorkFolder work(arguments.work);
  require_tilt(options);
  options.work_folder = work.path();
  StepLine steps;
  const auto list = [](const Composed& made, const auto& of) {
    std::string out;
    for (const PieceReport& piece : made.pieces) {
      const std::optional<double> deg = of(piece);
      out += fmt::format("{}{}", out.empty() ? "" : " ", deg ? fmt::format("{:.0f}", std::abs(*deg)) : "-");
    }
    return out;
  };
  fmt::print(
      "A machine that tilts {:.0f} deg. For each piece, deg: tilt of the table; how far its arm leans from "
      "z; its "
      "layers off\nsquare to the arm, measured on the mesh (-: no arm). Time, s: this job; the uncut part "
      "with "
      "support, same machine and\nspeeds; the same without, as if nothing hung: about the least that cutting "
      "can reach.\n\n"
      "{:<10} {:<17} {:<17} {:<17} {:>6} {:>8} {:>8} {:>6} {:>7}\n",
      options.decompose.max_tilt_rad / kRad, "part", "tilt", "arm leans", "layers off", "job", "support",
      "without", "times", "ideal");
  bool good = true;
  for (const std::string& name : example_names()) {
    options.on_step = [&](const std::string& words) { steps.show(fmt::format("{}: {}", name, words)); };
    const Composed made = compose(example_part(name), options, machine);
    steps.clear();
    const SupportComparison& uncut = made.support.value();
    const double job_s = made.verification.job_time_s;
    fmt::print("{:<10} {:<17} {:<17} {:<17} {:>6.0f} {:>8.0f} {:>8.0f} {:>6.2f} {:>7.2f}{}\n", name,
               list(made, [](const PieceReport& p) { return std::optional(p.tilt_deg); }),
               list(made, [](const PieceReport& p) { return p.arm_leans_deg; }),
               list(made, [](const PieceReport& p) { return p.layers_off_square_deg; }), job_s, uncut.time_s,
               uncut.unsupported_time_s, uncut.time_s / job_s, uncut.time_s / uncut.unsupported_time_s,
               made.verification.good() ? "" : "  THE JOB IS NOT GOOD");
    good = good && made.verification.good();
  }
  return good ? 0 : 1;
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
  const MachineDescription machine = machine_of(arguments);
  const ComposeOptions options = options_of(arguments, machine);
  const JoinedJob job = join(pieces, options.join);
  write_text(arguments.output, job.text);
  const Verification result = verify(job, pieces, meshes, machine, options.sweep);
  print_verification(arguments.output, result);
  return result.good() ? 0 : 1;
}

void common_options(CLI::App& command, Arguments& arguments) {
  command.add_option("-o,--output", arguments.output, "The job to write")->required();
  command.add_option("--machine", arguments.machine,
                     "Machine file, or the name of a shipped one (default: m1)");
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
  app.set_version_flag("--version", KINEBUS_VERSION);
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
  part->add_option("--max-tilt-deg", arguments.max_tilt_deg,
                   "Of the table (default: as far as the machine tilts)")
      ->check(CLI::Range(1.0, 89.0));
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
  auto* examples = app.add_subcommand("examples", "All example parts: tilt, layers to the arm, and time");
  examples->add_option("--machine", arguments.machine,
                       "Machine file, or the name of a shipped one (default: m1)");
  examples->add_option("--layer-mm", arguments.layer_mm, "Layer height")
      ->check(CLI::Range(0.05, 1.0))
      ->capture_default_str();
  examples->add_option("--slicer", arguments.program, "PrusaSlicer's program")->capture_default_str();
  examples->add_option("--slicer-config", arguments.config, "Your PrusaSlicer settings (.ini)")
      ->check(CLI::ExistingFile);
  examples->callback([&] { exit_code = compose_examples(arguments); });
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
