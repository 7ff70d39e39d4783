#include "gateway/stream/bench/encodings.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::bench {

namespace {

struct Motion {
  const std::vector<JointSpan>& spans;
  const AxisScaling& axis;
  double end_s;

  std::size_t span_at(double t, std::size_t hint) const {
    while (hint + 1 < spans.size() && spans[hint + 1].start_s <= t) ++hint;
    return hint;
  }
  double q(std::size_t span, double t) const {
    return axis.to_counts(spans[span].position(axis.joint, std::min(t, end_s) - spans[span].start_s));
  }
  double q1(std::size_t span, double t) const {
    if (t >= end_s) return 0;
    return axis.slope() * spans[span].velocity(axis.joint, t - spans[span].start_s);
  }
};

bool within(const Motion& m, std::size_t first, double t0, double t1, double tolerance) {
  const double h = t1 - t0;
  const std::size_t last = m.span_at(t1, first);
  const double p0 = m.q(first, t0), v0 = m.q1(first, t0), p1 = m.q(last, t1), v1 = m.q1(last, t1);
  const double c2 = (3 * (p1 - p0) / h - 2 * v0 - v1) / h, c3 = (v0 + v1 - 2 * (p1 - p0) / h) / (h * h);
  for (std::size_t s = first; s <= last; ++s) {
    const double from = std::max(t0, m.spans[s].start_s),
                 to = std::min(t1, s == last ? t1 : m.spans[s].start_s + m.spans[s].duration_s);
    for (int i = 1; i < 24; ++i) {
      const double t = from + (to - from) * i / 24, x = t - t0;
      if (std::abs(p0 + x * (v0 + x * (c2 + x * c3)) - m.q(s, t)) > tolerance) return false;
    }
  }
  return true;
}

}  // namespace

std::size_t cubic_frames(const std::vector<JointSpan>& spans, const AxisScaling& axis,
                         const CubicEncoding& encoding) {
  const Motion m{spans, axis, spans.back().start_s + spans.back().duration_s};
  const auto knots = static_cast<std::int64_t>(std::ceil(m.end_s / encoding.grid_s));
  const auto longest = static_cast<std::int64_t>(encoding.longest_s / encoding.grid_s);
  std::size_t frames = 0, first = 0;
  for (std::int64_t knot = 0; knot < knots; ++frames) {
    const double t0 = static_cast<double>(knot) * encoding.grid_s;
    first = m.span_at(t0, first);
    const std::int64_t most = std::min(longest, knots - knot);
    const auto good = [&](std::int64_t n) {
      return within(m, first, t0, static_cast<double>(knot + n) * encoding.grid_s, encoding.tolerance_counts);
    };
    std::int64_t low = 1, high = most + 1;
    if (good(most))
      low = most;
    else
      while (high - low > 1) (good((low + high) / 2) ? low : high) = (low + high) / 2;
    knot += low;
  }
  return frames;
}

}  // namespace kinebus::bench
