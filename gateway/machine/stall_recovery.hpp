#pragma once
// The gateway itself was away: its process was not run for a while, and the nodes have stopped on the path
// without it. Whether the job goes on by itself after that.

#include "gateway/description/machine_description.hpp"
#include "gateway/status/event_queue.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class StallRecovery {
 public:
  enum class Step : std::uint8_t { kNone, kClear, kGoOn };

  StallRecovery(const MachineDescription& machine, EventQueue& events)
      : wanted_(machine.stop.after_stall == StopDescription::AfterStall::kGoOn), events_(events) {}

  /// The process was not run for `length`, up to now; `why` in words.
  void on_stall(BusTime now, BusTime length, const Sentence& why);
  /// The machine is being stopped, or is stopped already. `by_absence`: because nobody spoke to the nodes.
  void on_stop(BusTime now, bool by_absence);
  /// Somebody commands the machine: nothing is done by itself any more.
  void commanded();

  /// What to do about a machine that stands since `since`: `stopped`, with a stop or an alarm to clear, or
  /// ready to be told to resume. Tells each step once.
  Step next(BusTime now, BusTime since, bool stopped);

 private:
  enum class Doing : std::uint8_t { kNothing, kStopped, kCleared };

  bool wanted_;
  EventQueue& events_;
  Doing doing_ = Doing::kNothing;
  bool stopping_ = false;  ///< the stop under way has been judged
  bool stalled_ = false;
  BusTime stall_end_{0};
  int in_a_row_ = 0;  ///< without a command or a long good time in between
};

}  // namespace kinebus
