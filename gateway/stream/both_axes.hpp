#pragma once
// One number of each of a node's two axes, reckoned with at once: what a processor with registers of two
// doubles does in one step. Each lane's result is that of the same arithmetic on doubles, to the bit.

#include <cstdint>

#include "protocol/motion/segment.hpp"

namespace kinebus {

static_assert(kAxesPerNode == 2);
using Both = double __attribute__((vector_size(2 * sizeof(double))));
using BothBits = std::int64_t __attribute__((vector_size(2 * sizeof(double))));

inline Both both(double x) {
  return Both{x, x};
}
/// As std::min and std::max.
inline Both lesser(Both a, Both b) {
  return b < a ? b : a;
}
inline Both greater(Both a, Both b) {
  return a < b ? b : a;
}
/// As std::clamp.
inline Both clamped(Both x, Both low, Both high) {
  return x < low ? low : high < x ? high : x;
}
inline BothBits signs() {
  return BothBits{INT64_MIN, INT64_MIN};
}
inline Both magnitude(Both x) {
  return reinterpret_cast<Both>(reinterpret_cast<BothBits>(x) & ~signs());
}
/// `size` is not negative.
inline Both with_sign_of(Both size, Both sign) {
  return reinterpret_cast<Both>(reinterpret_cast<BothBits>(size) |
                                (reinterpret_cast<BothBits>(sign) & signs()));
}
inline double greatest(Both x) {
  return x[0] < x[1] ? x[1] : x[0];
}
inline bool any(BothBits mask) {
  return (mask[0] | mask[1]) != 0;
}
inline bool all(BothBits mask) {
  return (mask[0] & mask[1]) != 0;
}

}  // namespace kinebus
