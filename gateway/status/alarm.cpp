#include "gateway/status/alarm.hpp"

#include <span>

#include "protocol/bytes.hpp"
#include "protocol/canopen/alarm_table.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {

namespace {

/// What a node with the session's key has not obeyed; `emergency`: as SessionGuard::next_refusal() tells it.
Sentence refused_words(const Emergency& emergency) {
  const std::uint16_t id = get_u16_le(std::span(emergency.vendor).subspan(1));
  if (id == cob_id::kNmt)
    return say("an NMT command that does not carry the session's check value was refused (%1)",
               printed("%02Xh", static_cast<unsigned>(emergency.vendor[3])));
  if (cob_id::node_of(id, cob_id::kSdoRequest) != 0)
    return say("a write of object %1 that does not carry the session's check value was refused",
               printed("%04Xh", static_cast<unsigned>(get_u16_le(std::span(emergency.vendor).subspan(3)))));
  if (id == kRateCobId)
    return say("a change of the rate that does not carry the session's check value was refused");
  if (cob_id::node_of(id, cob_id::rpdo(1, 0)) != 0)
    return say("a controlword or set point that does not carry the session's check value was refused");
  if (id == cob_id::kSync)
    return say(
        "while SYNC was silent its session was open, and a frame that nobody vouched for was obeyed (COB-ID "
        "%1)",
        printed("%03Xh", static_cast<unsigned>(get_u16_le(std::span(emergency.vendor).subspan(3)))));
  return say("a time stamp of SYNC that does not carry the session's check value was refused");
}

}  // namespace

AlarmText describe_emergency(const Emergency& emergency) {
  const AlarmRow& row = alarm_row(emergency.code);
  const auto reason = static_cast<std::size_t>(emergency.vendor[0] & 0x7F);
  const StopWords stop = reason < kStopWords.size() ? kStopWords[reason] : StopWords{};
  // The node's own codes say little more than why it stops.
  const bool by_reason = stop.words != nullptr && (emergency.code & 0xFF00) == 0xFF00;
  Sentence fault = say(row.words != nullptr ? row.words : kUnknownAlarm.words);
  if (by_reason)
    fault = say(stop.words);
  else if (stop.words != nullptr)
    fault = say("%1; %2", fault, say(stop.words));
  if (emergency.code == node_emcy::kNotVouched) fault = refused_words(emergency);
  if ((emergency.vendor[0] & 0x80) != 0) fault = say("%1, axis B", fault);
  AlarmText text;
  text.words = say("node %1: %2 (EMCY %3)", emergency.node, fault,
                   printed("%04Xh", static_cast<unsigned>(emergency.code)));
  text.advice = say(by_reason ? stop.advice : row.advice);
  return text;
}

Sentence advice_for(AlarmCode code) {
  return say(alarm_row(code).advice);
}

}  // namespace kinebus
