// Frames and time. What each state of the machine does as time passes: core_states.cpp.

#include "gateway/machine/core.hpp"

#include <algorithm>
#include <utility>

#include "gateway/description/machine_homing.hpp"
#include "gateway/devices/registry.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/foreign_frames.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Nodes with axes first, in the order of the streams: the one is at the same place as the other.
std::deque<NodeLink> make_links(const MachineDescription& machine, const std::vector<NodeAxes>& axes) {
  std::deque<NodeLink> links;
  for (const NodeAxes& node : axes) links.emplace_back(node.node_id, machine.node(node.node_id)->functions);
  for (const NodeDescription& node : machine.nodes)
    if (!node.functions.has_axes()) links.emplace_back(node.id, node.functions);
  return links;
}

/// A description whose geometry no machine can have leaves the default machine's kinematics, for show only.
std::unique_ptr<LevelledKinematics> machine_kinematics(const MachineDescription& machine, Sentence& defect) {
  auto made = make_kinematics(machine);
  if (made) return std::make_unique<LevelledKinematics>(std::move(*made));
  defect = say("the machine file's geometry cannot work: %1", made.error().what);
  return std::make_unique<LevelledKinematics>(std::move(*make_m1_kinematics(M1Geometry{})));
}

/// Devices that nobody stands behind are a defect of the file, as a geometry that cannot work is.
Devices machine_devices(const MachineDescription& machine, std::optional<Devices> given, Sentence& defect) {
  if (given) return std::move(*given);
  auto made = make_devices(machine);
  if (made) return std::move(*made);
  if (defect.empty()) defect = made.error();
  return {};
}

}  // namespace

Gateway::Core::Core(const MachineDescription& machine, Options options, std::optional<Devices> devices)
    : machine_(machine),
      options_(options),
      kinematics_(machine_kinematics(machine_, defect_)),
      axes_(node_axes(machine_)),
      links_(make_links(machine_, axes_)),
      rate_({.stop_ramp = machine_.stop.ramp}),
      group_(*kinematics_, axes_, stream_options(machine_)),
      devices_(machine_devices(machine_, std::move(devices), defect_)),
      heat_(machine_, devices_),
      bed_(machine_, *kinematics_, journal_, events_, options.unix_s_at_zero),
      state_(events_),
      voice_(machine_, options.epoch),
      session_(machine_.bus.trust, options.bus_secret),
      watch_(machine_, links_, rate_, group_, events_, counters_),
      parameters_(machine_, links_),
      bring_up_(machine_, links_, rate_),
      homing_(machine_, homing_plan(machine_, *kinematics_), links_),
      motors_(machine_, links_, parameters_, events_),
      currents_(links_.size()),
      scales_(machine_, axes_),
      position_(machine_, *kinematics_, axes_, group_),
      rest_(machine_, links_, rate_),
      clearing_(axes_, links_, rate_),
      printed_(machine_.bodies && machine_.bodies->printed_part ? std::make_unique<bodies::PrintedPart>()
                                                                : nullptr),
      hand_(machine_, *kinematics_, group_, rate_, heat_, events_, journal_, printed_.get()),
      print_(machine_, *kinematics_, group_, rate_, heat_, events_, journal_, printed_.get()),
      lines_(machine_, *kinematics_, journal_, printed_.get()),
      recovery_(machine_, *kinematics_, journal_),
      stall_(machine_, events_) {
  print_.runner().set_bed(&bed_);
  if (!options_.journal) return;
  journal_.enable();
  journal_.push(journal::Epoch{options_.epoch});
}

// Frames
// ------------------------------------------------------------------------------------------------------

void Gateway::Core::on_frame(BusTime when, const CanFrame& frame) {
  now_ = std::max(now_, when);
  ++counters_.frames_received;
  voice_.on_frame(when, frame);
  if (frame.remote) {
    // Node guarding and polls of other masters: nobody here answers them, and they say nothing.
    ++counters_.foreign_frames;
    if (!std::exchange(remote_told_, true))
      events_.message(now_, say("another device sends remote frames (COB-ID %1): nobody answers them",
                                printed("%03Xh", static_cast<unsigned>(frame.id))));
    return;
  }
  parameters_.on_frame(when, frame);
  if (frame.id == cob_id::kNmt)
    for (NodeLink& link : links_) link.on_nmt(frame);
  const ForeignFrame foreign = look_at_foreign(frame, links_);
  if (foreign.kind == ForeignFrame::Kind::kRecord || foreign.kind == ForeignFrame::Kind::kOrder)
    return on_foreign_command(foreign);
  if (foreign.kind == ForeignFrame::Kind::kGateway) {
    ++counters_.foreign_frames;
    if (bring_up_.busy()) {
      bring_up_.on_foreign_gateway();
    } else if (!state_.is_one_of(MachineState::kOff, MachineState::kAlarm) && !fault_) {
      events_.alarm(now_, AlarmCode::kSecondGateway,
                    say("another gateway has begun to speak on this bus (COB-ID %1)",
                        printed("%03Xh", static_cast<unsigned>(frame.id))));
      stop_all(true);
    }
    return;
  }
  // Path time first: every node that heard this EMCY has begun to count.
  if (const auto request = decode_stop_request(frame, when); request && voice_.speaks()) {
    rate_.on_stop_request({request->reason, request->axis, stop_instant(*request, when)}, now_);
    on_foreign_stop(static_cast<std::uint8_t>(frame.id - cob_id::kEmcy));
    // Heat nodes hear it, too, and do the same.
    if (request->reason == StopReason::kEmergencyStopInput) cut_heat(say("the emergency stop input"));
    if (!bring_up_.busy()) stop_all(false, NodeWatch::is_of_absence(request->reason));
  }
  const bool of_device = devices_.on_frame(when, frame);
  if (of_device) runner_->look_at_probe(now_);
  tell_of_tuning();  // before anybody who waits for it sees that it is over
  for (NodeLink& link : links_) {
    if (!link.on_frame(when, frame)) continue;
    take_stream_status(link);
    serve_probe();
    return;
  }
  if (of_device) return;
  if (cob_id::node_of(frame.id, cob_id::kHeartbeat) != 0)
    ++counters_.foreign_frames;
  else
    ++counters_.malformed_frames;
  if (useless_.are_many(now_))
    events_.message(now_, say("another device fills the bus with frames that nobody here uses (COB-ID %1)",
                              printed("%03Xh", static_cast<unsigned>(frame.id))));
}

/// The bus has heard it already. A record can only be wrong; an object that makes the machine unsafe is
/// refused by the node in motion, and at rest its parameters are compared.
void Gateway::Core::on_foreign_command(const ForeignFrame& foreign) {
  ++counters_.foreign_frames;
  const bool stands = state_.is_one_of(MachineState::kStopping, MachineState::kStopped, MachineState::kAlarm);
  if (!voice_.speaks() || bring_up_.busy() || stands) return;
  if (foreign.kind == ForeignFrame::Kind::kRecord) {
    events_.alarm(now_, AlarmCode::kNodeChanged, foreign.words, foreign.node);
    stop_all(false);
    return;
  }
  using AtRest = ForeignFrame::AtRest;
  if (foreign.at_rest == AtRest::kFreesMotors &&
      state_.is_one_of(MachineState::kUnhomed, MachineState::kReady)) {
    events_.alarm(now_, AlarmCode::kNodeChanged, foreign.words, foreign.node);
    NodeWatch::Verdict verdict;
    verdict.stop = verdict.fault = verdict.stream_lost = verdict.positions_lost = true;
    follow(verdict);
  } else if ((!state_.idle() || foreign.at_rest == AtRest::kIsTold) && orders_.is_news(now_, foreign.order)) {
    events_.message(now_, foreign.words);
  }
}

/// What the machine's own nodes ask for has words of its own.
void Gateway::Core::on_foreign_stop(std::uint8_t node) {
  const bool known =
      std::any_of(links_.begin(), links_.end(), [&](const NodeLink& link) { return link.id() == node; });
  if (known || state_.is_one_of(MachineState::kStopping, MachineState::kStopped, MachineState::kAlarm))
    return;
  events_.alarm(now_, AlarmCode::kNodeChanged,
                say("node %1, which the machine file does not name, has asked all to stop", node), node);
}

void Gateway::Core::on_frame_sent(BusTime when, const CanFrame& frame) {
  now_ = std::max(now_, when);
  ++counters_.frames_sent;
  voice_.on_frame_sent(when, frame);
  rate_.on_frame_sent(when, frame);
  if (frame.id == cob_id::kNmt)
    for (NodeLink& link : links_) link.on_nmt(frame);
}

std::optional<CanFrame> Gateway::Core::next_frame(BusTime now) {
  now_ = std::max(now_, now);
  return session_.next_frame([&] { return next_plain_frame(now); });
}

std::optional<CanFrame> Gateway::Core::next_plain_frame(BusTime now) {
  if (const auto frame = rate_.next_frame(now)) return frame;
  if (const auto frame = rate_.next_repeat(now)) return frame;
  if (const auto frame = voice_.next_frame(now)) return frame;
  if (const auto frame = bring_up_.next_frame()) return frame;
  for (NodeLink& link : links_)
    if (const auto frame = link.next_frame(now)) return frame;
  if (voice_.speaks())
    if (const auto frame = devices_.next_frame(now)) return frame;
  if (!streams_flow()) return std::nullopt;
  const auto frame = group_.next_frame(now, rate_.tau(now));
  if (frame) ++counters_.segments_sent;
  return frame;
}

BusTime Gateway::Core::next_deadline() const {
  // In pieces of fewer lines planning has as much of the time.
  const auto piece = [this](BusTime wait) {
    return wait * options_.planning_budget / Options{}.planning_budget;
  };
  BusTime wait = 100ms;
  switch (state_.now()) {
    case MachineState::kChecking:
      wait = piece(1ms);
      break;
    case MachineState::kRunning:
    case MachineState::kMoving:
    case MachineState::kHolding:
    case MachineState::kCancelling:
    case MachineState::kStopping:
      wait = runner_->plans_on() ? piece(5ms) : 5ms;
      break;
    case MachineState::kBringUp:
    case MachineState::kHoming:
      wait = 10ms;
      break;
    default:
      if (rest_.reading() || clearing_.busy()) wait = 10ms;
      break;
  }
  // From when time was served, not from the last frame: no flood of frames puts it off.
  BusTime due = voice_.next_deadline(now_, std::max(served_ + wait, now_ + BusTime{1}));
  if (!voice_.speaks()) return due;
  // What is due already waits for the bus, not for time: it is pulled when a frame can be sent.
  for (const BusTime deadline :
       {rate_.next_deadline(), devices_.next_deadline(), print_.runner().next_output(now_)})
    if (deadline > now_) due = std::min(due, deadline);
  return due;
}

void Gateway::Core::on_time(BusTime now) {
  served_ = now_ = std::max(now_, now);
  rate_.on_time(now_);
  devices_.on_time(now_);
  for (NodeLink& link : links_) link.on_time(now_);
  currents_.on_time(now_, links_, axes_, may_glance());
  scales_.on_time(now_, links_,
                  position_.homed() && state_.is_one_of(MachineState::kReady, MachineState::kHeld),
                  may_glance());
  motors_.on_time(now_, may_glance(), state_.idle() || state_.is(MachineState::kHeld) || lines_idle());
  watch_parameters();
  watch_nodes();
  watch_devices();
  watch_filament();
  watch_cold_feed();
  watch_idle_heat();
  watch_standby();
  tell_of_tuning();
  tell_of_the_unmeasured();
  tell_of_pin();
  serve_probe();
  feed_heat_ahead();
  note_progress();
  voice_.on_time(now_, bring_up_.busy());
  switch (state_.now()) {
    case MachineState::kBringUp:
      step_bring_up();
      break;
    case MachineState::kHoming:
      step_homing();
      break;
    case MachineState::kChecking:
      step_checking();
      break;
    case MachineState::kMoving:
    case MachineState::kRunning:
      step_running();
      break;
    case MachineState::kHolding:
      step_hold();
      break;
    case MachineState::kCancelling:
      step_cancel();
      break;
    case MachineState::kStopping:
      step_stop();
      break;
    case MachineState::kStopped:
    case MachineState::kAlarm:
      step_clear();
      break;
    case MachineState::kOff:
      if (recovery_.begins_by_itself()) static_cast<void>(go_on());
      break;
    case MachineState::kHeld:
      step_held();
      break;
    case MachineState::kUnhomed:
    case MachineState::kReady:
      break;
  }
  step_after_stall();
}

void Gateway::Core::on_stall(BusTime now, BusTime length, const Sentence& why) {
  now_ = std::max(now_, now);
  watch_.on_stall(now_);
  stall_.on_stall(now_, length, why);
}

void Gateway::Core::on_bus_failure(BusTime now, std::string_view what) {
  now_ = std::max(now_, now);
  if (watch_.needs_bring_up() && state_.is(MachineState::kAlarm)) return;
  watch_.lose();
  if (state_.is(MachineState::kOff)) return;
  events_.alarm(now_, AlarmCode::kBusFailure, say("the bus failed: %1", what));
  stop_all(true);
}

void Gateway::Core::watch_nodes() {
  const bool moves = runner_->active() && !runner_->suspended() && !group_.run_done(rate_.tau(now_));
  watch_.on_time(now_, streams_flow() && moves && rate_.rate(now_) > 0);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const bool follows =
        state_.streams() || state_.is_one_of(MachineState::kUnhomed, MachineState::kReady,
                                             MachineState::kChecking, MachineState::kCancelling);
    // A drive that was switched off in motion is seen while all stop; what goes on then needs it.
    const bool stops_in_run = state_.is(MachineState::kStopping) && runner_->active() && !fault_;
    const bool rests = state_.is_one_of(MachineState::kUnhomed, MachineState::kReady);
    follow(watch_.look(
        now_, i,
        {.state = state_.now(),
         .bringing_up = bring_up_.busy(),
         .homes = state_.is(MachineState::kHoming) && homing_.reports(i, now_ - NodeWatch::kStatusTimeout),
         .enabled = follows || stops_in_run || state_.is(MachineState::kHoming),
         .follows = follows,
         .rests_since = rests ? std::optional(state_.since()) : std::nullopt}));
  }
}

void Gateway::Core::watch_parameters() {
  const auto change = parameters_.on_time(now_, may_glance() && !motors_.busy());
  if (!change) return;
  const std::uint8_t node = links_[change->node].id();
  events_.alarm(
      now_, AlarmCode::kNodeChanged,
      say("node %1: another device has changed its parameters (fingerprint %2, the machine file's is "
          "%3): bringing up again writes them anew",
          node, printed("%08Xh", static_cast<unsigned>(change->found)),
          printed("%08Xh", static_cast<unsigned>(change->expected))),
      node);
  watch_.lose();
  stop_all(true);
}

/// What is hot is not left alone for long.
void Gateway::Core::watch_idle_heat() {
  const bool held = state_.is(MachineState::kHeld);
  const bool idle =
      held || state_.idle() || lines_idle() || state_.is_one_of(MachineState::kStopped, MachineState::kAlarm);
  // A bed takes its time to be measured; the measurement ends by itself.
  if (!idle || !heat_.heats() || heat_.tuned() != nullptr) heat_idle_since_ = now_;
  const auto patience = machine_.thermal.idle_off;
  if (now_ - heat_idle_since_ < patience) return;
  cut_heat(say("nothing has moved for %1 minutes",
               std::chrono::duration_cast<std::chrono::minutes>(patience).count()));
  // What is held in the middle of a job heats before it goes on, as after every stop; an interrupted one
  // does.
  if (held && !print_.runner().suspended()) stop_all(false);
}

/// What is planned is known to the heater before it is fed.
void Gateway::Core::feed_heat_ahead() {
  constexpr BusTime kPeriod = 100ms;
  if (now_ < next_flow_) return;
  next_flow_ = now_ + kPeriod;
  heat_.feed_ahead(runner_->filament_ahead(now_));
  follow_extruder();
}

/// By the plan, as far as it has run.
void Gateway::Core::follow_extruder() {
  if (machine_.filament_sensors.empty() || !position_.homed()) return;
  if (const auto pose = machine_pose()) heat_.follow_extruder((*pose)[kE]);
}

void Gateway::Core::take_stream_status(NodeLink& link) {
  const auto status = link.take_stream();
  if (!status || !runner_->active() || runner_->suspended() || position_.stream_lost()) return;
  const bool stopping = state_.is_one_of(MachineState::kStopping, MachineState::kStopped);
  if (stopping || streams_flow()) follow(watch_.take_stream(now_, link, *status, stopping));
}

void Gateway::Core::follow(const NodeWatch::Verdict& verdict) {
  if (verdict.stream_lost) position_.lose_stream();
  if (verdict.positions_lost) position_.forget();
  if (verdict.stop) stop_all(verdict.fault, verdict.by_absence);
}

}  // namespace kinebus
