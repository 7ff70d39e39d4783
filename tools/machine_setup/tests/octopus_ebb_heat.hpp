#pragma once
// An Octopus whose heat node is not there, an EBB as heat node: the rig's.

#include <gtest/gtest.h>

#include "tools/machine_setup/tests/setup_rig.hpp"

namespace kinebus {

class OctopusAndEbbHeat : public ::testing::Test {
 public:
  OctopusAndEbbHeat() {
    for (std::uint8_t i = 0; i < 4; ++i)
      rig.add_board(Stm32f446OctopusBoard::kFacts, 900U + i, static_cast<std::uint8_t>(1 + i));
    rig.is_octopus = true;
    rig.wires = {
        {{0, 0}, {"X", false}}, {{0, 1}, {"Y", false}}, {{1, 0}, {"Z", false}}, {{1, 1}, {"E", false}}};
    rig.answers = {{"Which machine", {"cartesian"}},
                   {"Which boards", {"octopus+ebb-heat"}},
                   {"Fan part", {"run"}},
                   {"Did it run?", {"yes"}},
                   {"Heater bed", {"skip"}},
                   {"Which one got warm?", {"hotend"}}};
    rig.presses = {
        {"Switch of X", {{0, 0, true}}}, {"Switch of Y", {{0, 1, true}}}, {"Switch of Z", {{1, 0, true}}}};
  }
  SetupRig rig;
};

}  // namespace kinebus
