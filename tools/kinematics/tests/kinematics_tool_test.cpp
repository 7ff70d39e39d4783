// kinebus-kinematics by what it prints.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>
#include <sstream>

#include "tools/kinematics/commands.hpp"
#include "tools/kinematics/m1_assemblies.hpp"
#include "tools/kinematics/shipped_machines.hpp"

namespace kinebus::kinematics_tool {
namespace {

struct Said {
  int code = 0;
  std::string out, err;
  Json json() const { return Json::parse(out); }
};

Said call(std::vector<std::string> arguments, const std::string& input = "") {
  std::istringstream in(input);
  std::ostringstream out, err;
  Said said;
  said.code = run(std::move(arguments), in, out, err);
  said.out = out.str();
  said.err = err.str();
  return said;
}

/// Lines of numbers; what stands behind # apart.
struct Lines {
  std::vector<std::vector<double>> numbers;
  std::vector<std::string> remarks;
};
Lines lines_of(const std::string& text) {
  Lines lines;
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);  // the columns' names
  while (std::getline(in, line)) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> values;
    for (double v = 0; words >> v;) values.push_back(v);
    lines.numbers.push_back(values);
    lines.remarks.push_back(line.find('#') == std::string::npos ? "" : line.substr(line.find('#') + 2));
  }
  return lines;
}

Subject subject(const std::string& name) {
  auto machine = machine_of(name);
  EXPECT_TRUE(machine) << machine.error();
  auto made = Subject::of(std::move(*machine));
  EXPECT_TRUE(made) << made.error();
  return std::move(*made);
}

/// Poses that the machine's own rules allow.
std::vector<std::vector<double>> allowed_poses(const Subject& s, std::size_t count, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  std::vector<std::vector<double>> poses;
  for (int tries = 0; poses.size() < count && tries < 100'000; ++tries) {
    std::vector<double> values;
    Pose pose{};
    for (const Subject::Axis& axis : s.pose_axes()) {
      values.push_back(axis.name == "C"   ? uniform(-170, 170)
                       : axis.name == "A" ? uniform(-45, 45)
                       : axis.name == "Z" ? uniform(0, 200)
                                          : uniform(-120, 120));
      pose[axis.index] = values.back() * axis.unit();
    }
    if (s.kinematics().check(Frame::kPart, pose)) poses.push_back(values);
  }
  EXPECT_EQ(poses.size(), count) << s.machine().name;
  return poses;
}

std::string table_of(const std::vector<std::vector<double>>& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (const double v : row) text += printed("%.15g ", v);
    text += "\n";
  }
  return text;
}

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

TEST(KinematicsTool, AccelerationAndJacobianMatchDifferencesOfInverse) {
  for (const ShippedMachine& shipped : shipped_machines()) {
    const std::string name(shipped.name);
    const Subject s = subject(name);
    const std::size_t n = s.pose_axes().size(), joints = s.joints().size();
    for (const auto& pose : allowed_poses(s, 3, 23)) {
      std::vector<double> path = pose;
      for (std::size_t k = 0; k < n; ++k) path.push_back(20.0 - 9.0 * static_cast<double>(k));
      for (std::size_t k = 0; k < n; ++k) path.push_back(7.0 * static_cast<double>(k) - 11.0);
      // q(t) of the parabola by inverse, five places.
      constexpr double h = 0.02;
      std::vector<std::vector<double>> places;
      for (int k = -2; k <= 2; ++k) {
        std::vector<double> place;
        for (std::size_t i = 0; i < n; ++i) {
          const double t = k * h;
          place.push_back(path[i] + t * (path[n + i] + 0.5 * t * path[2 * n + i]));
        }
        places.push_back(place);
      }
      const Json q = call({"inverse", "--json", "--machine", name}, table_of(places)).json()["rows"];
      const Said said = call({"acceleration", "--json", "--machine", name}, table_of({path}));
      ASSERT_EQ(said.code, 0) << said.err;
      const Json row = said.json()["rows"][0];
      const Json matrix =
          call({"jacobian", "--json", "--machine", name}, table_of({pose})).json()["rows"][0]["jacobian"];
      for (std::size_t j = 0; j < joints; ++j) {
        const std::string joint = s.joints()[j].column();
        const auto at = [&](std::size_t k) { return q[k]["joints"][joint].get<double>(); };
        const double speed = (8 * (at(3) - at(1)) - (at(4) - at(0))) / (12 * h);
        const double acceleration = (16 * (at(3) + at(1)) - (at(4) + at(0)) - 30 * at(2)) / (12 * h * h);
        EXPECT_NEAR(row["speed"][joint + "_per_s"].get<double>(), speed, 1e-3) << name << joint;
        EXPECT_NEAR(row["acceleration"][joint + "_per_s2"].get<double>(), acceleration, 1e-2)
            << name << joint;
        double by_matrix = 0;
        for (std::size_t k = 0; k < n; ++k)
          by_matrix += matrix[joint]["per_" + s.pose_axes()[k].column()].get<double>() * path[n + k];
        EXPECT_NEAR(by_matrix, speed, 1e-3) << name << joint;
      }
    }
  }
}

TEST(KinematicsTool, ATableAnswersEveryRowAndNamesTheFirstThatItCannot) {
  const std::string table = "# poses\nz_mm y_mm x_mm\n50 0 0\n\n50 5000 0  # beyond the rods\n60 10 0\n";
  const Said said = call({"inverse", "--machine", "m4", "--json"}, table);
  EXPECT_EQ(said.code, 1);
  const Json rows = said.json()["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["line"], 3);
  EXPECT_EQ(rows[0]["allowed"], true);
  EXPECT_EQ(rows[1]["line"], 5);
  EXPECT_EQ(rows[1]["error"]["kind"], "out_of_reach");
  EXPECT_EQ(rows[1]["error"]["joint"].get<std::string>().substr(0, 4), "rail");
  EXPECT_GT(rows[1]["error"]["short_by_mm"].get<double>(), 3000);
  EXPECT_EQ(rows[2]["pose"]["y_mm"], 10);
  EXPECT_NE(said.err.find("line 5: rail"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("out of reach"), std::string::npos);
  EXPECT_NE(said.err.find("1 of 3"), std::string::npos);
  // As text the row is a remark, and the others can still be read.
  const Said text = call({"inverse", "--machine", "m4"}, table);
  EXPECT_NE(text.out.find("# line 5: rail"), std::string::npos) << text.out;
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

TEST(KinematicsTool, BadInputIsNamedWithItsPlaceAndWhatIsExpected) {
  struct Case {
    std::vector<std::string> arguments;
    std::string input;
    const char* words;
  };
  const Case cases[] = {
      {{"inverse", "--machine", "m9"}, "", "unknown machine \"m9\"; expected a machine file, or one of"},
      {{"inverse", "--machine", "/nowhere/m1.toml"}, "", "unknown machine"},
      {{"inverse", "--machine", "m4", "1", "2"},
       "",
       "2 values; expected 3 to 5: x_mm y_mm z_mm [a_deg] [c_deg]"},
      {{"inverse", "--machine", "m5", "1", "2", "3", "4", "5"}, "", "5 values; expected 3 to 4"},
      {{"inverse", "1", "two", "3"}, "", "value 2 (y_mm): found \"two\"; expected a number"},
      {{"inverse", "1", "nan", "3"}, "", "found \"nan\"; expected a number"},
      {{"inverse", "1", "1e9", "3"}, "", "expected a number in -1e7 .. 1e7"},
      {{"forward", "--machine", "m4", "932.6"}, "", "1 value; expected 3 to 5: rail1_mm rail2_mm rail3_mm"},
      {{"forward", "--machine", "m4", "5000", "0", "0"}, "", "closes in no pose"},
      {{"forward", "--machine", "m1", "--mirrored", "1", "2", "3", "4"},
       "",
       "no part that could be mounted mirrored"},
      {{"inverse", "--machine", "m4"}, "", "standard input: no values"},
      {{"inverse", "--machine", "m4"}, "1 2 3\n1 2\n", "standard input:2: 2 values; expected 3 to 5"},
      {{"inverse", "--machine", "m4"}, "1 2 3\n1 x 3\n", "standard input:2: value 2 (y_mm): found \"x\""},
      {{"inverse", "--machine", "m4"}, "x_mm y_mm a_deg\n1 2 3\n", "standard input:1: no column z_mm"},
      {{"inverse", "--machine", "m4"},
       "x_mm y_mm z_mm q_mm\n",
       "standard input:1: a column that is not known"},
      {{"inverse", "--machine", "m4"}, "x_mm y_mm z_mm y_mm\n", "standard input:1: column y_mm stands twice"},
      {{"inverse", "--in", "/nowhere/table"}, "", "/nowhere/table: cannot be read"},
      {{"inverse", "1", "2", "3", "--in", "-"}, "", "expected one of them"},
  };
  for (const Case& bad : cases) {
    const Said said = call(bad.arguments, bad.input);
    EXPECT_EQ(said.code, 1) << bad.words;
    EXPECT_TRUE(said.out.empty() || said.out.find('\n') != std::string::npos);
    EXPECT_NE(said.err.find(bad.words), std::string::npos)
        << "expected: " << bad.words << "\nsaid: " << said.err;
  }
  EXPECT_NE(call({"clearence"}).code, 0);
  EXPECT_NE(call({}).code, 0);
  // Negative numbers are values, however they are written.
  EXPECT_EQ(call({"inverse", "--machine", "m4", "-1", "-.5", "50"}).code, 0);
}

TEST(KinematicsTool, AMachineFileIsReadAndAWrongOneRefusedWithItsPlace) {
  const std::string path = ::testing::TempDir() + "kinematics_tool_machine.toml";
  const auto write = [&](const std::string& text) { std::ofstream(path) << text; };
  std::string text;
  for (const ShippedMachine& shipped : shipped_machines())
    if (shipped.name == "m4") text = shipped.text;
  write(text);
  EXPECT_EQ(call({"inverse", "--machine", path, "0", "0", "50"}).out,
            call({"inverse", "--machine", "M4", "0", "0", "50"}).out);
  text.replace(text.find("rod_mm = 890"), 12, "rod_mm = -890");
  write(text);
  const Said said = call({"inverse", "--machine", path, "0", "0", "50"});
  EXPECT_EQ(said.code, 1);
  EXPECT_NE(said.err.find("kinematics.rod_mm"), std::string::npos) << said.err;
  std::remove(path.c_str());
}

}  // namespace
}  // namespace kinebus::kinematics_tool
