// A checker that finds nothing proves nothing: each is shown what it has to find.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "tools/simulation/bus/virtual_nodes.hpp"
#include "tools/simulation/checkers/bus_checker.hpp"
#include "tools/simulation/checkers/joint_checker.hpp"
#include "tools/simulation/checkers/path_checker.hpp"
#include "tools/simulation/checkers/queue_checker.hpp"
#include "tools/simulation/checkers/skew_checker.hpp"
#include "tools/simulation/checkers/step_checker.hpp"

namespace kinebus {
namespace {

using std::chrono::milliseconds;

CanFrame record(std::uint8_t node, const Segment& segment) {
  CanFrame frame{.id = 0x400u + node, .length = 8};
  put_u64_le(frame.data, encode(segment));
  return frame;
}

CanFrame status(std::uint8_t node, const StreamStatus& s) {
  CanFrame frame{.id = 0x280u + node, .length = 8};
  put_u64_le(frame.data, encode(s));
  return frame;
}

TEST(JointChecker, FindsAnAccelerationBeyondTheLimit) {
  const MachineDescription machine = default_m1();
  JointChecker checker(machine);
  // 5500 mm/s2 at 1280 counts a mm, in units of 7.28 counts/s2, for 20 ms: 110 mm/s.
  const double unit = 8.0 / 4294967296.0 / 16e-6 / 16e-6;
  const auto raw = static_cast<std::int32_t>(std::lround(5500 * 1280 / unit));
  checker.on_frame(record(1, {.sequence = 0, .duration = 1250, .acceleration = {raw, 0}}));
  EXPECT_NEAR(checker.max_acceleration_ratio(), 1.1, 1e-4);
  EXPECT_NEAR(checker.max_velocity_ratio(), 110.0 / 450, 1e-4);
  EXPECT_EQ(checker.segments(), 1u);
}

TEST(JointChecker, MeasuresAccelerationByDifferences) {
  const MachineDescription machine = default_m1();
  JointChecker checker(machine);
  for (int i = 0; i < 20; ++i) {
    Sample sample;
    sample.time = milliseconds{i};
    sample.rate = 1;
    sample.in_job = true;
    sample.joints[2] = 0.5 * 4000 * 1e-6 * i * i;
    checker.on_sample(sample);
  }
  EXPECT_NEAR(checker.max_measured_acceleration_ratio(), 0.8, 1e-6);
}

TEST(StepChecker, FindsAVelocityStepAndItsJoint) {
  const MachineDescription machine = default_m1();
  StepChecker checker(machine);
  for (int i = 0; i < 20; ++i) {
    Sample sample;
    sample.time = milliseconds{i};
    sample.joints[1] = i < 10 ? 0 : 0.03 * (i - 10);  // from rest to 30 mm/s at once
    checker.on_sample(sample);
  }
  EXPECT_NEAR(checker.max_ratio(), 3, 1e-6);
  EXPECT_EQ(checker.worst_joint(), "tower2");
  EXPECT_NEAR(checker.worst_time_s(), 0.011, 1e-9);
}

TEST(SkewChecker, FindsTheNodeThatIsLate) {
  SkewChecker checker;
  Probe probe;
  probe.node_count = 3;
  probe.tau = {PathTime{1000}, PathTime{1016}, PathTime{968}};  // 1/16 us each
  checker.on_probe(probe);
  EXPECT_DOUBLE_EQ(checker.max_us(), 3.0);
}

TEST(VirtualNodes, HaveTheSensorsOfTheFile) {
  const auto machine = load_machine(machines_folder() / "m1_octopus_ebb.toml");
  ASSERT_TRUE(machine) << to_string(machine.error());
  MachineDescription changed = *machine;
  changed.heaters.at(0).wiring.sensor = {
      .element = SensorElement::kPt1000, .max31865 = true, .reference_ohm = 4300};
  const std::uint8_t heated = changed.heaters.at(0).place.node_id,
                     channel = changed.heaters.at(0).place.channel;
  bool found = false;
  for (const VirtualNodeOptions& node : virtual_nodes_of(changed, {}, 1)) {
    if (!node.heat || node.node.node_id != heated) continue;
    found = true;
    const heat::SensorPart& part = node.sensors.at(channel - 1u);
    EXPECT_EQ(part.ohm(0), 1000);
    EXPECT_EQ(part.share(2150), 0.5);
    // generic_3950 at 150 C is 1770 Ohm.
    EXPECT_NEAR(node.sensors.at(2u - channel).ohm(150), 1770, 1e-6);
  }
  EXPECT_TRUE(found);
}

TEST(QueueChecker, FindsRecordsOutOfSequenceAndWithoutRoom) {
  QueueChecker checker;
  checker.on_frame(status(2, {.next_sequence = 0, .free_records = 2}));
  checker.on_frame(record(2, {.sequence = 0, .duration = 1}));
  checker.on_frame(record(2, {.sequence = 1, .duration = 1}));
  EXPECT_EQ(checker.findings().overruns, 0u);
  checker.on_frame(record(2, {.sequence = 2, .duration = 1}));
  EXPECT_EQ(checker.findings().overruns, 1u);
  EXPECT_EQ(checker.findings().out_of_sequence, 0u);
  checker.on_frame(record(2, {.sequence = 4, .duration = 1}));
  EXPECT_EQ(checker.findings().out_of_sequence, 1u);
  checker.on_frame(status(2, {.next_sequence = 3, .free_records = 0, .flags = StreamStatus::kUnderrun}));
  EXPECT_EQ(checker.findings().error_flags, 1u);
  EXPECT_EQ(checker.findings().fullest, 2);
}

TEST(BusChecker, FindsTheBusiestSecondWhereverItBegins) {
  BusChecker checker;
  BusModel::Statistics bus;
  Sample sample;
  sample.in_job = true;
  for (int i = 0; i < 5000; ++i) {
    bus.bits += i >= 2345 && i < 3345 ? 400 : 100;
    checker.on_sample(sample, bus);
  }
  EXPECT_NEAR(checker.peak_1s(), 0.4, 1e-3);
  EXPECT_NEAR(checker.mean(), 0.16, 1e-3);
}

class PathCheckerOf : public testing::Test {
 protected:
  double distance_um(Pose pose, std::uint32_t line) {
    StringSource text("G21 G90 F6000\nG1 X10 Y0\nG1 X10 Y10\nG2 X0 Y0 I-10 J0\nG0 X10 Y5\n");
    PathChecker checker(machine_, *kinematics_, text, {});
    Sample sample;
    for (std::uint32_t l = 2; l <= line; ++l) {
      sample.planned = PlannedPose{{}, Frame::kMachine, l};
      sample.line = l;
      sample.pose = pose;
      checker.on_sample(sample);
    }
    return checker.last_um();
  }
  MachineDescription machine_ = default_m1();
  std::unique_ptr<Kinematics> kinematics_ = std::move(*make_kinematics(machine_));
};

TEST_F(PathCheckerOf, MeasuresTheDistanceFromLines) {
  EXPECT_NEAR(distance_um({5, 0.002, 0}, 2), 2, 1e-6);
  EXPECT_NEAR(distance_um({10.003, 5, 0.004}, 3), 5, 1e-6);
}

TEST_F(PathCheckerOf, DoesNotTakeALaterLineForThePlace) {
  // Line 5 comes back to (10, 5), and line 3 passes there: in line 2 neither counts yet.
  EXPECT_NEAR(distance_um({10, 0.05, 0}, 2), 50, 1e-6);
}

TEST(VirtualNodes, StartSomewhereElseWithEverySeed) {
  const auto one = virtual_nodes_of(default_m1(), {}, 1), two = virtual_nodes_of(default_m1(), {}, 2);
  EXPECT_NE(one[0].axes[0].start_counts, two[0].axes[0].start_counts);
}

}  // namespace
}  // namespace kinebus
