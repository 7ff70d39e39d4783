#pragma once
// Whether a client that is to be heard first takes little of the loop's time: who takes more waits with the
// others for a while.

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "protocol/time.hpp"

namespace kinebus {

class Frugality {
 public:
  struct Options {
    /// Of the loop's time, for good; what was not used is kept for `burst`.
    double share = 1;
    LocalTime burst = std::chrono::seconds{1};
    /// So long it waits after it has taken more.
    LocalTime pause = std::chrono::seconds{1};
    /// And so long at first: who comes and goes never is.
    LocalTime trial{0};
  };

  bool holds(const Options& options, LocalTime now) {
    if (again_at_ == LocalTime::min()) again_at_ = now + options.trial;
    return now >= again_at_;
  }
  /// A piece of its work is done and has taken so much of the processor.
  void note(const Options& options, LocalTime now, LocalTime took) {
    const auto earned = static_cast<std::int64_t>(options.share * static_cast<double>((now - last_).count()));
    last_ = now;
    credit_ = std::min(options.burst, credit_ + LocalTime{earned}) - took;
    if (credit_ < LocalTime{0}) again_at_ = now + options.pause;
    credit_ = std::max(credit_, LocalTime{0});
  }

 private:
  LocalTime credit_{0}, last_{0}, again_at_ = LocalTime::min();
};

}  // namespace kinebus
