#include "gateway/stream/backlash_take_up.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace kinebus {
namespace {

// Shorter pieces would show rounding as acceleration; what is skipped changes the motion by less than 1 nm.
constexpr double kShortestPiece_s = 2e-6;
constexpr std::size_t kKeptEvents = 32;

/// Zeros of c1 + 2 c2 t + 3 c3 t^2 inside (0, end), in order.
int turning_points(const std::array<double, 4>& c, double end, double* roots) {
  const double a = 3 * c[3], b = 2 * c[2], d = c[1];
  int count = 0;
  const auto take = [&](double t) {
    if (t > 0 && t < end) roots[count++] = t;
  };
  if (const double square = b * b - 4 * a * d; square > 0) {
    // The root of smaller magnitude first, from the product of both: no digits are lost. A root at infinity
    // or 0/0 fails the comparisons.
    const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
    take(d / q);
    take(q / a);
  }
  return count;
}

}  // namespace

BacklashTakeUp::BacklashTakeUp(const Joints& joints) {
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    tracks_[j].joint = joints[j];
    needed_ = needed_ || joints[j].gap > 0;
    assert(!(joints[j].gap > 0) || joints[j].accel_per_s2 > 0);
  }
  homed();
}

void BacklashTakeUp::homed() {
  for (Track& t : tracks_) {
    t.direction = t.joint.home_side;
    t.settled = t.direction * t.joint.gap / 2;
    t.events.clear();
  }
}

void BacklashTakeUp::restart() {
  out_.clear();
  for (Track& t : tracks_) {
    if (!t.events.empty()) t.settled = t.events.back().to;
    t.events.clear();
    t.started = false;
  }
}

void BacklashTakeUp::abandon(double time_s) {
  out_.clear();
  for (Track& t : tracks_) {
    t.settled = offset_at(t, time_s);
    t.events.clear();
    // Half taken up: the motor is nearer to one side, and goes on from there.
    t.direction = t.settled >= 0 ? 1 : -1;
  }
}

double BacklashTakeUp::offset_at(const Track& track, double time_s) {
  double offset = track.settled;
  for (const Event& e : track.events) {
    if (time_s <= e.start_s) break;
    const double accel = std::copysign(track.joint.accel_per_s2, e.to - e.from);
    const double t = time_s - e.start_s, left = e.end_s() - time_s;
    offset = left <= 0 ? e.to : t <= left ? e.from + 0.5 * accel * t * t : e.to - 0.5 * accel * left * left;
  }
  return offset;
}

/// The polynomial, in powers of (t - from_s), that the offset follows around `time_s`.
std::array<double, 3> BacklashTakeUp::branch_at(const Track& track, double time_s, double from_s) {
  for (const Event& e : track.events) {
    if (time_s < e.start_s || time_s >= e.end_s()) continue;
    const double accel = std::copysign(track.joint.accel_per_s2, e.to - e.from);
    const bool first = time_s < e.start_s + e.duration_s / 2;
    const double t = from_s - (first ? e.start_s : e.end_s()), half = first ? 0.5 * accel : -0.5 * accel;
    return {(first ? e.from : e.to) + half * t * t, 2 * half * t, half};
  }
  return {offset_at(track, time_s), 0, 0};
}

double BacklashTakeUp::side_at(int joint, double time_s) const {
  const Track& t = tracks_[static_cast<std::size_t>(joint)];
  return t.joint.gap > 0 ? 2 * offset_at(t, time_s) / t.joint.gap : t.joint.home_side;
}

double BacklashTakeUp::side(int joint) const {
  return side_at(joint, HUGE_VAL);
}

void BacklashTakeUp::turn_round(Track& track, double time_s, double position) {
  track.direction = -track.direction;
  track.extreme = position;
  if (!track.events.empty() && track.events.back().start_s >= time_s) {
    // It had not begun: both turns cancel.
    track.events.pop_back();
    return;
  }
  add_event(track, time_s);
}

/// Takes the motor over to the side of the present direction, as soon as what is under way has ended.
void BacklashTakeUp::add_event(Track& track, double time_s) {
  Event e;
  e.from = track.events.empty() ? track.settled : track.events.back().to;
  e.to = track.direction * track.joint.gap / 2;
  e.start_s = track.events.empty() ? time_s : std::max(time_s, track.events.back().end_s());
  e.duration_s = 2 * std::sqrt(std::abs(e.to - e.from) / track.joint.accel_per_s2);
  if (!(e.duration_s > 0)) return;
  track.events.push_back(e);
  if (track.events.size() > kKeptEvents) {
    track.settled = track.events.front().to;
    track.events.pop_front();
  }
}

void BacklashTakeUp::watch(Track& track, const JointSpan& span, std::size_t joint) {
  const auto& c = span.coefficients[joint];
  const int index = static_cast<int>(joint);
  if (!track.started) {
    track.extreme = c[0];
    track.started = true;
    // A lost run may have left the motor inside the gap.
    add_event(track, span.start_s);
  }
  double roots[2];
  const int count = turning_points(c, span.duration_s, roots);
  double from = 0;
  for (int k = 0; k <= count; ++k) {
    const double to = k < count ? roots[k] : span.duration_s;
    const double end = span.position(index, to);
    if (track.direction * (end - track.extreme) >= 0) {
      track.extreme = end;
    } else if (track.direction * (track.extreme - end) > track.joint.hysteresis) {
      // Monotonic between turning points: one place where it has gone back far enough.
      double low = from, high = to;
      for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        const bool beyond =
            track.direction * (track.extreme - span.position(index, middle)) > track.joint.hysteresis;
        (beyond ? high : low) = middle;
      }
      turn_round(track, span.start_s + high, end);
    }
    from = to;
  }
}

void BacklashTakeUp::push(const JointSpan& span) {
  assert(wants_span());
  double busy_until = 0;
  for (std::size_t j = 0; j < tracks_.size(); ++j) {
    if (!(tracks_[j].joint.gap > 0)) continue;
    watch(tracks_[j], span, j);
    if (!tracks_[j].events.empty()) busy_until = std::max(busy_until, tracks_[j].events.back().end_s());
  }
  const double end = span.start_s + span.duration_s;
  const bool longer = span.last && busy_until > end + kShortestPiece_s;
  JointSpan first = span;
  if (longer) first.last = false;
  cut(first);
  if (!longer) return;
  JointSpan rest;
  rest.start_s = end;
  rest.duration_s = busy_until - end;
  rest.line = span.line;
  rest.last = true;
  for (std::size_t j = 0; j < tracks_.size(); ++j)
    rest.coefficients[j] = {span.position(static_cast<int>(j), span.duration_s), 0, 0, 0};
  cut(rest);
}

void BacklashTakeUp::cut(const JointSpan& span) {
  std::vector<double> cuts;
  const double end = span.start_s + span.duration_s;
  for (const Track& track : tracks_)
    for (const Event& e : track.events)
      for (const double t : {e.start_s, e.start_s + e.duration_s / 2, e.end_s()})
        if (t > span.start_s + kShortestPiece_s && t < end - kShortestPiece_s) cuts.push_back(t);
  std::sort(cuts.begin(), cuts.end());
  double from = span.start_s;
  for (std::size_t k = 0; k <= cuts.size(); ++k) {
    const bool final = k == cuts.size();
    const double to = final ? end : cuts[k];
    if (!final && to - from < kShortestPiece_s) continue;
    JointSpan piece = span;
    const double d = from - span.start_s;
    piece.start_s = from;
    piece.duration_s = to - from;
    piece.last = final && span.last;
    for (std::size_t j = 0; j < tracks_.size(); ++j) {
      const auto& c = span.coefficients[j];
      auto& p = piece.coefficients[j];
      p = {c[0] + d * (c[1] + d * (c[2] + d * c[3])), c[1] + d * (2 * c[2] + d * 3 * c[3]),
           c[2] + 3 * d * c[3], c[3]};
      if (!(tracks_[j].joint.gap > 0)) continue;
      const auto offset = branch_at(tracks_[j], 0.5 * (from + to), from);
      for (std::size_t power = 0; power < 3; ++power) p[power] += offset[power];
    }
    out_.push_back(piece);
    from = to;
  }
}

std::optional<JointSpan> BacklashTakeUp::next() {
  if (out_.empty()) return std::nullopt;
  const JointSpan span = out_.front();
  out_.pop_front();
  return span;
}

}  // namespace kinebus
