// HeatNode in a session (protocol/motion/session_guard.hpp): whose orders it takes.

#include <span>

#include "node_firmware/heat/heat_node.hpp"
#include "protocol/bytes.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus::heat {
namespace {

using namespace heat_object;

/// A gateway that was started anew listens for longer before it speaks: what heats obeys everybody then, and
/// takes the next key. One that only stood still vouches for its next SYNC stamp, and all is as before.
constexpr LocalTime kMasterSilent = std::chrono::milliseconds{400};

/// Whether set points, tuning or the switch of a heater are to change, which is guarded also while all is
/// cold; `off`: they are to be 0, and whoever asks for heat to go off gets it.
bool lets_heat(const CanFrame& frame, std::uint8_t node_id, bool& off) {
  if (frame.id == cob_id::rpdo(1, node_id)) {
    off = get_u64_le(frame.data) == 0;
    return true;
  }
  if (frame.id != cob_id::kSdoRequest + node_id) return false;
  const std::uint16_t index = sdo::address_in(frame).index;
  // 2xh: expedited, so that the value is here.
  off = index == kSetPoint.index && frame.data[0] >> 4 == 2 && (frame.data[0] & 2) != 0 &&
        get_u32_le(std::span(frame.data).subspan(4)) == 0;
  return index == kSetPoint.index || index == kTune.index || index == kOnOff.index;
}

}  // namespace

bool HeatNode::obeys(const CanFrame& frame) {
  bool off = false;
  const bool heats = lets_heat(frame, node_id_, off) || any_heat();
  const auto answer = session_.judge(frame, node_id_, heats && !off);
  if (answer == SessionGuard::Answer::kObey) return true;
  if (answer == SessionGuard::Answer::kRefuse && nmt_.allows_sdo()) sdo_.refuse(frame);
  return false;
}

void HeatNode::serve_session() {
  if (session_.in_force() && now_ - sync_seen_ > kMasterSilent) session_.lapse();
  while (const auto refusal = session_.next_refusal()) {
    emcy_.raise(node_emcy::kNotVouched, *refusal);
    emcy_.clear(node_emcy::kNotVouched);  // it is over: in the history
  }
}

}  // namespace kinebus::heat
