// Where the axes stand, and what of it is shown.

#include "gateway/machine/position.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/manual_motion.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Joints 1 to 3 have encoders, the others have none.
class PositionTest : public ::testing::Test {
 protected:
  static constexpr Pose kPose{20, 10, 30, 0.1, -0.2, 100};

  static MachineDescription with_encoders() {
    MachineDescription m = default_m1();
    for (std::size_t joint = 0; joint < 3; ++joint) {
      if (!m.joints[joint].motor) m.joints[joint].motor.emplace();
      m.joints[joint].motor->encoder = MotorDescription::Encoder::kWatch;
    }
    return m;
  }
  PositionTest() {
    EXPECT_TRUE(kinematics->inverse(Frame::kMachine, kPose, joints));
    for (const NodeAxes& node : axes) {
      links.emplace_back(node.node_id);
      links.back().on_frame(1s, heartbeat_frame(NmtState::kOperational, node.node_id));
      std::array<AxisState, kAxesPerNode> states{};
      for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
        if (node.axes[axis].joint >= 0)
          states[axis].position =
              to_fixed(node.axes[axis].to_counts(joints[static_cast<std::size_t>(node.axes[axis].joint)]));
      group.set_state(node.node_id, states, {});
    }
    position.take_run_end();
  }
  void is_known() {
    Standstill found(no_homing, links);
    ASSERT_TRUE(found.positions_known());
    position.take(found);
    position.take_run_end();
  }
  MachineStatus report() {
    MachineStatus s;
    for (const NodeLink& link : links) s.nodes.push_back(link.status(1s, 1s));
    position.report(s, joints, links);
    return s;
  }
  /// Both axes of a node are so many counts behind.
  void is_behind(std::size_t node, std::int32_t a, std::int32_t b) {
    CanFrame frame{.id = cob_id::tpdo(4, links[node].id()), .length = 8};
    put_u32_le(frame.data, static_cast<std::uint32_t>(a));
    put_u32_le(std::span(frame.data).subspan(4), static_cast<std::uint32_t>(b));
    EXPECT_TRUE(links[node].on_frame(1s, frame));
  }

  MachineDescription machine = with_encoders(), no_homing = [] {
    MachineDescription m = default_m1();
    for (JointDescription& joint : m.joints) joint.homing.reset();
    return m;
  }();
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));
  std::vector<NodeAxes> axes = node_axes(machine);
  StreamGroup group{*kinematics, axes, stream_options(machine)};
  std::deque<NodeLink> links;
  PathRate rate;
  Devices devices;
  Heat heat{machine, devices};
  EventQueue events;
  journal::Queue journal;
  ManualMotion hand{machine, *kinematics, group, rate, heat, events, journal, nullptr};
  Position position{machine, *kinematics, axes, group};
  JointVector joints{};
};

TEST_F(PositionTest, TheJointsAreWhereTheNodesRest) {
  const JointVector found = position.joints(hand.runner(), {});
  for (std::size_t joint = 0; joint < 6; ++joint) EXPECT_NEAR(found[joint], joints[joint], 1e-6) << joint;
  const auto pose = position.pose(found);
  ASSERT_TRUE(pose);
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) EXPECT_NEAR((*pose)[axis], kPose[axis], 1e-5) << axis;
  JointVector none = found;
  none[0] += 5000;
  const auto refused = position.pose(none);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().words.english().find("no pose fits the joints' positions: "), 0U);
}

TEST_F(PositionTest, NoPoseIsShownOfAMachineThatDoesNotKnowItsOwn) {
  MachineStatus s = report();
  EXPECT_FALSE(s.positions_known);
  EXPECT_EQ(s.pose, Pose{});
  EXPECT_EQ(s.machine_pose, Pose{});
  EXPECT_EQ(s.joint_count, 6);
  EXPECT_EQ(s.joints, joints);
  is_behind(0, 128, 256);
  EXPECT_FALSE(report().measured_pose);
  is_known();
  s = report();
  EXPECT_TRUE(s.positions_known && position.homed());
  EXPECT_TRUE(s.measured_pose);
  Pose part = kinematics->bed_reference();
  ASSERT_TRUE(kinematics->forward(Frame::kPart, joints, part));
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    EXPECT_NEAR(s.machine_pose[axis], kPose[axis], 1e-5) << axis;
    EXPECT_NEAR(s.pose[axis], part[axis], 1e-5) << axis;
  }
  position.lose_stream();
  s = report();
  EXPECT_FALSE(s.positions_known);
  EXPECT_NEAR(s.machine_pose[kX], kPose[kX], 1e-5) << "it is shown where it was";
  position.stream_is_new();
  EXPECT_TRUE(report().positions_known);
  position.forget();
  EXPECT_FALSE(report().positions_known);
}

TEST_F(PositionTest, TheJobsFilamentIsShownAndAJointsMotorCountsAnew) {
  is_known();
  position.show_filament_less(3);
  is_behind(0, 128, 128);
  const MachineStatus s = report();
  EXPECT_NEAR(s.pose[kE], kPose[kE] - 3, 1e-5);
  EXPECT_NEAR(s.machine_pose[kE], kPose[kE] - 3, 1e-5);
  ASSERT_TRUE(s.measured_pose);
  EXPECT_NEAR((*s.measured_pose)[kE], kPose[kE] - 3, 1e-5);
  is_known();
  EXPECT_NEAR(report().pose[kE], kPose[kE] - 3, 1e-5) << "as long as it is known";
  const Standstill unknown(machine, links);
  ASSERT_FALSE(unknown.positions_known());
  position.take(unknown);
  EXPECT_FALSE(position.homed());
  is_known();
  EXPECT_NEAR(report().pose[kE], kPose[kE], 1e-5);
}

TEST_F(PositionTest, OffCourseIsWhatAnEncoderSaysInTheJointsOwnUnit) {
  is_known();
  EXPECT_FALSE(report().measured_pose);
  is_behind(0, 128, 256);
  is_behind(1, -128, 640);
  const MachineStatus s = report();
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
      const AxisScaling& scaling = axes[i].axes[axis];
      const auto joint = static_cast<std::size_t>(scaling.joint);
      const double counts[2][2] = {{128, 256}, {-128, 640}};
      if (i < 2 && scaling.joint >= 0 && joint < 3) {
        ASSERT_TRUE(s.off_course[joint]) << joint;
        EXPECT_NEAR(*s.off_course[joint], counts[i][axis] / scaling.slope(), 1e-9) << joint;
        EXPECT_EQ(s.nodes[i].off_course[axis], s.off_course[joint]);
      } else {
        EXPECT_FALSE(s.nodes[i].off_course[axis]) << "no encoder, or nothing told";
      }
    }
  ASSERT_TRUE(s.measured_pose);
  JointVector measured = joints;
  for (std::size_t joint = 0; joint < 3; ++joint) measured[joint] -= *s.off_course[joint];
  Pose pose = s.pose;
  ASSERT_TRUE(kinematics->forward(Frame::kPart, measured, pose));
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
    EXPECT_NEAR((*s.measured_pose)[axis], pose[axis], 1e-5) << axis;
  MachineStatus silent;
  for (const NodeLink& link : links) silent.nodes.push_back(link.status(100s, 1s));
  position.report(silent, joints, links);
  EXPECT_FALSE(silent.off_course[0]) << "its node is not heard any more";
}

}  // namespace
}  // namespace kinebus
