// HeatNode on the bus: frames, NMT, LSS, storage. What it does every tick: heat_node_service.cpp.

#include "node_firmware/heat/heat_node.hpp"

#include <algorithm>
#include <utility>

#include "protocol/motion/broadcast.hpp"

namespace kinebus::heat {
namespace {

/// Control may be late by so much before the watchdog is left unfed.
constexpr LocalTime kLatestControl = std::chrono::milliseconds{50};

LssIdentity identity_of(const HeatNodeOptions& options) {
  return {kVendorId, HeatBoard::kFacts.product_code, HeatBoard::kFacts.revision, options.serial};
}

}  // namespace

HeatNode::HeatNode(const HeatNodeOptions& options, LocalTime now, std::span<const std::uint8_t> stored_image)
    : options_(options),
      now_(now),
      objects_(*this, 0, kHeatTable),
      sdo_(objects_),
      pdo_(objects_),
      lss_(identity_of(options), kUnconfiguredNodeId),
      master_seen_(now),
      next_tick_(now + kControlTick) {
  const bool damaged = image_.adopt(stored_image) == ParameterBytes::Load::kDamaged;
  const bool told = options.node_id >= 1 && options.node_id <= 127;
  node_id_ = told || options.id_from_board ? options.node_id : image_.node_id();
  lss_ = LssSlave(identity_of(options), node_id_ == 0 ? kUnconfiguredNodeId : node_id_);
  boot();
  if (damaged) emcy_.raise(emcy::kStorage);
}

// From power-up, and after NMT reset node: values as stored, all heat off.
void HeatNode::boot() {
  objects_.restore(node_id_);
  image_.apply(objects_, node_id_);
  confirmed_ = false;
  switch_off();
  for (Heater& heater : heaters_) {
    // A switch that does not open is no better for a reset, which is routine to a master: see reset_fault().
    if (heater.fault() != HeaterFault::kHeatUnasked) heater.clear_fault();
  }
  for (Fan& fan : fans_) fan.set_command(0);
  feed_forward_.fill(0);
  flow_.clear();
  on_.fill(true);
  tuned_ = -1;
  tuning_taken_ = true;
  apply_settings();
  apply_node_id();
}

// Heat goes on: a master that comes back finds the bed warm, and one that does not is missed.
void HeatNode::reset_communication() {
  for (const ObjectEntry& entry : objects_.table().entries)
    if (entry.address.index < 0x2000)
      objects_.set_value(entry.value_slot(), entry.initial() + (entry.node_id_relative ? node_id_ : 0));
  image_.apply(objects_, node_id_, 0x2000);
  apply_node_id();
}

void HeatNode::apply_node_id() {
  sdo_.reset(node_id_);
  pdo_.set_operational(false, now_);
  pdo_.configure();
  apply_communication();
  if (node_id_ != 0) boot_up_ = nmt_.boot(node_id_);
}

void HeatNode::apply_communication() {
  communication_changed_ = false;
  const std::chrono::milliseconds period{value(heat_slot_of(object::kProducerHeartbeat))};
  if (period != heartbeat_.period()) heartbeat_.set_period(period, now_);
  for (std::size_t i = 0; i < watched_entries_.size(); ++i) {
    const std::int64_t entry = value(heat_slot_of(object::kConsumerHeartbeat), i);
    // Writing the same again must not forget that the node is alive.
    if (std::exchange(watched_entries_[i], entry) != entry)
      watched_.configure(i, static_cast<std::uint32_t>(entry));
  }
  emcy_.set_inhibit_time(LocalTime{value(heat_slot_of(object::kEmcyInhibitTime)) * 100'000});
}

void HeatNode::on_frame(LocalTime at, const CanFrame& frame) {
  on_time(at);
  if (!obeys(frame)) return serve();
  const SyncReception sync = decode_sync(
      frame, cob_id::kSync, static_cast<std::uint8_t>(value(heat_slot_of(object::kSyncCounterOverflow))));
  if (sync.is_sync) {
    on_sync(sync);
  } else if (!options_.id_from_board && !any_heat() && lss_.on_frame(frame)) {
    on_lss();
  } else if (const auto stop = decode_stop_request(frame, BusTime{0});
             stop && stop->reason == StopReason::kEmergencyStopInput) {
    // Whoever has the button: what it stops is not to be touched hot, and this needs no gateway.
    switch_off();
  } else if (nmt_.state() != NmtState::kInitialising) {
    static_cast<void>(watched_.on_frame(now_, frame));
    if (is_sign_of_life(frame)) {
      master_seen_ = now_;
      watch_master();  // what it asks for now is heard
    }
    if (const auto command = nmt_.on_frame(frame)) {
      on_nmt(*command);
    } else {
      if (nmt_.allows_sdo()) sdo_.on_frame(now_, frame);
      static_cast<void>(pdo_.on_frame(now_, frame));
    }
  }
  serve();
}

// The master is the node of 1016h:1, from its first heartbeat on. One that sends none lives as long as it
// asks or commands.
bool HeatNode::is_sign_of_life(const CanFrame& frame) const {
  using Health = HeartbeatConsumer::Health;
  const std::uint8_t master = watched_nodes()[0];
  const Health health = watched_.health(master);
  if (health == Health::kAlive || health == Health::kLost) {
    const auto beat = decode_heartbeat(frame);
    return beat && beat->node == master;
  }
  if (decode_nmt(frame, node_id_) || (frame.id == cob_id::kSdoRequest + node_id_ && !frame.extended))
    return true;
  const auto ids = rpdo_cob_ids();
  return frame.id != 0 && !frame.extended && std::find(ids.begin(), ids.end(), frame.id) != ids.end();
}

void HeatNode::on_sync(const SyncReception& sync) {
  sync_seen_ = now_;
  if (!nmt_.allows_sync()) return;
  if (!sync.length_error)
    pdo_.on_sync(now_, sync.counter);
  else if (nmt_.allows_pdo() && !emcy_.active(emcy::kSyncLength))  // before, 1019h may not be written yet
    emcy_.raise(emcy::kSyncLength);
}

void HeatNode::on_lss() {
  if (lss_.take_store_request()) {
    const std::uint8_t id = lss_.pending_node_id();
    image_.set_node_id(id == kUnconfiguredNodeId ? std::uint8_t{0} : id);
    storing_ = Storing::kWanted;
    storing_for_lss_ = true;
  }
  if (const auto id = lss_.take_node_id()) {
    node_id_ = *id;
    boot();
  }
}

void HeatNode::on_nmt(NmtCommand command) {
  switch (command) {
    case NmtCommand::kStart:
      for (const std::uint16_t code :
           {emcy::kSyncLength, emcy::kPdoRefused, emcy::kPdoTooShort, emcy::kPdoTooLong, emcy::kRpdoTimeout})
        emcy_.clear(code);
      break;
    case NmtCommand::kEnterPreOperational:
      break;
    case NmtCommand::kStop:
      switch_off();  // a stopped node hears no set point any more
      break;
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      session_.end();
      lss_.activate();
      node_id_ = lss_.active_node_id() == kUnconfiguredNodeId ? std::uint8_t{0} : lss_.active_node_id();
      reset_requested_ = reset_requested_ || command == NmtCommand::kResetNode;
      command == NmtCommand::kResetNode ? boot() : reset_communication();
      break;
  }
  pdo_.set_operational(nmt_.allows_pdo(), now_);
}

void HeatNode::on_sample(LocalTime at, int sensor, std::uint32_t ratio, bool broken) {
  now_ = std::max(now_, at);
  sensors_[static_cast<std::size_t>(sensor)].on_sample(at, ratio, broken);
}

void HeatNode::on_tacho(int fan, std::uint32_t pulses) {
  fans_[static_cast<std::size_t>(fan)].on_pulses(pulses);
}

std::optional<CanFrame> HeatNode::next_frame() {
  if (auto reply = lss_.next_frame()) return reply;
  if (node_id_ == 0) return std::nullopt;
  if (boot_up_) return std::exchange(boot_up_, std::nullopt);
  if ((value(heat_slot_of(object::kEmcyCobId)) & kEmcyOff) != 0)
    emcy_.discard();
  else if (nmt_.allows_emcy())
    if (auto frame = emcy_.next_frame(now_, node_id_)) return frame;
  if (auto frame = pdo_.next_frame(now_)) return frame;
  if (auto frame = heartbeat_.next_frame(now_, nmt_.state(), node_id_)) return frame;
  return nmt_.allows_sdo() ? sdo_.next_frame() : std::nullopt;
}

LocalTime HeatNode::next_deadline() const {
  if (sensors_changed_) return now_;
  LocalTime deadline = std::min(next_tick_, sdo_.next_deadline());
  // A frame that is due waits for the bus, not for on_time().
  for (const LocalTime due : {pdo_.next_deadline(), emcy_.next_deadline(),
                              node_id_ == 0 ? LocalTime::max() : heartbeat_.next_deadline()})
    if (due > now_) deadline = std::min(deadline, due);
  return deadline;
}

std::array<std::uint16_t, kRpdoCount> HeatNode::rpdo_cob_ids() const {
  std::array<std::uint16_t, kRpdoCount> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int place = objects_.place_of({static_cast<std::uint16_t>(0x1400 + i), 1});
    if (place < 0 || !pdo_.rpdo_valid(static_cast<int>(i) + 1)) continue;
    ids[i] = static_cast<std::uint16_t>(objects_.value(objects_.table()[place].value_slot()) & 0x7FF);
  }
  return ids;
}

std::array<std::uint8_t, 2> HeatNode::watched_nodes() const {
  std::array<std::uint8_t, 2> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = static_cast<std::uint8_t>((watched_entries_[i] >> 16) & 0x7F);
  return ids;
}

std::span<const std::uint8_t> HeatNode::image_to_store() {
  if (storing_ != Storing::kWanted) return {};
  // Power has come since it was asked for.
  if (neighbours_powered_) {
    storing_ = Storing::kNothing;
    if (std::exchange(storing_for_lss_, false)) lss_.finish_store(false);
    if (sdo_.deferred()) sdo_.finish(AbortCode::kDeviceState);
    return {};
  }
  storing_ = Storing::kWriting;
  return image_.bytes();
}

void HeatNode::on_image_stored(bool good) {
  if (storing_ != Storing::kWriting) return;
  storing_ = Storing::kNothing;
  if (std::exchange(storing_for_lss_, false)) lss_.finish_store(good);
  if (sdo_.deferred()) sdo_.finish(good ? AbortCode::kNone : AbortCode::kHardware);
  if (!good) emcy_.raise(emcy::kStorage);
}

bool HeatNode::take_reset_request() {
  return std::exchange(reset_requested_, false);
}

bool HeatNode::healthy(LocalTime now) const {
  return now - next_tick_ <= kLatestControl;
}

}  // namespace kinebus::heat
