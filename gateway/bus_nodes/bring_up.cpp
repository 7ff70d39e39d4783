#include "gateway/bus_nodes/bring_up.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "protocol/canopen/heat_objects.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Another gateway shows itself by SYNC (50 ms) and heartbeat (500 ms) in this time.
constexpr BusTime kListenTime = 600ms;
constexpr BusTime kOperationalTimeout = 2s;
/// 24 SYNCs make a clock estimate; twice that, and as much again for lost ones.
constexpr BusTime kSynchroniseTimeout = 10s;
constexpr int kCloseClock_us = 1;
/// By then a window is full of SYNCs: waiting longer brings a clock no closer.
constexpr BusTime kCloseClockTimeout = 2500ms;
constexpr BusTime kEnableTimeout = 5s;
constexpr BusTime kAskAgain = 200ms;
constexpr PathTime kPathTimeGap = 1s;

}  // namespace

BringUp::BringUp(const MachineDescription& machine, std::deque<NodeLink>& links, PathRate& rate)
    : machine_(machine), links_(links), rate_(rate) {
  for (const NodeLink& link : links) {
    Node node;
    for (const JointDescription& joint : machine.joints)
      if (joint.node_id == link.id()) node.used[joint.axis & 1u] = true;
    nodes_.push_back(std::move(node));
  }
}

void BringUp::start(BusTime now, bool alone, const std::vector<ParameterWrite>& key) {
  for (NodeLink& link : links_) link.forget();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    // The description's currents may be others than at the last one.
    nodes_[i].configuration = configure_node(machine_, links_[i].id());
    std::vector<ParameterWrite>& settings = nodes_[i].configuration.settings;
    if (links_[i].functions().has_axes() || machine_.carries_heat(links_[i].id()))
      settings.insert(settings.end(), key.begin(), key.end());
    nodes_[i].config = Config::kCheck;
    nodes_[i].rewritten = nodes_[i].differs = false;
  }
  foreign_ = failed_ = equalising_ = false;
  without_smooth_.reset();
  out_.clear();
  found_.clear();
  enter(alone ? Stage::kIdentify : Stage::kListen, now);
}

void BringUp::enter(Stage stage, BusTime now) {
  stage_ = stage;
  entered_ = now;
  // Clocks, path time and drives are asked of nodes that have axes.
  const bool of_axes = stage >= Stage::kSynchronise && stage <= Stage::kEnable;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    node.requested = false;
    node.done = of_axes && !links_[i].functions().has_axes();
    node.attempts = 0;
    node.asked = now - kAskAgain;
  }
}

bool BringUp::all_done() const {
  return std::all_of(nodes_.begin(), nodes_.end(), [](const Node& n) { return n.done; });
}

void BringUp::fail(AlarmCode code, std::uint8_t node, Sentence words) {
  if (failed_) return;
  failed_ = true;
  failure_ = {code, node, std::move(words)};
}

std::optional<CanFrame> BringUp::next_frame() {
  if (out_.empty()) return std::nullopt;
  const CanFrame frame = out_.front();
  out_.pop_front();
  return frame;
}

Sentence BringUp::doing() const {
  switch (stage_) {
    case Stage::kIdle:
      return {};
    case Stage::kListen:
      return say("listening for another gateway");
    case Stage::kIdentify:
      return say("looking for the nodes");
    case Stage::kConfigure:
      return say("checking the nodes' parameters");
    case Stage::kOperational:
      return say("starting the nodes");
    case Stage::kSynchronise:
      return say("synchronising the clocks");
    case Stage::kPathTime:
    case Stage::kLatch:
      return say("equalising path time");
    case Stage::kEnable:
      return say("enabling the drives");
    case Stage::kEnd:
      return {};
  }
  return {};
}

void BringUp::abort() {
  if (stage_ == Stage::kIdle) return;
  stage_ = Stage::kIdle;
  for (NodeLink& link : links_) link.sdo().abandon();
}

BringUp::Outcome BringUp::on_time(BusTime now) {
  if (stage_ == Stage::kIdle) return Outcome::kDone;
  if (foreign_)
    fail(AlarmCode::kSecondGateway, 0,
         say("another gateway speaks on this bus (SYNC, stamps or heartbeat of node 127)"));
  for (NodeLink& link : links_) {
    if (link.take_two_states())
      fail(AlarmCode::kIdTaken, link.id(),
           say("two nodes use the id %1: one says that it is operational, the other that it is not",
               link.id()));
    if (link.serial_numbers().size() < 2) continue;
    fail(AlarmCode::kIdTaken, link.id(),
         say("two nodes use the id %1: those with the serial numbers %2 and %3", link.id(),
             link.serial_numbers()[0], link.serial_numbers()[1]));
  }
  if (stage_ == Stage::kListen) {
    if (!failed_ && now - entered_ >= kListenTime) enter(Stage::kIdentify, now);
  } else {
    for (std::size_t i = 0; i < nodes_.size() && !failed_; ++i)
      if (!nodes_[i].done) step(now, i);
  }
  if (failed_) {
    abort();
    return Outcome::kFailed;
  }
  if (stage_ == Stage::kListen || !all_done()) return Outcome::kBusy;
  if (stage_ == Stage::kPathTime) {
    const bool first = found_.empty();
    std::optional<std::int64_t> one;
    std::int64_t most = 0;
    bool equal = true;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (!links_[i].functions().has_axes()) continue;
      const std::int64_t ticks = nodes_[i].path_ticks;
      if (first) found_.emplace_back(ticks);
      most = std::max(most, ticks);
      equal = equal && ticks == one.value_or(ticks);
      one = ticks;
    }
    if (!std::exchange(equalising_, true)) {
      // Nodes that were switched on at different times: all take a time that none of them has seen. Equal
      // ones take it again without the fractions of a tick that SDO does not tell.
      if (!equal) most = (most / kPathTicksPerUnit) * kPathTicksPerUnit + kPathTimeGap.count();
      for (Node& node : nodes_) node.path_ticks = most;
      enter(Stage::kPathTime, now);
      return Outcome::kBusy;
    }
    rate_.set_smooth(machine_.path.tool_jerk_mm_per_s3 > 0 && !without_smooth_);
    rate_.set_tau(PathTime{most}, now);
    rate_.clear(now);
  }
  enter(static_cast<Stage>(static_cast<int>(stage_) + 1), now);
  if (stage_ != Stage::kEnd) return Outcome::kBusy;
  stage_ = Stage::kIdle;
  return Outcome::kDone;
}

void BringUp::step(BusTime now, std::size_t i) {
  NodeLink& link = links_[i];
  Node& node = nodes_[i];
  switch (stage_) {
    case Stage::kIdentify:
      return identify(now, link, node);
    case Stage::kConfigure:
      return configure(now, link, node);
    case Stage::kOperational:
      return operational(now, link, node);
    case Stage::kSynchronise:
      return synchronise(now, link, node);
    case Stage::kPathTime:
      return path_time(link, node);
    case Stage::kLatch:
      return latch(now, link, node);
    case Stage::kEnable:
      return enable(now, link, node);
    case Stage::kEnd:
    case Stage::kIdle:
    case Stage::kListen:
      return;
  }
}

std::optional<SdoResult> BringUp::result(NodeLink& link, AlarmCode code) {
  const auto answer = link.sdo().next_result();
  if (!answer || answer->abort == AbortCode::kNone) return answer;
  // An older program does not have it.
  if (answer->address == object::kStreamFunctions && answer->abort == AbortCode::kNoObject) return answer;
  if (answer->abort == AbortCode::kTimeout) code = AlarmCode::kNodeMissing;
  fail(code, link.id(), to_string(link.id(), *answer));
  return std::nullopt;
}

void BringUp::note_functions(const NodeLink& link, Node& node, const SdoResult& answer) {
  const auto told = answer.abort == AbortCode::kNone ? static_cast<std::uint64_t>(answer.value) : 0;
  if ((told & kTellsTailCheck) != 0) node.configuration.settings.push_back({object::kTailCheck, 1, 1});
  const bool follows = machine_.path.tool_jerk_mm_per_s3 == 0 || (told & kFollowsSmoothRamps) != 0;
  if (!follows && !without_smooth_) without_smooth_ = link.id();
}

/// A node that NMT has stopped answers no SDO.
void BringUp::wake(BusTime now, NodeLink& link, Node& node) {
  link.sdo().abandon();
  node.requested = false;
  if (now - node.asked >= kAskAgain) {
    out_.push_back(nmt_frame(NmtCommand::kEnterPreOperational, link.id()));
    node.asked = now;
  }
  if (now - entered_ > kOperationalTimeout + machine_.bus.heartbeat_timeout)
    fail(AlarmCode::kNodeMissing, link.id(), say("node %1 stays stopped by NMT", link.id()));
}

void BringUp::identify(BusTime now, NodeLink& link, Node& node) {
  if (link.nmt_state() == NmtState::kStopped) return wake(now, link, node);
  if (!node.requested) {
    node.requested = true;
    for (std::uint8_t sub = 1; sub <= 4; ++sub) link.sdo().read({object::kVendorIdentity.index, sub});
    if (link.functions().has_axes()) link.sdo().read(object::kStreamFunctions);
    return;
  }
  while (const auto answer = result(link, AlarmCode::kWrongIdentity)) {
    if (answer->address == object::kStreamFunctions) {
      note_functions(link, node, *answer);
      node.done = true;
      continue;
    }
    node.identity[answer->address.subindex - 1u] = static_cast<std::uint32_t>(answer->value);
    if (answer->address.subindex < 4) continue;
    const NodeDescription* wanted = machine_.node(link.id());
    const std::array<std::optional<std::uint32_t>, 4> rules{
        wanted ? wanted->vendor : std::nullopt,
        wanted && wanted->product ? wanted->product : node.configuration.product, std::nullopt,
        wanted ? wanted->serial : std::nullopt};
    constexpr std::array kNames{phrase("vendor"), phrase("product"), phrase("revision"),
                                phrase("serial number")};
    for (std::size_t k = 0; k < 4; ++k) {
      if (!rules[k] || *rules[k] == node.identity[k]) continue;
      return fail(AlarmCode::kWrongIdentity, link.id(),
                  say("node %1: %2 is %3, the machine file wants %4", link.id(), say(kNames[k]),
                      printed("%08Xh", static_cast<unsigned>(node.identity[k])),
                      printed("%08Xh", static_cast<unsigned>(*rules[k]))));
    }
    // Heaters stay off until the node was named by its number: this is the one that is meant.
    if (node.identity[1] == HeatBoard::kFacts.product_code)
      node.configuration.settings.push_back({heat_object::kConfirmedSerial, 4, node.identity[3]});
    node.done = !link.functions().has_axes();
  }
}

void BringUp::operational(BusTime now, NodeLink& link, Node& node) {
  if (now - node.asked >= kAskAgain) {
    out_.push_back(nmt_frame(NmtCommand::kStart, link.id()));
    node.asked = now;
  }
  if (link.nmt_state() == NmtState::kOperational) {
    node.done = true;
    static_cast<void>(link.take_boot_up());
  } else if (now - entered_ > kOperationalTimeout + machine_.bus.heartbeat_timeout) {
    fail(AlarmCode::kNodeMissing, link.id(), say("node %1 does not become operational", link.id()));
  }
}

void BringUp::synchronise(BusTime now, NodeLink& link, Node& node) {
  if (!node.requested && now - node.asked >= kAskAgain) {
    node.requested = true;
    node.asked = now;
    link.sdo().read(object::kStreamStatus);
  }
  while (const auto answer = result(link, AlarmCode::kSyncError)) {
    node.requested = false;
    const StreamStatus status = decode_stream_status(static_cast<std::uint64_t>(answer->value));
    // Two nodes within 2 us of each other, from the first motion on. One with much interrupt latency may need
    // longer, or come no closer.
    const bool close = status.sync_error_us < kCloseClock_us || now - entered_ > kCloseClockTimeout;
    if ((status.flags & StreamStatus::kSynchronised) != 0 && close) node.done = true;
  }
  if (!node.done && now - entered_ > kSynchroniseTimeout)
    fail(AlarmCode::kSyncError, link.id(), say("node %1 does not synchronise its clock", link.id()));
}

void BringUp::path_time(NodeLink& link, Node& node) {
  if (!node.requested) {
    node.requested = true;
    if (equalising_) {
      // With motion queued another path time would be another position.
      link.sdo().write({object::kBufferClear, 1, 0});
      link.sdo().write({object::kPathTime, 8, node.path_ticks});
    } else {
      link.sdo().read(object::kPathTime);
    }
    return;
  }
  while (const auto answer = result(link, AlarmCode::kPathTimeDiffers)) {
    if (answer->read) node.path_ticks = answer->value;
    node.done = link.sdo().idle();
  }
}

/// A stop that was latched before is lifted by the rate broadcast; the status says when it is.
void BringUp::latch(BusTime now, NodeLink& link, Node& node) {
  if (!node.requested && now - node.asked >= kAskAgain / 4 && now - entered_ >= kAskAgain / 4) {
    node.requested = true;
    node.asked = now;
    link.sdo().read(object::kStreamStatus);
  }
  while (const auto answer = result(link, AlarmCode::kStopTimeout)) {
    node.requested = false;
    const StreamStatus status = decode_stream_status(static_cast<std::uint64_t>(answer->value));
    if ((status.flags & StreamStatus::kStopped) == 0) node.done = true;
  }
  if (!node.done && now - entered_ > kEnableTimeout)
    fail(AlarmCode::kStopTimeout, link.id(),
         say("node %1 keeps its stop latched: an emergency stop or limit switch is active", link.id()));
}

void BringUp::enable(BusTime now, NodeLink& link, Node& node) {
  constexpr auto kMode = static_cast<std::int8_t>(cia402::Mode::kInterpolatedPosition);
  bool enabled = link.drive_known();
  for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
    if (!node.used[axis] || !link.drive_known()) continue;
    const cia402::State state = link.drive_state(axis);
    if (state == cia402::State::kOperationEnabled) {
      link.set_control(axis, cia402::control::kOperation | cia402::control::kInterpolationEnable, kMode);
      continue;
    }
    enabled = false;
    const std::uint16_t next = cia402::next_controlword(state);
    // Fault reset works on its edge: the bit goes down between two attempts.
    const bool low = state == cia402::State::kFault && (node.attempts & 1) != 0;
    link.set_control(axis, low ? 0 : next, kMode);
  }
  if (enabled) {
    node.done = true;
    return;
  }
  if (now - node.asked >= kAskAgain) {
    node.asked = now;
    ++node.attempts;
    link.repeat_control();
  }
  if (now - entered_ <= kEnableTimeout) return;
  fail(AlarmCode::kEnableFailed, link.id(),
       say("node %1: its drives do not enable (statuswords %2 and %3)", link.id(),
           printed("%04Xh", static_cast<unsigned>(link.statusword(0))),
           printed("%04Xh", static_cast<unsigned>(link.statusword(1)))));
}

}  // namespace kinebus
