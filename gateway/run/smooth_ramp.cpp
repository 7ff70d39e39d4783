#include "gateway/run/smooth_ramp.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using Seconds = std::chrono::duration<double>;

/// What the wire carries, and what is not too short to be looked at.
constexpr std::chrono::milliseconds kLongest{510}, kShortest{20}, kUnit{2};
constexpr PathTime kStep = std::chrono::milliseconds{1};
constexpr double kStep_s = 1e-3;
/// Where most ramps that are too short are found out, and for where one may be cut short.
constexpr double kCoarse_s = 4e-3;
/// A cut ramp lands within half a second, and the new one takes one more: path time passes no faster.
constexpr std::size_t kMostSamples = 1600;
/// Of the limits: between the instants looked at it may be a little more.
constexpr double kEnough = 0.99;
/// Each ramp tried is longer by this.
constexpr double kLonger = 1.12;
/// Of a jerk limit, what plans take (PointLimits): of what is not planned yet.
constexpr double kPlanned = 0.96;
constexpr std::size_t kTool = 3;

}  // namespace

/// Path time that passes in `t` seconds.
PathTime SmoothRamp::way(const Rate& from, double t) {
  return std::chrono::duration_cast<PathTime>(
      Seconds{(from.rate + (from.slope / 2 + from.bend / 6 * t) * t) * t});
}

/// The rate is a parabola between two changes.
SmoothRamp::Bend SmoothRamp::bend_between(const PathClock& clock, BusTime from, BusTime to) {
  const auto rate_at = [&](BusTime t) { return static_cast<double>(clock.rate_q32(t)) / 4294967296.0; };
  const double lasts_s = to_seconds(to - from);
  if (!(lasts_s > 0)) return {{rate_at(from), 0, 0}, clock.tau(from), 0};
  const double begin = rate_at(from), middle = rate_at(from + (to - from) / 2), end = rate_at(to);
  return {
      {begin, (4 * middle - 3 * begin - end) / lasts_s, 4 * (begin - 2 * middle + end) / (lasts_s * lasts_s)},
      clock.tau(from),
      lasts_s};
}

SmoothRamp::SmoothRamp(const MachineDescription& machine, const Kinematics& kinematics)
    : kinematics_(kinematics), axes_(kTool + machine.joints.size()) {
  for (std::size_t i = 0; i < axes_; ++i) {
    const bool tool = i < kTool;
    const double jerk =
        tool ? machine.path.tool_jerk_mm_per_s3 : joint_jerk_limit(machine, machine.joints[i - kTool]);
    const double accel = tool ? machine.path.tool_accel_mm_per_s2 : machine.joints[i - kTool].accel_per_s2;
    per_jerk_[i] = 1 / jerk;
    jerk_per_accel_[i] = jerk / accel;
  }
  if (!(machine.path.tool_jerk_mm_per_s3 > 0)) return;
  samples_.reserve(kMostSamples);
  terms_.reserve(kMostSamples);
}

bool SmoothRamp::take_sample(const Planned& planned) {
  const PathTime at = first_ + static_cast<std::int64_t>(samples_.size()) * kStep;
  const auto pose = ended_ || samples_.size() == kMostSamples ? std::nullopt : planned(at);
  JointVector joints{};
  if (!pose || !kinematics_.inverse(pose->frame, pose->pose, joints)) {
    ended_ = true;
    return false;
  }
  Sample& next = samples_.emplace_back();
  next.frame = pose->frame;
  for (std::size_t i = 0; i < axes_; ++i)
    next.at[i] = (i < kTool ? pose->pose[i] : joints[i - kTool]) * per_jerk_[i];
  if (samples_.size() < 4) return true;
  const Sample* const s = &samples_[samples_.size() - 4];
  const bool one_frame = s[0].frame == s[3].frame;
  Terms& terms = terms_.emplace_back();
  for (std::size_t i = one_frame ? 0 : kTool; i < axes_; ++i) {
    terms.speed[i] = (s[2].at[i] - s[0].at[i]) / (2 * kStep_s);
    terms.accel[i] = (s[2].at[i] - 2 * s[1].at[i] + s[0].at[i]) / (kStep_s * kStep_s);
    terms.jerk[i] =
        (s[3].at[i] - 3 * s[2].at[i] + 3 * s[1].at[i] - s[0].at[i]) / (kStep_s * kStep_s * kStep_s);
  }
  return true;
}

/// So many terms are there; false: so much is not planned.
bool SmoothRamp::reach(const Planned& planned, std::size_t terms) {
  while (terms_.size() < terms)
    if (!take_sample(planned)) return false;
  return true;
}

/// Acceleration and jerk against the limits, or against what they are undisturbed where that is more.
double SmoothRamp::ratio(const Terms& here, const Row& jerk, const Rate& rate) const {
  const double square = rate.rate * rate.rate;
  double most = 0;
  std::array<double, 4> tool{};  // squares: jerk, acceleration; undisturbed
  for (std::size_t i = 0; i < axes_; ++i) {
    const double j =
        here.speed[i] * rate.bend + 3 * here.accel[i] * rate.rate * rate.slope + jerk[i] * square * rate.rate;
    const double a = (here.accel[i] * square + here.speed[i] * rate.slope) * jerk_per_accel_[i];
    const double a_plan = here.accel[i] * jerk_per_accel_[i];
    if (i < kTool) {
      tool[0] += j * j;
      tool[1] += a * a;
      tool[2] += jerk[i] * jerk[i];
      tool[3] += a_plan * a_plan;
    } else {
      most = std::max({most, std::abs(j) / std::max(1.0, std::abs(jerk[i])),
                       std::abs(a) / std::max(1.0, std::abs(a_plan))});
    }
  }
  return std::max(
      {most, std::sqrt(tool[0] / std::max(1.0, tool[2])), std::sqrt(tool[1] / std::max(1.0, tool[3]))});
}

/// With the speed that is planned last, and the most jerk that a plan takes.
double SmoothRamp::unknown_ratio(const Terms& last, const Rate& rate) const {
  double bend = 0;
  for (std::size_t i = 0; i < axes_; ++i) bend = std::max(bend, std::abs(last.speed[i] * rate.bend));
  return bend + kPlanned * rate.rate * rate.rate * rate.rate;
}

double SmoothRamp::worst_at(const Planned& planned, PathTime tau, const Rate& rate) {
  const std::int64_t nearest = (tau - first_ + kStep / 2) / kStep - 1;
  const auto at = static_cast<std::size_t>(std::max<std::int64_t>(nearest, 0));
  // The jerk of a sample is that of some ms, and changes at once: that of the neighbours counts, too.
  const bool known = reach(planned, at + 2);
  if (terms_.empty()) return 0;
  if (!known && at >= terms_.size()) return unknown_ratio(terms_.back(), rate);
  double most = 0;
  for (std::size_t i = at < 2 ? 0 : at - 2; i <= std::min(at + 1, terms_.size() - 1); ++i)
    most = std::max(most, ratio(terms_[at], terms_[i].jerk, rate));
  return most;
}

bool SmoothRamp::keeps_limits_at(const Planned& planned, const Bend& bend, double share) {
  const double t = bend.lasts_s * share;
  const Rate& r = bend.from;
  const Rate rate{r.rate + (r.slope + r.bend / 2 * t) * t, r.slope + r.bend * t, r.bend};
  return worst_at(planned, bend.tau + way(r, t), rate) <= kEnough;
}

/// Looks in even steps, both ends included.
bool SmoothRamp::keeps_limits(const Planned& planned, const Bends& bends, std::size_t which, double step_s) {
  const int steps = std::max(1, static_cast<int>(std::ceil(bends[which].lasts_s / step_s)));
  for (int i = 0; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    if (keeps_limits_at(planned, bends[which], share)) continue;
    failed_ = {which, share};
    return false;
  }
  return true;
}

/// The ramp's two halves, and how the first lands where it is cut short: with as much bend the other way.
/// What comes before them is as it is, whatever their length.
SmoothRamp::Bends SmoothRamp::bends_of(const PathClock& clock, BusTime now) {
  std::array<BusTime, 3> edges{now, now, now};
  while (const auto change = clock.next_change(edges[2])) edges = {edges[1], edges[2], *change};
  Bends bends{};
  bends[0] = bend_between(clock, edges[0], edges[1]);
  bends[1] = bend_between(clock, edges[1], edges[2]);
  const Rate& leaves = bends[0].from;
  for (std::size_t i = 1; i < kCuts; ++i) {
    const double t = bends[0].lasts_s * static_cast<double>(i) / static_cast<double>(kCuts);
    bends[1 + i] = {.from = {leaves.rate + leaves.bend / 2 * t * t, leaves.bend * t, -leaves.bend},
                    .tau = bends[0].tau + way(leaves, t),
                    .lasts_s = t};
  }
  return bends;
}

bool SmoothRamp::keeps_limits(const Planned& planned, const PathClock& clock, BusTime now) {
  const Bends bends = bends_of(clock, now);
  // A ramp that is a little longer fails where the last one did, most often.
  if (failed_ && !keeps_limits_at(planned, bends[failed_->bend], failed_->share)) return false;
  for (std::size_t i = 0; i < bends.size(); ++i)
    if (!keeps_limits(planned, bends, i, kCoarse_s)) return false;
  return keeps_limits(planned, bends, 0, kStep_s) && keeps_limits(planned, bends, 1, kStep_s);
}

std::chrono::milliseconds SmoothRamp::full_ramp(const Planned& planned, const Trial& trial,
                                                std::chrono::milliseconds least, PathTime from, BusTime now) {
  samples_.clear();
  terms_.clear();
  ended_ = false;
  failed_.reset();
  first_ = from - 3 * kStep;
  while (first_ < from && !planned(first_)) first_ += kStep;
  auto ramp = std::clamp((least + std::chrono::milliseconds{1}) / 2 * 2, kShortest, kLongest);
  while (ramp < kLongest && !keeps_limits(planned, trial(ramp), now)) {
    const auto longer = std::chrono::milliseconds{
        2 * static_cast<std::int64_t>(std::ceil(kLonger / 2 * static_cast<double>(ramp.count())))};
    ramp = std::min(std::max(longer, ramp + kUnit), kLongest);
  }
  return ramp;
}

}  // namespace kinebus
