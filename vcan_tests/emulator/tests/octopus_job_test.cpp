// M1 on boards that people own: the images of an Octopus and an EBB, their drivers, a hot end, switches, and
// one USB cable to the gateway. It homes, heats and prints; all is measured at rotors and blocks.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/description/shipped_machines.hpp"
#include "tools/simulation/simulate.hpp"
#include "vcan_tests/emulator/tests/one_cable.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr const char* kJob =
    "G21 G90 M83\nM104 S205\nG0 X0 Y0 Z10\nM109 S205\nM106 S128\n"
    "G1 X12 Y0 E0.5 F3000\nG1 X12 Y12 E0.5\nG3 X0 Y12 I-6 J0 E0.7\nG1 X-8 Y4 Z10.4 E0.5\n"
    "G1 X-8 Y-8 E0.5\nG1 X8 Y-8 C30 E0.6\nG1 X0 Y0 E0.4\nM107\nM104 S0\n";
// Of the hot end: a print a moment ago has left it warm.
constexpr double kStart_c = 204;
constexpr double kStepCounts = OctopusBoard::kCountsPerStep;

const ElfImage& octopus_image() {
  static const ElfImage loaded = load_elf(KINEBUS_OCTOPUS_IMAGE);
  return loaded;
}

MachineDescription machine_file() {
  auto machine = machine_of("m1_octopus_ebb");
  EXPECT_TRUE(machine) << machine.error();
  return *machine;
}

double filament_mm_per_count(const MachineDescription& machine) {
  for (const JointDescription& joint : machine.joints)
    if (joint.name == "E") return 1 / joint.drive.counts_per_unit();
  return 0;
}

// The carriages stand a little off their switches: homing takes seconds, not half a minute.
std::vector<VirtualNodeOptions> near_the_switches(std::vector<VirtualNodeOptions> nodes) {
  double off = 9'000;
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0)
        axis.start_counts = axis.switch_counts + (axis.active_above ? -1 : 1) * (off += 1'111);
  return nodes;
}

TEST(OctopusJob, HomesHeatsAndPrintsOnAnOctopusAndAnEbbThroughOneCable) {
  const MachineDescription machine = machine_file();
  OneCableMachine* cable = nullptr;
  SimulateOptions options;
  options.simulation.seed = 3;
  options.simulation.clocks.offset_max = 50ms;
  options.make_nodes = [&](const std::vector<VirtualNodeOptions>& nodes) -> std::unique_ptr<NodeMachine> {
    auto made = std::make_unique<OneCableMachine>(octopus_image(), near_the_switches(nodes),
                                                  filament_mm_per_count(machine), kStart_c, true);
    cable = made.get();
    return made;
  };
  std::uint64_t echoes = 0;
  options.operate = [&](Gateway&, double) { echoes = cable->host().heard.size(); };
  StringSource same(kJob);
  // A joint against the plan, in counts: what homing left of it, and how it moves around that.
  struct Span {
    double least = 1e9, most = -1e9;
    double middle() const { return (least + most) / 2; }
    double half() const { return (most - least) / 2; }
  };
  std::array<Span, kMaxJoints> off{};
  auto made = make_kinematics(machine);
  ASSERT_TRUE(made);
  const std::unique_ptr<const Kinematics> kinematics = std::move(*made);
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    JointVector planned{};
    if (!sample.planned || !kinematics->inverse(sample.planned->frame, sample.planned->pose, planned)) return;
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      const double counts = (sample.joints[j] - planned[j]) * machine.joints[j].drive.counts_per_unit();
      off[j] = {std::min(off[j].least, counts), std::max(off[j].most, counts)};
    }
  };
  double hottest_printing = 0;
  options.on_frame = [&](BusTime, const CanFrame&) {
    hottest_printing = std::max(hottest_printing, cable->octopus().heated().hot_end().block());
  };
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(kJob), same, options);
  fmt::print("{}\n", to_table(report));
  ASSERT_TRUE(report.finished) << report.outcome;
  EXPECT_GT(echoes, 1000u) << "all went through the cable";
  EXPECT_LE(report.max_node_time_skew_us, 2.0);
  EXPECT_EQ(report.underruns, 0u);
  EXPECT_EQ(report.records_out_of_sequence, 0u);
  // The plan is within half a microstep of where homing has found the motor, which is within another half;
  // the rotor within what load and friction turn it.
  EXPECT_LT(report.max_joint_error_counts, kStepCounts);
  EXPECT_LT(report.max_path_error_um, 80);
  ASSERT_TRUE(report.heat);
  for (std::size_t j = 0; j < machine.joints.size(); ++j) {
    const JointDescription& joint = machine.joints[j];
    fmt::print("joint {}: {:+.2f} counts off, +-{:.2f} around it\n", joint.name, off[j].middle(),
               off[j].half());
    EXPECT_LE(off[j].half(), kStepCounts / 2 + machine.tolerances.segment_counts) << joint.name;
    EXPECT_LE(std::abs(off[j].middle()), joint.homing ? kStepCounts / 2 + 0.5 : 0.3) << joint.name;
  }
  fmt::print("block at most {:.1f} C, coldest fed {:.1f} C\n", hottest_printing, report.heat->coldest_fed_c);
  EXPECT_GT(report.heat->coldest_fed_c, 203);
  EXPECT_LT(hottest_printing, 208);
}

}  // namespace
}  // namespace kinebus::emulator
