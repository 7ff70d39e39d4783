#include "gateway/machine/commands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/machine/gateway.hpp"

namespace kinebus {
namespace {

using S = MachineState;

TEST(Commands, StopIsAllowedEverywhere) {
  for (int i = 0; i < kMachineStates; ++i)
    EXPECT_TRUE(allowed(command::kind<command::Stop>, static_cast<S>(i))) << to_string(static_cast<S>(i));
}

TEST(Commands, MotionBeginsOnlyWhenReady) {
  for (int i = 0; i < kMachineStates; ++i)
    for (const CommandKind command : {command::kind<command::Run>, command::kind<command::OpenLines>,
                                      command::kind<command::GoToReference>})
      EXPECT_EQ(allowed(command, static_cast<S>(i)), static_cast<S>(i) == S::kReady);
}

TEST(Commands, EachIsTakenInItsStatesAndInNoOthers) {
  using namespace command;
  const std::vector<S> rest{S::kUnhomed, S::kReady, S::kStopped, S::kAlarm};
  const std::vector<std::pair<CommandKind, std::vector<S>>> table{
      {kind<BringUp>, {S::kOff}},
      {kind<Home>, {S::kUnhomed, S::kReady}},
      {kind<Hold>, {S::kMoving, S::kRunning}},
      {kind<Resume>, {S::kHeld, S::kOff, S::kUnhomed, S::kReady}},
      {kind<Clear>, {S::kStopped, S::kAlarm}},
      {kind<MotorsOff>, rest},
      {kind<MovePin>, rest},
      {kind<TuneMotor>, {S::kUnhomed, S::kReady}},
      {kind<TuneHeater>, {S::kUnhomed, S::kReady}},
      {kind<JogMotor>, {S::kReady}},
      {kind<MoveFilament>, {S::kReady}},
      {kind<StepAside>, {S::kHeld}},
      {kind<ExcludeObject>, {S::kRunning, S::kHolding, S::kHeld}},
      {kind<Cancel>,
       {S::kMoving, S::kRunning, S::kHolding, S::kHeld, S::kChecking, S::kOff, S::kUnhomed, S::kReady}},
  };
  for (const auto& [command, states] : table)
    for (int i = 0; i < kMachineStates; ++i) {
      const auto state = static_cast<S>(i);
      EXPECT_EQ(allowed(command, state), std::find(states.begin(), states.end(), state) != states.end())
          << sentence(command) << " while " << to_string(state);
    }
  for (int i = 0; i < kMachineStates; ++i) {
    const auto state = static_cast<S>(i);
    for (const CommandKind heats : {kind<SetTemperature>, kind<SetSpindle>})
      EXPECT_EQ(allowed(heats, state), state != S::kAlarm) << "what is dangerous stays off in an alarm";
    EXPECT_EQ(allowed(kind<SetMotorCurrents>, state), state != S::kOff && state != S::kBringUp);
  }
}

TEST(Commands, AJogMayFollowAnother) {
  for (int i = 0; i < kMachineStates; ++i) {
    const auto state = static_cast<S>(i);
    EXPECT_EQ(allowed(command::kind<command::Jog>, state), state == S::kReady || state == S::kMoving);
  }
}

TEST(Commands, WhatMayNotBeGivenIsRefusedInTheWordsThatWereToldBefore) {
  Gateway gateway(default_m1());
  const auto told = gateway.may(command::kind<command::Jog>);
  ASSERT_FALSE(told);
  EXPECT_EQ(told.error().words, "cannot jog while the machine is off: bring it up first");
  const auto refused = gateway.carry_out(command::Jog{.delta = {1, 0, 0, 0, 0, 0}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().words, told.error().words);
  EXPECT_EQ(gateway.may(command::kind<command::Resume>).error().words,
            "there is no interrupted job to resume");
  ASSERT_TRUE(gateway.may(command::kind<command::BringUp>));
  EXPECT_TRUE(gateway.carry_out(command::BringUp{}));
}

TEST(Commands, ValuesThatTheMachineCannotHaveAreRefused) {
  Gateway gateway(default_m1());
  EXPECT_FALSE(gateway.carry_out(command::SetFan{1.5}));
  EXPECT_FALSE(gateway.carry_out(command::SetFan{.ratio = 1, .index = 7}));
  EXPECT_FALSE(gateway.carry_out(command::SetOutput{.ratio = 1, .index = 7}));
  EXPECT_FALSE(gateway.carry_out(command::SetTemperature{{static_cast<HeaterKind>(200), 0}, 0}));
  EXPECT_FALSE(gateway.carry_out(command::SetTemperature{{HeaterKind::kHotend, 255}, 40}));
  EXPECT_FALSE(gateway.carry_out(command::SetSpindle{9000}));
  EXPECT_FALSE(gateway.carry_out(command::SetWorkOffset{.system = 10}));
  EXPECT_FALSE(gateway.carry_out(command::SetWorkOffset{.offset = {1e9, 0, 0, 0, 0, 0}}));
  EXPECT_FALSE(gateway.carry_out(command::SetWorkOffset{.here = true})) << "nobody knows where the tool is";
  ASSERT_TRUE(gateway.carry_out(command::SetFan{0.4}));
  EXPECT_EQ(gateway.status().fans.at(0).ratio, 0.4);
}

TEST(Commands, AWorkOffsetIsInMillimetresWhateverTheLinesCount) {
  Gateway gateway(default_m1());
  ASSERT_TRUE(gateway.take_line("G20 G55", 1));
  ASSERT_TRUE(gateway.carry_out(command::SetWorkOffset{.system = 2, .offset = {10, 0, -4, 0, 0, 0}}));
  EXPECT_EQ(gateway.work_offsets()[1][kX], 10);
  EXPECT_EQ(gateway.status().work_offset[kZ], -4);
}

}  // namespace
}  // namespace kinebus
