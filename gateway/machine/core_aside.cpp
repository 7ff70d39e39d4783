// A job that is set aside: by its operator, by M600, or when it has waited for long.

#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {
using Done = Result<void, Refusal>;
}  // namespace

Done Gateway::Core::on(command::StepAside&) {
  return step_aside(print_.runner().changes_filament() ? HeatHold::Aside::kForFilament
                                                       : HeatHold::Aside::kByCommand);
}

/// In kHeld.
Done Gateway::Core::step_aside(HeatHold::Aside why) {
  const Runner& job = print_.runner();
  if (!job.active() || job.live()) return refused(say("no job is held that could be set aside"));
  if (hand_.runner().active()) return refused(say("the tool is on its way: resume or cancel first"));
  if (job.probing()) return refused(say("the probe is on its way: resume or cancel first"));
  if (job.cuts_thread()) return refused(say("the tool is in a thread: resume or cancel first"));
  recovery_.do_not_go_on();
  standby_due_ = false;
  // What a fault holds is off the part already.
  if (heat_hold_.is(HeatHold::Stage::kHolds) || heat_hold_.is(HeatHold::Stage::kMends)) {
    heat_hold_.abort();
    enter(MachineState::kReady);
    return {};
  }
  heat_.note(journal_);
  heat_.keep();
  runner_ = &print_.runner();
  runner_->hold_still(now_);
  rest_.begin(now_);
  heat_hold_.begin_aside(why);
  enter(MachineState::kHolding);
  return {};
}

/// Over to where the operator has room, and the filament out of the melt for M600.
void Gateway::Core::add_parking(const Pose& from, std::vector<canonical::Line>& moves) {
  const PauseDescription& pause = machine_.pause;
  Pose at = from;
  if (!moves.empty()) at = std::get<canonical::Traverse>(moves.back().command).target;
  if (pause.park) {
    Pose over = at;
    over[kX] = pause.park_x_mm;
    over[kY] = pause.park_y_mm;
    const std::vector<canonical::Line> way{{0, canonical::Traverse{over, Frame::kMachine}}};
    const auto reach = kinematics_->check(Frame::kMachine, over);
    auto near = reach ? hand_.in_the_way(at, way) : std::optional(to_string(reach.error()));
    if (near) {
      events_.message(now_, say("the tool is not parked: %1", std::move(*near)));
    } else {
      moves.push_back(way.front());
      at = over;
    }
  }
  if (heat_hold_.aside() != HeatHold::Aside::kForFilament || pause.unload_mm == 0 || heat_.too_cold()) return;
  at[kE] -= pause.unload_mm;
  moves.push_back(
      {0, canonical::Feed{.target = at, .frame = Frame::kMachine, .feed_per_s = pause.unload_mm_per_s}});
}

void Gateway::Core::finish_aside() {
  const bool filament = heat_hold_.aside() == HeatHold::Aside::kForFilament;
  runner_ = &print_.runner();
  heat_hold_.forget();
  heat_.stop_spindle();
  events_.message(now_,
                  filament ? say("change the filament: load, purge, then resume goes on with the job")
                           : say("the job is set aside: jog, heat and extrude, then resume goes on with it"),
                  runner_->line(now_));
  if (std::exchange(standby_due_, false)) {
    heat_.stand_by(machine_.pause.standby_c);
    stands_by_ = true;
  }
  enter(MachineState::kReady);
}

/// A hot end that waits for its operator neither oozes nor chars. What goes on heats again first.
void Gateway::Core::watch_standby() {
  const PauseDescription& pause = machine_.pause;
  const Runner& job = print_.runner();
  const bool waits = pause.standby_c > 0 && job.active() && !job.live() &&
                     (state_.is(MachineState::kHeld) || (state_.is(MachineState::kReady) && interrupted()));
  if (!waits) {
    waits_since_ = now_;
    stands_by_ = false;
    return;
  }
  if (stands_by_ || now_ - waits_since_ < pause.standby_after) return;
  if (heat_.hottest_target() <= pause.standby_c) return;
  if (job.suspended()) {
    if (!heat_.kept()) heat_.keep();
    stands_by_ = true;
    heat_.stand_by(pause.standby_c);
    return;
  }
  waits_since_ = now_;
  standby_due_ = step_aside(HeatHold::Aside::kByCommand).has_value();
}

Done Gateway::Core::on(command::MoveFilament& asked) {
  using What = command::MoveFilament::What;
  if (machine_.heater(heat_.tool()) == nullptr) return refused(say("nothing here feeds filament"));
  if (auto cold = heat_.too_cold()) return refused(std::move(*cold));
  const PauseDescription& pause = machine_.pause;
  const double distance_mm = asked.what == What::kUnload ? -pause.unload_mm
                             : asked.what == What::kLoad ? pause.load_mm
                                                         : pause.purge_mm;
  if (distance_mm == 0)
    return refused(say("%1 is 0 in the machine file", asked.what == What::kUnload ? "pause.unload_mm"
                                                      : asked.what == What::kLoad ? "pause.load_mm"
                                                                                  : "pause.purge_mm"));
  command::Jog jog;
  jog.delta[kE] = distance_mm;
  jog.speed_per_s = asked.what == What::kUnload ? pause.unload_mm_per_s
                    : asked.what == What::kLoad ? pause.load_mm_per_s
                                                : pause.purge_mm_per_s;
  return on(jog);
}

}  // namespace kinebus
