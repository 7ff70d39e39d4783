// kinebus-kinematics: inverse, forward, jacobian and acceleration of any machine.

#include <cstdio>
#include <exception>
#include <iostream>

#include "tools/kinematics/commands.hpp"

int main(int argc, char** argv) {
  try {
    return kinebus::kinematics_tool::run({argv + 1, argv + argc}, std::cin, std::cout, std::cerr);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "kinebus-kinematics: %s\n", e.what());
    return 1;
  }
}
