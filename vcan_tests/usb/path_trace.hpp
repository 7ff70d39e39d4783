#pragma once
// The motion that a log of the bus commands: segments of all nodes, integrated exactly.

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gateway/result.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

/// One stretch of motion from rest to rest, of all nodes.
struct TracedRun {
  std::map<std::uint8_t, std::vector<Segment>> segments;  ///< by node id
  std::int64_t units = 0;                                 ///< longest node's duration, 16 us
};

/// All runs that move something, in order.
struct PathTrace {
  std::vector<TracedRun> runs;
  std::uint64_t records = 0, repeated = 0;
};

Result<PathTrace, std::string> read_trace(const std::string& path);

struct TraceDifference {
  bool same_runs = false;     ///< run by run, unit by unit of path time; else by shape only
  double largest_counts = 0;  ///< over all axes and times
  std::int64_t compared = 0;  ///< instants
};
/// `skip`: runs of both that are passed over (the way to where the print begins).
TraceDifference compare(const PathTrace& a, const PathTrace& b, std::size_t skip);

}  // namespace kinebus
