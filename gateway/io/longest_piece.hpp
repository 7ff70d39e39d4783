#pragma once
// How long a piece of work may take, by what was done lately.

#include <algorithm>
#include <chrono>

#include "protocol/time.hpp"

namespace kinebus {

/// The longest piece of work of the last seconds: a request carried out, an answer written.
class LongestPiece {
 public:
  void note(LocalTime begin, LocalTime end) {
    if (end - begin_ > kWindow) {
      before_ = now_;
      now_ = kLeast;
      begin_ = end;
    }
    now_ = std::max(now_, end - begin);
  }
  LocalTime lately() const { return std::max(now_, before_); }

 private:
  static constexpr LocalTime kWindow = std::chrono::seconds{5}, kLeast = std::chrono::microseconds{100};
  LocalTime now_ = kLeast, before_ = std::chrono::milliseconds{5}, begin_{0};
};

}  // namespace kinebus
