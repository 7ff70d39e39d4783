#pragma once
// A piece of path with its limits, as the look-ahead sees it. Speeds appear as x = (ds/dt)^2, because with
// constant path acceleration a over a length d: x_end = x_start + 2 a d.
//
// The tool's acceleration is a vector: |x_ss x + x_s a| <= A. With the bounds w >= |x_s|, k >= |x_ss| and
// c >= |x_s . x_ss| over the piece, every |a| <= tool_accel(x) satisfies it. Joints and axes are linear in
// (x, a); the least of them is a concave function of x, so the straight line between its values at x = 0 and
// x = cap lies below it. Both bounds are concave in x: what holds at both ends of a speed change holds in
// between.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace kinebus {

struct PlanPiece {
  double s0 = 0;  ///< where this piece begins on its PathPiece
  double length = 0;
  double cap = 0;    ///< greatest x anywhere on the piece
  double accel = 0;  ///< A; straight pieces: all that limits a, divided by |x_s|
  double k2 = 0, c = 0, w2 = 1;
  double up0 = 0, up1 = 0;      ///< linear part: greatest a at x = 0 and at x = cap
  double down0 = 0, down1 = 0;  ///< the same for -a
  double entry = 0;  ///< look-ahead: greatest x at the start from which the rest of the path is feasible
  /// Where jerk is limited: greatest path acceleration and jerk, at any speed up to these shares of
  /// ramp_cap's: the slower, the less of it the path's curvature takes. Above it, up to the cap, a bend
  /// is for passing at constant speed. A piece without length caps the speed at its place
  /// and bounds the ramps that touch it.
  static constexpr std::array<double, 2> kRampSpeeds{0.7, 1};
  struct Even {
    double accel = 0, jerk = 0;
  };
  std::array<Even, kRampSpeeds.size()> even{};
  double ramp_cap = 0;    ///< x; the cap where no bend takes most of the jerk
  double touch_jerk = 0;  ///< of a piece without length: the same for a ramp that begins or ends just there
  std::uint64_t geometry = 0;
  std::uint32_t line = 0;
  bool curved = false;  ///< k2, c, w2 count
  bool linear = false;  ///< up and down count
  bool stop_after = false;

  double tool_accel(double x) const {
    if (!curved) return accel;
    const double under = c * c * x * x + w2 * (accel * accel - k2 * x * x);
    return std::max(std::sqrt(std::max(under, 0.0)) - c * x, 0.0) / w2;
  }
  double up(double x) const { return up0 + (up1 - up0) * (x / cap); }
  double down(double x) const { return down0 + (down1 - down0) * (x / cap); }
  /// Greatest constant acceleration (deceleration) for a change of speed between low and high.
  double accel_between(double low, double high) const {
    const double tool = tool_accel(high);
    return linear ? std::min({tool, up(low), up(high)}) : tool;
  }
  double decel_between(double low, double high) const {
    const double tool = tool_accel(high);
    return linear ? std::min({tool, down(low), down(high)}) : tool;
  }

  /// No acceleration or deceleration at speeds from x on is greater.
  double greatest_accel(double x) const {
    const double tool = tool_accel(x);
    return linear ? std::min(tool, std::max({up0, up1, down0, down1})) : tool;
  }

  /// Time over the piece between these speeds at its ends, s: as fast as its limits allow, within a few
  /// percent.
  double crossing_s(double x0, double x1) const {
    const double high = std::max(x0, x1);
    const double up = 2 * accel_between(high, high), down = 2 * decel_between(high, high);
    double peak = high;
    if (up > 0 && down > 0)
      peak = std::clamp((length + x0 / up + x1 / down) / (1 / up + 1 / down), high, cap);
    const double v0 = std::sqrt(x0), v1 = std::sqrt(x1), v = std::sqrt(peak);
    if (!(peak > high)) return v0 + v1 > 0 ? 2 * length / (v0 + v1) : 0;
    const double cruise = std::max(0.0, length - (peak - x0) / up - (peak - x1) / down);
    return 2 * (v - v0) / up + 2 * (v - v1) / down + cruise / v;
  }

  /// Greatest x (<= cap) that one constant acceleration over the whole piece reaches from x0.
  double reach_accelerating(double x0) const { return linear ? reach(x0, up0, up1) : reach_tool(x0); }
  /// Greatest x (<= cap) from which one constant deceleration over the whole piece gets down to x1.
  double reach_decelerating(double x1) const { return linear ? reach(x1, down0, down1) : reach_tool(x1); }

 private:
  double reach_tool(double x) const {
    const double twice = 2 * length;
    if (!curved) return std::min(cap, x + twice * accel);
    // k2 y^2 + 2 c y a + w2 a^2 = A^2 with a = (y - x) / twice, solved for y.
    const double quadratic = k2 * twice * twice + 2 * c * twice + w2;
    const double half_linear = (c * twice + w2) * x;
    const double constant = w2 * x * x - accel * accel * twice * twice;
    const double root = std::sqrt(std::max(half_linear * half_linear - quadratic * constant, 0.0));
    return std::min(cap, std::max(x, (half_linear + root) / quadratic));
  }
  double reach(double x, double at_zero, double at_cap) const {
    const double twice = 2 * length;
    const double slope = (at_cap - at_zero) / cap;
    double y = std::min(reach_tool(x), x + twice * std::max(at_zero + slope * x, 0.0));
    const double divisor = 1 - twice * slope;
    if (divisor > 0) y = std::min(y, std::max(x, (x + twice * at_zero) / divisor));
    return y;
  }
};

}  // namespace kinebus
