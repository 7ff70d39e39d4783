#pragma once
// Jobs for demo, tests and benchmarks, written as slicers write them. Deterministic.

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus {

/// Takes the job's text in pieces.
using TextSink = std::function<void(std::string_view)>;

struct JobKind {
  std::string name, description;
  std::uint32_t default_lines;
  void (*write)(const TextSink& sink, std::uint32_t lines);
};

/// dense-curve: 0.2 mm lines along a smooth plane curve at 100 mm/s (3 decimals, as sliced files have).
/// five-axis: 0.2 mm lines at 100 mm/s under G43.4 with X Y Z A C and E all moving.
/// print: a gear-like part with perimeters, infill, retractions and travels.
/// demo: a small lobed vase, about a minute.
const std::vector<JobKind>& job_kinds();

}  // namespace kinebus
