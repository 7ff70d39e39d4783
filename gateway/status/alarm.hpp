#pragma once
// Alarms in plain words: what happened and what to do next, by protocol/canopen/alarm_table.hpp.

#include "gateway/sentence.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/canopen/emcy.hpp"

namespace kinebus {

struct AlarmText {
  Sentence words;
  Sentence advice;
};

/// Words for what a node reports; why it asks all to stop (StopReason) is part of them.
AlarmText describe_emergency(const Emergency& emergency);
/// Advice for the gateway's own alarms.
Sentence advice_for(AlarmCode code);

}  // namespace kinebus
