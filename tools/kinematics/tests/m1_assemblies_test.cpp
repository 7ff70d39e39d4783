// Every assembly of four legs, found in another way.

#include "tools/kinematics/m1_assemblies.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "tools/kinematics/tests/tool_call.hpp"

namespace kinebus::kinematics_tool {
namespace {

/// The four legs' length errors by the drawing (paper M1, eq. 1), p and A as printed.
Eigen::Vector4d closure(const M1Geometry& g, const JointVector& q, const Eigen::Vector4d& p_a) {
  Eigen::Vector4d r;
  const double c = std::cos(p_a(3)), s = std::sin(p_a(3));
  for (std::size_t i = 0; i < 4; ++i) {
    const M1Leg& leg = g.legs[i];
    const Vector3 &b = leg.attachment_mm, &a = leg.foot_mm, &d = leg.rail;
    const double norm = std::hypot(d[0], d[1], d[2]), along = (q[i] + leg.connector_mm) / norm;
    r(static_cast<Eigen::Index>(i)) =
        std::hypot(p_a(0) + b[0] - a[0] - along * d[0], p_a(1) + c * b[1] - s * b[2] - a[1] - along * d[1],
                   p_a(2) + s * b[1] + c * b[2] - a[2] - along * d[2]) -
        leg.length_mm;
  }
  return r;
}

/// Newton with differences from many starts: finds assemblies in another way.
std::vector<Eigen::Vector4d> assemblies_by_search(const M1Geometry& g, const JointVector& q, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  double middle = 0, reach = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    middle += (q[i] + g.legs[i].foot_mm[2]) / 4;
    reach = std::max(reach, g.legs[i].length_mm);
  }
  std::vector<Eigen::Vector4d> found;
  for (int start = 0; start < 400; ++start) {
    Eigen::Vector4d x(uniform(-reach, reach), uniform(-reach, reach), middle + uniform(-reach, reach),
                      uniform(-3.14, 3.14));
    for (int step = 0; step < 60; ++step) {
      const Eigen::Vector4d r = closure(g, q, x);
      Eigen::Matrix4d j;
      for (int k = 0; k < 4; ++k) {
        const double h = k == 3 ? 1e-6 : 1e-4;
        Eigen::Vector4d there = x;
        there(k) += h;
        j.col(k) = (closure(g, q, there) - r) / h;
      }
      Eigen::Vector4d move = j.fullPivLu().solve(-r);
      const double most = std::max(move.head<3>().norm() / 200, std::abs(move(3)) / 0.5);
      x += most > 1 ? Eigen::Vector4d(move / most) : move;
      if (move.norm() < 1e-10) break;
    }
    if (!(closure(g, q, x).cwiseAbs().maxCoeff() < 1e-8)) continue;
    x(3) = std::remainder(x(3), 2 * std::numbers::pi);
    bool known = false;
    for (const Eigen::Vector4d& other : found)
      known = known || ((x - other).head<3>().norm() < 1e-3 &&
                        std::abs(std::remainder(x(3) - other(3), 2 * std::numbers::pi)) < 1e-5);
    if (!known) found.push_back(x);
  }
  return found;
}

TEST(KinematicsTool, EliminationFindsEveryAssemblyThatASearchFinds) {
  for (const char* name : {"m1", "m5"}) {
    const Subject s = subject(name);
    const M1Geometry g = std::holds_alternative<M5Geometry>(s.machine().kinematics)
                             ? static_cast<const M1Geometry&>(std::get<M5Geometry>(s.machine().kinematics))
                             : std::get<M1Geometry>(s.machine().kinematics);
    std::vector<JointVector> all;
    for (const auto& values : allowed_poses(s, 4, 11)) {
      Pose pose{};
      for (std::size_t k = 0; k < s.pose_axes().size(); ++k)
        pose[s.pose_axes()[k].index] = values[k] * s.pose_axes()[k].unit();
      JointVector q{};
      ASSERT_TRUE(s.kinematics().inverse(Frame::kPart, pose, q));
      all.push_back(q);
    }
    // Level pairs: the elimination's linear equations are dependent there.
    JointVector level{};
    ASSERT_TRUE(s.kinematics().inverse(Frame::kPart, s.kinematics().bed_reference(), level));
    all.push_back(level);
    for (std::size_t n = 0; n < all.size(); ++n) {
      const auto eliminated = m1_assemblies(g, all[n]);
      int physical = 0;
      for (const M1Assembly& a : eliminated) {
        const Vector3& p = a.platform_mm;
        EXPECT_LT(closure(g, all[n], {p[0], p[1], p[2], a.a_rad}).cwiseAbs().maxCoeff(), 1e-8);
        physical += a.physical() ? 1 : 0;
      }
      EXPECT_GE(physical, 1);
      for (const Eigen::Vector4d& x : assemblies_by_search(g, all[n], 17)) {
        int seen = 0;
        for (const M1Assembly& a : eliminated)
          seen +=
              std::hypot(a.platform_mm[0] - x(0), a.platform_mm[1] - x(1), a.platform_mm[2] - x(2)) < 1e-3 &&
                      std::abs(std::remainder(a.a_rad - x(3), 2 * std::numbers::pi)) < 1e-5
                  ? 1
                  : 0;
        EXPECT_EQ(seen, 1) << name << " pose " << n << ": " << x.transpose();
      }
    }
  }
}

}  // namespace
}  // namespace kinebus::kinematics_tool
