#pragma once
// Whether the loop was run when it wanted to be, and if not, why.

#include <optional>

#include "gateway/sentence.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class StallWatch {
 public:
  struct Stall {
    LocalTime length{0};
    Sentence why;
  };
  /// Nodes do without the gateway for longer.
  static constexpr LocalTime kNoticed = std::chrono::milliseconds{100};

  /// The loop's turn is over; it wants to be run again at `until` at the latest.
  void sleeps(LocalTime now, LocalTime until);
  /// It is run. What was lost between the beginning of the last turn and now.
  std::optional<Stall> wakes(LocalTime now);

 private:
  struct Usage {  ///< of the loop's thread
    LocalTime processor{0};
    long disk_faults = 0;  ///< pages that had to be read
    long preempted = 0;
  };
  static Usage usage();

  LocalTime began_ = LocalTime::max();  ///< the last turn; max: there was none
  LocalTime slept_{0}, until_{0}, sampled_{0};
  Usage before_;
};

}  // namespace kinebus
