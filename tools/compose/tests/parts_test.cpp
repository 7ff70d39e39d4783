// Five overhanging parts all the way: cut, sliced by the real PrusaSlicer, joined, checked, and printed on
// the simulated machine.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "gateway/jobs/byte_source.hpp"
#include "tools/compose/composer.hpp"
#include "tools/compose/example_parts.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus::compose {
namespace {

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
