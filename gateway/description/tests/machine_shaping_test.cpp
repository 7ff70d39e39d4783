// What a machine file says about vibration and about the pressure in the nozzle.

#include <gtest/gtest.h>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/tests/machine_text.hpp"

namespace kinebus {
namespace {

TEST(MachineFile, VibrationSaysAShaperForAllDirectionsOrEach) {
  EXPECT_FALSE(parse_machine(edited("[tolerance]", "[tolerance]").text, "m")->vibration.shapes());
  const auto machine = parse_machine(edited("[tolerance]",
                                            "[vibration]\nshaper = \"EI\"\nfrequency_hz = 48.5\ndeviation_um "
                                            "= 20\noverride_from_percent = 50\n[tolerance]")
                                         .text,
                                     "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_TRUE(machine->vibration.shapes());
  EXPECT_EQ(machine->vibration.axis(2), (AxisVibration{ShaperKind::kEi, 48.5, 0.1}));
  EXPECT_NEAR(machine->vibration.deviation_mm, 0.020, 1e-12);
  EXPECT_NEAR(machine->vibration.slowest_rate, 0.5, 1e-12);
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);

  const std::pair<const char*, const char*> refused[] = {
      {"[vibration]\nshaper = \"ei\"\nfrequency_hz = 40",
       "vibration.shaper: found 'ei'; expected one of \"none\" \"ZV\" \"MZV\" \"ZVD\" \"EI\" \"2HUMP\" "
       "\"3HUMP\" \"ZVDD\" \"ZVDDD\""},
      {"[vibration]\nshaper = \"ZV\"",
       "found no frequency; expected the frequency of the vibration that the shaper is for"},
      {"[vibration]\nshaper = \"ZV\"\nfrequency_hz = 0.5", "expected a number in 1 .. 500"},
      {"[vibration]\nshaper = \"ZV\"\nfrequency_hz = 40\ndamping_ratio = 0.9",
       "expected a number in 0 .. 0.5"},
      {"[vibration]\ndeviation_um = 20", "found a deviation without a shaper"},
      {"[vibration.x]\nshaper = \"ZV\"\nfrequency_hz = 40",
       "found different shapers on a machine that turns or tilts the part; expected one shaper for X, Y and "
       "Z, in [vibration] itself"},
  };
  for (const auto& [table, message] : refused) {
    const auto bad = parse_machine(edited("[tolerance]", table + std::string("\n[tolerance]")).text, "m");
    ASSERT_FALSE(bad) << table;
    EXPECT_NE(to_string(bad.error()).find(message), std::string::npos) << to_string(bad.error());
  }
}

TEST(MachineFile, PressureAdvanceSaysAModelAndItsTimes) {
  EXPECT_FALSE(parse_machine(edited("[tolerance]", "[tolerance]").text, "m")->pressure_advance.acts());
  const auto machine = parse_machine(edited("[tolerance]",
                                            "[pressure_advance]\nmodel = \"tanh\"\nadvance_s = "
                                            "0.02\nnonlinear_mm = 0.05\nnonlinear_mm_per_s = 3\n"
                                            "melt_ms = 6\nsmooth_ms = 12\n[tolerance]")
                                         .text,
                                     "m");
  ASSERT_TRUE(machine) << to_string(machine.error());
  EXPECT_EQ(machine->pressure_advance, (AdvanceModel{AdvanceKind::kTanh, 0.02, 0.05, 3, 0.006, 0.012}));
  const auto again = parse_machine(write_machine(*machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == *machine);

  const std::pair<const char*, const char*> refused[] = {
      {"advance_s = 3", "pressure_advance.advance_s: found 3; expected a number in 0 .. 2"},
      {"smooth_ms = 1", "pressure_advance.smooth_ms: found 1; expected a number in 2 .. 200"},
      {"melt_ms = 200", "pressure_advance.melt_ms: found 200; expected a number in 0.1 .. 100"},
      {"model = \"cubic\"", "expected one of \"linear\" \"tanh\" \"reciprocal\""},
      {"nonlinear_mm = 0.1", "found 0.1; expected no such key with a linear model"},
      {"model = \"tanh\"\nadvance_s = 0.05",
       "found 0; expected the filament that this model presses together at most"},
      {"advance = 0.05", "pressure_advance.advance"},
  };
  for (const auto& [keys, message] : refused) {
    const auto bad = parse_machine(
        edited("[tolerance]", std::string("[pressure_advance]\n") + keys + "\n[tolerance]").text, "m");
    ASSERT_FALSE(bad) << keys;
    EXPECT_NE(to_string(bad.error()).find(message), std::string::npos) << to_string(bad.error());
  }
}

TEST(MachineFile, ADirectionHasAShaperOfItsOwnWhereNothingTurns) {
  const auto corexy = load_machine(kMachines / "corexy.toml");
  ASSERT_TRUE(corexy) << to_string(corexy.error());
  MachineDescription machine = *corexy;
  machine.vibration.every = {ShaperKind::kMzv, 60, 0.1};
  machine.vibration.y = {ShaperKind::kZvd, 38, 0.08};
  const auto again = parse_machine(write_machine(machine), "written");
  ASSERT_TRUE(again) << to_string(again.error());
  EXPECT_TRUE(*again == machine);
  EXPECT_EQ(again->vibration.axis(1).shaper, ShaperKind::kZvd);
  EXPECT_EQ(again->vibration.axis(0).shaper, ShaperKind::kMzv);
}

}  // namespace
}  // namespace kinebus
