#pragma once
// News from the machine: state changes, alarms in plain words, messages of a job.

#include <cstdint>
#include <string>

#include "gateway/sentence.hpp"
#include "gateway/status/state.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct MachineEvent {
  enum class Kind : std::uint8_t {
    kState,     ///< the machine's state changed to `state`
    kAlarm,     ///< something went wrong: `code`, `words`, and what to do next in `advice`
    kMessage,   ///< a text of the job (M117) or an answer to its query
    kProblem,   ///< pre-flight found an error or a warning (`line`)
    kFinished,  ///< job or move done
  };
  Kind kind{};
  BusTime when{0};
  MachineState state{};
  std::uint16_t code = 0;  ///< EMCY error code, or 0xFFxx of the gateway's own (alarm.hpp)
  std::uint8_t node = 0;   ///< 0: none
  std::uint32_t line = 0;
  Sentence words;
  Sentence advice;
};

}  // namespace kinebus
