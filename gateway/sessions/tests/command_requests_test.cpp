// Each request of the job link is the command that it names, with all that it says.

#include "gateway/sessions/command_requests.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace kinebus {
namespace {

using joblink::ClientMessage;

/// Ends the test where it is another command.
template <typename C>
C made_of(const ClientMessage& message) {
  const auto command = command_of(message);
  const C* made = command ? std::get_if<C>(&*command) : nullptr;
  if (made == nullptr) throw std::runtime_error("another command");
  return *made;
}
void fill(joblink::Pose& pose) {
  pose.set_x_mm(1);
  pose.set_y_mm(2);
  pose.set_z_mm(3);
  pose.set_a_rad(4);
  pose.set_c_rad(5);
  pose.set_e_mm(6);
}
constexpr Pose kFilled{1, 2, 3, 4, 5, 6};

TEST(CommandRequests, AHeaterIsThatOfItsKindAndIndexAndNoOtherWhereThereIsNone) {
  ClientMessage m;
  joblink::SetTemperature& set = *m.mutable_set_temperature();
  set.set_celsius(200);
  set.set_kind(joblink::HEATER_CHAMBER);
  set.set_index(2);
  EXPECT_EQ(made_of<command::SetTemperature>(m).heater, (HeaterId{HeaterKind::kChamber, 2}));
  EXPECT_EQ(made_of<command::SetTemperature>(m).celsius, 200);
  set.set_index(256);
  EXPECT_EQ(made_of<command::SetTemperature>(m).heater.index, 255) << "not the first";
  set.set_bed(true);
  EXPECT_EQ(made_of<command::SetTemperature>(m).heater, kFirstBed) << "whatever kind and index say";
  ClientMessage fan;
  fan.mutable_set_fan()->set_ratio(0.5);
  fan.mutable_set_fan()->set_index(256);
  EXPECT_EQ(made_of<command::SetFan>(fan).index, 255);
  EXPECT_EQ(made_of<command::SetFan>(fan).ratio, 0.5);
  ClientMessage tune;
  tune.mutable_tune_heater()->set_kind(joblink::HEATER_BED);
  tune.mutable_tune_heater()->set_index(1);
  tune.mutable_tune_heater()->set_celsius(70);
  EXPECT_EQ(made_of<command::TuneHeater>(tune).heater, (HeaterId{HeaterKind::kBed, 1}));
  EXPECT_EQ(made_of<command::TuneHeater>(tune).celsius, 70);
}

TEST(CommandRequests, ThePinGoesOutOnlyWhenItIsTold) {
  using Order = ContactProbe::PinOrder;
  ClientMessage m;
  const auto order = [&](int number) {
    m.mutable_move_probe_pin()->set_order(static_cast<joblink::MoveProbePin::Order>(number));
    return made_of<command::MovePin>(m).order;
  };
  EXPECT_EQ(order(joblink::MoveProbePin::OUT), Order::kOut);
  EXPECT_EQ(order(joblink::MoveProbePin::IN), Order::kIn);
  EXPECT_EQ(order(joblink::MoveProbePin::SELF_TEST), Order::kTest);
  EXPECT_EQ(order(joblink::MoveProbePin::RESET), Order::kReset);
  EXPECT_EQ(order(99), Order::kIn) << "no order";
}

TEST(CommandRequests, FilamentGoesWhereItIsTold) {
  using What = command::MoveFilament::What;
  ClientMessage m;
  for (const auto& [asked, what] : {std::pair{joblink::MoveFilament::UNLOAD, What::kUnload},
                                    std::pair{joblink::MoveFilament::LOAD, What::kLoad},
                                    std::pair{joblink::MoveFilament::PURGE, What::kPurge}}) {
    m.mutable_move_filament()->set_what(asked);
    EXPECT_EQ(made_of<command::MoveFilament>(m).what, what);
  }
}

TEST(CommandRequests, MovesAndOffsetsSayAllTheyCarry) {
  ClientMessage jog;
  fill(*jog.mutable_jog()->mutable_delta());
  jog.mutable_jog()->set_speed_per_s(7);
  jog.mutable_jog()->set_while_held(true);
  EXPECT_EQ(made_of<command::Jog>(jog).delta, kFilled);
  EXPECT_EQ(made_of<command::Jog>(jog).speed_per_s, 7);
  EXPECT_TRUE(made_of<command::Jog>(jog).while_held);
  ClientMessage offset;
  fill(*offset.mutable_set_work_offset()->mutable_offset());
  offset.mutable_set_work_offset()->set_system(4);
  offset.mutable_set_work_offset()->set_here(true);
  EXPECT_EQ(made_of<command::SetWorkOffset>(offset).offset, kFilled);
  EXPECT_EQ(made_of<command::SetWorkOffset>(offset).system, 4U);
  EXPECT_TRUE(made_of<command::SetWorkOffset>(offset).here);
  ClientMessage motor;
  motor.mutable_jog_motor()->set_joint(3);
  motor.mutable_jog_motor()->set_distance(-2);
  motor.mutable_jog_motor()->set_speed_per_s(5);
  EXPECT_EQ(made_of<command::JogMotor>(motor).joint, 3U);
  EXPECT_EQ(made_of<command::JogMotor>(motor).distance, -2);
  EXPECT_EQ(made_of<command::JogMotor>(motor).speed_per_s, 5);
}

TEST(CommandRequests, ACurrentThatIsNotNamedStaysAsItIs) {
  ClientMessage m;
  m.mutable_set_motor_currents()->set_joint(2);
  auto motor = made_of<command::SetMotorCurrents>(m).motors.at(0);
  EXPECT_EQ(motor.joint, 2U);
  EXPECT_FALSE(motor.run_ma);
  EXPECT_FALSE(motor.hold_ma);
  m.mutable_set_motor_currents()->set_run_a(1.5);
  motor = made_of<command::SetMotorCurrents>(m).motors.at(0);
  EXPECT_EQ(motor.run_ma, 1500);
  EXPECT_FALSE(motor.hold_ma);
  m.mutable_set_motor_currents()->clear_run_a();
  m.mutable_set_motor_currents()->set_hold_a(0.5);
  motor = made_of<command::SetMotorCurrents>(m).motors.at(0);
  EXPECT_FALSE(motor.run_ma);
  EXPECT_EQ(motor.hold_ma, 500);
}

TEST(CommandRequests, WhatIsNoCommandOrWaitsForItsTextIsNone) {
  ClientMessage m;
  EXPECT_FALSE(command_of(m));
  m.mutable_start_job();
  EXPECT_FALSE(command_of(m));
  m.mutable_get_status();
  EXPECT_FALSE(command_of(m));
  m.mutable_hold();
  made_of<command::Hold>(m);
}

}  // namespace
}  // namespace kinebus
