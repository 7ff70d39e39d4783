#include "gateway/bus_nodes/homing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr auto kHomingMode = static_cast<std::int8_t>(cia402::Mode::kHoming);
constexpr auto kStreamMode = static_cast<std::int8_t>(cia402::Mode::kInterpolatedPosition);
constexpr std::uint16_t kHome = cia402::control::kOperation | cia402::control::kHomingStart;
constexpr std::uint16_t kFollow = cia402::control::kOperation | cia402::control::kInterpolationEnable;
/// Positions are reported so often while carriages home: at 40 mm/s that is 0.8 mm of travel.
constexpr std::int64_t kReportMs = 20;
constexpr BusTime kModeTimeout = 3s;
/// After the start command a statusword of before may still be on its way.
constexpr BusTime kSettle = 50ms;
/// A controlword that was lost comes again: a carriage that waits for it would wait for ever.
constexpr BusTime kRepeatControl = 200ms;
/// A carriage that is to home, and rests so long, has lost its start: its drive takes none without an edge.
constexpr BusTime kLostStart = 500ms;

struct Place {
  std::uint8_t order = 1;  ///< of its stage, from 1
  double lift_per_s = 0;
};
Place place_of(const homing::Plan& plan, std::size_t joint) {
  for (std::size_t n = 0; n < plan.stages.size(); ++n) {
    const homing::Stage& stage = plan.stages[n];
    for (std::size_t i = 0; i < stage.joints.size(); ++i)
      if (stage.joints[i].joint == joint)
        return {static_cast<std::uint8_t>(n + 1), stage.lift_per_s.empty() ? 0 : stage.lift_per_s[i]};
  }
  return {};
}

}  // namespace

MachineHoming::MachineHoming(const MachineDescription& machine, const homing::Plan& plan,
                             std::deque<NodeLink>& links)
    : machine_(machine), links_(links), reports_(links.size()) {
  for (std::size_t number = 0; number < machine.joints.size(); ++number) {
    const JointDescription& joint = machine.joints[number];
    if (!joint.homing) continue;
    for (std::size_t node = 0; node < links.size(); ++node) {
      if (links[node].id() != joint.node_id) continue;
      Axis axis;
      axis.joint = number;
      axis.node = node;
      axis.axis = joint.axis & 1u;
      axis.name = joint.name;
      axis.linear = !joint.rotary;
      axis.counts_per_unit = std::abs(joint.drive.counts_per_unit());
      // Three reports may have been lost.
      axis.jump_counts =
          4 * joint.homing->fast_per_s * axis.counts_per_unit * 1e-3 * static_cast<double>(kReportMs);
      const Place place = place_of(plan, number);
      axis.order = place.order;
      axis.lift_per_s = place.lift_per_s;
      axes_.push_back(axis);
    }
  }
}

void MachineHoming::start(BusTime now) {
  for (Axis& axis : axes_) {
    axis.attained = axis.waits = axis.started = axis.lowered = false;
    axis.rests_since = kMoves;
  }
  failed_ = unexplained_ = false;
  order_ = 0;
  next_order();
  enter(order_ == 0 ? Stage::kIdle : Stage::kReports, now);
}

void MachineHoming::next_order() {
  int next = 256;
  for (const Axis& axis : axes_)
    if (axis.order > order_) next = std::min<int>(next, axis.order);
  order_ = next > 255 ? 0 : static_cast<std::uint8_t>(next);
}

std::vector<MachineHoming::Axis*> MachineHoming::group() {
  std::vector<Axis*> members;
  for (Axis& axis : axes_)
    if (axis.order == order_) members.push_back(&axis);
  return members;
}

std::vector<std::size_t> MachineHoming::group_nodes() {
  std::vector<std::size_t> nodes;
  for (const Axis* axis : group())
    if (std::find(nodes.begin(), nodes.end(), axis->node) == nodes.end()) nodes.push_back(axis->node);
  return nodes;
}

void MachineHoming::set_group(std::uint16_t controlword, std::int8_t mode) {
  for (const Axis* axis : group()) links_[axis->node].set_control(axis->axis, controlword, mode);
}

bool MachineHoming::group_in_mode(std::int8_t mode) {
  for (const Axis* axis : group())
    if (links_[axis->node].mode(axis->axis) != mode) return false;
  return true;
}

bool MachineHoming::group_lifts() {
  const std::vector<Axis*> members = group();
  return std::any_of(members.begin(), members.end(), [](const Axis* a) { return a->lift_per_s > 0; });
}

bool MachineHoming::group_rests() {
  for (const Axis* axis : group())
    if ((links_[axis->node].statusword(axis->axis) & cia402::status::kTargetReached) == 0) return false;
  return true;
}

void MachineHoming::lend_speeds(bool own) {
  for (const Axis* axis : group()) {
    if (!(axis->lift_per_s > 0)) continue;
    const JointDescription& joint = machine_.joints[axis->joint];
    const ParameterWrite its = homing_speed(joint, joint.homing->fast_per_s);
    links_[axis->node].lend(own ? its : homing_speed(joint, axis->lift_per_s), its);
  }
}

void MachineHoming::repeat_control(BusTime now) {
  if (now - repeated_ < kRepeatControl) return;
  repeated_ = now;
  for (const std::size_t node : group_nodes()) links_[node].repeat_control();
}

void MachineHoming::set_report_period(std::int64_t ms) {
  for (const std::size_t node : group_nodes()) links_[node].set_report_period(std::chrono::milliseconds{ms});
}

bool MachineHoming::reports(std::size_t node, BusTime from) const {
  return (stage_ == Stage::kMove || stage_ == Stage::kLift) && entered_ < from &&
         std::any_of(axes_.begin(), axes_.end(),
                     [&](const Axis& axis) { return axis.node == node && axis.order == order_; });
}

bool MachineHoming::requests_done() {
  bool done = true;
  for (NodeLink& link : links_) {
    while (const auto answer = link.sdo().next_result())
      if (answer->abort != AbortCode::kNone)
        fail(AlarmCode::kHomingFailed, link.id(), to_string(link.id(), *answer));
    done = done && link.sdo().idle();
  }
  return done;
}

void MachineHoming::fail(AlarmCode code, std::uint8_t node, Sentence words) {
  if (failed_) return;
  failed_ = true;
  failure_ = {code, node, std::move(words)};
}

void MachineHoming::abort() {
  if (stage_ == Stage::kIdle) return;
  // Start bit down and halt up: whatever a carriage is at, it slows down and holds.
  for (const Axis& axis : axes_)
    links_[axis.node].set_control(axis.axis, cia402::control::kOperation | cia402::control::kHalt);
  for (NodeLink& link : links_) link.sdo().abandon();
  stage_ = Stage::kIdle;
  unexplained_ = !failed_;
}

std::optional<StepFailure> MachineHoming::explain() {
  if (!std::exchange(unexplained_, false)) return std::nullopt;
  for (const Axis* axis : group()) {
    const NodeLink& link = links_[axis->node];
    const std::uint16_t status = link.statusword(axis->axis);
    if (!machine_.joints[axis->joint].homing->by_load() || link.mode(axis->axis) != kHomingMode ||
        (status & cia402::status::kHomingError) == 0)
      continue;
    return StepFailure{AlarmCode::kHomingFailed, link.id(), error_words(*axis, status)};
  }
  return std::nullopt;
}

void MachineHoming::enter(Stage stage, BusTime now) {
  stage_ = stage;
  entered_ = repeated_ = now;
  switch (stage) {
    case Stage::kReports:
      began_ = now;
      set_report_period(kReportMs);
      lend_speeds(false);
      break;
    case Stage::kMode:
      set_group(cia402::control::kOperation, kHomingMode);
      break;
    case Stage::kLift:
      for (std::size_t node = 0; node < links_.size(); ++node)
        reports_[node] = links_[node].position_frames();
      for (const Axis* axis : group())
        links_[axis->node].set_control(
            axis->axis,
            axis->lift_per_s > 0 ? kHome | cia402::control::kHomingStay : cia402::control::kOperation,
            kHomingMode);
      break;
    case Stage::kHalt:
      set_group(cia402::control::kOperation, kHomingMode);
      break;
    case Stage::kSpeeds:
      lend_speeds(true);
      break;
    case Stage::kMove:
      for (std::size_t node = 0; node < links_.size(); ++node)
        reports_[node] = links_[node].position_frames();
      set_group(kHome | cia402::control::kHomingStay, kHomingMode);
      break;
    case Stage::kBack:
      set_group(kFollow, kStreamMode);
      break;
    case Stage::kQuiet:
      set_report_period(0);
      break;
    case Stage::kIdle:
      break;
  }
}

MachineHoming::Outcome MachineHoming::on_time(BusTime now) {
  if (stage_ == Stage::kIdle) return failed_ ? Outcome::kFailed : Outcome::kDone;
  switch (stage_) {
    case Stage::kReports:
      if (requests_done()) enter(Stage::kMode, now);
      break;
    case Stage::kMode:
    case Stage::kBack:
      if (group_in_mode(stage_ == Stage::kMode ? kHomingMode : kStreamMode))
        enter(stage_ == Stage::kMode ? Stage::kMove : Stage::kQuiet, now);
      else if (now - entered_ > kModeTimeout)
        fail(AlarmCode::kHomingFailed, 0, say("the drives do not change their mode of operation"));
      repeat_control(now);
      break;
    case Stage::kLift:
    case Stage::kMove:
      watch(now);
      repeat_control(now);
      break;
    case Stage::kHalt:
      if (now - entered_ >= kSettle && group_rests())
        enter(Stage::kSpeeds, now);
      else if (in_time(now))
        repeat_control(now);
      break;
    case Stage::kSpeeds:
      if (requests_done()) enter(Stage::kMove, now);
      break;
    case Stage::kQuiet:
      if (!requests_done()) break;
      if (!failed_)
        for (const std::size_t node : group_nodes()) links_[node].reports_ended();
      next_order();
      enter(order_ == 0 ? Stage::kIdle : Stage::kReports, now);
      break;
    case Stage::kIdle:
      break;
  }
  if (failed_) {
    abort();
    return Outcome::kFailed;
  }
  return stage_ == Stage::kIdle ? Outcome::kDone : Outcome::kBusy;
}

void MachineHoming::watch(BusTime now) {
  watch_spread();
  bool all = true, first = false;
  for (Axis* axis : group()) {
    const NodeLink& link = links_[axis->node];
    const std::uint16_t status = link.statusword(axis->axis);
    if (link.drive_state(axis->axis) != cia402::State::kOperationEnabled)
      return fail(AlarmCode::kHomingFailed, link.id(), say("%1: its drive is no longer enabled", axis->name));
    if (now - entered_ < kSettle) {
      all = false;
      continue;
    }
    if ((status & cia402::status::kHomingError) != 0)
      return fail(AlarmCode::kHomingFailed, link.id(), error_words(*axis, status));
    axis->attained =
        (status & cia402::status::kHomingAttained) != 0 && (status & cia402::status::kTargetReached) != 0;
    axis->waits = (status & cia402::status::kHomingWaits) != 0;
    if (stage_ == Stage::kMove) start_again(*axis, now);
    all = all && axis->attained;
    first = first || axis->waits;
  }
  if (stage_ == Stage::kLift) {
    if (first) return enter(Stage::kHalt, now);
  } else {
    if (all) return enter(Stage::kBack, now);
    if (now - entered_ >= kSettle) let_leave();
  }
  in_time(now);
}

/// A controlword or a mode with a wrong bit has taken it out of homing: the bit of its start goes down and
/// up.
void MachineHoming::start_again(Axis& axis, BusTime now) {
  NodeLink& link = links_[axis.node];
  const bool rests = (link.statusword(axis.axis) & cia402::status::kTargetReached) != 0;
  if (!rests || axis.attained || axis.waits || link.mode(axis.axis) != kHomingMode)
    axis.rests_since = kMoves;
  else
    axis.rests_since = std::min(axis.rests_since, now);
  if (axis.lowered && now - axis.rests_since >= kSettle) {
    link.set_control(axis.axis, kHome | cia402::control::kHomingStay, kHomingMode);
    axis.lowered = false;
    axis.rests_since = kMoves;
  } else if (axis.rests_since != kMoves && now - axis.rests_since >= kLostStart) {
    link.set_control(axis.axis, cia402::control::kOperation, kHomingMode);
    axis.lowered = true;
    axis.rests_since = now;
  }
}

Sentence MachineHoming::error_words(const Axis& axis, std::uint16_t status) const {
  if (!machine_.joints[axis.joint].homing->by_load())
    return say(
        "%1 did not find its home switch, or the switch did not release: is it wired to another "
        "carriage?",
        axis.name);
  if ((status & cia402::status::kHomingWaits) != 0)
    return say(
        "%1: its driver told a stop where there is none, or not twice at one place; stall_threshold is "
        "too high, the motion too rough, or DIAG is not led to the input",
        axis.name);
  return say("%1 came to no stop by its driver's load; stall_threshold is too low, or max_search too short",
             axis.name);
}

/// Fails when it is not.
bool MachineHoming::in_time(BusTime now) {
  if (now - began_ <= machine_.homing.timeout) return true;
  std::string names;
  for (const Axis* axis : group())
    if (!axis->attained) names += (names.empty() ? "" : ", ") + axis->name;
  fail(AlarmCode::kHomingTimeout, 0, say("homing took too long; not at home: %1", names));
  return false;
}

/// All stand on their switches, or have left them: the next node's may go.
void MachineHoming::let_leave() {
  const std::vector<Axis*> members = group();
  if (!std::all_of(members.begin(), members.end(), [](const Axis* a) { return a->waits || a->attained; }))
    return;
  const auto next = std::find_if(members.begin(), members.end(), [](const Axis* a) { return !a->attained; });
  for (const Axis* axis : members)
    if (axis->node == (*next)->node) links_[axis->node].set_control(axis->axis, kHome, kHomingMode);
}

/// Travels since the start, put together from the reports: at its edge a carriage gets a new zero, which is
/// no travel.
void MachineHoming::watch_spread() {
  double least = 1e300, most = -1e300;
  const Axis* farthest = nullptr;
  for (const std::size_t node : group_nodes()) {
    const NodeLink& link = links_[node];
    if (link.position_frames() == reports_[node]) continue;
    reports_[node] = link.position_frames();
    for (Axis* axis : group()) {
      if (axis->node != node) continue;
      const std::int32_t counts = link.position_counts(axis->axis);
      const double step = static_cast<double>(counts) - static_cast<double>(axis->last_counts);
      if (!axis->started) axis->travel_counts = 0;
      if (axis->started && std::abs(step) <= axis->jump_counts) axis->travel_counts += step;
      axis->started = true;
      axis->last_counts = counts;
    }
  }
  for (const Axis* axis : group()) {
    if (!axis->started || !axis->linear) continue;
    const double travel_mm = std::abs(axis->travel_counts) / axis->counts_per_unit;
    least = std::min(least, travel_mm);
    if (travel_mm > most) farthest = axis;
    most = std::max(most, travel_mm);
  }
  if (!farthest || most - least <= machine_.homing.max_spread_mm) return;
  fail(AlarmCode::kHomingSpread, links_[farthest->node].id(),
       say("%1 has gone %2 mm farther than another carriage; allowed are %3 mm", farthest->name,
           printed("%.1f", most - least), printed("%.1f", machine_.homing.max_spread_mm)));
}

}  // namespace kinebus
