#include "node_firmware/core/node.hpp"

#include <algorithm>
#include <utility>

#include "node_firmware/core/emergency_codes.hpp"

namespace kinebus {
namespace {

/// A timed job may be late by so much before the watchdog is left unfed.
constexpr LocalTime kLatestService = std::chrono::milliseconds{50};

LssIdentity lss_identity(const NodeIdentity& id) {
  return {id.vendor_id, id.product_code, id.revision, id.serial};
}

// 0: there is none, or none that leaves room for those that go with it.
std::uint8_t first_id(const NodeOptions& options, std::uint8_t stored) {
  const bool wanted = options.node_id >= 1 && options.node_id <= 127;
  const std::uint8_t id = wanted || options.id_from_board ? options.node_id : stored;
  return options.id_from_board || id + options.consecutive_ids <= 128 ? id : std::uint8_t{0};
}

}  // namespace

Node::Node(const NodeOptions& options, BusClock& clock, LocalTime now,
           std::span<const std::uint8_t> stored_image)
    : options_(options),
      now_(now),
      objects_(*this, 0, *options.table),
      path_(clock),
      axes_{DriveAxis(0, objects_, path_, inputs_), DriveAxis(1, objects_, path_, inputs_)},
      sdo_(objects_),
      pdo_(objects_),
      lss_(lss_identity(options.identity), kUnconfiguredNodeId, options.consecutive_ids) {
  axes_[0].set_neighbour(axes_[1]);
  axes_[1].set_neighbour(axes_[0]);
  const bool damaged = image_.adopt(stored_image) == ParameterImage::Load::kDamaged;
  node_id_ = first_id(options, image_.node_id());
  lss_ = LssSlave(lss_identity(options.identity), node_id_ == 0 ? kUnconfiguredNodeId : node_id_,
                  options.consecutive_ids);
  boot();
  tell_reset();
  if (!damaged) return;
  count(NodeCounter::kStorageErrors);
  emcy_.raise(emcy::kStorage);
}

// Of the past: in the history, and over as soon as it is told.
void Node::tell_reset() {
  const ResetReport& reset = options_.reset;
  const bool by_watchdog = reset.cause == ResetCause::kWatchdog;
  if (by_watchdog) count(NodeCounter::kWatchdogResets);
  const bool unmeasured = reset.reason == fault_reason::kUnmeasuredCrystal;
  const bool failed = by_watchdog || (reset.reason != fault_reason::kNone && !unmeasured);
  const std::uint16_t code = failed                                 ? emcy::kSoftware
                             : reset.cause == ResetCause::kBrownOut ? emcy::kUnderVoltage
                             : unmeasured                           ? emcy::kCrystal
                                                                    : emcy::kNoError;
  if (code == emcy::kNoError) return;
  emcy_.raise(code, {0, static_cast<std::uint8_t>(reset.cause), static_cast<std::uint8_t>(reset.reason),
                     static_cast<std::uint8_t>(reset.reason >> 8), 0});
  emcy_.clear(code);
}

// From power-up, and after NMT reset node: values as stored, drives without power.
void Node::boot() {
  objects_.restore(node_id_);
  image_.apply(objects_, node_id_);
  for (DriveAxis& axis : axes_) axis.on_initialised();
  apply_node_id();
}

void Node::reset_communication() {
  for (const ObjectEntry& entry : objects_.table().entries)
    if (entry.address.index < 0x2000)
      objects_.set_value(entry.value_slot(), entry.initial() + (entry.node_id_relative ? node_id_ : 0));
  image_.apply(objects_, node_id_, 0x2000);
  apply_node_id();
}

void Node::apply_node_id() {
  sdo_.reset(node_id_);
  guard_.reset();
  clearing_ = false;
  pdo_.set_operational(false, now_);
  pdo_.configure();
  apply_parameters();
  if (node_id_ != 0) boot_up_ = nmt_.boot(node_id_);
}

void Node::apply_parameters() {
  parameters_changed_ = false;
  const auto value = [&](ObjectSlot slot) { return objects_.value(slot); };
  path_.set_options({.stop_ramp_2ms = static_cast<std::uint8_t>(value(slot_of(object::kStopRamp)) / 2),
                     .sync_timeout = LocalTime{value(slot_of(object::kSyncLossTimeout)) * 1'000'000},
                     .starvation_margin = PathTime{value(slot_of(object::kStarvationMargin)) * 16'000}});
  constexpr ObjectSlot function = slot_of(object::kSwitchFunction),
                       polarity = slot_of(object::kSwitchPolarity),
                       debounce = slot_of(object::kSwitchDebounce);
  for (int i = 0; i < kSwitchInputs; ++i) {
    const auto nth = [&](ObjectSlot first) { return value({static_cast<std::uint16_t>(first.value + i)}); };
    inputs_.configure(
        i, {static_cast<SwitchFunction>(nth(function)), nth(polarity) != 0, LocalTime{nth(debounce) * 1000}});
  }
  const std::chrono::milliseconds period{value(slot_of(object::kProducerHeartbeat))};
  if (period != heartbeat_.period()) heartbeat_.set_period(period, now_);
  guard_.set_life_time(std::chrono::milliseconds{value(slot_of(object::kGuardTime)) *
                                                 value(slot_of(object::kLifeTimeFactor))});
  for (std::size_t i = 0; i < watched_entries_.size(); ++i) {
    const std::int64_t entry =
        value({static_cast<std::uint16_t>(slot_of(object::kConsumerHeartbeat).value + i)});
    // Writing the same again must not forget that the node is alive.
    if (std::exchange(watched_entries_[i], entry) != entry)
      watched_.configure(i, static_cast<std::uint32_t>(entry));
  }
  emcy_.set_inhibit_time(LocalTime{value(slot_of(object::kEmcyInhibitTime)) * 100'000});
}

void Node::on_switch(LocalTime at, int input, bool level) {
  // Where the axes were at the edge; a stream is never looked at backwards.
  path_.advance_to(at);
  const LatchedPositions latched{axes_[0].position(at), axes_[1].position(at)};
  // A level that has lasted long enough until this edge counts, also when both are heard of at once.
  now_ = std::max(now_, at);
  serve_switches();
  inputs_.on_level(at, input, level, latched, directed_scales());
  serve();
}

void Node::on_drive_fault(LocalTime at, int axis, std::uint16_t emcy_code) {
  now_ = std::max(now_, at);
  serve();
  count(NodeCounter::kDriveFaults);
  DriveAxis& faulty = axes_[static_cast<std::size_t>(axis & 1)];
  faulty.set_fault_present(true);
  // The reason is told before what follows from it: a stream that one axis cannot go on with.
  if (faulty.state() != cia402::State::kFault)
    path_.request_stop(StopReason::kAxisFault, axis & 1, emcy_code, now_);
  faulty.on_fault(now_, emcy_code, true);
  static_cast<void>(faulty.take_emergency());
  serve();
}

void Node::on_drive_fault_gone(LocalTime at, int axis) {
  now_ = std::max(now_, at);
  axes_[static_cast<std::size_t>(axis & 1)].set_fault_present(false);
}

void Node::on_axis_trouble(LocalTime at, int axis, std::uint16_t emcy_code) {
  now_ = std::max(now_, at);
  serve();
  if (emcy_.active(emcy_code)) return;
  count(NodeCounter::kDriveFaults);
  path_.request_stop(StopReason::kAxisFault, axis & 1, emcy_code, now_);
  serve();
}

void Node::set_motor(int axis, std::uint32_t resistance_mohm, std::uint32_t inductance_uh,
                     std::int32_t encoder_offset) {
  const auto i = static_cast<std::size_t>(axis & 1);
  objects_.set_value(slot_of_axes(object::kPhaseResistance)[i], resistance_mohm);
  objects_.set_value(slot_of_axes(object::kPhaseInductance)[i], inductance_uh);
  if (encoder_offset >= 0) objects_.set_value(slot_of_axes(object::kEncoderOffset)[i], encoder_offset);
}

void Node::count(NodeCounter counter, std::uint32_t times) {
  counters_[static_cast<std::size_t>(counter)] += times;
}

void Node::on_receive_overrun(LocalTime at, std::uint32_t frames) {
  if (frames == 0) return;
  // The stop that is named must lie ahead of the present, not of the last frame that was heard.
  now_ = std::max(now_, at);
  serve();
  count(NodeCounter::kRxOverrun, frames);
  if (!path_.stop_latched() && (!path_.at_rest(now_) || !path_.stream().idle()))
    path_.request_stop(StopReason::kCommand, 0, emcy::kCanOverrun, now_);
  serve();
}

void Node::on_time(LocalTime now) {
  now_ = std::max(now_, now);
  may_brake_ = true;
  serve();
  may_brake_ = false;
}

std::int64_t Node::position(LocalTime at, int axis) {
  const std::int64_t user = user_position(at, axis);
  const DriveAxis& mine = axes_[static_cast<std::size_t>(axis & 1)];
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(user) -
                                   static_cast<std::uint64_t>(mine.origin()) +
                                   static_cast<std::uint64_t>(correction(at, axis)));
}

std::int64_t Node::user_position(LocalTime at, int axis) {
  DriveAxis& mine = axes_[static_cast<std::size_t>(axis & 1)];
  path_.advance_to(at);
  // A set-point that waits for the end of the motion before it begins at that end, whoever looks first.
  if (at >= mine.next_deadline()) mine.on_time(at);
  return mine.position(at);
}

LatchedPositions NodePreview::positions(LocalTime at) {
  const SegmentStream& stream = node_.path_.stream();
  // Nobody goes by path time: then it need not be known.
  if (stream.following(0) || stream.following(1)) stream_.advance_to(node_.path_.tau(at));
  LatchedPositions motor{};
  for (std::size_t i = 0; i < axes_; ++i) {
    const DriveAxis& axis = node_.axes_[i];
    motor[i] =
        static_cast<std::int64_t>(static_cast<std::uint64_t>(axis.position_ahead(at, stream_)) -
                                  static_cast<std::uint64_t>(axis.origin()) +
                                  static_cast<std::uint64_t>(node_.correction(at, static_cast<int>(i))));
  }
  return motor;
}

std::array<std::uint16_t, kRpdoCount> Node::rpdo_cob_ids() const {
  std::array<std::uint16_t, kRpdoCount> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const int place = objects_.place_of({static_cast<std::uint16_t>(0x1400 + i), 1});
    const std::int64_t cob_id = objects_.value(objects_.table()[place].value_slot());
    if (pdo_.rpdo_valid(static_cast<int>(i) + 1)) ids[i] = static_cast<std::uint16_t>(cob_id & 0x7FF);
  }
  return ids;
}

std::array<std::uint8_t, 2> Node::watched_nodes() const {
  std::array<std::uint8_t, 2> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i)
    ids[i] = static_cast<std::uint8_t>((watched_entries_[i] >> 16) & 0x7F);
  return ids;
}

bool Node::moving(LocalTime at) const {
  return axes_[0].moving(at) || axes_[1].moving(at);
}

DriveOutput Node::drive(int axis) const {
  const auto i = static_cast<std::size_t>(axis & 1);
  return {.power = axes_[i].powered(),
          .holding = !axes_[i].moving(now_),
          .inverted = objects_.value(slot_of_axes(object::kDirectionInvert)[i]) != 0};
}

std::optional<CanFrame> Node::next_frame() {
  if (auto reply = lss_.next_frame()) return reply;
  if (node_id_ == 0) return std::nullopt;
  if (boot_up_) return std::exchange(boot_up_, std::nullopt);
  // A stop request goes out in every state: the other nodes move.
  const bool urgent = emcy_.next_deadline() == LocalTime::min();
  if ((objects_.value(slot_of(object::kEmcyCobId)) & kEmcyOff) != 0)
    emcy_.discard();
  else if (nmt_.allows_emcy() || urgent)
    if (auto frame = emcy_.next_frame(now_, node_id_)) return frame;
  if (auto frame = pdo_.next_frame(now_)) {
    if (frame->id == cob_id::tpdo(1, node_id_)) inputs_.told();
    return frame;
  }
  if (auto frame = heartbeat_.next_frame(now_, nmt_.state(), node_id_)) return frame;
  if (auto frame = guard_.next_frame(nmt_.state(), node_id_)) return frame;
  return nmt_.allows_sdo() ? sdo_.next_frame() : std::nullopt;
}

LocalTime Node::next_deadline() const {
  LocalTime deadline = std::min({path_.next_deadline(), inputs_.next_deadline(), axes_[0].next_deadline(),
                                 axes_[1].next_deadline(), watched_.next_deadline(), guard_.next_deadline(),
                                 sdo_.next_deadline(), status_look_, scale_look_});
  // A frame that is due waits for the bus, not for on_time().
  const auto if_ahead = [&](LocalTime due) {
    if (due > now_) deadline = std::min(deadline, due);
  };
  if_ahead(pdo_.next_deadline());
  if_ahead(emcy_.next_deadline());
  if (node_id_ != 0) if_ahead(heartbeat_.next_deadline());
  return deadline;
}

std::span<const std::uint8_t> Node::image_to_store() {
  if (storing_ != Storing::kWanted) return {};
  if (board_powered()) {
    refuse_storing();
    return {};
  }
  storing_ = Storing::kWriting;
  return image_.bytes();
}

void Node::refuse_storing() {
  storing_ = Storing::kNothing;
  if (std::exchange(storing_for_lss_, false)) lss_.refuse_store();
  if (sdo_.deferred() && !clearing_) sdo_.finish(AbortCode::kDeviceState);
}

void Node::on_image_stored(bool good) {
  if (storing_ != Storing::kWriting) return;
  storing_ = Storing::kNothing;
  if (std::exchange(storing_for_lss_, false)) lss_.finish_store(good);
  if (sdo_.deferred() && !clearing_) sdo_.finish(good ? AbortCode::kNone : AbortCode::kHardware);
  if (good) return;
  count(NodeCounter::kStorageErrors);
  emcy_.raise(emcy::kStorage);
}

bool Node::take_reset_request() {
  return std::exchange(reset_requested_, false);
}

bool Node::healthy(LocalTime now) const {
  const LocalTime deadline = next_deadline();
  return deadline == LocalTime::max() || now - deadline <= kLatestService;
}

}  // namespace kinebus
