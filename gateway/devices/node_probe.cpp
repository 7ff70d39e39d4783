#include "gateway/devices/node_probe.hpp"

#include <utility>

#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {

bool NodeProbe::on_frame(BusTime, const CanFrame& frame) {
  constexpr std::size_t kInputs = 6;  // of TPDO1: two statuswords and two modes come before it
  if (frame.extended || frame.remote || frame.length <= kInputs) return false;
  if (frame.id != cob_id::tpdo(1, place_.node_id)) return false;
  take_inputs(frame.bytes()[kInputs]);
  if (watch_ == Watch::kWaits && touches_ != away_) {
    watch_ = Watch::kAsks;
    next_ = Request::kStatus;
  }
  return true;
}

void NodeProbe::arm(bool away) {
  away_ = away;
  last_ = false;
  watch_ = Watch::kArms;
  next_ = Request::kFunction;
  asked_ = Request::kNone;
}

void NodeProbe::ask() {
  last_ = true;
  if (watch_ != Watch::kWaits) return;
  watch_ = Watch::kAsks;
  next_ = Request::kStatus;
}

std::optional<ProbeRequest> NodeProbe::next_request() {
  if (next_ == Request::kNone || asked_ != Request::kNone) return std::nullopt;
  asked_ = std::exchange(next_, Request::kNone);
  switch (asked_) {
    case Request::kFunction: {
      const unsigned edge = away_ ? touch_probe::kNegativeEdge : touch_probe::kPositiveEdge;
      return ProbeRequest{object::kTouchProbeFunction, false, 2, touch_probe::kOn | edge};
    }
    case Request::kLevels:
      return ProbeRequest{object::kSwitchLevels};
    case Request::kStatus:
      return ProbeRequest{object::kTouchProbeStatus};
    case Request::kTime:
      return ProbeRequest{away_ ? object::kTouchProbeNegativeTime : object::kTouchProbePositiveTime};
    case Request::kNone:
      break;
  }
  return std::nullopt;
}

void NodeProbe::on_reply(BusTime now, std::optional<std::int64_t> value) {
  const Request asked = std::exchange(asked_, Request::kNone);
  if (next_ != Request::kNone || asked == Request::kNone) return;  // of a contact that nobody waits for
  if (!value) {
    watch_ = Watch::kFailed;
    return;
  }
  switch (asked) {
    case Request::kFunction:
      next_ = Request::kLevels;
      break;
    case Request::kLevels:
      take_inputs(*value);
      watch_ = Watch::kWaits;
      break;
    case Request::kStatus: {
      const unsigned stored = away_ ? touch_probe::kNegativeStored : touch_probe::kPositiveStored;
      if ((static_cast<unsigned>(*value) & stored) != 0)
        next_ = Request::kTime;
      else
        watch_ = last_ ? Watch::kNone : Watch::kWaits;
      break;
    }
    case Request::kTime:
      // The low 32 bits of a time that is less than four seconds past.
      contact_ = now - BusTime{static_cast<std::uint32_t>(now.count()) - static_cast<std::uint32_t>(*value)};
      watch_ = Watch::kContact;
      break;
    case Request::kNone:
      break;
  }
}

std::unique_ptr<ContactProbe> node_probe(const ProbeDescription& probe, const MachineDescription&) {
  return std::make_unique<NodeProbe>(probe.place);
}

}  // namespace kinebus
