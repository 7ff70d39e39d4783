// A whole job with homing on three firmware images with motors: the gateway core drives emulated boards in
// the simulation's place of the virtual nodes, and the tool is where the rotors put it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "protocol/bytes.hpp"
#include "tools/simulation/simulate.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr const char* kJob =
    "G21 G90 M83\nG0 X0 Y0 Z10\nG1 X12 Y0 F6000\nG1 X12 Y12 E0.4\nG3 X0 Y12 I-6 J0 E0.6\nG1 X-8 Y4 Z10.4 "
    "E0.4\n"
    "G1 X-8 Y-8 F12000 E0.4\nG1 X8 Y-8 C30 E0.5\nG1 X0 Y0 E0.3\n";

const ElfImage& image() {
  static const ElfImage loaded = load_elf(KINEBUS_FIRMWARE_IMAGE);
  return loaded;
}

// The carriages stand a little off their switches: homing takes a second, not ten.
std::vector<VirtualNodeOptions> near_the_switches(std::vector<VirtualNodeOptions> nodes) {
  double off = 9'000;
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0)
        axis.start_counts = axis.switch_counts + (axis.active_above ? -1 : 1) * (off += 1'111);
  return nodes;
}

// The emulated motors' data sheet, and an encoder on each tower's motor.
MachineDescription with_encoders(MachineDescription machine) {
  const StepperParameters p;
  for (JointDescription& joint : machine.joints)
    if (joint.homing)
      joint.motor = MotorDescription{.resistance_ohm = p.resistance_ohm,
                                     .inductance_mh = p.inductance_h * 1e3,
                                     .torque_nm_per_a = p.torque_nm_per_a,
                                     .encoder = MotorDescription::Encoder::kWatch};
  return machine;
}

SimulationReport run(bool emulated, SimulateOptions options = {}, EmulatedMachine** machine = nullptr) {
  options.simulation.seed = 3;
  options.simulation.clocks.offset_max = 50ms;
  options.make_nodes = [&](const std::vector<VirtualNodeOptions>& nodes) -> std::unique_ptr<NodeMachine> {
    if (!emulated) return std::make_unique<VirtualMachine>(near_the_switches(nodes), 3);
    auto boards = std::make_unique<EmulatedMachine>(image(), boards_like(near_the_switches(nodes)));
    if (machine != nullptr) *machine = boards.get();
    return boards;
  };
  StringSource same(kJob);
  return simulate(with_encoders(default_m1()), std::make_unique<StringSource>(kJob), same, options);
}

TEST(Job, ThreeImagesPrintWithTheirRotorsOnThePath) {
  const SimulationReport ideal = run(false);
  SimulateOptions options;
  double off_course_mm = 0;
  int readings = 0, without_encoder = 0;
  options.operate = [&](Gateway& gateway, double) {
    const MachineStatus status = gateway.status();
    if (status.state != MachineState::kRunning) return;
    for (int joint = 0; joint < status.joint_count; ++joint) {
      const auto& off = status.off_course[static_cast<std::size_t>(joint)];
      if (off) ++readings, off_course_mm = std::max(off_course_mm, std::abs(*off));
      if (!off) ++without_encoder;
    }
  };
  const SimulationReport rotors = run(true, options);
  fmt::print(
      "tool against planned pose: virtual nodes {:.2f} um, rotors of three images {:.2f} um\n"
      "joints: {:.2f} and {:.2f} microsteps; path {:.2f} and {:.2f} um; skew {:.2f} and {:.2f} us\n"
      "job {:.2f} s, machine {:.1f} s in {:.1f} s of one core\n",
      ideal.max_tracking_error_um, rotors.max_tracking_error_um, ideal.max_joint_error_counts,
      rotors.max_joint_error_counts, ideal.max_path_error_um, rotors.max_path_error_um,
      ideal.max_node_time_skew_us, rotors.max_node_time_skew_us, rotors.job_time_s, rotors.machine_time_s,
      rotors.cpu_s);
  EXPECT_TRUE(ideal.finished) << ideal.outcome;
  EXPECT_TRUE(rotors.finished) << rotors.outcome << "\n" << to_table(rotors);
  EXPECT_LE(rotors.max_node_time_skew_us, 2.0);
  EXPECT_EQ(rotors.underruns, 0u);
  EXPECT_EQ(rotors.records_out_of_sequence, 0u);
  fmt::print("four encoders, by the gateway's status: at most {:.1f} um off course in {} readings\n",
             off_course_mm * 1e3, readings);
  EXPECT_GT(readings, 0);
  EXPECT_EQ(readings, 2 * without_encoder) << "four towers have one, C and E have none";
  EXPECT_GT(off_course_mm, 0) << "measured";
  EXPECT_LT(off_course_mm * 1280, 51.2) << "two tenths of a full step";
}

TEST(Job, AShortedMotorIsToldAndTheOthersStopTogetherOnThePath) {
  EmulatedMachine* machine = nullptr;
  bool shorted = false;
  double skew_us = 0, others_counts = 0;
  std::array<PathTime, 3> tau{}, before{};
  std::array<std::optional<double>, 6> begin{};
  std::vector<std::uint16_t> codes;
  SimulateOptions options;
  options.limit_s = 2;
  options.on_frame = [&](BusTime, const CanFrame& frame) {
    if (shorted && frame.id > 0x080 && frame.id < 0x100) codes.push_back(get_u16_le(frame.data));
  };
  options.operate = [&](Gateway&, double job_s) {
    if (job_s > 0.6 && !shorted) {
      shorted = true;
      machine->board(1).motor(0).set_winding(0, StepperMotor::Winding::kShorted);
    }
    before = tau;
    const BusTime now = machine->now();
    for (int node = 0; node < 3; ++node) tau[static_cast<std::size_t>(node)] = machine->path_time(node, now);
    const auto [low, high] = std::minmax_element(tau.begin(), tau.end());
    skew_us = std::max(skew_us, static_cast<double>((*high - *low).count()) / 16);
    for (int node = 0; node < 3; ++node)
      for (int axis = 0; axis < 2; ++axis) {
        if (node == 1 && axis == 0) continue;
        const auto command = machine->commanded(node, axis);
        ASSERT_TRUE(command.has_value());
        // A rotor without encoder comes into step somewhere within an electrical turn of where it stood:
        // homing makes that good. It counts from the job's begin on.
        const double apart =
            machine->board(node).true_counts(axis) - static_cast<double>(*command) / 4294967296.0;
        auto& at_begin = begin[static_cast<std::size_t>(2 * node + axis)];
        if (!at_begin) at_begin = apart;
        others_counts = std::max(others_counts, std::abs(apart - *at_begin));
      }
  };
  const SimulationReport report = run(true, options, &machine);
  fmt::print("shorted motor of node 2: {}; EMCY", report.outcome);
  for (const std::uint16_t code : codes) fmt::print(" {:04X}", code);
  fmt::print("; path times within {:.2f} us, the other rotors within {:.1f} counts of their commands\n",
             skew_us, others_counts);
  EXPECT_NE(std::find(codes.begin(), codes.end(), 0x2320), codes.end());
  EXPECT_FALSE(report.finished);
  EXPECT_EQ(tau, before) << "path time stands still on all nodes";
  EXPECT_LE(skew_us, 2.0);
  EXPECT_LE(others_counts, 51.2) << "two tenths of a full step";
}

}  // namespace
}  // namespace kinebus::emulator
