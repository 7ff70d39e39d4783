#include "gateway/status/alarm.hpp"

#include "protocol/canopen/alarm_table.hpp"

namespace kinebus {

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
