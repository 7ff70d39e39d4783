#include "tools/compose/verify.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <variant>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/jobs/job_plan.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "tools/compose/tool_path.hpp"

namespace kinebus::compose {
namespace {

/// Where the tool points away from the part, in part coordinates.
Vector tool_up(double a_rad, double c_rad) {
  return {std::sin(c_rad) * std::sin(a_rad), std::cos(c_rad) * std::sin(a_rad), std::cos(a_rad)};
}

/// Follows the canonical commands of a job and looks at the tool's places on the way.
class Sweep {
 public:
  Sweep(const JoinedJob& job, const std::vector<JoinPiece>& pieces, const std::vector<TriangleMesh>& meshes,
        const SweepOptions& options, Verification& out)
      : job_(job), pieces_(pieces), meshes_(meshes), options_(options), out_(out) {}

  void take(const canonical::Line& line) {
    if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) here_ = set->pose;
    if (const auto* move = std::get_if<canonical::Traverse>(&line.command))
      go(line.line, move->target, nullptr);
    if (const auto* move = std::get_if<canonical::Feed>(&line.command)) go(line.line, move->target, nullptr);
    if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) go(line.line, arc->target, arc);
  }

 private:
  /// The piece that a line works for; -1 before the first, the number of pieces after the last.
  int piece_at(std::uint32_t line) const {
    const auto number = static_cast<int>(line);
    for (std::size_t i = 0; i < job_.pieces.size(); ++i)
      if (number <= job_.pieces[i].last) return number >= job_.pieces[i].first ? static_cast<int>(i) : -1;
    return static_cast<int>(job_.pieces.size());
  }

  void go(std::uint32_t line, const Pose& target, const canonical::Arc* arc) {
    const int piece = piece_at(line);
    const bool feeds = target[5] > here_[5] + 1e-9;
    const bool strand = feeds && (tip_of(target) - tip_of(here_)).norm() > 1e-6;
    if (strand) out_.filament_mm += target[5] - here_[5];
    if (strand && piece >= 0 && piece < static_cast<int>(pieces_.size())) {
      const Vector n = pieces_[static_cast<std::size_t>(piece)].frame.normal();
      for (const Pose& end : {here_, target}) {
        const double cosine = std::clamp(tool_up(end[3], end[4]).dot(n), -1.0, 1.0);
        out_.worst_layer_tilt_deg =
            std::max(out_.worst_layer_tilt_deg, std::acos(cosine) * 180 / std::numbers::pi);
      }
    }
    look_along(line, piece, target, arc);
    here_ = target;
  }

  void look_along(std::uint32_t line, int piece, const Pose& target, const canonical::Arc* arc) {
    const Vector from = tip_of(here_), to = tip_of(target);
    const double length = length_of(from, to, arc);
    const double turn = std::max(std::abs(target[3] - here_[3]), std::abs(target[4] - here_[4]));
    const int steps = std::max({1, static_cast<int>(std::ceil(length / options_.step_mm)),
                                static_cast<int>(std::ceil(turn / options_.step_rad))});
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      look(line, piece, tip_between(from, to, arc, share), here_[3] + share * (target[3] - here_[3]),
           here_[4] + share * (target[4] - here_[4]));
    }
  }

  void look(std::uint32_t line, int piece, const Vector& tip, double a, double c) {
    const Vector up = tool_up(a, c);
    const Obstacles& there = obstacles(piece, up, up.dot(tip));
    if (there.empty()) return;
    const double overlap = there.overlap_mm(options_.nozzle, tip);
    if (overlap <= out_.worst_overlap_mm) return;
    out_.worst_overlap_mm = overlap;
    out_.worst_overlap_line = static_cast<int>(line);
  }

  /// Kept as long as pieces and direction stay and the tip is not lower than it was made for.
  const Obstacles& obstacles(int piece, const Vector& up, double height) {
    const bool same =
        kept_ && kept_piece_ == piece && (up - kept_up_).norm() < 1e-9 && height >= kept_lowest_;
    if (same) return *kept_;
    double lowest = height;
    const auto k = static_cast<std::size_t>(std::max(piece, 0));
    if (k < pieces_.size() && (up - pieces_[k].frame.normal()).norm() < 1e-6)
      lowest = std::min(lowest, up.dot(pieces_[k].frame.origin));
    std::vector<const TriangleMesh*> standing;
    for (std::size_t i = 0; i < std::min(k, meshes_.size()); ++i) standing.push_back(&meshes_[i]);
    kept_ = std::make_unique<Obstacles>(standing, options_.table_radius_mm, up, lowest);
    kept_piece_ = piece, kept_up_ = up, kept_lowest_ = lowest;
    return *kept_;
  }

  const JoinedJob& job_;
  const std::vector<JoinPiece>& pieces_;
  const std::vector<TriangleMesh>& meshes_;
  const SweepOptions& options_;
  Verification& out_;
  Pose here_{};
  std::unique_ptr<Obstacles> kept_;
  int kept_piece_ = -2;
  Vector kept_up_{0, 0, 0};
  double kept_lowest_ = 0;
};

std::unique_ptr<Kinematics> kinematics_of(const MachineDescription& machine) {
  auto made = make_kinematics(machine);
  if (!made) throw std::runtime_error(made.error().what);
  return std::move(*made);
}

}  // namespace

double planned_time_s(const std::string& text, const MachineDescription& machine, ProblemList& problems) {
  const auto kinematics = kinematics_of(machine);
  StringSource source(text);
  JobPlan plan(machine, *kinematics, source);
  while (!plan.step(10'000)) {
  }
  problems = plan.problems();
  return plan.report().job_time_s;
}

Verification verify(const JoinedJob& job, const std::vector<JoinPiece>& pieces,
                    const std::vector<TriangleMesh>& meshes, const MachineDescription& machine,
                    const SweepOptions& options) {
  Verification out;
  out.job_time_s = planned_time_s(job.text, machine, out.problems);
  out.worst_overlap_mm = -options.nozzle.widest();
  const auto kinematics = kinematics_of(machine);
  const Pose start = kinematics->bed_reference();
  gcode::Interpreter interpreter(interpreter_options(machine, start, start));
  gcode::JobReader reader(interpreter);
  gcode::CommandBuffer commands;
  Sweep sweep(job, pieces, meshes, options, out);
  bool good = reader.read(job.text, commands).has_value();
  if (good) good = reader.finish(commands).has_value();
  for (const canonical::Line& line : commands) sweep.take(line);
  if (!good && out.problems.errors() == 0)
    out.problems.add({Problem::Severity::kError, reader.lines(), 0, say("refused")});
  return out;
}

}  // namespace kinebus::compose
