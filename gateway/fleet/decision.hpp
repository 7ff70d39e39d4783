#pragma once
// What an agent does next at one gateway: a pure function of what the queue and the gateway say now. Nothing
// is remembered between two turns, so an agent may be killed at any moment, and several may serve one
// gateway.

#include <cstdint>
#include <optional>

#include "gateway/fleet/job.hpp"

namespace kinebus::fleet {

enum class Action : std::uint8_t {
  kWait,
  kClaim,  ///< ask the queue for a job that fits
  kHome,
  kStart,  ///< send the text, and start the ticket
  kNoteStarted,
  kNoteEnded,    ///< with the run's result
  kNextAttempt,  ///< the ticket is used up by a start that the machine refused: another ticket
  kCancelRun,
  kUseUp,        ///< start the ticket with a text that cannot run: then it never can run
  kNoteNotRun,   ///< the ticket is used up and never ran: cancelled, or back into the queue
  kAskOperator,  ///< whether it has started cannot be known
};

struct Policy {
  bool home = false;     ///< machines whose positions are unknown
  bool give_up = false;  ///< an interrupted job is cancelled; otherwise somebody resumes or cancels it
};

/// `job`: which the queue has given to this gateway and which is not over; nullopt: none. Not to be called
/// for a gateway that does not answer: its job stays its job.
Action decide(const std::optional<QueuedJob>& job, const GatewayFacts& gateway, const Policy& policy);

}  // namespace kinebus::fleet
