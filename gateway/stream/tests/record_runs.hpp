#pragma once
// Runs of records for a node's stream.

#include <array>
#include <cstdint>

#include "gateway/stream/node_stream.hpp"

namespace kinebus::testing {

inline PathTime path_units(std::int64_t units) {
  return PathTime{units * kPathTicksPerUnit};
}

/// Segments of `units` each, that accelerate and brake in turn; without an end.
inline void push_segments(NodeStream& stream, int count, std::int32_t units, std::int64_t from_units = 0) {
  FittedSegment s;
  s.start = stream.final_state();
  s.start_units = from_units;
  s.duration = units;
  for (int k = 0; k < count; ++k) {
    s.acceleration = k % 2 == 0 ? std::array{200, -300} : std::array{-200, 300};
    s.line = static_cast<std::uint32_t>(k + 1);
    stream.push(s);
    for (std::size_t i = 0; i < kAxesPerNode; ++i)
      s.start[i] = advance(s.start[i], s.acceleration[i], units, kDefaultAccelerationShift);
    s.start_units += units;
  }
}
inline void push_run(NodeStream& stream, int count, std::int32_t units) {
  stream.push_start();
  push_segments(stream, count, units);
  stream.push_end();
}

}  // namespace kinebus::testing
