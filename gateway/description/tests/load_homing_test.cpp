// Homing at a mechanical stop by the driver's load: what a machine file has to say of it.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

constexpr const char* kByLoad =
    "method = -4\nswitch_input = 1\nfast_mm_per_s = 60\nslow_mm_per_s = 60\naccel_mm_per_s2 = 1000\n"
    "back_off_mm = 5\nswitch_position_mm = -110\nmax_search_mm = 240\nstall_threshold = 70\n"
    "stall_above_mm_per_s = 40\n";

/// cartesian_octopus.toml, with this as the homing of a joint, and one thing in the text another one.
std::string homing_of(const std::string& joint, std::string keys, const std::string& from = "",
                      const std::string& to = "") {
  std::string text = file_text("cartesian_octopus.toml");
  const std::string head = "[joint." + joint + ".homing]\n";
  const std::size_t begin = text.find(head) + head.size(), end = text.find("\n[", begin);
  if (const std::size_t at = keys.find(from); !from.empty() && at != std::string::npos)
    keys.replace(at, from.size(), to);
  return text.replace(begin, end - begin, keys);
}

TEST(LoadHoming, AJointFindsItsStopByItsDriversLoad) {
  const auto machine = parse_machine(homing_of("X", kByLoad), "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  const HomingDescription& h = *machine->joints[0].homing;
  EXPECT_TRUE(h.by_load());
  EXPECT_FALSE(h.towards_positive());
  EXPECT_EQ(h.edge_direction(), -1);
  EXPECT_EQ(h.stall_threshold, 70u);
  EXPECT_EQ(h.stall_above_per_s, 40);
  EXPECT_EQ(h.node_method({.inverted = true}), -3);
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

struct BadKey {
  const char* from;
  const char* to;
  const char* key;       ///< that is named, after joint.X.homing.
  const char* expected;  ///< is in the words
};
class LoadHomingKeys : public testing::TestWithParam<BadKey> {};

TEST_P(LoadHomingKeys, AreRefusedWithPlaceAndRule) {
  const BadKey& bad = GetParam();
  const auto machine = parse_machine(homing_of("X", kByLoad, bad.from, bad.to), "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, std::string("joint.X.homing.") + bad.key)
      << to_string(machine.error());
  EXPECT_NE(machine.error().front().expected.find(bad.expected), std::string::npos)
      << to_string(machine.error());
}
INSTANTIATE_TEST_SUITE_P(
    Each, LoadHomingKeys,
    testing::Values(
        BadKey{"method = -4", "method = -2", "method", "17..22, 37, -3 or -4"},
        BadKey{"method = -4", "method = 22", "stall_threshold", "method = -3 or -4"},
        BadKey{"stall_threshold = 70\n", "", "stall_threshold", "1 to 255"},
        BadKey{"threshold = 70", "threshold = 256", "stall_threshold", "1 to 255"},
        BadKey{"threshold = 70", "threshold = 0", "stall_threshold", "1 to 255"},
        BadKey{"stall_above_mm_per_s = 40", "stall_above_mm_per_s = 55", "stall_above_mm_per_s", "20 to 54"},
        BadKey{"stall_above_mm_per_s = 40\n", "", "stall_above_mm_per_s", "20 to 54"},
        BadKey{"fast_mm_per_s = 60\nslow_mm_per_s = 60", "fast_mm_per_s = 30\nslow_mm_per_s = 30",
               "fast_mm_per_s", "at least 40"},
        BadKey{"slow_mm_per_s = 60", "slow_mm_per_s = 6", "slow_mm_per_s", "as much as the fast speed, 60"},
        BadKey{"back_off_mm = 5", "back_off_mm = 4", "back_off_mm", "at least 4.5"}));

// From wherever it stands it would first come down on the part.
TEST(LoadHoming, AnAxisThatTakesTheToolOffTheTableHomesAtASwitch) {
  const auto machine = parse_machine(
      homing_of("Z",
                "method = -3\nswitch_input = 1\nfast_mm_per_s = 8\nslow_mm_per_s = 8\naccel_mm_per_s2 = 100\n"
                "back_off_mm = 2\nswitch_position_mm = 210\nmax_search_mm = 250\nstall_threshold = 70\n"
                "stall_above_mm_per_s = 5\n"),
      "m");
  ASSERT_FALSE(machine);
  ASSERT_EQ(machine.error().size(), 1u) << to_string(machine.error());
  EXPECT_EQ(machine.error().front().key, "joint.Z.homing.method");
  EXPECT_NE(machine.error().front().found.find("goes off the stop"), std::string::npos)
      << to_string(machine.error());
}

TEST(LoadHoming, DiagIsHighAtAStopAndOnAnInputOfItsOwnAxis) {
  std::string text = homing_of("X", kByLoad);
  const std::size_t input = text.find("[node.1.input1]"), low = text.find("active_low = false", input);
  text.replace(low, 18, "active_low = true");
  const auto upside_down = parse_machine(text, "m");
  ASSERT_FALSE(upside_down);
  EXPECT_EQ(upside_down.error().front().key, "node.1.input1.active_low") << to_string(upside_down.error());
  const auto other = parse_machine(homing_of("X", kByLoad, "switch_input = 1", "switch_input = 2"), "m");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().front().key, "joint.X.homing.switch_input");
}

TEST(LoadHoming, ANodeThatDrivesTheMotorItselfTellsNoLoad) {
  const std::string motor =
      "[joint.X.motor]\nresistance_ohm = 1.6\ninductance_mh = 3\ntorque_nm_per_a = 0.3\n\n[joint.Y]";
  std::string text = homing_of("X", kByLoad);
  text.replace(text.find("[joint.Y]"), 9, motor);
  const auto machine = parse_machine(text, "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "joint.X.homing.method") << to_string(machine.error());
}

}  // namespace
}  // namespace kinebus
