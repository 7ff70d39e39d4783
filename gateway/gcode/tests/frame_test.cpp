// Tool centre point, tilted plane, and the rotation convention m = R_X(A) R_Z(C) q.

#include <cmath>
#include <numbers>
#include <random>

#include "gateway/gcode/tests/test_support.hpp"
#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Pose random_pose(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-100, 100), angle(-3, 3);
  return {place(random), place(random), place(random), angle(random), angle(random), place(random)};
}

TEST(Frame, MachineIsRxARzCTimesPart) {
  // A = 90, C = 90: the part's +X points along the machine's +Y before A, along +Z after it.
  const Pose part = {1, 0, 0, 90 * kDegree, 90 * kDegree, 5};
  expect_near(in_frame(part, Frame::kPart, Frame::kMachine), {0, 0, 1, 90 * kDegree, 90 * kDegree, 5}, 1e-12);
  std::mt19937 random(5);
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = random_pose(random);
    expect_near(in_frame(in_frame(pose, Frame::kPart, Frame::kMachine), Frame::kMachine, Frame::kPart), pose,
                1e-12);
  }
}

TEST(Frame, SwitchingToolCentrePointMovesNothing) {
  std::mt19937 random(6);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    Options options;
    options.start = pose;
    Session session(options);
    session.must("G10 L2 P1 X3 Y-4 Z5\nG43.4\nG49");
    const auto positions = session.all<canonical::SetPosition>();
    ASSERT_EQ(positions.size(), 3U);
    expect_near(positions[0].pose, pose);
    expect_near(in_frame(positions[1].pose, positions[1].frame, Frame::kMachine), pose);
    EXPECT_EQ(positions[1].frame, Frame::kPart);
    expect_near(positions[2].pose, pose);
    EXPECT_EQ(positions[2].frame, Frame::kMachine);
  }
}

TEST(TiltedPlane, IsGivenByEulerAnglesZxz) {
  // The plane's X after I, J, K: checked against turning the axes one after the other about themselves.
  const double i = 20 * kDegree, j = 35 * kDegree, k = -50 * kDegree;
  const Matrix3 plane = euler_zxz(i, j, k);
  const Vector3 normal = {plane[0][2], plane[1][2], plane[2][2]};
  EXPECT_NEAR(normal[0], std::sin(i) * std::sin(j), 1e-12);
  EXPECT_NEAR(normal[1], -std::cos(i) * std::sin(j), 1e-12);
  EXPECT_NEAR(normal[2], std::cos(j), 1e-12);
  const Vector3 line_of_nodes = {std::cos(i), std::sin(i), 0};
  const Vector3 x = {plane[0][0], plane[1][0], plane[2][0]};
  EXPECT_NEAR(x[0] * line_of_nodes[0] + x[1] * line_of_nodes[1], std::cos(k), 1e-12);
}

TEST(TiltedPlane, OrientedToolStandsNormalToThePlane) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> any(-180, 180), slope(0.1, 44);
  for (int n = 0; n < 300; ++n) {
    const double i = any(random), j = slope(random), k = any(random);
    Session session;
    const std::string tcp = (n & 1) != 0 ? "G43.4\n" : "";
    session.must("G0 X10 Y-20 Z30 C" + std::to_string(any(random)) + "\n" + tcp + "G68.2 X1 Y2 Z3 I" +
                 std::to_string(i) + " J" + std::to_string(j) + " K" + std::to_string(k));
    const Pose before = session.interpreter.state().modal.position;
    session.must("G53.1");
    const ModalState& m = session.interpreter.state().modal;
    EXPECT_EQ(m.frame, Frame::kPart);
    const Matrix3 turn = rotation_x(m.position[kAxisA]) * rotation_z(m.position[kAxisC]);
    const Vector3 normal = turn * Vector3{m.tilt[0][2], m.tilt[1][2], m.tilt[2][2]};
    EXPECT_NEAR(normal[0], 0, 1e-9);
    EXPECT_NEAR(normal[1], 0, 1e-9);
    EXPECT_NEAR(normal[2], 1, 1e-9);
    EXPECT_LE(std::abs(m.position[kAxisC] - before[kAxisC]), std::numbers::pi / 2 + 1e-9);
    // With tool centre point control the tip stays on the part, without it the machine's X Y Z stay.
    const Frame kept = (n & 1) != 0 ? Frame::kPart : Frame::kMachine;
    Pose expected = in_frame(before, Frame::kPart, kept);
    const Pose actual = in_frame(m.position, Frame::kPart, kept);
    expected[kAxisA] = actual[kAxisA];
    expected[kAxisC] = actual[kAxisC];
    expect_near(actual, expected);
  }
}

TEST(TiltedPlane, ProgramAndPositionStayOneAnothersImage) {
  Session session;
  session.must("G10 L2 P1 X7 Y8 Z9\nG68.2 X1 Y2 Z3 I10 J20 K30\nG53.1\nG0 X4 Y5 Z6");
  const Pose inside = session.interpreter.program_position();
  expect_near({inside[0], inside[1], inside[2], 0, 0, 0}, {4, 5, 6, 0, 0, 0});
  const Vector3 expected =
      euler_zxz(10 * kDegree, 20 * kDegree, 30 * kDegree) * Vector3{4, 5, 6} + Vector3{1 + 7, 2 + 8, 3 + 9};
  const Pose position = session.interpreter.state().modal.position;
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(position[axis], expected[axis], 1e-9);
  // Incremental moves go along the plane's axes.
  session.must("G91 G0 X1");
  const Pose moved = session.interpreter.state().modal.position;
  EXPECT_NEAR(std::hypot(moved[0] - position[0], moved[1] - position[1], moved[2] - position[2]), 1, 1e-9);
}

}  // namespace
}  // namespace kinebus::gcode
