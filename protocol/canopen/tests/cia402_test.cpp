#include "protocol/canopen/cia402.hpp"

#include <gtest/gtest.h>

namespace kinebus::cia402 {
namespace {

constexpr StopOptions kOptions{};

PowerStateMachine enabled(const StopOptions& options = kOptions) {
  PowerStateMachine drive;
  drive.on_initialised();
  for (const auto word : {control::kShutdown, control::kSwitchedOn, control::kOperation})
    drive.on_controlword(word, options);
  return drive;
}

TEST(Cia402, ShutdownSwitchOnEnableIsTheWayUp) {
  PowerStateMachine drive;
  EXPECT_EQ(drive.statusword() & status::kStateMask, 0x00);
  drive.on_initialised();
  EXPECT_EQ(drive.statusword(), 0x0250);
  drive.on_controlword(0x06, kOptions);
  EXPECT_EQ(drive.statusword(), 0x0231);
  EXPECT_FALSE(drive.powered());
  drive.on_controlword(0x07, kOptions);
  EXPECT_EQ(drive.statusword(), 0x0233);
  drive.on_controlword(0x0F, kOptions);
  EXPECT_EQ(drive.statusword(), 0x0237);
  EXPECT_TRUE(drive.moves());
}

TEST(Cia402, MasterHelperFindsTheWayFromAnyState) {
  PowerStateMachine drive;
  drive.on_initialised();
  drive.on_fault(kOptions, true);
  for (int i = 0; i < 5; ++i) drive.on_controlword(next_controlword(state_of(drive.statusword())), kOptions);
  EXPECT_EQ(drive.state(), State::kOperationEnabled);
}

TEST(Cia402, EveryStateReadsBackFromItsStatusword) {
  PowerStateMachine drive;
  const auto check = [&](State state) {
    EXPECT_EQ(drive.state(), state);
    EXPECT_EQ(state_of(drive.statusword()), state);
  };
  check(State::kNotReadyToSwitchOn);
  drive = enabled();
  check(State::kOperationEnabled);
  drive.on_controlword(0x02, kOptions);
  check(State::kQuickStopActive);
  drive.on_fault(kOptions, false);
  check(State::kFaultReactionActive);
  drive.on_stop_finished(kOptions);
  check(State::kFault);
}

TEST(Cia402, QuickStopOptionSixHoldsWithPowerAndCanBeLeft) {
  auto drive = enabled();
  drive.on_controlword(0x02, kOptions);
  EXPECT_EQ(drive.stop(), Stop::kQuickStop);
  drive.on_controlword(0x0F, kOptions);
  EXPECT_EQ(drive.state(), State::kQuickStopActive) << "not before the ramp has ended";
  drive.on_stop_finished(kOptions);
  EXPECT_TRUE(drive.powered());
  drive.on_controlword(0x0F, kOptions);
  EXPECT_EQ(drive.state(), State::kOperationEnabled);
}

TEST(Cia402, QuickStopOptionTwoSwitchesOffAfterTheRamp) {
  const StopOptions options{.quick_stop = 2};
  auto drive = enabled(options);
  drive.on_controlword(0x02, options);
  EXPECT_TRUE(drive.powered());
  drive.on_stop_finished(options);
  EXPECT_EQ(drive.state(), State::kSwitchOnDisabled);
}

TEST(Cia402, DisableOperationAndShutdownRampFirst) {
  auto drive = enabled();
  drive.on_controlword(0x07, kOptions);
  EXPECT_EQ(drive.state(), State::kOperationEnabled);
  EXPECT_EQ(drive.stop(), Stop::kSlowDown);
  EXPECT_FALSE(drive.moves());
  drive.on_stop_finished(kOptions);
  EXPECT_EQ(drive.state(), State::kSwitchedOn);

  const StopOptions at_once{.shutdown = 0, .disable_operation = 0};
  drive = enabled(at_once);
  drive.on_controlword(0x07, at_once);
  EXPECT_EQ(drive.state(), State::kSwitchedOn);
  drive = enabled(at_once);
  drive.on_controlword(0x06, at_once);
  EXPECT_EQ(drive.state(), State::kReadyToSwitchOn);
}

TEST(Cia402, DisableVoltageTakesPowerAtOnce) {
  auto drive = enabled();
  drive.on_controlword(0x00, kOptions);
  EXPECT_EQ(drive.state(), State::kSwitchOnDisabled);
  EXPECT_FALSE(drive.powered());
}

TEST(Cia402, HaltStopsAndReleaseGoesOn) {
  auto drive = enabled();
  drive.on_controlword(0x10F, kOptions);
  EXPECT_TRUE(drive.halted());
  EXPECT_FALSE(drive.moves());
  drive.on_stop_finished(kOptions);
  EXPECT_FALSE(drive.moves());
  drive.on_controlword(0x0F, kOptions);
  EXPECT_TRUE(drive.moves());
}

TEST(Cia402, FaultNeedsARisingResetBitAndAGoneCause) {
  auto drive = enabled();
  drive.set_fault_present(true);
  drive.on_fault(kOptions, true);
  EXPECT_EQ(drive.state(), State::kFault);
  drive.on_controlword(0x80, kOptions);
  EXPECT_EQ(drive.state(), State::kFault) << "the cause is still there";
  drive.set_fault_present(false);
  drive.on_controlword(0x80, kOptions);
  EXPECT_EQ(drive.state(), State::kFault) << "no edge";
  drive.on_controlword(0x00, kOptions);
  drive.on_controlword(0x80, kOptions);
  EXPECT_EQ(drive.state(), State::kSwitchOnDisabled);
}

TEST(Cia402, ShortCircuitDuringFaultReactionEndsItAtOnce) {
  auto drive = enabled();
  drive.on_fault(kOptions, false);
  EXPECT_TRUE(drive.powered());
  EXPECT_EQ(drive.stop(), Stop::kQuickStop);
  drive.on_fault(kOptions, true);
  EXPECT_FALSE(drive.powered());
}

}  // namespace
}  // namespace kinebus::cia402
