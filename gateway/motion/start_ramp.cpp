#include "gateway/motion/start_ramp.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// Of the ramp, for one phase with constant acceleration: 1/50 of 200 ms is 4 ms.
constexpr double kSteps = 50;
/// Less than this is not there: rounding.
constexpr double kNothing_s = 1e-9;

}  // namespace

void StartRamp::start(double full_ramp_s) {
  full_ramp_s_ = full_ramp_s;
  rate_ = full_ramp_s > 0 ? 0 : 1;
}

void StartRamp::apply(const Phase& phase, double from_s, std::vector<Phase>& out) {
  const std::size_t first = out.size();
  double t = std::clamp(from_s, 0.0, phase.duration_s);
  double s = phase.s(t);
  while (active() && phase.duration_s - t > kNothing_s) {
    double rate = std::min(1.0, rate_ + 1 / kSteps);
    // rate^2 grows by 2 / ramp per path time.
    double end = t + 0.5 * full_ramp_s_ * (rate * rate - rate_ * rate_);
    if (end > phase.duration_s - kNothing_s) {
      end = phase.duration_s;
      rate = std::min(1.0, std::sqrt(rate_ * rate_ + 2 * (end - t) / full_ramp_s_));
    }
    const double end_s = phase.s(end), way = end_s - s;
    const double v0 = phase.speed(t) * rate_, v1 = phase.speed(end) * rate;
    if (v0 + v1 > 0 && way > 0) {
      Phase part = phase;
      part.s0 = s;
      part.v0 = v0;
      part.duration_s = 2 * way / (v0 + v1);
      part.a = (v1 - v0) / part.duration_s;
      part.jerk = 0;
      part.last = false;
      out.push_back(part);
    }
    t = end;
    s = end_s;
    rate_ = rate;
  }
  // What ends a run is never left out.
  if (phase.duration_s - t > kNothing_s || (phase.last && out.size() == first)) {
    Phase rest = phase;
    rest.s0 = s;
    rest.v0 = phase.speed(t) * rate_;
    rest.a = phase.accel(t);
    rest.duration_s = phase.duration_s - t;
    rest.last = false;
    out.push_back(rest);
  }
  if (out.size() > first) out.back().last = phase.last;
}

}  // namespace kinebus
