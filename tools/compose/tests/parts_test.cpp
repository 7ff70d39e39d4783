// Five overhanging parts all the way: cut, sliced by the real PrusaSlicer, joined, checked, and printed on
// the simulated machine.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>

#include "gateway/jobs/byte_source.hpp"
#include "tools/compose/composer.hpp"
#include "tools/compose/example_parts.hpp"
#include "tools/compose/strands.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus::compose {
namespace {

/// A stretch of an example part's arm as its drawing has it, before the part is put on the table.
struct DrawnArm {
  Vector from{0, 0, 0}, to{0, 0, 0};
  double radius_mm = 0;  ///< strands within it belong to the arm
};

std::vector<DrawnArm> drawn_arms(const std::string& part) {
  const double lean = 50 * std::numbers::pi / 180;
  const Vector at50(std::sin(lean), 0, std::cos(lean));
  if (part == "t") return {{{10, 0, 34}, {26, 0, 34}, 9}, {{-10, 0, 34}, {-26, 0, 34}, 9}};
  if (part == "y") {  // between a lower side that leans 60 deg and an upper one from the notch to its tip
    const double upper = std::atan2(6 + 32 * std::sqrt(0.75) - 6, 22 + 16 + 6 * std::sqrt(3.0) - 39.32);
    const double middle = (std::numbers::pi / 3 + upper) / 2;
    const Vector tip((33.71 + 27.71) / 2, 0, (38 + 48.39) / 2);
    const Vector along(std::sin(middle), 0, std::cos(middle));
    const Vector root = tip - 18 * along;
    return {{root, tip, 9}, {{-root[0], 0, root[2]}, {-tip[0], 0, tip[2]}, 9}};
  }
  if (part == "hook")
    return {{{-17, 0, 0}, {-17, 0, 25}, 9}, {{2, 0, 43}, {13, 0, 43}, 9}, {{21, 0, 54}, {21, 0, 60}, 9}};
  if (part == "table") return {{Vector(14, 0, 27) + 16 * at50, Vector(14, 0, 27) + 40 * at50, 8}};
  return {{{0, 0, 0}, {0, 0, 16}, 12}, {Vector(0, 0, 28) + 16 * at50, Vector(0, 0, 28) + 36 * at50, 12}};
}

double degrees_between(const Vector& a, const Vector& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// Share of an arm's strands, by length, that are laid square to it as nearly as the table tilts.
double share_laid_square(const std::vector<Strand>& strands, const DrawnArm& arm, double max_tilt_deg,
                         double slack_deg) {
  const Vector axis = (arm.to - arm.from).normalized();
  const double allowed_deg = std::max(0.0, degrees_between(axis, Vector(0, 0, 1)) - max_tilt_deg) + slack_deg;
  double all = 0, square = 0;
  for (const Strand& s : strands) {
    const Vector from_root = (s.from + s.to) / 2 - arm.from;
    const double along = axis.dot(from_root);
    if (along < 0 || along > (arm.to - arm.from).norm()) continue;
    if ((from_root - along * axis).norm() > arm.radius_mm) continue;
    const Vector tool(std::sin(s.c_rad) * std::sin(s.a_rad), std::cos(s.c_rad) * std::sin(s.a_rad),
                      std::cos(s.a_rad));
    all += (s.to - s.from).norm();
    if (degrees_between(tool, axis) <= allowed_deg) square += (s.to - s.from).norm();
  }
  return all > 0 ? square / all : 0;
}

class Part : public testing::TestWithParam<std::string> {};

TEST_P(Part, IsPrintedWithoutSupportOnTheSimulatedMachine) {
  const MachineDescription machine = default_m1();
  ComposeOptions options;
  options.slicer.layer_mm = 0.4;  // half as many layers: the same rules, half the time
  options.work_folder = testing::TempDir() + "/compose-" + GetParam();
  std::filesystem::create_directories(options.work_folder);
  const Composed made = compose(example_part(GetParam()), options, machine);

  ASSERT_GE(made.pieces.size(), 2u);
  double filament = 0;
  for (const PieceReport& piece : made.pieces) {
    EXPECT_LE(piece.overhang_mm2, options.decompose.allowed_mm2) << piece.name;
    EXPECT_GT(piece.layers, 2) << piece.name;
    filament += piece.filament_mm;
  }
  const auto& problems = made.verification.problems;
  EXPECT_EQ(problems.errors(), 0u) << problems.all().front().line << ": " << problems.all().front().words;
  EXPECT_LE(made.verification.worst_layer_tilt_deg, 1);
  EXPECT_LE(made.verification.worst_overlap_mm, 0) << "line " << made.verification.worst_overlap_line;
  EXPECT_NEAR(made.verification.filament_mm, filament, 0.01 * filament);
  ASSERT_TRUE(made.support);
  EXPECT_GT(made.support->support_filament_mm, 0)
      << "the slicer itself finds that the uncut part needs support";
  // By the same planner at the same speeds; layers of small pieces cost time, support costs more.
  EXPECT_LT(made.verification.job_time_s, made.support->time_s);
  EXPECT_LT(made.support->unsupported_time_s, made.support->time_s);

  // Read back from the job: which way the tool pointed while each arm was laid.
  const Box drawn = bounds(example_part(GetParam()));
  const Vector shift(-(drawn.low[0] + drawn.high[0]) / 2, -(drawn.low[1] + drawn.high[1]) / 2, -drawn.low[2]);
  const std::vector<Strand> strands = strands_of(made.job, machine);
  for (DrawnArm arm : drawn_arms(GetParam())) {
    arm.from += shift, arm.to += shift;
    EXPECT_GE(share_laid_square(strands, arm, 45, 3), 0.95) << "arm to " << arm.to.transpose();
  }
  // And what the report says of each arm, measured on the meshes.
  int arms = 0;
  for (const PieceReport& piece : made.pieces) {
    if (!piece.tilted_to_limit && piece.tilt_deg < 1) continue;
    if (!piece.layers_off_square_deg) continue;
    ++arms;
    EXPECT_LE(*piece.layers_off_square_deg, std::max(0.0, *piece.arm_leans_deg - 45) + 4) << piece.name;
  }
  EXPECT_GE(arms, 1);

  SimulateOptions simulation;
  StringSource checkers_text(made.job.text);
  const SimulationReport report =
      simulate(machine, std::make_unique<StringSource>(made.job.text), checkers_text, simulation);
  EXPECT_TRUE(report.finished) << report.trouble << " (seed " << report.seed << ")";
  EXPECT_LE(report.max_path_error_um, 10) << "seed " << report.seed;
  // M1's legs, which stand steeply, move the tool by more than a carriage is off.
  EXPECT_LE(report.max_tracking_error_um, 1.5) << "seed " << report.seed;
  RecordProperty("job_time_s", std::to_string(made.verification.job_time_s));
}

INSTANTIATE_TEST_SUITE_P(Examples, Part, testing::ValuesIn(example_names()), [](const auto& parameter) {
  std::string name = parameter.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace kinebus::compose
