#pragma once
// Path time must be equal on all nodes at every instant. Looked at at random instants: SYNC and the samples
// of the other checkers share the gateway's round milliseconds.

#include <algorithm>

#include "tools/simulation/sample.hpp"

namespace kinebus {

class SkewChecker {
 public:
  void on_probe(const Probe& probe) {
    if (probe.node_count == 0) return;
    const auto begin = probe.tau.begin();
    const auto [low, high] = std::minmax_element(begin, begin + probe.node_count);
    const double us = 1e6 * to_seconds(*high - *low);
    if (us <= max_us_) return;
    max_us_ = us;
    worst_time_s_ = to_seconds(probe.time);
  }
  double max_us() const { return max_us_; }
  double worst_time_s() const { return worst_time_s_; }

 private:
  double max_us_ = 0, worst_time_s_ = 0;
};

}  // namespace kinebus
