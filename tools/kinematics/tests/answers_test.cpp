// kinebus-kinematics by what it prints: numbers.

#include <cmath>

#include "tools/kinematics/tests/tool_call.hpp"

namespace kinebus::kinematics_tool {
namespace {

TEST(KinematicsTool, Table6OfM4IsOneCall) {
  const Said said = call({"forward", "--machine", "m4", "932.6", "1029.4", "283.4", "--mirrored"});
  ASSERT_EQ(said.code, 0) << said.err;
  // phi, yp, xp as printed, 180 deg added where the print has left them out.
  struct Row {
    double phi_deg, y_mm, x_mm;
    bool mirrored;
  };
  const Row rows[] = {{36.5, 163, -7.1, false},
                      {-69.91, 232, 248.8, false},
                      {115.27, 219.5, -49.7, true},
                      {77.46 - 180, 250.9, 221, true}};
  const Lines lines = lines_of(said.out);
  ASSERT_EQ(lines.numbers.size(), 4u) << said.out;
  for (const Row& row : rows) {
    int seen = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const auto& n = lines.numbers[k];
      if (std::abs(n[0] - row.phi_deg) > 0.05 || std::abs(n[1] - row.y_mm) > 0.1 ||
          std::abs(n[2] - row.x_mm) > 0.1)
        continue;
      ++seen;
      EXPECT_LT(n.back(), 1e-9);
      EXPECT_EQ(lines.remarks[k].find("mirrored triangle") == 0, row.mirrored) << lines.remarks[k];
    }
    EXPECT_EQ(seen, 1) << row.phi_deg;
  }
  // Without the word only what the machine itself can take.
  EXPECT_EQ(lines_of(call({"forward", "--machine", "m4", "932.6", "1029.4", "283.4"}).out).numbers.size(),
            2u);
}

TEST(KinematicsTool, ForwardFindsThePoseOfInverseOnEveryShippedMachine) {
  for (const ShippedMachine& shipped : shipped_machines()) {
    const Subject s = subject(std::string(shipped.name));
    const auto poses = allowed_poses(s, 40, 5);
    for (const char* frame : {"part", "machine"}) {
      const std::vector<std::string> where{"--machine", std::string(shipped.name), "--frame", frame};
      std::vector<std::string> there{"inverse", "--json"}, back{"forward", "--json"};
      there.insert(there.end(), where.begin(), where.end());
      back.insert(back.end(), where.begin(), where.end());
      // JSON keeps all digits; rows of the joints' values go back in.
      const Said inverse = call(there, table_of(poses));
      ASSERT_EQ(inverse.code, 0) << shipped.name << inverse.err;
      std::string joints;
      const Json there_all = inverse.json();
      for (const Json& row : there_all["rows"]) {
        for (const auto& [name, value] : row["joints"].items())
          joints += printed("%.17g ", value.get<double>());
        joints += "\n";
      }
      const Said forward = call(back, joints);
      ASSERT_EQ(forward.code, 0) << shipped.name << forward.err;
      const Json found = forward.json();
      for (std::size_t k = 0; k < poses.size(); ++k) {
        int same = 0;
        for (const Json& assembly : found["rows"][k]["assemblies"]) {
          EXPECT_LT(assembly["residual_mm"].get<double>(), 1e-8);
          double apart = 0;
          std::size_t axis = 0;
          for (const auto& [name, value] : assembly["pose"].items())
            apart = std::max(apart, std::abs(value.get<double>() - poses[k][axis++]));
          if (apart > 1e-6) continue;
          ++same;
          EXPECT_TRUE(assembly["as_described"].get<bool>());
        }
        EXPECT_EQ(same, 1) << shipped.name << " frame " << frame << " row " << k;
      }
    }
  }
}

TEST(KinematicsTool, TheTextOfInverseIsTheInputOfForward) {
  const Said joints =
      call({"inverse", "--machine", "m4"}, "x_mm,y_mm,z_mm,a_deg,c_deg\n10,20,50,5,30\n0,0,40,0,0\n");
  ASSERT_EQ(joints.code, 0) << joints.err;
  const Said poses = call({"forward", "--machine", "m4"}, joints.out);
  ASSERT_EQ(poses.code, 0) << poses.err;
  bool seen = false;
  for (const auto& n : lines_of(poses.out).numbers)
    seen = seen || (n.size() == 9 && std::abs(n[3] - 10) < 1e-4 && std::abs(n[4] - 20) < 1e-4 &&
                    std::abs(n[5] - 50) < 1e-4 && std::abs(n[6] - 5) < 1e-4 && std::abs(n[7] - 30) < 1e-4);
  EXPECT_TRUE(seen) << poses.out;
}

TEST(KinematicsTool, AccelerationAndJacobianMatchDifferencesOfInverse) {
  for (const ShippedMachine& shipped : shipped_machines()) {
    const std::string name(shipped.name);
    const Subject s = subject(name);
    const std::size_t n = s.pose_axes().size(), joints = s.joints().size();
    const auto poses = allowed_poses(s, 3, 23);
    // Of each pose a parabola through it, and q(t) of that by inverse at five places.
    constexpr double h = 0.02;
    std::vector<std::vector<double>> paths, places;
    for (const auto& pose : poses) {
      std::vector<double> path = pose;
      for (std::size_t k = 0; k < n; ++k) path.push_back(20.0 - 9.0 * static_cast<double>(k));
      for (std::size_t k = 0; k < n; ++k) path.push_back(7.0 * static_cast<double>(k) - 11.0);
      for (int k = -2; k <= 2; ++k) {
        std::vector<double> place;
        for (std::size_t i = 0; i < n; ++i) {
          const double t = k * h;
          place.push_back(path[i] + t * (path[n + i] + 0.5 * t * path[2 * n + i]));
        }
        places.push_back(place);
      }
      paths.push_back(path);
    }
    const Json q = call({"inverse", "--json", "--machine", name}, table_of(places)).json()["rows"];
    const Said said = call({"acceleration", "--json", "--machine", name}, table_of(paths));
    ASSERT_EQ(said.code, 0) << said.err;
    const Json rows = said.json()["rows"];
    const Json matrices = call({"jacobian", "--json", "--machine", name}, table_of(poses)).json()["rows"];
    for (std::size_t p = 0; p < poses.size(); ++p) {
      for (std::size_t j = 0; j < joints; ++j) {
        const std::string joint = s.joints()[j].column();
        const auto at = [&](std::size_t k) { return q[5 * p + k]["joints"][joint].get<double>(); };
        const double speed = (8 * (at(3) - at(1)) - (at(4) - at(0))) / (12 * h);
        const double acceleration = (16 * (at(3) + at(1)) - (at(4) + at(0)) - 30 * at(2)) / (12 * h * h);
        EXPECT_NEAR(rows[p]["speed"][joint + "_per_s"].get<double>(), speed, 1e-3) << name << joint;
        EXPECT_NEAR(rows[p]["acceleration"][joint + "_per_s2"].get<double>(), acceleration, 1e-2)
            << name << joint;
        double by_matrix = 0;
        for (std::size_t k = 0; k < n; ++k)
          by_matrix += matrices[p]["jacobian"][joint]["per_" + s.pose_axes()[k].column()].get<double>() *
                       paths[p][n + k];
        EXPECT_NEAR(by_matrix, speed, 1e-3) << name << joint;
      }
    }
  }
}

TEST(KinematicsTool, APoseBeyondTheRulesHasJointsAndTheRuleThatItBreaks) {
  const Said said = call({"inverse", "--machine", "m4", "0", "0", "1000", "--json"});
  ASSERT_EQ(said.code, 0) << said.err;
  const Json row = said.json()["rows"][0];
  EXPECT_EQ(row["allowed"], false);
  EXPECT_NE(row["breaks"].get<std::string>().find("Z is"), std::string::npos);
  // A joint's limits of the machine file are named when a path is too fast for it.
  const Said fast =
      call({"acceleration", "--machine", "cartesian", "0", "0", "50", "100000", "0", "0", "0", "0", "0"});
  ASSERT_EQ(fast.code, 0) << fast.err;
  EXPECT_NE(fast.out.find("X: speed 1e+05 of"), std::string::npos) << fast.out;
}

}  // namespace
}  // namespace kinebus::kinematics_tool
