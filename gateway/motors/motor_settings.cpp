#include "gateway/motors/motor_settings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kTryAgain = 200ms;
constexpr BusTime kTuneLook = 100ms;
/// A node that measures has begun by then, and is through.
constexpr BusTime kTuneBegins = 1s;
constexpr BusTime kTuneEnds = 30s;
// What 2150h:8 says.
constexpr std::int64_t kTuneIdle = 0, kTuneDone = 2, kTuneFailed = 3;

constexpr std::array kTunedObjects{object::kPhaseResistance, object::kPhaseInductance,
                                   object::kEncoderOffset};

std::string thousandths(std::int64_t value) {
  return printed("%.3f", static_cast<double>(value) * 1e-3);
}

}  // namespace

MotorSettings::MotorSettings(MachineDescription& machine, std::deque<NodeLink>& links,
                             ParameterWatch& parameters, EventQueue& events)
    : machine_(machine),
      links_(links),
      parameters_(parameters),
      events_(events),
      wanted_(machine.joints.size()) {
  for (const JointDescription& joint : machine.joints)
    file_.push_back({joint.run_current_ma, joint.hold_current_ma});
}

Result<void, Refusal> MotorSettings::set(const std::vector<MotorSetting>& asked) {
  if (asked.empty()) return refused(say("no motor is named"));
  std::vector<std::pair<std::size_t, Currents>> all;
  for (const MotorSetting& motor : asked) {
    if (motor.joint >= machine_.joints.size())
      return refused(say("there is no joint %1: they are 1 to %2", motor.joint + 1, machine_.joints.size()));
    const JointDescription& joint = machine_.joints[motor.joint];
    const Currents now = wanted_[motor.joint].value_or(Currents{joint.run_current_ma, joint.hold_current_ma});
    const double most = joint.max_current_ma.value_or(file_[motor.joint].run_ma);
    const double run = motor.run_ma.value_or(now.run_ma);
    // Without a word of its own the hold current keeps the machine file's ratio.
    const double ratio = static_cast<double>(file_[motor.joint].hold_ma) / file_[motor.joint].run_ma;
    const double hold = motor.hold_ma.value_or(motor.run_ma ? std::round(run * ratio) : now.hold_ma);
    if (!(run >= 50 && run <= most))
      return refused(
          say("%1: a run current is 50 to %2 mA; max_current_ma of [joint.%3] in the machine file "
              "says how much the motor bears",
              joint.name, static_cast<int>(most), joint.name));
    if (!(hold >= 0 && hold <= run))
      return refused(say("%1: a hold current is 0 to the run current, %2 mA", joint.name,
                         static_cast<int>(std::lround(run))));
    all.emplace_back(motor.joint, Currents{static_cast<std::uint16_t>(std::lround(run)),
                                           static_cast<std::uint16_t>(std::lround(hold))});
  }
  for (const auto& [joint, currents] : all) wanted_[joint] = currents;
  return {};
}

Result<void, Refusal> MotorSettings::tune(std::size_t joint) {
  if (joint >= machine_.joints.size())
    return refused(say("there is no joint %1: they are 1 to %2", joint + 1, machine_.joints.size()));
  to_tune_ = joint;
  return {};
}

bool MotorSettings::waits() const {
  return std::any_of(wanted_.begin(), wanted_.end(), [](const auto& wanted) { return wanted.has_value(); });
}

std::optional<std::size_t> MotorSettings::tuned() const {
  if (to_tune_) return to_tune_;
  if (work_ && !work_->currents) return work_->joint;
  return std::nullopt;
}

std::optional<std::size_t> MotorSettings::link_of(const JointDescription& joint) const {
  for (std::size_t i = 0; i < links_.size(); ++i)
    if (links_[i].id() == joint.node_id) return i;
  return std::nullopt;
}

void MotorSettings::bring_up_begins(BusTime now) {
  work_.reset();
  to_tune_.reset();
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const auto wanted = std::exchange(wanted_[i], std::nullopt);
    if (!wanted) continue;
    JointDescription& joint = machine_.joints[i];
    joint.run_current_ma = wanted->run_ma;
    joint.hold_current_ma = wanted->hold_ma;
    if (const auto node = link_of(joint)) parameters_.changed(machine_, *node, now);
  }
}

void MotorSettings::on_time(BusTime now, bool may_ask, bool rests) {
  if (!work_ && may_ask && rests) begin(now);
  if (!work_) return;
  SdoChannel& sdo = links_[work_->node].sdo();
  if (work_->asked) {
    const auto answer = sdo.next_glance(*work_->asked);
    // Without an answer and idle: the channel was emptied for something else.
    if (!answer && !sdo.idle()) return;
    work_->asked.reset();
    if (answer) take(now, *answer);
  }
  if (work_ && may_ask && now >= work_->due && sdo.idle()) ask();
}

void MotorSettings::begin(BusTime now) {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    if (!wanted_[i]) continue;
    const JointDescription& joint = machine_.joints[i];
    const auto node = link_of(joint);
    if (!node) return wanted_[i].reset();
    work_ = Work{.joint = i, .node = *node, .currents = wanted_[i], .due = now};
    const std::size_t axis = joint.axis & 1u;
    work_->writes = {{on_axis(object::kRunCurrent, axis), 2, wanted_[i]->run_ma},
                     {on_axis(object::kHoldCurrent, axis), 2, wanted_[i]->hold_ma}};
    return;
  }
  const auto joint = std::exchange(to_tune_, std::nullopt);
  if (!joint) return;
  if (const auto node = link_of(machine_.joints[*joint]))
    work_ = Work{.joint = *joint, .node = *node, .step = Step::kTuneBegins, .due = now};
}

void MotorSettings::ask() {
  Work& work = *work_;
  SdoChannel& sdo = links_[work.node].sdo();
  const std::size_t axis = machine_.joints[work.joint].axis & 1u;
  ParameterWrite write{on_axis(object::kAutoTune, axis), 1, 1};
  switch (work.step) {
    case Step::kWrite:
      write = work.writes[work.next];
      [[fallthrough]];
    case Step::kTuneBegins:
      sdo.write_apart(write);
      work.asked = write.address;
      return;
    case Step::kTuneRuns:
    case Step::kTuneRead: {
      const ObjectAddress base = work.step == Step::kTuneRuns ? object::kAutoTune : kTunedObjects[work.next];
      work.asked = on_axis(base, axis);
      sdo.glance(*work.asked);
      return;
    }
  }
}

void MotorSettings::take(BusTime now, const SdoResult& answer) {
  if (work_->step == Step::kWrite) return written(now, answer);
  measured(now, answer);
}

void MotorSettings::written(BusTime now, const SdoResult& answer) {
  Work& work = *work_;
  if (answer.abort == AbortCode::kDeviceState) {
    // Something moves again: both are written anew when it rests.
    if (std::exchange(work.next, 0) == 0 && work.currents) return work_.reset();
    work.due = now + kTryAgain;
    return;
  }
  if (answer.abort != AbortCode::kNone) return fail(now, to_string(links_[work.node].id(), answer));
  if (++work.next == work.writes.size()) finish(now);
}

void MotorSettings::measured(BusTime now, const SdoResult& answer) {
  Work& work = *work_;
  const bool good = answer.abort == AbortCode::kNone;
  if (work.step == Step::kTuneBegins) {
    if (!good) return fail(now, to_string(links_[work.node].id(), answer));
    work.step = Step::kTuneRuns;
    work.begun = now;
    work.due = now + kTuneLook;
    return;
  }
  if (!good) {
    if (now - work.begun > kTuneEnds) return fail(now, to_string(links_[work.node].id(), answer));
    work.due = now + kTuneLook;
    return;
  }
  if (work.step == Step::kTuneRead) {
    work.found[work.next] = answer.value;
    if (++work.next == kTuned) restore_tuned(now);
    return;
  }
  if (answer.value == kTuneDone) {
    work.step = Step::kTuneRead;
    work.next = 0;
    return;
  }
  if (answer.value == kTuneFailed) return fail(now, say("the measurement failed: is a motor connected?"));
  if (answer.value == kTuneIdle && now - work.begun > kTuneBegins)
    return fail(now, say("this node measures no currents"));
  if (now - work.begun > kTuneEnds) return fail(now, say("the measurement does not end"));
  work.due = now + kTuneLook;
}

/// What was found is told; in force stays what the machine file says, since bring-up would write it anyway.
void MotorSettings::restore_tuned(BusTime now) {
  Work& work = *work_;
  const JointDescription& joint = machine_.joints[work.joint];
  events_.message(now, say("%1: measured %2 Ohm, %3 mH, encoder offset %4: resistance_ohm, inductance_mh and "
                           "encoder_offset_counts of [joint.%5.motor] in the machine file keep them",
                           joint.name, thousandths(work.found[0]), thousandths(work.found[1]), work.found[2],
                           joint.name));
  work.step = Step::kWrite;
  work.next = 0;
  for (const ParameterWrite& write : configure_node(machine_, joint.node_id).writes)
    for (const ObjectAddress base : kTunedObjects)
      if (write.address == on_axis(base, joint.axis & 1u)) work.writes.push_back(write);
}

void MotorSettings::finish(BusTime now) {
  const Work work = *std::exchange(work_, std::nullopt);
  JointDescription& joint = machine_.joints[work.joint];
  if (work.currents) {
    joint.run_current_ma = work.currents->run_ma;
    joint.hold_current_ma = work.currents->hold_ma;
    std::optional<Currents>& wanted = wanted_[work.joint];
    if (wanted && wanted->run_ma == joint.run_current_ma && wanted->hold_ma == joint.hold_current_ma)
      wanted.reset();
    events_.message(now, say("%1: run current %2 mA, hold current %3 mA", joint.name, joint.run_current_ma,
                             joint.hold_current_ma));
  }
  parameters_.changed(machine_, work.node, now);
}

void MotorSettings::fail(BusTime now, Sentence why) {
  const Work work = *std::exchange(work_, std::nullopt);
  if (work.currents) wanted_[work.joint].reset();
  events_.message(now, say("%1: %2", machine_.joints[work.joint].name, std::move(why)));
  // Half of it may have been done: the watch finds out, and bring-up makes it whole.
  parameters_.changed(machine_, work.node, now);
}

}  // namespace kinebus
