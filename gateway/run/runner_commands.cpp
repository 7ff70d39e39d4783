// What a job commands besides motion: heaters, spindle, messages, and the waits for them, for time and for
// the operator. Commands take effect when path time has passed the phase before them.

#include <algorithm>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/run/runner.hpp"

namespace kinebus {
bool Runner::wait_is_over(BusTime now) {
  switch (wait_) {
    case Wait::kNone:
      return true;
    case Wait::kRunDone:
      if (!group_.run_done(rate_.tau(now))) return false;
      feed_.end_run();
      execute_due(now);
      rate_.request(0, kRampAtRest, now, false);
      if (std::exchange(hold_waits_, false)) held_ = true;
      wait_ = Wait::kRest;
      return wait_is_over(now);
    case Wait::kRest:
      // A bus that is blocked keeps the command from the nodes: their path time goes on.
      if (!rate_.at_rest(now) || !rate_.all_sent()) return false;
      break;
    case Wait::kDwell:
      if (dwell_left_ > BusTime{0}) return false;
      break;
    case Wait::kHeating:
      if (held_) return false;
      if (heating_.in_vain(heat_))
        events_out_.message(
            now, say("the %1 was switched off: nothing waits for it", heater_words(heating_.heater())),
            last_line_);
      else if (!heating_.over(heat_, now))
        return false;
      break;
    case Wait::kMelt:
      if (held_ || heat_.too_cold()) return false;
      break;
    case Wait::kSpindle:
      if (held_ || !heat_.spindle_at_speed()) return false;
      break;
    case Wait::kPinOut:
      if (pin_is(ContactProbe::Pin::kOut)) arm_probe();
      return false;
    case Wait::kPinStays:
      if (!pin_is(ContactProbe::Pin::kOut)) {
        // A bring-up in between has drawn it in.
        if (pin_is(ContactProbe::Pin::kIn)) heat_.probe()->move_pin(ContactProbe::PinOrder::kOut);
        return false;
      }
      break;
    case Wait::kProbeReady:
      if (!probe_has_answered()) return false;
      break;
    case Wait::kProbeEnd:
      if (!probe_has_answered()) return false;
      end_wait();
      return !draw_pin_in();
    case Wait::kPinIn:
      if (!pin_is(ContactProbe::Pin::kIn)) return false;
      break;
    case Wait::kInput:
      if (held_ || !input_has_come(now)) return false;
      break;
    case Wait::kPause:
      return false;
  }
  end_wait();
  return true;
}

void Runner::end_wait() {
  const bool of_job =
      wait_ == Wait::kDwell || wait_ == Wait::kHeating || wait_ == Wait::kSpindle || wait_ == Wait::kPause;
  wait_ = Wait::kNone;
  doing_ = say("moving");
  if (!of_job) return;
  ++waits_done_;
  if (noted_) journal_.push(journal::WaitsDone{waits_done_});
}

void Runner::skip_heating() {
  if (wait_ != Wait::kHeating) return;
  end_wait();
  pipeline_.melt_not_awaited();
}

void Runner::execute_due(BusTime now) {
  if (events_.empty() || still_) return;
  const std::uint64_t done = feed_.place(rate_.tau(now)).phase;
  while (!events_.empty() && (!feed_.streaming() || events_.front().phase <= done)) {
    execute(now, events_.front().line);
    events_.pop_front();
  }
}

BusTime Runner::next_output(BusTime now) const {
  if (still_) return BusTime::max();
  const auto is_output = [](const Event& event) {
    const auto* const thermal = std::get_if<canonical::Thermal>(&event.line.command);
    return thermal != nullptr && thermal->what == canonical::Thermal::What::kOutput;
  };
  const auto event = std::find_if(events_.begin(), events_.end(), is_output);
  const double rate = rate_.rate(now);
  if (event == events_.end() || rate <= 0) return BusTime::max();
  const auto start = feed_.start_of(event->phase);
  if (!start) return BusTime::max();
  const double left_s = std::max(0.0, to_seconds(*start - rate_.tau(now))) / rate;
  constexpr double kFar_s = 1;
  return left_s > kFar_s ? BusTime::max() : now + BusTime{static_cast<std::int64_t>(left_s * 1e9) + 1};
}

void Runner::execute(BusTime now, const canonical::Line& line) {
  if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command)) {
    heat_.execute(*thermal);
  } else if (const auto* spindle = std::get_if<canonical::Spindle>(&line.command)) {
    heat_.execute(*spindle);
  } else if (const auto* per_turn = std::get_if<canonical::FeedPerTurn>(&line.command)) {
    per_turn_.follow(per_turn->rpm);
  } else if (const auto* message = std::get_if<canonical::Message>(&line.command)) {
    events_out_.message(now, Sentence::verbatim(message->text), line.line);
  } else if (std::holds_alternative<canonical::EmergencyStop>(line.command)) {
    stop_asked_ = true;
  }
}

/// Whether the machine waits there; the same for every reading of the job.
bool Runner::waits(const canonical::Line& line) const {
  if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command))
    return awaited(*thermal) != nullptr;
  if (const auto* spindle = std::get_if<canonical::Spindle>(&line.command)) return spindle->rpm != 0;
  return std::holds_alternative<canonical::Dwell>(line.command) ||
         std::holds_alternative<canonical::Pause>(line.command);
}

Runner::Outcome Runner::barrier(BusTime now) {
  const canonical::Line& line = pipeline_.command();
  last_line_ = line.line;
  if (const auto* dwell = std::get_if<canonical::Dwell>(&line.command)) {
    dwell_left_ = BusTime{static_cast<std::int64_t>(dwell->seconds * 1e9)};
    wait_ = Wait::kDwell;
    doing_ = say("dwelling");
  } else if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command)) {
    execute(now, line);
    begin_heating(*thermal);
  } else if (const auto* spindle = std::get_if<canonical::Spindle>(&line.command)) {
    execute(now, line);
    if (spindle->rpm != 0) {
      wait_ = Wait::kSpindle;
      doing_ = say("waiting for the spindle");
    }
  } else if (const auto* tool = std::get_if<canonical::Tool>(&line.command)) {
    change_tool(tool->hotend);
  } else if (const auto* sync = std::get_if<canonical::SpindleSync>(&line.command)) {
    begin_thread(*sync);
  } else if (std::holds_alternative<canonical::Probe>(line.command)) {
    begin_probe();
  } else if (const auto* pin = std::get_if<canonical::ProbePin>(&line.command)) {
    move_pin(*pin);
  } else if (const auto* wait = std::get_if<canonical::AwaitInput>(&line.command)) {
    begin_input(*wait);
  } else if (const auto* mesh = std::get_if<canonical::Mesh>(&line.command)) {
    return level(now, canonical::Mesh(*mesh), line.line);
  } else if (const auto* pause = std::get_if<canonical::Pause>(&line.command)) {
    wait_ = Wait::kPause;
    filament_change_ = pause->filament_change;
    doing_ = say("paused by the job");
    events_out_.message(now, say("the job pauses here: resume to go on"), line.line);
  } else if (std::holds_alternative<canonical::MotorsOff>(line.command)) {
    // A platform on vertical rails falls when its drives let go: drives hold, with hold current, until the
    // operator switches them off.
    events_out_.message(now, say("M18/M84 in a job: the motors go on holding"), line.line);
  }
  return Outcome::kBusy;
}

const HeaterDescription* Runner::awaited(const canonical::Thermal& thermal) const {
  const auto id = heater_of(thermal);
  return id && (thermal.value > 0 || thermal.wait_cooling) ? machine_.heater(*id) : nullptr;
}

void Runner::begin_heating(const canonical::Thermal& thermal) {
  const HeaterDescription* heater = awaited(thermal);
  if (heater == nullptr) return;
  heating_.begin(thermal, *heater, heat_);
  wait_ = Wait::kHeating;
  doing_ = say("waiting for the %1 at %2", heater_words(heater->id()), printed("%.0f C", thermal.value));
}

}  // namespace kinebus
