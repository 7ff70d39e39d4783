// The commands, refused with a reason or begun.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {
using Done = Result<void, Refusal>;

bool moves_or_measures(CommandKind command) {
  static constexpr std::array kKinds{command::kind<command::Home>,      command::kind<command::GoToReference>,
                                     command::kind<command::Jog>,       command::kind<command::Run>,
                                     command::kind<command::OpenLines>, command::kind<command::Resume>,
                                     command::kind<command::TuneMotor>, command::kind<command::JogMotor>,
                                     command::kind<command::TuneHeater>};
  return std::find(kKinds.begin(), kKinds.end(), command) != kKinds.end();
}

constexpr double kFarthestMotorJog = 20;       // mm
constexpr double kFarthestMotorTurn = 0.5236;  // rad, 30 degrees
constexpr double kMotorJogSpeed = 5;           // mm/s
constexpr double kMotorTurnSpeed = 0.1;        // rad/s
constexpr double kJointsMeet = 1e-3;           // mm or rad: as exact as a pose is found
constexpr double kNoWay = 1e-6;                // mm or rad: a coordinate of it that was not to change

}  // namespace

Done Gateway::Core::may(CommandKind command) const {
  if (command == command::kind<command::Stop>) return {};
  if (!defect_.empty()) return refused(defect_);
  const MachineState state = state_.now();
  if (const auto joint = motors_.tuned(); joint && moves_or_measures(command))
    return refused(
        say("cannot %1 while a motor is measured (%2)", sentence(command), machine_.joints[*joint].name));
  if (const HeaterDescription* heater = heat_.tuned(); heater != nullptr && moves_or_measures(command))
    return refused(say("cannot %1 while heater.%2 is measured: a target of 0 ends that", sentence(command),
                       heater->name));
  if (allowed(command, state)) {
    const bool for_interrupted =
        (command == command::kind<command::Resume> && state != MachineState::kHeld) ||
        (command == command::kind<command::Cancel> && state_.idle());
    if (for_interrupted && !interrupted())
      return refused(say("there is no interrupted job to %1", sentence(command)));
    if (command == command::kind<command::Jog> && state == MachineState::kMoving &&
        hand_.jogs() == ManualMotion::Jogs::kNone)
      return refused(say("cannot %1 while the machine is %2", sentence(command), sentence(state)));
    return {};
  }
  const Sentence words = say("cannot %1 while the machine is %2", sentence(command), sentence(state));
  switch (state) {
    case MachineState::kOff:
      return refused(say("%1: bring it up first", words));
    case MachineState::kUnhomed:
      return refused(say("%1: home it first", words));
    case MachineState::kStopped:
    case MachineState::kAlarm:
      return refused(say("%1: clear first", words));
    default:
      return refused(words);
  }
}

Done Gateway::Core::carry_out(Command command) {
  if (auto ok = may(command.index()); !ok) return ok;
  stall_.commanded();
  return std::visit([this](auto& asked) { return on(asked); }, command);
}

Done Gateway::Core::on(command::BringUp&) {
  recovery_.do_not_go_on();
  begin_bring_up();
  return {};
}

Done Gateway::Core::on(command::Home&) {
  if (auto ok = may_home(); !ok) return ok;
  recovery_.do_not_go_on();
  // So the operator says that the table is empty; an interrupted job's part stays on it.
  if (printed_ && !interrupted()) printed_->clear();
  begin_homing();
  return {};
}

void Gateway::Core::begin_move(canonical::Command move, const Pose& from) {
  if (!interrupted()) print_.forget_name();
  runner_ = &hand_.runner();
  hand_.start({{0, std::move(move)}}, from, override_, ManualMotion::Then::kNothing);
  started_ = now_;
  if (!state_.is(MachineState::kMoving)) enter(MachineState::kMoving);
}

Done Gateway::Core::on(command::GoToReference&) {
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  if (auto meet = hand_.in_the_way_to_reference(*from)) return refused(hand_.with_way_out(std::move(*meet)));
  hand_.end_jogs();
  begin_move(hand_.reference(*from), *from);
  return {};
}

Done Gateway::Core::on(command::Jog& asked) {
  if (state_.is(MachineState::kMoving)) return jog_on(asked);
  // Let go when it had come to its end already.
  if (asked.while_held && asked.delta == Pose{}) return {};
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  auto move = hand_.jog(asked, *from, heat_);
  if (!move) return Error<Refusal>(move.error());
  hand_.begin_jog(now_, asked, *move, *from);
  begin_move(*move, *from);
  return {};
}

Done Gateway::Core::jog_on(const command::Jog& asked) {
  const bool held = hand_.jogs() == ManualMotion::Jogs::kWhileHeld;
  if (held != asked.while_held) return refused(say("another jog is under way"));
  if (!held) return hand_.add_jog(asked, heat_);
  if (asked.delta == Pose{})
    end_jog();
  else if (!hand_.hold_on(now_, asked))
    return refused(say("another jog is under way"));
  return {};
}

void Gateway::Core::end_jog() {
  runner_->hold(now_);
  rest_.begin(now_);
  enter(MachineState::kCancelling);
}

/// A jog of the tool to where this one joint's new value has it.
Done Gateway::Core::on(command::JogMotor& asked) {
  if (asked.joint >= machine_.joints.size())
    return refused(say("there is no joint %1: they are 1 to %2", asked.joint + 1, machine_.joints.size()));
  const JointDescription& joint = machine_.joints[asked.joint];
  const double farthest = joint.rotary ? kFarthestMotorTurn : kFarthestMotorJog;
  if (!std::isfinite(asked.distance) || !std::isfinite(asked.speed_per_s) || asked.speed_per_s < 0)
    return refused(say("a jog needs numbers"));
  if (asked.distance == 0) return refused(say("a jog needs a distance"));
  if (std::abs(asked.distance) > farthest)
    return refused(say("one motor alone goes at most 20 mm or 30 degrees: the others hold the tool"));
  const auto from = machine_pose();
  if (!from) return Error<Refusal>(from.error());
  JointVector joints = joints_now();
  joints[asked.joint] += asked.distance;
  Pose to = *from;
  JointVector reached{};
  if (auto found = kinematics_->forward(Frame::kMachine, joints, to); !found)
    return refused(to_string(found.error(), *kinematics_));
  if (auto back = kinematics_->inverse(Frame::kMachine, to, reached); !back)
    return refused(to_string(back.error(), *kinematics_));
  for (std::size_t i = 0; i < machine_.joints.size(); ++i)
    if (std::abs(reached[i] - joints[i]) > kJointsMeet)
      return refused(say("%1 cannot move alone here", joint.name));
  command::Jog jog;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    const double part = to[axis] - (*from)[axis];
    jog.delta[axis] = std::abs(part) > kNoWay ? part : 0;
  }
  // As long as the joint takes; a jog's speed is the tool's, or that of the axis that goes farthest.
  const double speed = asked.speed_per_s > 0 ? asked.speed_per_s
                       : joint.rotary        ? kMotorTurnSpeed
                                             : kMotorJogSpeed;
  const double mm = std::hypot(jog.delta[kX], jog.delta[kY], jog.delta[kZ]);
  double way = mm;
  if (mm == 0)
    for (const double part : jog.delta) way = std::max(way, std::abs(part));
  jog.speed_per_s = way * speed / std::abs(asked.distance);
  return on(jog);
}

Done Gateway::Core::on(command::Run& asked) {
  if (!asked.job || !asked.job->rewind())
    return refused(say("the job cannot be read twice: it is checked before it runs"));
  give_up_job();
  print_.rename(std::move(asked.name));
  print_.begin_check(std::move(asked.job), heat_.hotends_found(), lines_.work_offsets());
  enter(MachineState::kChecking);
  return {};
}

Done Gateway::Core::on(command::Hold&) {
  held_from_ = state_.now();
  runner_->hold(now_);
  enter(MachineState::kHolding);
  return {};
}

Done Gateway::Core::on(command::Resume&) {
  recovery_.commanded();
  if (const auto cold = heat_.kept_too_cold(); cold && state_.is(MachineState::kHeld) && heat_hold_.cold())
    return refused(say("the %1 is set to %2 C: set it to at least %3 C, then resume",
                       heater_words(cold->hotend), std::lround(cold->celsius),
                       std::lround(machine_.thermal.min_extrude_c)));
  if (state_.is(MachineState::kHeld) && !heat_hold_.why().empty() && out_of_order()) {
    heat_.clear_faults();
    heat_hold_.await_mended(now_);
    return {};
  }
  // What is still broken says so again, on the way back.
  if (out_of_order()) heat_.clear_faults();
  return resume();
}

Done Gateway::Core::resume() {
  // What is held on its way back to the job goes on with that.
  const bool by_hand = hand_.runner().active();
  if (!state_.is(MachineState::kHeld) || (print_.runner().suspended() && !by_hand)) return go_on();
  // Its way back turns the spindle itself.
  if (!by_hand && heat_.start_kept_spindle()) {
    recovery_.await_spindle(state_.visit());
    return {};
  }
  runner_->resume(now_);
  enter(held_from_);
  return {};
}

Done Gateway::Core::on(command::Cancel&) {
  // Nothing goes on that would want it back.
  if (machine_.thermal.on_cancel == ThermalDescription::After::kOff && heat_.heats()) {
    heat_.heaters_off();
    events_.message(now_, say("the heaters are off: %1", say("the job was cancelled")));
  }
  if (state_.is(MachineState::kChecking)) {
    print_.abort_check();
    print_.drop_source();
    give_up_job();
    enter(MachineState::kReady);
    return {};
  }
  if (state_.idle()) {
    give_up_job();
    return {};
  }
  heat_hold_.abort();
  hand_.forget_then();
  hand_.end_jogs();
  if (rest_.reading()) {
    rest_.read_for(Rest::After::kCancel);
  } else {
    if (runner_->taps()) return refused(say("the tool is in a tap: hold rests when it is out of the hole"));
    runner_->hold_at_once(now_);
    rest_.begin(now_);
  }
  enter(MachineState::kCancelling);
  return {};
}

Done Gateway::Core::on(command::Stop& asked) {
  const bool off = asked.heaters_off || machine_.thermal.on_stop == ThermalDescription::After::kOff ||
                   heat_.tuned() != nullptr;
  if (off) cut_heat(asked.why);
  if (state_.is_one_of(MachineState::kStopping, MachineState::kStopped, MachineState::kAlarm)) return {};
  events_.message(now_, std::move(asked.why));
  // Nothing moves that is switched off, and nobody is asked for a ramp.
  if (state_.is(MachineState::kOff))
    recovery_.do_not_go_on();
  else
    stop_all(false);
  return {};
}

Done Gateway::Core::on(command::SetTemperature& asked) {
  const double least = machine_.thermal.min_extrude_c;
  const bool feeds = state_.is(MachineState::kRunning) && runner_ == &print_.runner() && !runner_->live() &&
                     runner_->feeds();
  // Off is off at any time; the job is held before it feeds cold.
  if (feeds && asked.heater == heat_.tool() && asked.celsius > 0 && asked.celsius < least)
    return refused(
        say("the job feeds filament, which needs at least %1 C: hold it first", std::lround(least)));
  heat_idle_since_ = waits_since_ = now_;
  stands_by_ = false;
  return heat_.set_temperature(asked.heater, asked.celsius);
}

void Gateway::Core::cut_heat(const Sentence& why) {
  if (!heat_.heats()) return;
  if (print_.runner().active()) heat_.keep();
  heat_.heaters_off();
  events_.message(now_, say("the heaters are off: %1", why));
}

Done Gateway::Core::on(command::Clear&) {
  heat_.clear_faults();
  if (watch_.needs_bring_up() || !voice_.speaks()) {
    fault_ = false;
    position_.forget();
    hand_.runner().drop();
    const bool job = print_.runner().active();
    if (!job) print_.forget_name();
    events_.message(now_, job ? say("cleared: resume brings the machine up again and goes on with the job")
                              : say("cleared: bring the machine up again"));
    enter(MachineState::kOff);
    return {};
  }
  if (!clearing_.busy() && !rest_.reading()) clearing_.begin(now_);
  return {};
}

Done Gateway::Core::on(command::SetFeedOverride& asked) {
  if (!(asked.ratio >= 0.01 && asked.ratio <= 5)) return refused(say("a feed override is 0.01 to 5"));
  override_ = asked.ratio;
  runner_->set_override(asked.ratio);
  if (print_.runner().active()) journal_.push(journal::Override{asked.ratio});
  return {};
}

Done Gateway::Core::on(command::MotorsOff&) {
  for (NodeLink& link : links_)
    for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
      link.set_control(axis, cia402::control::kShutdown);
  hand_.runner().drop();
  interrupt(rate_.tau(now_));
  recovery_.lose_filament();
  rest_.abort();
  clearing_.abort();
  position_.forget();
  enter(MachineState::kOff);
  return {};
}

Done Gateway::Core::on(command::SetWorkOffset& asked) {
  std::optional<Pose> where;
  if (asked.here && !lines_open()) {
    // Where the tool stands counts, however it came there.
    if (!position_.homed())
      return refused(say("%1: home it first",
                         say("cannot %1 while the machine is %2",
                             sentence(command::kind<command::SetWorkOffset>), sentence(state_.now()))));
    const auto pose = machine_pose();
    if (!pose) return Error<Refusal>(pose.error());
    where = *pose;
  }
  return lines_.set_work_offset(asked.system, asked.offset, asked.here, where);
}

}  // namespace kinebus
