#include "vcan_tests/usb/path_trace.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

constexpr std::uint32_t kSegmentCobId = 0x400;  // RPDO3 of node n
constexpr std::int64_t kStep = 64;              // 1.024 ms
constexpr double kCount = 4294967296.0;         // fractional bits of AxisState
/// In shape comparison: how far the other path may be ahead or behind, instants.
constexpr std::ptrdiff_t kSearch = 400;

using Point = std::vector<double>;  // counts, all axes of all nodes in the order of their ids

/// Positions every kStep units, relative to where the runs begin; rest between runs is left out.
std::vector<Point> points_of(const PathTrace& trace, std::size_t skip) {
  std::map<std::uint8_t, std::size_t> place;
  for (const TracedRun& run : trace.runs)
    for (const auto& [node, segments] : run.segments) place.emplace(node, 0);
  std::size_t axes = 0;
  for (auto& [node, first] : place) first = std::exchange(axes, axes + kAxesPerNode);
  std::vector<Point> points;
  Point base(axes, 0.0);
  for (std::size_t r = skip; r < trace.runs.size(); ++r) {
    const TracedRun& run = trace.runs[r];
    const auto count = static_cast<std::size_t>(run.units / kStep + 1);
    const std::size_t first = points.size();
    points.resize(first + count, base);
    for (const auto& [node, segments] : run.segments) {
      std::array<AxisState, kAxesPerNode> state{};
      std::int64_t begins = 0;
      std::size_t at = 0;
      const std::size_t axis0 = place.at(node);
      for (const Segment& segment : segments) {
        for (; at < count && static_cast<std::int64_t>(at) * kStep < begins + segment.duration; ++at)
          for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
            points[first + at][axis0 + axis] =
                base[axis0 + axis] +
                static_cast<double>(advance(state[axis], segment.acceleration[axis],
                                            static_cast<std::int64_t>(at) * kStep - begins,
                                            kDefaultAccelerationShift)
                                        .position) /
                    kCount;
        for (std::size_t axis = 0; axis < kAxesPerNode; ++axis)
          state[axis] =
              advance(state[axis], segment.acceleration[axis], segment.duration, kDefaultAccelerationShift);
        begins += segment.duration;
      }
      for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
        base[axis0 + axis] += static_cast<double>(state[axis].position) / kCount;
        for (std::size_t i = at; i < count; ++i) points[first + i][axis0 + axis] = base[axis0 + axis];
      }
    }
  }
  return points;
}

double distance(const Point& p, const Point& a, const Point& b) {
  double along = 0, length = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    along += (p[i] - a[i]) * (b[i] - a[i]);
    length += (b[i] - a[i]) * (b[i] - a[i]);
  }
  const double share = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  double worst = 0;
  for (std::size_t i = 0; i < p.size(); ++i)
    worst = std::max(worst, std::abs(p[i] - a[i] - share * (b[i] - a[i])));
  return worst;
}

/// Largest distance of a point of `a` from the line through `b`, both walked from their beginnings.
double shape_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::ptrdiff_t near = 0;
  double largest = 0;
  for (const Point& p : a) {
    double best = 1e300;
    std::ptrdiff_t found = near;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(near - 20, 0);
         i + 1 < static_cast<std::ptrdiff_t>(b.size()) && i < near + kSearch; ++i) {
      const double d = distance(p, b[static_cast<std::size_t>(i)], b[static_cast<std::size_t>(i + 1)]);
      if (d < best) {
        best = d;
        found = i;
      }
    }
    near = found;
    largest = std::max(largest, best);
  }
  return largest;
}

}  // namespace

Result<PathTrace, std::string> read_trace(const std::string& path) {
  std::ifstream in(path);
  if (!in) return Error<std::string>("cannot read " + path);
  PathTrace trace;
  struct Node {
    int last_sequence = -1;
    bool open = false;
    TracedRun* run = nullptr;
    std::size_t runs = 0;
  };
  std::map<std::uint8_t, Node> nodes;
  std::vector<TracedRun> all;
  all.reserve(100'000);
  for (std::string text; std::getline(in, text);) {
    const auto line = parse_candump(text);
    if (!line || line->frame.extended || line->frame.length != 8) continue;
    const std::uint32_t id = line->frame.id;
    if (id <= kSegmentCobId || id > kSegmentCobId + 127) continue;
    const auto segment = decode_segment(get_u64_le(line->frame.bytes()));
    if (!segment) continue;
    Node& node = nodes[static_cast<std::uint8_t>(id - kSegmentCobId)];
    ++trace.records;
    if (segment->sequence == node.last_sequence) {
      ++trace.repeated;
      continue;
    }
    node.last_sequence = segment->sequence;
    if (segment->control == SegmentControl::kStart) {
      if (all.size() <= node.runs) all.emplace_back();
      node.run = &all[node.runs++];
      node.run->segments[static_cast<std::uint8_t>(id - kSegmentCobId)];
    } else if (segment->control == SegmentControl::kNone && node.run != nullptr) {
      node.run->segments[static_cast<std::uint8_t>(id - kSegmentCobId)].push_back(*segment);
    }
  }
  for (TracedRun& run : all) {
    bool moves = false;
    for (const auto& [node, segments] : run.segments) {
      std::int64_t units = 0;
      for (const Segment& segment : segments) {
        units += segment.duration;
        moves = moves || segment.acceleration[0] != 0 || segment.acceleration[1] != 0;
      }
      run.units = std::max(run.units, units);
    }
    if (moves) trace.runs.push_back(std::move(run));
  }
  return trace;
}

TraceDifference compare(const PathTrace& a, const PathTrace& b, std::size_t skip) {
  TraceDifference difference;
  const auto first = points_of(a, skip), second = points_of(b, skip);
  if (first.empty() || second.empty() || first.front().size() != second.front().size()) {
    difference.largest_counts = INFINITY;
    return difference;
  }
  difference.compared = static_cast<std::int64_t>(first.size());
  difference.same_runs = a.runs.size() == b.runs.size();
  for (std::size_t r = skip; difference.same_runs && r < a.runs.size(); ++r)
    difference.same_runs = std::abs(a.runs[r].units - b.runs[r].units) <= 2 &&
                           a.runs[r].units / kStep == b.runs[r].units / kStep;
  if (difference.same_runs) {
    for (std::size_t i = 0; i < first.size(); ++i)
      for (std::size_t axis = 0; axis < first[i].size(); ++axis)
        difference.largest_counts =
            std::max(difference.largest_counts, std::abs(first[i][axis] - second[i][axis]));
  } else {
    difference.largest_counts = std::max(shape_difference(first, second), shape_difference(second, first));
  }
  return difference;
}

}  // namespace kinebus
