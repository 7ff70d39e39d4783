// An accelerometer on a heat node, by M956: what the tool feels comes as energy over frequency along the
// machine's directions.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <sstream>

#include "gateway/machine/tests/heat_printer.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

MachineDescription with_an_accelerometer() {
  MachineDescription machine = printer_on_the_bus();
  machine.accelerometer = {.present = true, .node = kHeatId, .axes = AccelerometerDescription::Axes::kYxz};
  return machine;
}

class Vibration : public HeatPrinter {
 protected:
  Vibration() : HeatPrinter(with_an_accelerometer()) {}
  heat::AccelerometerPlant& chip() { return rig.nodes.heat_plant(kHeat).accelerometer(); }
  Result<std::string, Refusal> says(const char* line) { return rig.gateway->text_line(line); }
};

TEST_F(Vibration, IsFoundAlongTheMachinesDirectionsWhileAJobRuns) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  // The chip lies with its X along the machine's Y.
  chip().feels = [](double t) {
    const auto sine = [t](double hz) { return std::sin(2 * std::numbers::pi * hz * t); };
    return heat::AccelerometerPlant::Vector{2000 * sine(40), 1000 * sine(70), 0};
  };
  ASSERT_TRUE(says("M956 S1"));
  ASSERT_TRUE(rig.gateway->carry_out(
      command::Run{std::make_unique<StringSource>("G1 X20 F3000\nG4 S8\nG1 X0\n"), "shakes"}));
  ASSERT_TRUE(rig.reach(MachineState::kRunning, 60s));
  EXPECT_EQ(says("M956").value_or(""), "measuring");
  EXPECT_FALSE(says("M956 S1")) << "not while something runs";
  ASSERT_TRUE(rig.reach(MachineState::kReady, 60s)) << rig.story();
  ASSERT_TRUE(says("M956 S0"));
  EXPECT_EQ(says("M956").value_or(""), "reading");
  ASSERT_TRUE(rig.run_until([&] { return says("M956").value_or("").starts_with("rate_hz "); }, 60s));
  std::istringstream text(*says("M956"));
  std::string line;
  ASSERT_TRUE(std::getline(text, line));
  double rate_hz = 0;
  unsigned windows = 0, clipped = 1;
  ASSERT_EQ(std::sscanf(line.c_str(), "rate_hz %lf windows %u clipped %u", &rate_hz, &windows, &clipped), 3);
  EXPECT_NEAR(rate_hz, chip().rate(), 5) << "by the node's clock";
  EXPECT_GE(windows, 8u);
  EXPECT_EQ(clipped, 0u);
  const double width = rate_hz / 8192;
  std::array<double, 3> highest{}, at{}, all{};
  int bands = 0;
  for (; std::getline(text, line); ++bands) {
    std::array<double, 3> e{};
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", e.data(), &e[1], &e[2]), 3) << line;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all[axis] += e[axis];
      if (e[axis] > highest[axis]) highest[axis] = e[axis], at[axis] = bands * width;
    }
  }
  EXPECT_EQ(bands, kVibrationBands);
  EXPECT_NEAR(at[kX], 70, width) << "the chip's Y";
  EXPECT_NEAR(at[kY], 40, width);
  // Squares of amplitudes: Hann's window spreads one over three bands, 1.5 in all.
  EXPECT_NEAR(all[kY] / windows / (1.5 * 2000 * 2000), 1, 0.15);
  EXPECT_LT(all[kZ], 0.05 * all[kX]);
}

TEST_F(Vibration, AChipOrANodeThatIsGoneIsToldInWords) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  EXPECT_FALSE(says("M956 S0")) << "nothing is measured";
  ASSERT_TRUE(says("M956 S1"));
  rig.run_for(5s);
  chip().silent = true;
  ASSERT_TRUE(rig.run_until([&] { return !says("M956"); }, 10s));
  EXPECT_EQ(says("M956").error().words.english(), "the accelerometer does not answer its node");
  chip().silent = false;
  rig.run_for(1s);
  ASSERT_TRUE(says("M956 S1"));
  rig.run_for(1s);
  ASSERT_TRUE(says("M956 S0"));
  ASSERT_TRUE(rig.run_until([&] { return !says("M956"); }, 10s));
  EXPECT_EQ(says("M956").error().words.english(), "it was too short: 4 s at least");
  ASSERT_TRUE(says("M956 S1"));
  rig.run_for(1s);
  rig.nodes.set_power(kHeat, rig.now, false);
  ASSERT_TRUE(rig.run_until([&] { return !says("M956"); }, 20s)) << rig.story();
}

TEST_F(HeatPrinter, WithoutAnAccelerometerM956SaysWhatToWrite) {
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  const auto refused = rig.gateway->text_line("M956 S1");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().words.find("[accelerometer]"), std::string::npos);
}

}  // namespace
}  // namespace kinebus
