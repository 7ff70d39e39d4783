// Inputs that a job reads and waits for: M66.

#include <cstdio>

#include "gateway/machine/tests/resume_rig.hpp"

namespace kinebus {
namespace {

constexpr int kNode = 2, kChannel = 5;  // node 3

MachineDescription machine_with_inputs() {
  MachineDescription machine = default_m1();
  machine.inputs = {{.name = "part_there",
                     .index = 2,
                     .place = {DevicePlace::Where::kNode, 3, static_cast<std::uint8_t>(kChannel)}},
                    {.name = "always", .index = 0, .sim_on = true}};
  return machine;
}

class Inputs : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(rig.make_ready()) << rig.story(); }
  void set(bool on) { rig.nodes.set_input(kNode, rig.now, kChannel, on); }
  bool begin(const std::string& text) {
    rig.job_text = text;
    return rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(text), "part"}).has_value() &&
           rig.reach(MachineState::kRunning, 20s);
  }
  /// The job stands and waits.
  bool waits() {
    return rig.run_until(
        [&] {
          rig.store();
          return rig.gateway->status().doing.english().find("waiting for input") != std::string::npos;
        },
        60s);
  }
  /// As soon as it may.
  bool goes_on() {
    return rig.run_until(
        [&] {
          rig.store();
          const auto done = rig.gateway->carry_out(command::Resume{});
          if (!done) why = done.error().words.english();
          return done.has_value();
        },
        60s);
  }
  std::string why;  ///< it does not go on
  double x() { return rig.gateway->status().pose[kX]; }
  ResumeRig rig{machine_with_inputs()};
};

constexpr const char* kBranch =
    "G21 G90\nG1 X-20 Y0 Z10 F3000\nM66 P2 L3 Q20\n"
    "o1 if [#5399 EQ 1]\n  G1 X20\no1 else\n  G1 X-40\no1 endif\nG1 Y5\n";

TEST_F(Inputs, AJobStandsUntilTheInputOfANodeIsOn) {
  ASSERT_TRUE(begin(kBranch)) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  rig.run(5s);
  EXPECT_NEAR(x(), -20, 1e-2) << "it stands";
  EXPECT_EQ(rig.gateway->status().inputs[0].level, InputLevel::kOff);
  set(true);
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(x(), 20, 1e-2) << rig.story();
  EXPECT_EQ(rig.gateway->status().inputs[1].name, "always");
  EXPECT_EQ(rig.gateway->status().inputs[1].level, InputLevel::kOn);
}

TEST_F(Inputs, AnInputThatDoesNotComeIsMinusOneWhenTheTimeIsOver) {
  ASSERT_TRUE(begin(kBranch)) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  const BusTime from = rig.now;
  ASSERT_TRUE(rig.run_until([&] { return x() < -20.1; }, 60s)) << rig.story();
  const double stood_s = to_seconds(rig.now - from);
  std::printf("input: stood for %.3f s of 20\n", stood_s);
  EXPECT_GE(stood_s, 20);
  EXPECT_LE(stood_s, 21) << "with the beginning of the next run";
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(x(), -40, 1e-2);
  EXPECT_NE(rig.story().find("input 2 has not come in time"), std::string::npos) << rig.story();
}

TEST_F(Inputs, AnEdgeCountsHoweverLongTheInputWasOnBefore) {
  set(true);
  rig.run(100ms);
  ASSERT_TRUE(begin("G1 X-20 Y0 Z10 F3000\nM66 P2 L1 Q60\nG1 X[#5399 * 20]\n")) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  rig.run(2s);
  EXPECT_NEAR(x(), -20, 1e-2) << "it was on already";
  set(false);
  rig.run(1s);
  EXPECT_NEAR(x(), -20, 1e-2);
  set(true);
  rig.run(30ms);  // a short pulse
  set(false);
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(x(), 20, 1e-2);
}

TEST_F(Inputs, APulseIsSeenHoweverShortItIsIfItOutlastsTheDebouncing) {
  for (const auto pulse : {600us, 1000us, 2000us, 5000us, 10'000us}) {
    ASSERT_TRUE(begin("G1 X-20 Y0 Z10 F3000\nM66 P2 L1 Q3\nG1 X[#5399 * 20]\n")) << rig.story();
    ASSERT_TRUE(waits()) << rig.story();
    rig.run(537ms);
    set(true);
    rig.run(pulse);
    set(false);
    ASSERT_TRUE(rig.finish()) << rig.story();
    EXPECT_NEAR(x(), 20, 1e-2) << "a pulse of " << pulse.count() << " us was not seen";
    // The other edge, of an input that is on.
    set(true);
    ASSERT_TRUE(begin("G1 X-20 Y0 Z10 F3000\nM66 P2 L2 Q3\nG1 X[10 + #5399 * 20]\n")) << rig.story();
    ASSERT_TRUE(waits()) << rig.story();
    rig.run(537ms);
    set(false);
    rig.run(pulse);
    set(true);
    ASSERT_TRUE(rig.finish()) << rig.story();
    EXPECT_NEAR(x(), 10, 1e-2) << "a gap of " << pulse.count() << " us was not seen";
    set(false);
  }
}

TEST_F(Inputs, AHoldStopsTheTimeAndWhatTheInputDoesMeanwhile) {
  ASSERT_TRUE(begin("G1 X-20 Y0 Z10 F3000\nM66 P2 L1 Q5\nG1 X[#5399 * 20]\n")) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  set(true);
  rig.run(10s);
  set(false);
  rig.run(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  rig.run(2s);
  EXPECT_NEAR(x(), -20, 1e-2) << "neither the edge in the hold nor its ten seconds count";
  set(true);
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_NEAR(x(), 20, 1e-2);
}

TEST_F(Inputs, AnotherGatewayGoesOnWithWhatWasRead) {
  set(true);
  rig.run(100ms);
  ASSERT_TRUE(begin(
      "G1 X-20 Y0 Z10 F3000\nM66 P2\n#1 = #5399\nM66 P0\nG1 X0 F1200\nG1 X[#1 * 20]\nG1 Y[5 * #5399]\n"))
      << rig.story();
  ASSERT_TRUE(rig.run_until(
      [&] {
        rig.store();
        return rig.gateway->status().line == 5 && x() > -10;
      },
      60s))
      << rig.story();
  rig.replace_gateway();
  set(false);  // another reading would lead elsewhere
  ASSERT_TRUE(goes_on()) << why << rig.story();
  ASSERT_TRUE(rig.finish(300s)) << rig.story();
  EXPECT_NEAR(x(), 20, 1e-2) << rig.story();
  EXPECT_NEAR(rig.gateway->status().pose[kY], 5, 1e-2);
}

TEST_F(Inputs, AGatewayThatEndsWhileItWaitsWaitsAgain) {
  ASSERT_TRUE(begin(kBranch)) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  rig.run(1s);
  rig.replace_gateway();
  ASSERT_TRUE(goes_on()) << rig.story();
  ASSERT_TRUE(waits()) << rig.story();
  rig.run(3s);
  EXPECT_NEAR(x(), -20, 1e-2);
  set(true);
  ASSERT_TRUE(rig.finish(300s)) << rig.story();
  EXPECT_NEAR(x(), 20, 1e-2) << rig.story();
}

TEST_F(Inputs, WhatTheMachineDoesNotHaveIsRefusedBeforeItMoves) {
  rig.job_text = "G1 X-20 F3000\nM66 P5 L3 Q2\n";
  ASSERT_TRUE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(rig.job_text), "part"}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 20s)) << rig.story();
  EXPECT_NE(rig.story().find("this machine has no input 5"), std::string::npos) << rig.story();
}

TEST_F(Inputs, WhatIsReadLeadsOutOfReachIsRefusedJustBeforeItMoves) {
  // Pre-flight takes the input to be off.
  ASSERT_TRUE(begin("G1 X-20 Y0 Z10 F3000\nM66 P0\nG1 X[#5399 * 900]\n")) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return rig.told(AlarmCode::kJobError); }, 60s)) << rig.story();
  EXPECT_LT(x(), -19.9) << "nothing has moved towards it";
}

TEST_F(Inputs, ALineBehindM66KnowsWhatItRead) {
  set(true);
  rig.run(100ms);
  ASSERT_TRUE(rig.gateway->carry_out(command::OpenLines{"lines"})) << rig.story();
  ASSERT_TRUE(rig.gateway->take_line("M66 P2", 1)) << rig.story();
  EXPECT_EQ(rig.gateway->line_room(), 0u) << "the next line has to know";
  ASSERT_TRUE(rig.run_until([&] { return rig.gateway->line_room() > 0; }, 20s)) << rig.story();
  ASSERT_TRUE(rig.gateway->take_line("G1 X[#5399 * 15] F3000", 2)) << rig.story();
  ASSERT_TRUE(rig.run_until([&] { return x() > 14.99; }, 20s)) << rig.story();
  EXPECT_FALSE(rig.gateway->take_line("M66 P6", 3));
}

}  // namespace
}  // namespace kinebus
