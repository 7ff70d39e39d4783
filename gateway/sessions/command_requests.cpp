#include "gateway/sessions/command_requests.hpp"

#include <algorithm>

#include "gateway/sessions/messages.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;

struct Row {
  joblink::Command request;  ///< the request's number in ClientMessage
  CommandKind kind;
  Command (*made)(const ClientMessage& request);  ///< nullptr: it has to wait for something first
};

/// No machine has the last one.
constexpr std::uint8_t narrow(std::uint32_t number) {
  return static_cast<std::uint8_t>(std::min(number, 255u));
}

HeaterId heater_of(joblink::HeaterKind kind, std::uint32_t index) {
  return {static_cast<HeaterKind>(narrow(static_cast<std::uint32_t>(kind))), narrow(index)};
}
HeaterId heater_of(const joblink::SetTemperature& request) {
  return request.bed() ? kFirstBed : heater_of(request.kind(), request.index());
}

/// What is no order draws it in.
ContactProbe::PinOrder order_of(joblink::MoveProbePin::Order order) {
  using Order = ContactProbe::PinOrder;
  switch (order) {
    case joblink::MoveProbePin::OUT:
      return Order::kOut;
    case joblink::MoveProbePin::SELF_TEST:
      return Order::kTest;
    case joblink::MoveProbePin::RESET:
      return Order::kReset;
    default:
      return Order::kIn;
  }
}

template <typename C>
constexpr Row plain(joblink::Command request) {
  return {request, command::kind<C>, [](const ClientMessage&) -> Command { return C{}; }};
}

const Row kTable[] = {
    {joblink::COMMAND_MOVE_PROBE_PIN, command::kind<command::MovePin>,
     [](const ClientMessage& m) -> Command {
       return command::MovePin{order_of(m.move_probe_pin().order())};
     }},
    {joblink::COMMAND_MOVE_FILAMENT, command::kind<command::MoveFilament>,
     [](const ClientMessage& m) -> Command {
       using What = command::MoveFilament::What;
       const auto what = m.move_filament().what();
       return command::MoveFilament{what == joblink::MoveFilament::LOAD    ? What::kLoad
                                    : what == joblink::MoveFilament::PURGE ? What::kPurge
                                                                           : What::kUnload};
     }},
    plain<command::StepAside>(joblink::COMMAND_STEP_ASIDE),
    {joblink::COMMAND_EXCLUDE_OBJECT, command::kind<command::ExcludeObject>,
     [](const ClientMessage& m) -> Command { return command::ExcludeObject{m.exclude_object().name()}; }},
    {joblink::COMMAND_START_JOB, command::kind<command::Run>, nullptr},
    plain<command::Hold>(joblink::COMMAND_HOLD),
    plain<command::Resume>(joblink::COMMAND_RESUME),
    plain<command::Cancel>(joblink::COMMAND_CANCEL),
    plain<command::Stop>(joblink::COMMAND_STOP),
    plain<command::Clear>(joblink::COMMAND_CLEAR),
    plain<command::BringUp>(joblink::COMMAND_BRING_UP),
    plain<command::Home>(joblink::COMMAND_HOME),
    plain<command::GoToReference>(joblink::COMMAND_REFERENCE),
    {joblink::COMMAND_JOG, command::kind<command::Jog>,
     [](const ClientMessage& m) -> Command {
       return command::Jog{pose_of(m.jog().delta()), m.jog().speed_per_s(), m.jog().while_held()};
     }},
    {joblink::COMMAND_SET_OVERRIDE, command::kind<command::SetFeedOverride>,
     [](const ClientMessage& m) -> Command { return command::SetFeedOverride{m.set_override().ratio()}; }},
    {joblink::COMMAND_SET_TEMPERATURE, command::kind<command::SetTemperature>,
     [](const ClientMessage& m) -> Command {
       return command::SetTemperature{heater_of(m.set_temperature()), m.set_temperature().celsius()};
     }},
    {joblink::COMMAND_SET_FAN, command::kind<command::SetFan>,
     [](const ClientMessage& m) -> Command {
       return command::SetFan{m.set_fan().ratio(), narrow(m.set_fan().index())};
     }},
    plain<command::MotorsOff>(joblink::COMMAND_MOTORS_OFF),
    {joblink::COMMAND_SET_WORK_OFFSET, command::kind<command::SetWorkOffset>,
     [](const ClientMessage& m) -> Command {
       const joblink::SetWorkOffset& set = m.set_work_offset();
       return command::SetWorkOffset{set.system(), pose_of(set.offset()), set.here()};
     }},
    {joblink::COMMAND_SET_MOTOR_CURRENTS, command::kind<command::SetMotorCurrents>,
     [](const ClientMessage& m) -> Command {
       const joblink::SetMotorCurrents& set = m.set_motor_currents();
       MotorSetting motor{.joint = set.joint()};
       if (set.has_run_a()) motor.run_ma = 1000 * set.run_a();
       if (set.has_hold_a()) motor.hold_ma = 1000 * set.hold_a();
       return command::SetMotorCurrents{{motor}};
     }},
    {joblink::COMMAND_TUNE_MOTOR, command::kind<command::TuneMotor>,
     [](const ClientMessage& m) -> Command { return command::TuneMotor{m.tune_motor().joint()}; }},
    {joblink::COMMAND_JOG_MOTOR, command::kind<command::JogMotor>,
     [](const ClientMessage& m) -> Command {
       const joblink::JogMotor& jog = m.jog_motor();
       return command::JogMotor{jog.joint(), jog.distance(), jog.speed_per_s()};
     }},
    {joblink::COMMAND_TUNE_HEATER, command::kind<command::TuneHeater>,
     [](const ClientMessage& m) -> Command {
       const joblink::TuneHeater& tune = m.tune_heater();
       return command::TuneHeater{heater_of(tune.kind(), tune.index()), tune.celsius()};
     }},
};

}  // namespace

std::optional<Command> command_of(const ClientMessage& request) {
  for (const Row& row : kTable)
    if (static_cast<int>(row.request) == static_cast<int>(request.request_case()) && row.made != nullptr)
      return row.made(request);
  return std::nullopt;
}

void add_commands(joblink::Status& status, const Gateway& gateway) {
  for (const Row& row : kTable) {
    joblink::CommandStatus& command = *status.add_commands();
    command.set_command(row.request);
    const auto may = gateway.may(row.kind);
    command.set_allowed(may.has_value());
    if (!may) *command.mutable_why_not() = to_message(may.error().words);
  }
}

}  // namespace kinebus
