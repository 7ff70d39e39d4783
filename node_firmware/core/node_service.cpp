// Node: what is looked after on every input and at every deadline, one job a function.

#include <algorithm>
#include <utility>

#include "node_firmware/core/emergency_codes.hpp"
#include "node_firmware/core/node.hpp"

namespace kinebus {
namespace {

/// TPDO2: so often at least while the stream runs, or when so many records were executed since.
constexpr LocalTime kStatusPeriod = std::chrono::milliseconds{100};
constexpr LocalTime kStatusRepeat = std::chrono::milliseconds{500};
constexpr std::uint32_t kStatusRecords = 32;
/// 32 records of the shortest segments that a bus at its budget can bring (1 ms) are looked for in time.
constexpr LocalTime kStatusLook = std::chrono::milliseconds{20};
constexpr int kStreamStatusPdo = 2;

struct Limit {
  SwitchFunction function;
  int axis;
};
constexpr std::array<Limit, 4> kLimits{{{SwitchFunction::kPositiveLimitA, 0},
                                        {SwitchFunction::kPositiveLimitB, 1},
                                        {SwitchFunction::kNegativeLimitA, 0},
                                        {SwitchFunction::kNegativeLimitB, 1}}};

}  // namespace

void Node::serve() {
  path_.on_time(now_, path_.sync_overdue(now_) && moving(now_));
  serve_switches();
  if (parameters_changed_) apply_parameters();
  watch_levels();
  serve_stops();
  for (DriveAxis& axis : axes_) axis.on_time(now_);
  serve_scales();
  serve_emergencies();
  serve_stops();
  serve_clearing();
  sdo_.on_time(now_);
  serve_stream_status();
  pdo_.on_time(now_);
  serve_pdo_problems();
}

/// Last, so that what on_time() has found is told now.
void Node::serve_pdo_problems() {
  while (const auto problem = pdo_.next_problem()) {
    const bool length = problem->emcy_code == emcy::kPdoTooShort || problem->emcy_code == emcy::kPdoTooLong;
    if (length) count(NodeCounter::kPdoLengthErrors);
    const std::uint16_t index = problem->object.index;
    if (!emcy_.active(problem->emcy_code))
      emcy_.raise(problem->emcy_code, {0, problem->rpdo, static_cast<std::uint8_t>(index),
                                       static_cast<std::uint8_t>(index >> 8), problem->object.subindex});
  }
  if (!pdo_.rpdo_missing()) emcy_.clear(emcy::kRpdoTimeout);
}

void Node::serve_scales() {
  if (now_ < scale_look_ && scale_look_ != LocalTime::max()) return;
  bool any = false;
  for (int axis = 0; axis < kAxesPerNode; ++axis) {
    if (!scale_fitted(axis) || axis_parameter(slot_of_axes(object::kScaleCorrectionMost), axis) == 0) {
      scale_corrections_[static_cast<std::size_t>(axis)].hold(now_);
      continue;
    }
    any = true;
    follow_scale(axis);
  }
  scale_look_ = any ? now_ + ScaleCorrection::kPeriod : LocalTime::max();
}

/// A scale that is broken, or farther away than may be corrected, stops all on the path; nothing loses power.
void Node::follow_scale(int axis) {
  const auto i = static_cast<std::size_t>(axis);
  ScaleCorrection& correction = scale_corrections_[i];
  const auto home = axes_[i].scale_at_home();
  if (home != corrected_from_[i]) correction.hold(now_);
  corrected_from_[i] = home;
  if (!home) return;
  // The edge has the negative of the home offset.
  const std::int64_t edge = -axis_parameter(slot_of_axes(object::kHomeOffset), axis);
  const auto counted = static_cast<std::uint32_t>(directed_scales()[i]) - static_cast<std::uint32_t>(*home);
  const ScaleCorrection::Settings settings{
      .ratio_q16 = static_cast<std::int32_t>(axis_parameter(slot_of_axes(object::kScaleMotorRatio), axis)),
      .most_counts = axis_parameter(slot_of_axes(object::kScaleCorrectionMost), axis),
      .counts_per_s = axis_parameter(slot_of_axes(object::kScaleCorrectionRate), axis)};
  const auto finding = correction.look(
      settings, {now_, whole_counts(axes_[i].position(now_)) - edge, static_cast<std::int32_t>(counted)});
  if (finding == ScaleCorrection::Finding::kGood || path_.stop_latched()) return;
  const bool stands = finding == ScaleCorrection::Finding::kStands;
  count(NodeCounter::kDriveFaults);
  path_.request_stop(StopReason::kAxisFault, axis, stands ? emcy::kIncrementalEncoder : emcy::kFollowingError,
                     now_);
}

void Node::serve_switches() {
  // Who sends no TPDO1 keeps nothing for it: 2133h is read as it is.
  const auto show = [&] {
    if (!nmt_.allows_pdo()) inputs_.told();
    inputs_.show(now_);
  };
  while (const auto event = inputs_.next_event(now_)) {
    const auto bus_ns = static_cast<std::uint32_t>(path_.clock().to_bus(event->at).count());
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      axes_[i].on_switch(now_, *event);
      if (event->function != SwitchFunction::kProbe) continue;
      if (event->active) axes_[i].set_probe(event->latched[i]);
      probes_[i].on_edge(event->active, whole_counts(event->latched[i]), bus_ns);
    }
    show();
  }
  show();
}

// Levels, not edges: an input that becomes an E-stop input while it is active stops too.
void Node::watch_levels() {
  const bool pressed = inputs_.active(SwitchFunction::kEmergencyStop);
  if (pressed && !std::exchange(emergency_stop_, pressed))
    path_.request_stop(StopReason::kEmergencyStopInput, 0, node_emcy::kEmergencyStop, now_);
  emergency_stop_ = pressed;
  for (std::size_t i = 0; i < kLimits.size(); ++i) {
    const Limit& limit = kLimits[i];
    const bool active = inputs_.active(limit.function);
    const bool came = active && !std::exchange(limit_active_[i], active);
    limit_active_[i] = active;
    if (!came || (!moving(now_) && path_.at_rest(now_))) continue;
    if (!axes_[static_cast<std::size_t>(limit.axis)].homes_with(limit.function))
      path_.request_stop(StopReason::kLimitSwitch, limit.axis, node_emcy::kLimitSwitch, now_);
  }
}

bool Node::clear_allowed() const {
  return !inputs_.active(SwitchFunction::kEmergencyStop);
}

// The stream follows the stop by path time itself, from the instant that was named. A motion by local time,
// such as homing, shares no path with others: it brakes as soon as the stop is known, here at once, on other
// nodes a frame later.
void Node::serve_stops() {
  const auto start = path_.stop_start();
  if (start) stop_known_ = true;
  if (start && !stop_served_ && (may_brake_ || !options_.stops_on_time)) {
    stop_served_ = true;
    for (DriveAxis& axis : axes_) axis.on_path_stop(now_);
  }
  if (start || !std::exchange(stop_known_, false)) return;
  stop_served_ = false;
  end_stop();
}

void Node::end_stop() {
  for (const std::uint16_t code : node_emcy::kEndWithClear) emcy_.clear(code);
  for (DriveAxis& axis : axes_)
    if (axis.take_left_behind()) emcy_.clear(emcy::kFollowingError);
}

void Node::serve_emergencies() {
  bool homing_error = false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    DriveAxis& axis = axes_[i];
    homing_error = homing_error || axis.homing_error() != HomingError::kNone;
    if (const std::uint16_t cleared = axis.take_cleared_fault(); cleared != 0) emcy_.clear(cleared);
    const std::uint16_t code = axis.take_emergency();
    if (code == 0) continue;
    // A carriage that does not home stops the others that home with it. Without a gateway there are none.
    if (code != node_emcy::kHoming || path_.clock().synchronised())
      path_.request_stop(StopReason::kAxisFault, static_cast<int>(i), code, now_);
    else
      emcy_.raise(code);
  }
  if (!homing_error) emcy_.clear(node_emcy::kHoming);
  serve_lost_masters();
  while (const auto refusal = session_.next_refusal()) {
    emcy_.raise(node_emcy::kNotVouched, *refusal);
    emcy_.clear(node_emcy::kNotVouched);  // it is over: in the history
  }
  while (const auto alarm = path_.next_alarm()) emcy_.raise(alarm->emcy_code, encode(alarm->stop), true);
}

// By heartbeat or by life guarding.
void Node::serve_lost_masters() {
  while (watched_.on_time(now_) || guard_.take_lost(now_)) {
    const bool matters = path_.clock().synchronised() || moving(now_);
    if (matters)
      path_.request_stop(StopReason::kGatewayLost, 0, emcy::kHeartbeat, now_);
    else
      emcy_.raise(emcy::kHeartbeat);
    nmt_.on_error(static_cast<std::uint8_t>(objects_.value(slot_of(object::kErrorBehaviour))));
    pdo_.set_operational(nmt_.allows_pdo(), now_);
  }
  const bool missing = std::any_of(watched_entries_.begin(), watched_entries_.end(), [&](std::int64_t entry) {
    return watched_.health(static_cast<std::uint8_t>((entry >> 16) & 0x7F)) ==
           HeartbeatConsumer::Health::kLost;
  });
  if (!missing && !guard_.lost()) emcy_.clear(emcy::kHeartbeat);
}

void Node::serve_clearing() {
  if (!clearing_ || axes_[0].creeping(now_) || axes_[1].creeping(now_)) return;
  clearing_ = false;
  sdo_.finish(AbortCode::kNone);
}

void Node::serve_stream_status() {
  const std::uint8_t flags = path_.status_flags(), sequence = path_.stream().next_sequence();
  const std::uint32_t consumed = path_.stream().consumed();
  const bool running = path_.rate_q32(now_) != 0 && !path_.stream().idle();
  // At rest the queue is filled: the gateway hears that all has arrived. What is said once may be lost, and
  // motion that waits would wait for ever: said again, more seldom.
  const bool fresh = running || sequence != told_sequence_;
  const bool news = fresh || !path_.stream().idle();
  const LocalTime period = fresh ? kStatusPeriod : kStatusRepeat;
  if (flags != told_flags_ || consumed - told_consumed_ >= kStatusRecords ||
      (news && now_ - status_told_at_ >= period)) {
    told_flags_ = flags;
    told_sequence_ = sequence;
    told_consumed_ = consumed;
    status_told_at_ = now_;
    pdo_.trigger(kStreamStatusPdo);
  }
  status_look_ = running ? now_ + kStatusLook : news ? status_told_at_ + period : LocalTime::max();
}

}  // namespace kinebus
