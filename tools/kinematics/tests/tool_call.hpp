#pragma once
// kinebus-kinematics called in the process, and what it prints taken apart.

#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "gateway/description/shipped_machines.hpp"
#include "tools/kinematics/commands.hpp"

namespace kinebus::kinematics_tool {

struct Said {
  int code = 0;
  std::string out, err;
  Json json() const { return Json::parse(out); }
};

inline Said call(std::vector<std::string> arguments, const std::string& input = "") {
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
inline Lines lines_of(const std::string& text) {
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

inline Subject subject(const std::string& name) {
  auto machine = machine_of(name);
  EXPECT_TRUE(machine) << machine.error();
  auto made = Subject::of(std::move(*machine));
  EXPECT_TRUE(made) << made.error();
  return std::move(*made);
}

/// Poses that the machine's own rules allow.
inline std::vector<std::vector<double>> allowed_poses(const Subject& s, std::size_t count, unsigned seed) {
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

inline std::string table_of(const std::vector<std::vector<double>>& rows) {
  std::string text;
  for (const auto& row : rows) {
    for (const double v : row) text += printed("%.15g ", v);
    text += "\n";
  }
  return text;
}

}  // namespace kinebus::kinematics_tool
