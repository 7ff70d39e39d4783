#pragma once
// Machine and small jobs for the tests of this folder.

#include <memory>
#include <string>

#include "gateway/description/machine_description.hpp"

namespace kinebus::job_test {

inline const MachineDescription& machine() {
  static const MachineDescription m1 = default_m1();
  return m1;
}
inline const Kinematics& kinematics() {
  static const std::unique_ptr<Kinematics> m1 = std::move(*make_kinematics(machine()));
  return *m1;
}

/// A square spiral of `turns` turns in a layer at z = 5 mm, with extrusion.
inline std::string spiral(int turns) {
  std::string text = "G21\nG90\nM83\nM104 S210\nG1 Z5 F6000\n";
  double side = 2;
  double x = 0, y = 0;
  const double directions[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int i = 0; i < 4 * turns; ++i) {
    x += directions[i % 4][0] * side;
    y += directions[i % 4][1] * side;
    text += "G1 X" + std::to_string(x) + " Y" + std::to_string(y) + " E" + std::to_string(side * 0.03) +
            " F3000\n";
    side += 0.4;
  }
  return text;
}

}  // namespace kinebus::job_test
