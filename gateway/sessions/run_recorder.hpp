#pragma once
// Watches the machine while a job runs, and says at its end what the history is to hold.

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/sentence.hpp"
#include "gateway/status/event.hpp"
#include "gateway/status/status.hpp"

namespace kinebus {

class RunRecorder {
 public:
  enum class Result : std::uint8_t { kComplete, kCancelled, kRefused, kFailed };
  struct Ended {
    Result result{};
    double duration_s = 0;
    double estimate_s = 0;  ///< when it began to move
    std::uint32_t line = 0;
    Sentence first_error;
  };

  /// A job was accepted at `now`.
  void begin(LocalTime now);
  bool active() const { return active_; }
  /// Every event of the machine, in order. A value: this one ended the run.
  std::optional<Ended> on_event(const MachineEvent& event);
  /// Called now and then while active.
  void on_status(const MachineStatus& status);

 private:
  Ended end(LocalTime now);
  bool active_ = false, seen_ = false, ran_ = false, finished_ = false;
  LocalTime begun_{0};
  std::uint32_t line_ = 0;
  double estimate_s_ = 0;
  Sentence first_error_;
  bool alarm_ = false;
};

}  // namespace kinebus
