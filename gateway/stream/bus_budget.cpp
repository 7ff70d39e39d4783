#include "gateway/stream/bus_budget.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinebus {

namespace {
// Look-ahead of the deadline test: 40 steps of 25 ms. Dense stretches are seen a second before they begin.
constexpr std::int64_t kStepUnits = 1'563;
constexpr int kSteps = 40;
constexpr std::uint64_t kWindowStride = 16;  // records between two windows of a full queue
}  // namespace

double BusBudget::allowed_rate(std::span<const NodeStream* const> nodes, PathTime tau,
                               bool run_complete) const {
  const std::int64_t now = tau.count() / kPathTicksPerUnit;
  const double reserve_s = static_cast<double>(options_.reserve.count()) * kSecondsPerUnit;
  const double bits_per_s = options_.bits_per_second * std::max(options_.share - options_.overhead, 0.01);
  double rate = 1;
  // A record that begins x path seconds from now must be there reserve_s before: x / rate - reserve_s >= bits
  // / bps.
  const auto limit = [&](std::int64_t begins_units, double records) {
    const double x = static_cast<double>(std::max<std::int64_t>(begins_units - now, 0)) * kSecondsPerUnit;
    rate = std::min(rate, x / (records * options_.bits_per_record / bits_per_s + reserve_s));
  };

  std::int64_t made = INT64_MAX, next = INT64_MAX;
  std::uint64_t all = 0;
  for (const NodeStream* node : nodes) {
    made = std::min(made, node->made_until_units());
    next = std::min(next, node->unsent_begins_units(0));
    all += node->unsent();
  }
  if (!run_complete) limit(made, 0);
  if (all == 0) return rate;
  // All that waits fits before the first of it is due: the usual case, at once.
  const double before = rate;
  limit(next, static_cast<double>(all));
  if (rate >= before && all <= static_cast<std::uint64_t>(options_.node_records)) return rate;
  rate = before;

  std::array<std::uint64_t, kMostNodes> known{};
  for (int k = 1; k <= kSteps; ++k) {
    const std::int64_t until = std::min(now + k * kStepUnits, made);
    std::uint64_t records = 0;
    std::int64_t first = INT64_MAX;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::uint64_t waiting = known[i] = nodes[i]->unsent_until(until, known[i]);
      records += waiting;
      if (waiting > 0) first = std::min(first, nodes[i]->unsent_begins_units(waiting - 1));
    }
    bool settled = until == made;
    if (records > 0) {
      limit(first, static_cast<double>(records));
      // What begins later has more time, and all that waits is the most that it can wait for.
      const double tightest = rate;
      limit(first, static_cast<double>(all));
      settled |= rate >= tightest;
      rate = tightest;
    }
    if (settled) break;
  }

  // A full queue, where it covers least.
  const auto queue = static_cast<std::uint64_t>(options_.node_records);
  std::int64_t least = INT64_MAX;
  for (const NodeStream* node : nodes) {
    const std::uint64_t waiting = node->unsent();
    for (std::uint64_t n = 0; n + queue < waiting; n += kWindowStride) {
      const std::int64_t begins = node->unsent_begins_units(n);
      if (begins > now + kSteps * kStepUnits) break;
      least = std::min(least, node->unsent_begins_units(n + queue) - begins);
    }
  }
  if (least == INT64_MAX) return rate;
  return std::min(
      rate, std::max(rate_of_full_queue(static_cast<double>(least) * kSecondsPerUnit), options_.lowest_rate));
}

/// A record comes into it when a status has told that 32 are executed, and is looked at when the next one
/// tells of 32 more, each up to 20 ms late. What is left before it must do for a stop: covered * (120 - 64) /
/// 120 >= rate * kLooks_s + rate^2 * stop_way.
double BusBudget::rate_of_full_queue(double covered_s) const {
  constexpr double kLooks_s = 0.055, kToldOf = 64;
  const double way_s = static_cast<double>(options_.stop_way.count()) * kSecondsPerUnit;
  const double left_s = covered_s * std::max(0.0, 1 - kToldOf / options_.node_records);
  return 2 * left_s / (kLooks_s + std::sqrt(kLooks_s * kLooks_s + 4 * way_s * left_s));
}

}  // namespace kinebus
