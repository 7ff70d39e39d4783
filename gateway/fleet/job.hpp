#pragma once
// What the queue holds of a job, and what a gateway tells about it.

#include <cstdint>
#include <optional>
#include <string>

namespace kinebus::fleet {

/// Of a start: one job, at one gateway, for the n-th time.
struct QueuedJob {
  std::int64_t id = 0;
  std::string name{};           ///< for people
  std::string file_hash{};      ///< SHA-256 of its text, as the queue stores it
  std::string text_hash{};      ///< as gateways name it (job_hash.hpp)
  int attempt = 0;              ///< from 1; 0: it was never given to a gateway
  std::uint64_t after_run = 0;  ///< the gateway's newest run when it was given the job; 0: it had none
  bool started = false;         ///< noted
  bool cancel = false;          ///< somebody wants it ended
};

/// The name under which the gateway knows it: one that runs once, whoever asks how often.
std::string ticket_of(const QueuedJob& job);

/// A machine and what it can take.
struct Machine {
  std::string name{};
  std::string kind{};
  std::string material{};
  double nozzle_mm = 0;
};

enum class Result : std::uint8_t { kComplete, kCancelled, kRefused, kFailed, kInterrupted };
/// "complete": the word of the queue.
const char* to_word(Result result);

/// The run of a ticket in the gateway's history.
struct TicketRun {
  std::string text_hash{};
  bool ended = false;
  Result result{};
  double duration_s = 0;  ///< 0 of one that ended: the machine would not take it, nothing has moved
  std::string words{};
};

/// What a gateway told just now.
struct GatewayFacts {
  std::string state{};  ///< in words
  double progress = 0;  ///< of `job`, 0..1
  std::uint64_t newest_run = 0;
  bool takes_job = false;    ///< a start would be accepted
  bool can_home = false;     ///< it stands, its positions are unknown, and homing would be accepted
  bool interrupted = false;  ///< `job` waits for resume or cancel
  std::string job{};         ///< which the machine has; empty: none
  /// Of the ticket that was asked for; nullopt: its history knows none.
  std::optional<TicketRun> run{};
  /// The history does not reach back to where the job was given: it is another one, or has forgotten it.
  bool history_is_short = false;
};

}  // namespace kinebus::fleet
