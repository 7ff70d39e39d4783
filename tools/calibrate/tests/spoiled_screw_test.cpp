// A screw that is 0.14 % too long, as paper M5's third rail: found by what `kinebus measure` writes when
// there are linear scales on the rails. The motors' encoders certify it, and the file says what they cannot
// see.

#include <gtest/gtest.h>

#include <filesystem>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "gateway/sessions/messages.hpp"
#include "tools/calibrate/readings.hpp"
#include "tools/cli/encoder_rows.hpp"
#include "tools/simulation/simulation.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kSpoiled = 0.0014;
constexpr std::size_t kSpoiledRail = 2;

struct Measured {
  std::map<std::string, double> scale;  ///< that the rails' fit finds, by joint
  std::string sources;
  double worst_apart_mm = 0;  ///< of the scales from the true carriages
};

/// Homes, and reads 15 places up and down, as somebody does with `kinebus jog` and `kinebus measure`.
Measured measure(const MachineDescription& machine) {
  MachineDescription truth = machine;
  truth.joints[kSpoiledRail].calibration.scale = kSpoiled;
  const auto kinematics = make_kinematics(machine);
  EXPECT_TRUE(kinematics);
  SimulationOptions options;
  options.plant = &truth;
  Simulation simulation(machine, **kinematics, options);
  const auto reach = [&](MachineState state) {
    return simulation.run_until_state([state](MachineState s) { return s == state; }, 200s);
  };
  Gateway& gateway = simulation.gateway();
  EXPECT_TRUE(gateway.carry_out(command::BringUp{}) && reach(MachineState::kUnhomed));
  EXPECT_TRUE(gateway.carry_out(command::Home{}) && reach(MachineState::kReady));
  EXPECT_TRUE(gateway.carry_out(command::GoToReference{}) && reach(MachineState::kReady));
  const joblink::MachineInfo info = to_message(machine, {});
  Measured result;
  std::string csv = kEncoderHeader;
  for (int step = 0; step < 30; ++step) {
    Pose delta{};
    delta[kZ] = step < 15 ? 8 : -8;
    EXPECT_TRUE(gateway.carry_out(command::Jog{.delta = delta, .speed_per_s = 50}));
    simulation.run_until(simulation.now() + 200ms);
    EXPECT_TRUE(reach(MachineState::kReady));
    simulation.run_until(simulation.now() + 2s);
    const EncoderRows rows = encoder_rows(to_message(gateway.status()), info);
    EXPECT_TRUE(rows.silent.empty()) << rows.silent.front();
    csv += rows.csv;
    result.sources = source_words(rows);
    const JointVector true_joints = simulation.sample().joints;
    for (std::size_t node = 0; node < gateway.status().nodes.size(); ++node)
      for (const JointDescription& joint : machine.joints)
        if (const NodeStatus& s = gateway.status().nodes[node];
            joint.node_id == s.id && s.by_scale_mm[joint.axis])
          result.worst_apart_mm =
              std::max(result.worst_apart_mm,
                       std::abs(*s.by_scale_mm[joint.axis] -
                                true_joints[static_cast<std::size_t>(&joint - machine.joints.data())]));
  }
  const auto parsed = Csv::parse(csv);
  EXPECT_TRUE(parsed) << csv;
  const auto samples = rail_samples(*parsed, machine);
  EXPECT_TRUE(samples);
  for (const auto& [name, rows] : *samples) result.scale[name] = fit_rail(rows, {}).calibration.scale;
  return result;
}

TEST(SpoiledScrew, IsFoundWithScalesAndCertifiedWithoutThem) {
  const auto m5 = load_machine(machines_folder() / "m5.toml");
  ASSERT_TRUE(m5) << to_string(m5.error());
  const Measured without = measure(*m5);
  ASSERT_EQ(without.scale.size(), 4u) << "the rails' motors have encoders";
  for (const auto& [name, scale] : without.scale) EXPECT_NEAR(scale, 0, 1e-6) << name;
  EXPECT_NE(without.sources.find("encoders on the motors' shafts: rail1, rail2, rail3, rail4"),
            std::string::npos)
      << without.sources;
  EXPECT_NE(without.sources.find("An error of screw or belt is not in these readings"), std::string::npos);

  MachineDescription scaled = *m5;
  for (std::size_t rail = 0; rail < 4; ++rail)
    scaled.joints[rail].scale = ScaleDescription{.pulses_per_mm = 100, .inverted = rail == 1};
  // Two tell their places, in the encoders' place.
  for (const std::size_t rail : {2u, 3u}) {
    scaled.joints[rail].scale->absolute_bits = 24;
    scaled.joints[rail].scale->gray_code = rail == 3;
    scaled.joints[rail].motor->encoder = MotorDescription::Encoder::kNone;
  }
  const Measured with = measure(scaled);
  ASSERT_EQ(with.scale.size(), 4u);
  for (const auto& [name, scale] : with.scale)
    EXPECT_NEAR(scale, name == m5->joints[kSpoiledRail].name ? kSpoiled : 0, 4e-5) << name;
  EXPECT_NE(with.sources.find("linear scales on the rails: rail1, rail2, rail3, rail4"), std::string::npos)
      << with.sources;
  EXPECT_EQ(with.sources.find("encoders"), std::string::npos);
  EXPECT_LE(with.worst_apart_mm, 0.021) << "two pulses: one at the switch, one here";
  EXPECT_EQ(without.worst_apart_mm, 0) << "without a scale nothing is said";
}

}  // namespace
}  // namespace kinebus
