// Nothing is fed through a hot end that does not melt it: jobs, lines, and waits that were cut short. Looked
// at from outside: where the extruder's motor really is, and how hot the block and its sensor really are.

#include <gtest/gtest.h>

#include <string>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kExtruder = 5;
constexpr double kFed_mm = 0.02;

class ColdFeed : public HeatPrinter {
 protected:
  bool fed() { return rig.joints()[kExtruder] > kFed_mm; }
  double sensor() { return rig.nodes.heat_plant(kHeat).hot_end().sensor(); }
  /// The sensor when the first of it went through.
  void expect_fed_hot(BusTime within) {
    ASSERT_TRUE(rig.run_until([this] { return fed(); }, within)) << rig.story();
    EXPECT_GT(sensor(), rig.machine.thermal.min_extrude_c - 1) << rig.story();
  }
};

TEST_F(ColdFeed, AJobThatHeatsNothingIsRefusedWhileTheHotEndIsOff) {
  ASSERT_TRUE(begin("G1 X5 F600\nG1 X10 E3\n")) << rig.story();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_FALSE(rig.run_until([this] { return fed(); }, 5s));
  EXPECT_NE(rig.story().find("filament is fed with the hotend at 0 C; at least 170 C is needed"),
            std::string::npos)
      << rig.story();
}

TEST_F(ColdFeed, AJobThatHeatsNothingWaitsForAHotEndThatSomebodyHasTurnedOn) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::SetTemperature{kFirstHotend, 200}));
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X5 F600\nG1 X10 E3\n"), "part"}));
  expect_fed_hot(200s);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.joints()[kExtruder], 3, 0.01);
}

TEST_F(ColdFeed, AJobThatDoesNotWaitForItsHotEndIsMadeToBeforeItFeeds) {
  ASSERT_TRUE(begin("M104 S200\nG1 X20 F1200\nG1 X40 E3\nM104 S190\nG1 X0 E6\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 19.9; }, 60s)) << rig.story();
  EXPECT_LT(sensor(), 100) << "what feeds nothing moves meanwhile";
  expect_fed_hot(200s);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  EXPECT_NEAR(rig.joints()[kExtruder], 6, 0.01);
}

TEST_F(ColdFeed, AHoldInThatWaitHoldsAndAResumedJobStillWaits) {
  ASSERT_TRUE(begin("M104 S200\nG1 X20 F1200\nG1 X40 E3\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([this] { return rig.gateway->status().pose[kX] > 19.9; }, 60s)) << rig.story();
  rig.run_for(2s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  rig.run_for(20s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  expect_fed_hot(200s);
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

TEST_F(ColdFeed, ALineIsRefusedWhileTheHotEndIsOffAndWaitsWhileItWarms) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::OpenLines{"host"})) << rig.story();
  const auto cold = rig.gateway->take_line("G1 E5 F100", 1);
  ASSERT_FALSE(cold);
  EXPECT_NE(cold.error().words.find("at least 170 C is needed"), std::string::npos) << cold.error().words;
  ASSERT_TRUE(rig.gateway->take_line("M109 S200", 2)) << rig.story();
  ASSERT_TRUE(rig.gateway->take_line("G1 E5 F100", 3)) << rig.story();
  rig.run_for(5s);
  rig.gateway->skip_heating();  // M108
  rig.gateway->skip_heating();
  expect_fed_hot(200s);
  rig.gateway->close_lines();
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
}

}  // namespace
}  // namespace kinebus
