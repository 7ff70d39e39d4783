// [joint.X.driver]: a stepper driver behind step and direction.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

/// cartesian_octopus.toml with these keys of a joint's driver.
std::string driver_of(const std::string& joint, const std::string& keys) {
  return file_text("cartesian_octopus.toml") + "\n[joint." + joint + ".driver]\n" + keys;
}

TEST(DriverTable, SaysWhatTheModuleIsAndIsWrittenAgain) {
  const auto machine =
      parse_machine(driver_of("X", "sense_resistor_mohm = 150\nstealthchop_below_mm_per_s = 40\n"), "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  ASSERT_TRUE(machine->joints[0].driver);
  EXPECT_FALSE(machine->joints[0].driver->stands_alone);
  EXPECT_EQ(machine->joints[0].driver->sense_resistor_mohm, 150u);
  EXPECT_EQ(machine->joints[0].driver->stealthchop_below_per_s, 40);
  EXPECT_FALSE(machine->joints[1].driver) << "most files say nothing of it";
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);
}

struct BadDriver {
  const char* keys;
  const char* key;       ///< that is named, after joint.X.
  const char* expected;  ///< is in the words
};
class BadDriverTables : public testing::TestWithParam<BadDriver> {};

TEST_P(BadDriverTables, AreRefusedWithPlaceAndRule) {
  const BadDriver& bad = GetParam();
  const auto machine = parse_machine(driver_of("X", bad.keys), "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, std::string("joint.X.") + bad.key) << to_string(machine.error());
  EXPECT_NE(machine.error().front().expected.find(bad.expected), std::string::npos)
      << to_string(machine.error());
}
INSTANTIATE_TEST_SUITE_P(
    Each, BadDriverTables,
    testing::Values(BadDriver{"sense_resistor_mohm = 9\n", "driver.sense_resistor_mohm", "10 to 1000"},
                    BadDriver{"sense_resistor_mohm = 1001\n", "driver.sense_resistor_mohm", "10 to 1000"},
                    BadDriver{"sense_resistor_mohm = -110\n", "driver.sense_resistor_mohm", ""},
                    BadDriver{"stealthchop_below_mm_per_s = -1\n", "driver.stealthchop_below_mm_per_s", ""},
                    BadDriver{"sense_resistor_mohm = 110\nstands_alone = true\n", "driver.stands_alone",
                              "stands_alone alone"},
                    BadDriver{"stealthchop_below_mm_per_s = 5\nstands_alone = true\n", "driver.stands_alone",
                              "stands_alone alone"},
                    BadDriver{"sense_resistor_mohm = 110\n[joint.X.motor]\nresistance_ohm = 2\n", "driver",
                              "one of the two tables"},
                    BadDriver{"sense_ohm = 0.11\n", "driver.sense_ohm", ""}));

TEST(DriverTable, WhoHomesByItsLoadIsSpokenTo) {
  std::string text = driver_of("X", "stands_alone = true\n");
  const std::string head = "[joint.X.homing]\n";
  const std::size_t begin = text.find(head) + head.size(), end = text.find("\n[", begin);
  text.replace(
      begin, end - begin,
      "method = -4\nfast_mm_per_s = 60\nslow_mm_per_s = 60\naccel_mm_per_s2 = 1000\nback_off_mm = 5\n"
      "switch_position_mm = -110\nmax_search_mm = 240\nstall_threshold = 70\nstall_above_mm_per_s = 40\n");
  const auto machine = parse_machine(text, "m");
  ASSERT_FALSE(machine);
  EXPECT_EQ(machine.error().front().key, "joint.X.driver.stands_alone") << to_string(machine.error());
}

}  // namespace
}  // namespace kinebus
