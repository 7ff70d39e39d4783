#include "vcan_tests/campaign/operator.hpp"

namespace kinebus {

using namespace std::chrono_literals;

void Operator::on_event(const MachineEvent& event) {
  if (event.kind == MachineEvent::Kind::kFinished && event.words.starts_with("job done")) job_done_ = true;
}

void Operator::on_time(BusTime now, Gateway& gateway, bool cause_over) {
  job_runs_ = job_begun_ && gateway.state() == MachineState::kRunning;
  if (now < next_) return;
  next_ = now + 20ms;
  act(now, gateway, cause_over);
}

/// Takes up the interrupted job, wherever the machine is.
bool Operator::go_on(Gateway& gateway) {
  if (!gateway.status().interrupted || !gateway.carry_out(command::Resume{})) return false;
  ++resumed_;
  return true;
}

void Operator::act(BusTime now, Gateway& gateway, bool cause_over) {
  switch (gateway.state()) {
    case MachineState::kOff:
      if (!cause_over && ever_ready_) return;
      next_ = now + 100ms;
      if (!go_on(gateway)) static_cast<void>(gateway.carry_out(command::BringUp{}));
      return;
    case MachineState::kUnhomed:
      if (!cause_over && ever_ready_) return;
      next_ = now + 100ms;
      if (!go_on(gateway)) static_cast<void>(gateway.carry_out(command::Home{}));
      return;
    case MachineState::kReady:
      ever_ready_ = true;
      lift_attempts_ = 0;
      if (job_done_) {
        content_ = true;
      } else if (job_begun_) {
        if (cause_over && go_on(gateway)) return;
        if (cause_over && begins_again_ && begun_again_ < 3 &&
            gateway.carry_out(command::Run{std::make_unique<StringSource>(job_), "job"})) {
          ++begun_again_;
          return;
        }
        job_lost_ = content_ = cause_over;
      } else if (gateway.carry_out(command::Run{std::make_unique<StringSource>(job_), "job"})) {
        job_begun_ = true;
      }
      return;
    case MachineState::kHeld:
      if (!cause_over) return;
      if (gateway.carry_out(command::Resume{})) ++resumed_;
      return;
    case MachineState::kStopped:
    case MachineState::kAlarm:
      if (!cause_over) return;
      next_ = now + 4s;  // lifting a stop takes up to 3 s
      ++lifted_;
      if (lift_attempts_++ < 2 && gateway.carry_out(command::Clear{})) return;
      lift_attempts_ = 0;
      static_cast<void>(gateway.carry_out(command::MotorsOff{}));
      return;
    case MachineState::kHoming:
      homed_again_ = homed_again_ || job_begun_;
      return;
    default:
      return;
  }
}

}  // namespace kinebus
