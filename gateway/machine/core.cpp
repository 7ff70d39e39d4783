// Frames, time, and what each state of the machine does as time passes.

#include "gateway/machine/core.hpp"

#include <algorithm>
#include <utility>

#include "gateway/devices/registry.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A stop takes its ramp and no more; a node that does not say so is lost.
constexpr BusTime kStopTimeout = 3s;

/// Frames that only a gateway sends.
bool is_of_a_gateway(const CanFrame& frame) {
  return !frame.extended && (frame.id == cob_id::kSync || frame.id == kRateCobId ||
                             frame.id == kSyncStampCobId || frame.id == cob_id::kHeartbeat + kGatewayNodeId);
}

/// Nodes with axes first, in the order of the streams: the one is at the same place as the other.
std::deque<NodeLink> make_links(const MachineDescription& machine, const std::vector<NodeAxes>& axes) {
  std::deque<NodeLink> links;
  for (const NodeAxes& node : axes) links.emplace_back(node.node_id, machine.node(node.node_id)->functions);
  for (const NodeDescription& node : machine.nodes)
    if (!node.functions.has_axes()) links.emplace_back(node.id, node.functions);
  return links;
}

/// A description whose geometry no machine can have leaves the default machine's kinematics, for show only.
std::unique_ptr<Kinematics> machine_kinematics(const MachineDescription& machine, Sentence& defect) {
  auto made = make_kinematics(machine);
  if (made) return std::move(*made);
  defect = say("the machine file's geometry cannot work: %1", made.error().what);
  return std::move(*make_m1_kinematics(M1Geometry{}));
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
      state_(events_),
      voice_(machine_, options.epoch),
      watch_(machine_, links_, rate_, group_, events_, counters_),
      parameters_(machine_, links_),
      bring_up_(machine_, links_, rate_),
      homing_(machine_, links_),
      currents_(links_.size()),
      position_(machine_, *kinematics_, axes_, group_),
      rest_(machine_, links_, rate_),
      clearing_(axes_, links_, rate_),
      hand_(machine_, *kinematics_, group_, rate_, heat_, events_, journal_),
      print_(machine_, *kinematics_, group_, rate_, heat_, events_, journal_),
      lines_(machine_, *kinematics_, journal_),
      recovery_(machine_, *kinematics_, journal_) {
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
  if (is_of_a_gateway(frame)) {
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
    rate_.on_stop_request(*request, now_);
    on_foreign_stop(static_cast<std::uint8_t>(frame.id - cob_id::kEmcy));
    if (!bring_up_.busy()) stop_all(false);
  }
  const bool of_device = devices_.on_frame(when, frame);
  for (NodeLink& link : links_) {
    if (!link.on_frame(when, frame)) continue;
    take_stream_status(link);
    return;
  }
  if (of_device) return;
  if (cob_id::node_of(frame.id, cob_id::kHeartbeat) != 0)
    ++counters_.foreign_frames;
  else
    ++counters_.malformed_frames;
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
}

std::optional<CanFrame> Gateway::Core::next_frame(BusTime now) {
  now_ = std::max(now_, now);
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
  BusTime wait = 100ms;
  switch (state_.now()) {
    case MachineState::kChecking:
      wait = 1ms;
      break;
    case MachineState::kRunning:
    case MachineState::kMoving:
    case MachineState::kHolding:
    case MachineState::kCancelling:
    case MachineState::kStopping:
      wait = 5ms;
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
  for (const BusTime deadline : {rate_.next_deadline(), devices_.next_deadline()})
    if (deadline > now_) due = std::min(due, deadline);
  return due;
}

// Time
// ------------------------------------------------------------------------------------------------------

void Gateway::Core::on_time(BusTime now) {
  served_ = now_ = std::max(now_, now);
  rate_.on_time(now_);
  devices_.on_time(now_);
  for (NodeLink& link : links_) link.on_time(now_);
  currents_.on_time(now_, links_, axes_, may_glance());
  watch_parameters();
  watch_nodes();
  watch_devices();
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
  const bool moves = runner_->active() && !runner_->suspended();
  watch_.on_time(now_, streams_flow() && moves && rate_.rate(now_) > 0);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const bool follows =
        state_.streams() || state_.is_one_of(MachineState::kUnhomed, MachineState::kReady,
                                             MachineState::kChecking, MachineState::kCancelling);
    const bool rests = state_.is_one_of(MachineState::kUnhomed, MachineState::kReady);
    follow(watch_.look(
        now_, i,
        {.state = state_.now(),
         .bringing_up = bring_up_.busy(),
         .homes = state_.is(MachineState::kHoming) && homing_.reports(i, now_ - NodeWatch::kStatusTimeout),
         .enabled = follows || state_.is(MachineState::kHoming),
         .follows = follows,
         .rests_since = rests ? std::optional(state_.since()) : std::nullopt}));
  }
}

void Gateway::Core::watch_parameters() {
  const auto change = parameters_.on_time(now_, may_glance());
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

/// A device that is out of order has switched itself off; whatever it was needed for must not go on.
void Gateway::Core::watch_devices() {
  const auto fault = heat_.new_fault();
  if (!fault) return;
  events_.alarm(now_, AlarmCode::kThermal, say("%1: %2", fault->device, fault->words), fault->node);
  if (!state_.is(MachineState::kOff)) stop_all(true);
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
  if (verdict.stop) stop_all(verdict.fault);
}

// Bring-up and homing
// ------------------------------------------------------------------------------------------

void Gateway::Core::begin_bring_up() {
  watch_.bring_up_begins();
  parameters_.forget();
  remote_told_ = false;
  fault_ = false;
  position_.forget();
  position_.stream_is_new();
  hand_.runner().drop();
  recovery_.bring_up_begins(rate_.tau(now_));
  bring_up_.start(now_, voice_.speaks());
  enter(MachineState::kBringUp);
}

void Gateway::Core::step_bring_up() {
  if (rest_.reading()) return step_standstill();
  if (recovery_.waits_for_journal(now_)) return;
  const BringUp::Outcome outcome = bring_up_.on_time(now_);
  if (bring_up_.may_speak()) voice_.begin(now_);
  recovery_.note_found(now_, bring_up_);
  if (outcome == BringUp::Outcome::kBusy) return;
  if (outcome == BringUp::Outcome::kDone) {
    voice_.nodes_are_new(now_);
    return rest_.read(now_, Rest::After::kBringUp);
  }
  const StepFailure& failure = bring_up_.failure();
  if (failure.code == AlarmCode::kSecondGateway) voice_.end();
  watch_.lose();
  recovery_.do_not_go_on();
  events_.alarm(now_, failure.code, failure.words, failure.node);
  enter(MachineState::kAlarm);
}

void Gateway::Core::begin_homing() {
  position_.forget();
  homing_.start(now_);
  enter(MachineState::kHoming);
}

void Gateway::Core::step_homing() {
  if (rest_.reading()) return step_standstill();
  const MachineHoming::Outcome outcome = homing_.on_time(now_);
  if (outcome == MachineHoming::Outcome::kBusy) return;
  if (outcome == MachineHoming::Outcome::kDone) return rest_.read(now_, Rest::After::kHoming);
  const StepFailure& failure = homing_.failure();
  events_.alarm(now_, failure.code, failure.words, failure.node);
  stop_all(true);
}

// Jobs and moves
// -----------------------------------------------------------------------------------------------

void Gateway::Core::step_checking() {
  if (recovery_.left()) return step_recovery();
  if (!print_.check(now_, options_.planning_budget)) return;
  if (print_.errors() > 0 || !print_.rewind()) {
    events_.push({.kind = MachineEvent::Kind::kFinished,
                  .when = now_,
                  .words = say("the job was not begun: it has %1 errors", print_.errors()),
                  .advice = say("correct the lines named, then run it again")});
    print_.drop_source();
    print_.forget_name();
    return enter(MachineState::kReady);
  }
  const auto pose = machine_pose();
  if (!pose) {
    events_.alarm(now_, AlarmCode::kJobError, pose.error().words);
    return stop_all(true);
  }
  if (auto meet = hand_.in_the_way_to_reference(*pose)) {
    events_.push({.kind = MachineEvent::Kind::kFinished,
                  .when = now_,
                  .words = say("the job was not begun: on the way to the bed reference %1", std::move(*meet)),
                  .advice = say("move the tool clear by hand, then run it again")});
    print_.drop_source();
    print_.forget_name();
    return enter(MachineState::kReady);
  }
  runner_ = &hand_.runner();
  hand_.start({{0, hand_.reference(*pose)}}, *pose, override_, ManualMotion::Then::kJob);
  started_ = now_;
  enter(MachineState::kRunning);
}

void Gateway::Core::step_running() {
  if (runner_->live() && lines_.given_up(now_)) {
    events_.message(now_, say("the lines' host has gone: what is left of them is given up"));
    static_cast<void>(carry_out(command::Cancel{}));
    return;
  }
  switch (runner_->on_time(now_, options_.planning_budget)) {
    case Runner::Outcome::kBusy:
      return;
    case Runner::Outcome::kPaused:
      held_from_ = state_.now();
      enter(MachineState::kHolding);
      return enter(MachineState::kHeld);
    case Runner::Outcome::kDone:
      return finish_motion();
    case Runner::Outcome::kEmergencyStop:
      events_.alarm(now_, AlarmCode::kEmergencyStop, say("M112 in the job"), 0, runner_->line(now_));
      cut_heat(say("M112 in the job"));
      return stop_all(false);
    case Runner::Outcome::kFailed: {
      const Runner::Failure& failure = runner_->failure();
      position_.lose_stream();
      if (runner_ == &print_.runner() && !failure.stream) recovery_.fail_job();
      events_.alarm(now_, failure.stream ? AlarmCode::kStreamLost : AlarmCode::kJobError, failure.words, 0,
                    failure.line);
      return stop_all(false);
    }
  }
}

void Gateway::Core::finish_motion() {
  const bool live = runner_->live();
  if (runner_ == &print_.runner()) journal_.push(journal::JobEnd{});
  runner_->drop();
  position_.take_run_end();
  switch (hand_.take_then()) {
    case ManualMotion::Then::kReturn:
      return finish_return();
    case ManualMotion::Then::kJob: {
      Pose start = kinematics_->bed_reference();
      if (const auto pose = machine_pose()) start[kE] = (*pose)[kE];
      return begin_job(start);
    }
    case ManualMotion::Then::kNothing:
      break;
  }
  const bool job = state_.is(MachineState::kRunning);
  if (job) heat_.stop_spindle();  // the end of a program stops it (RS274/NGC 3.6.1)
  events_.push({.kind = MachineEvent::Kind::kFinished,
                .when = now_,
                .words = !job   ? say("move done")
                         : live ? say("all lines done: %1", print_.name())
                                : say("job done: %1", print_.name()),
                .advice = {}});
  if (job) print_.forget_name();
  enter(MachineState::kReady);
}

void Gateway::Core::step_hold() {
  // A wait between runs stands still at once; planning ahead goes on.
  static_cast<void>(runner_->on_time(now_, options_.planning_budget));
  if (rest_.standing(now_)) enter(MachineState::kHeld);
}

void Gateway::Core::step_held() {
  if (!recovery_.awaits_spindle(state_.visit()) || !heat_.spindle_at_speed()) return;
  heat_.forget_kept();
  runner_->resume(now_);
  enter(held_from_);
}

// Stops, and the standstill in which positions are read before anything moves again
// -----------------------------------------------------------------------------------------------

void Gateway::Core::stop_all(bool fault) {
  fault_ = fault_ || fault;
  recovery_.do_not_go_on();
  if (hand_.leads_to(ManualMotion::Then::kReturn)) hand_.forget_then();
  bring_up_.abort();
  if (homing_.busy()) {
    homing_.abort();
    position_.forget();
  }
  if (auto& left = recovery_.left(); left && left->replaying) {
    left->job = print_.runner().take_source();
    left->replaying = false;
    print_.runner().drop();
  } else if (left) {
    if (auto source = print_.take_source()) left->job = std::move(source);
  }
  print_.abort_check();
  rest_.abort();
  clearing_.abort();
  if (state_.is_one_of(MachineState::kRunning, MachineState::kMoving)) held_from_ = state_.now();
  if (voice_.speaks() && !rate_.stop_latched()) rate_.stop(now_);
  // Whatever stopped the machine stops the cutter; a job that goes on gets it back first.
  if (print_.runner().active() && (fault_ || heat_.spindle_on())) heat_.keep();
  heat_.stop_spindle();
  if (fault_) heat_.heaters_off();
  if (!state_.is_one_of(MachineState::kAlarm, MachineState::kStopped)) enter(MachineState::kStopping);
}

void Gateway::Core::step_stop() {
  if (rest_.settled(now_) && now_ - state_.since() >= Rest::kSettle)
    return enter(fault_ ? MachineState::kAlarm : MachineState::kStopped);
  if (now_ - state_.since() < kStopTimeout) return;
  events_.alarm(now_, AlarmCode::kStopTimeout, say("path time did not come to rest"));
  fault_ = true;
  watch_.lose();
  enter(MachineState::kAlarm);
}

/// After clear the run can go on, or its rest is dropped.
void Gateway::Core::step_clear() {
  if (rest_.reading()) return step_standstill();
  if (!clearing_.busy()) return;
  switch (clearing_.on_time(now_)) {
    case Clearing::Outcome::kBusy:
      return;
    case Clearing::Outcome::kFailed:
      return events_.alarm(now_, clearing_.failure().code, clearing_.failure().words);
    case Clearing::Outcome::kLifted:
      break;
  }
  fault_ = false;
  // A job whose heaters went off heats on its way back.
  const bool goes_on = runner_->active() && !runner_->suspended() && !position_.stream_lost() &&
                       position_.homed() && clearing_.together() && !heat_.kept_heat() &&
                       state_.is(MachineState::kStopped);
  if (!goes_on) return rest_.read(now_, Rest::After::kClear);
  runner_->hold(now_);
  enter(MachineState::kHeld);
}

void Gateway::Core::step_cancel() {
  if (rest_.reading()) return step_standstill();
  if (rest_.settled(now_)) rest_.read(now_, Rest::After::kCancel);
}

void Gateway::Core::step_standstill() {
  const Standstill::Outcome outcome = rest_.on_time();
  if (outcome == Standstill::Outcome::kBusy) return;
  if (outcome == Standstill::Outcome::kDone) return finish_standstill();
  watch_.lose();
  events_.alarm(now_, rest_.failure().code, rest_.failure().words, rest_.failure().node);
  if (state_.is(MachineState::kAlarm)) return;
  fault_ = true;
  enter(MachineState::kAlarm);
}

/// Positions are read and queues are empty: every motion can begin from here.
void Gateway::Core::finish_standstill() {
  using After = Rest::After;
  const After after = rest_.after();
  const Standstill& found = rest_.found();
  group_.cancel();
  for (std::size_t i = 0; i < axes_.size(); ++i)
    group_.set_state(links_[i].id(), found.node(i).position, found.node(i).stream);
  if (after == After::kHoming) group_.homed();
  position_.take(found);
  const bool cancelled = after == After::kCancel, job_failed = recovery_.take_job_failed();
  fault_ = false;
  hand_.runner().drop();
  if (after == After::kHoming && !position_.homed()) {
    events_.alarm(now_, AlarmCode::kHomingFailed, say("a node does not know its position after homing"));
    return stop_all(true);
  }
  if (cancelled || job_failed)
    give_up_job();
  else
    interrupt(after == After::kBringUp ? recovery_.found_tau(bring_up_, print_.runner().run_start())
                                       : found.path_time());
  if (!interrupted()) print_.forget_name();
  if (interrupted() && !position_.homed()) recovery_.lose_filament();
  if (after == After::kHoming)
    events_.push({.kind = MachineEvent::Kind::kFinished, .when = now_, .words = say("homed"), .advice = {}});
  if (cancelled) events_.message(now_, say("cancelled: positions are known"));
  // What was interrupted by a stop alone is held; elsewhere the machine may be moved first.
  if (after == After::kClear && position_.homed() && print_.runner().active())
    return enter(MachineState::kHeld);
  enter(position_.homed() ? MachineState::kReady : MachineState::kUnhomed);
  if (recovery_.going_on()) finish_recovery();
}

}  // namespace kinebus
