#pragma once
// Path time must be equal on all nodes at every instant.

#include <algorithm>

#include "vcan_tests/sim/sample.hpp"

namespace kinebus {

class SkewChecker {
 public:
  void on_sample(const Sample& sample) {
    if (!sample.in_job || sample.node_count == 0) return;
    const auto begin = sample.node_tau.begin();
    const auto [low, high] = std::minmax_element(begin, begin + sample.node_count);
    max_us_ = std::max(max_us_, 1e6 * to_seconds(*high - *low));
  }
  double max_us() const { return max_us_; }

 private:
  double max_us_ = 0;
};

}  // namespace kinebus
