#include "gateway/motion/jerk_lookahead.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kinebus {
namespace {

// Of a phase: shorter ones are rounding, 3 pm of path at 300 mm/s.
constexpr double kBriefest_s = 1e-11;
constexpr double kShortest_mm = JerkWindow::kShortest_mm;
// The peak of a stretch that reaches no cap: to this part of what there is to gain, or of the way.
constexpr double kNearPeak = 1e-6;
// Of tries for it; a stretch that begins and ends at rest needs one that is not 0.
constexpr int kMostTries = 200;
// The speed of a bend that has no room for its cap.
constexpr int kBendHalvings = 6;
// Times that one stretch may be tried with a higher cap than its lowest.
constexpr int kRaises = 8;
// So near to a bend no ramp begins.
constexpr double kBeside_mm = 0.02;

}  // namespace

void JerkLookahead::clear() {
  parts_.clear();
  committed_ = part_ = 0;
  stage_ = 0;
  stage_s_ = stage_at_ = done_ = end_ = window_at_ = speed_ = 0;
  planned_end_ = 0;
  planned_finish_ = to_the_end_ = kept_ = false;
}

void JerkLookahead::put(double from, double to, const SpeedRamp& ramp, bool capped) {
  if (to > from) parts_.push_back({from, to, ramp, capped});
}

/// Ramps from both ends to `speed`, each by the bounds of the pieces that it passes.
JerkLookahead::Fit JerkLookahead::fit(const Stretch& stretch, std::size_t first, std::size_t last,
                                      double speed) const {
  Fit f;
  f.cruise_from = stretch.from;
  f.cruise_to = stretch.to;
  if (speed > stretch.v0) {
    PlanPiece::Even even = window_.touching_from(stretch.from, first);
    for (std::size_t i = first;; ++i) {
      if (window_.lower(i, speed, even)) {
        f.up = SpeedRamp(stretch.v0, speed, even.accel, even.jerk);
        f.cruise_from = stretch.from + f.up.length();
      }
      if (i == last || window_.start(i + 1) > f.cruise_from) break;
    }
  }
  if (speed > stretch.v1) {
    PlanPiece::Even even = window_.touching_to(stretch.to, last);
    for (std::size_t i = last;; --i) {
      if (window_.lower(i, speed, even)) {
        f.down = SpeedRamp(speed, stretch.v1, even.accel, even.jerk);
        f.cruise_to = stretch.to - f.down.length();
      }
      if (i == first || window_.start(i) < f.cruise_to) break;
    }
  }
  f.fits = f.room() >= 0;
  return f;
}

/// Whether the ramp up passes every piece below its cap, and the ramp down none whose cap is lower. A slower
/// piece that a ramp down has begun before would have to be reached without acceleration when the path goes
/// on, for which there might be no room then.
bool JerkLookahead::keeps_caps(const Stretch& stretch, std::size_t first, std::size_t last,
                               const Fit& fit) const {
  const double speed = std::max(fit.up.to(), fit.down.from());
  for (std::size_t i = first; i <= last && window_.start(i) < fit.cruise_from; ++i) {
    const double way = window_.start(i + 1) - stretch.from;
    const double v = way >= fit.up.length() ? speed : fit.up.speed_after(way);
    if (window_.speed(i) < speed && v > window_.speed(i)) return false;
  }
  for (std::size_t i = last + 1; i-- > first && window_.start(i + 1) > fit.cruise_to;) {
    if (window_.speed(i) < speed) return false;
  }
  return true;
}

/// The greatest speed, below `cap`, for which there is room; `lack`: of way, at the cap. Where there is none
/// even for ramps to the higher of the ends' speeds, that speed.
JerkLookahead::Peak JerkLookahead::peak(const Stretch& stretch, std::size_t first, std::size_t last,
                                        double cap, double lack) const {
  const double higher = std::max(stretch.v0, stretch.v1), way = stretch.to - stretch.from;
  Peak best{.speed = higher, .fit = fit(stretch, first, last, higher)};
  if (!best.fit.fits) return best;
  // The way left shrinks as the speed grows: false position (Anderson and Bjoerck), aimed at what is near
  // enough, and a halving whenever two steps left more than half.
  const auto weight = [](double now, double then) { return now < then ? 1 - now / then : 0.5; };
  // No step is smaller than what is near enough: above a bend that lets no ramp pass, ramps of a little less
  // than that would creep.
  const double least = kNearPeak * (cap - higher);
  double high = cap, room = best.fit.room(), before = 2 * (high - higher);
  bool halve = false;
  for (int k = 0; k < kMostTries; ++k) {
    const double open = high - best.speed;
    if (best.speed > 0 && (open <= least || best.fit.room() <= kNearPeak * way)) break;
    if (k % 2 == 0) {
      halve = open > 0.5 * before;
      before = open;
    }
    const double aim = 0.5 * kNearPeak * way;
    const double share = halve || !(room > aim) ? 0.5 : (room - aim) / (room - lack);
    const double speed = best.speed + std::max(share * open, std::min(least, 0.5 * open));
    const Fit tried = fit(stretch, first, last, speed);
    if (tried.fits) {
      best = {.speed = speed, .fit = tried};
      lack *= weight(tried.room(), room);
      room = tried.room();
    } else {
      high = speed;
      room *= weight(-tried.room(), -lack);
      lack = tried.room();
    }
  }
  return best;
}

/// No piece can be passed at its cap: up, and down again. `lack`: of way for it, mm.
void JerkLookahead::solve_below_caps(const Stretch& stretch, std::size_t first, std::size_t last, double cap,
                                     double lack) {
  const Peak found = peak(stretch, first, last, cap, lack);
  const double low = found.speed;
  const Fit& best = found.fit;
  no_room_ = no_room_ || best.room() < -kShortest_mm;
  const double from = std::min(best.cruise_from, stretch.to), to = std::max(best.cruise_to, from);
  put(stretch.from, from, best.up);
  const SpeedRamp steady(low, low, 1, 1);
  open_.push_back(
      {.from = to, .to = stretch.to, .v0 = low, .v1 = stretch.v1, .ramp = best.down, .ramped = true});
  // A bend may be in the way of a higher peak, and not of what is behind it.
  double begin = from, end = to;
  std::size_t a = window_.piece_after(begin), b = window_.piece_before(end);
  if (a < last && !window_.blocks(a, low) && window_.start(a + 1) - begin < kBeside_mm) ++a;
  if (b > first && !window_.blocks(b, low) && end - window_.start(b) < kBeside_mm) --b;
  for (; a <= last && begin < to && window_.blocks(a, low); ++a) begin = std::min(window_.start(a + 1), to);
  for (; b > first && end > begin && window_.blocks(b, low); --b) end = std::max(window_.start(b), begin);
  const bool shorter = begin > stretch.from + kShortest_mm || end < stretch.to - kShortest_mm;
  if (!(low > 0 && shorter && end - begin > kShortest_mm)) return put(from, to, steady);
  put(from, begin, steady);
  open_.push_back({.from = end, .to = to, .v0 = low, .v1 = low, .ramp = steady, .ramped = true});
  open_.push_back({.from = begin, .to = end, .v0 = low, .v1 = low});
}

/// Plans one stretch, or gives its parts back to open_, the later ones first.
void JerkLookahead::solve(const Stretch& stretch) {
  if (!(stretch.to > stretch.from)) return;
  if (stretch.plateau) return put(stretch.from, stretch.to, SpeedRamp(stretch.v0, stretch.v0, 1, 1), true);
  // What rounding leaves between two pieces is in neither: a piece that is a little slower would be looked
  // for in it without end.
  if (stretch.to - stretch.from <= kShortest_mm && stretch.v0 > 0)
    return put(stretch.from, stretch.to, SpeedRamp(stretch.v0, stretch.v0, 1, 1));
  const std::size_t first = window_.piece_after(stretch.from),
                    last = std::max(first, window_.piece_before(stretch.to));
  std::size_t slowest = window_.lowest(first, last);
  // Lower than v0: the path went on with slower pieces after v0 had been given out.
  const bool descends = window_.speed(slowest) < stretch.v0;
  double cap = std::max(window_.speed(slowest), stretch.v1);
  Fit f = fit(stretch, first, last, cap);
  if (!f.fits && window_.ramp_speed(slowest) < window_.speed(slowest) &&
      window_.ramp_speed(slowest) > std::max(stretch.v0, stretch.v1)) {
    // No room beside the bend for ramps to its cap: for what there is, down to where ramps may pass it.
    double high = cap;
    cap = window_.ramp_speed(slowest);
    f = fit(stretch, first, last, cap);
    for (int k = 0; k < kBendHalvings && f.fits; ++k) {
      const double middle = 0.5 * (cap + high);
      const Fit tried = fit(stretch, first, last, middle);
      (tried.fits ? cap : high) = middle;
      if (tried.fits) f = tried;
    }
  }
  if (!f.fits) return solve_below_caps(stretch, first, last, cap, f.room());
  for (int k = 0; k < kRaises && !descends; ++k) {
    if (window_.start(slowest + 1) > f.cruise_from) break;
    if (!(f.cruise_to > f.cruise_from)) break;
    // The slowest piece lies under a ramp: perhaps the next one can be reached all the same.
    const std::size_t next =
        window_.lowest(window_.piece_after(f.cruise_from),
                       std::max(window_.piece_after(f.cruise_from), window_.piece_before(f.cruise_to)));
    if (!(window_.speed(next) > cap)) break;
    const Fit raised = fit(stretch, first, last, window_.speed(next));
    if (!raised.fits || !keeps_caps(stretch, first, last, raised)) break;
    f = raised;
    slowest = next;
    cap = window_.speed(next);
  }
  double from = f.cruise_from, to = f.cruise_to;
  if (window_.start(slowest + 1) <= from && window_.start(slowest) < from) {
    to = from;  // under the ramp up: on from its end
  } else if (window_.start(slowest) >= to && window_.start(slowest + 1) > to) {
    from = to;
  } else {
    std::size_t a = slowest, b = slowest;
    const auto same = [&](std::size_t i) {
      return window_.speed(i) == cap || (window_.speed(i) == window_.speed(slowest) &&
                                         window_.ramp_speed(i) == window_.ramp_speed(slowest));
    };
    while (a > first && same(a - 1)) --a;
    while (b < last && same(b + 1)) ++b;
    from = std::clamp(window_.start(a), from, to);
    to = std::clamp(window_.start(b + 1), from, to);
  }
  // What is exactly a ramp needs no more planning.
  const bool up_done = !descends && from <= f.cruise_from, down_done = to >= f.cruise_to;
  if (down_done)
    open_.push_back(
        {.from = f.cruise_to, .to = stretch.to, .v0 = cap, .v1 = stretch.v1, .ramp = f.down, .ramped = true});
  else
    open_.push_back({.from = to, .to = stretch.to, .v0 = cap, .v1 = stretch.v1});
  open_.push_back({.from = from, .to = to, .v0 = cap, .v1 = cap, .plateau = true});
  if (up_done)
    open_.push_back({.from = stretch.from,
                     .to = f.cruise_from,
                     .v0 = stretch.v0,
                     .v1 = cap,
                     .ramp = f.up,
                     .ramped = true});
  else
    open_.push_back({.from = stretch.from, .to = from, .v0 = stretch.v0, .v1 = cap});
}

/// From the end of what is committed to a stop at the end of what is known.
void JerkLookahead::plan() {
  if (planned_end_ == path_->added() && planned_finish_ == path_->finishing() && planned_end_ > 0) return;
  planned_end_ = path_->added();
  planned_finish_ = path_->finishing();
  before_.assign(parts_.begin() + static_cast<std::ptrdiff_t>(committed_), parts_.end());
  parts_.resize(committed_);
  no_room_ = kept_ = false;
  if (path_->empty()) return;
  window_.load(*path_, window_at_);
  const std::uint64_t first = path_->first();
  double at = end_, speed = speed_;
  for (std::size_t i = 0; i < window_.size(); ++i) {
    const bool last = i + 1 == window_.size();
    if ((!last && !path_->piece(first + i).stop_after) || window_.start(i + 1) <= at) continue;
    open_.clear();
    open_.push_back({.from = at, .to = window_.start(i + 1), .v0 = speed, .v1 = 0});
    while (!open_.empty()) {
      const Stretch stretch = open_.back();
      open_.pop_back();
      if (stretch.ramped)
        put(stretch.from, stretch.to, stretch.ramp);
      else
        solve(stretch);
    }
    at = window_.start(i + 1);
    speed = 0;
  }
  if (!no_room_ || before_.empty()) return;
  parts_.resize(committed_);
  parts_.insert(parts_.end(), before_.begin(), before_.end());
  kept_ = true;
}

/// Gives out what more path would hardly change.
void JerkLookahead::commit() {
  plan();
  if (committed_ == parts_.size()) return;
  std::size_t until = committed_;
  if (kept_) {
    until = committed_ + 1;
    planned_end_ = 0;
    ++forced_;
  } else if (path_->finishing()) {
    until = parts_.size();
    to_the_end_ = true;
  } else {
    // Of a full window, a quarter of its pieces is kept back.
    const double enough =
        path_->full() ? window_.start(window_.size() - window_.size() / 4) : parts_.back().to;
    for (std::size_t i = committed_; i < parts_.size() && (until == committed_ || parts_[i].to <= enough);
         ++i)
      if (parts_[i].capped) until = i + 1;
    if (until == committed_ && path_->full()) {
      const double half = 0.5 * (end_ + parts_.back().to);
      until = committed_ + 1;
      while (until < parts_.size() && parts_[until].to <= half) ++until;
      ++forced_;
    }
  }
  if (until == committed_) return;
  committed_ = until;
  end_ = parts_[until - 1].to;
  speed_ = parts_[until - 1].ramp.to();
}

bool JerkLookahead::next(Phase& phase, bool early) {
  for (;;) {
    if (give(phase)) return true;
    // All that was committed is given out: its parts are not needed any more.
    parts_.erase(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(committed_));
    committed_ = part_ = 0;
    if (path_->empty() || (!early && !path_->finishing() && !path_->full())) return false;
    commit();
    if (committed_ == 0) return false;
  }
}

/// The next phase of what is committed.
bool JerkLookahead::give(Phase& phase) {
  while (part_ < committed_) {
    const Part& part = parts_[part_];
    const bool even = part.ramp.from() == part.ramp.to();
    while (!path_->empty() && window_at_ + path_->piece(path_->first()).length <= done_ + kShortest_mm &&
           path_->first() + 1 < path_->added()) {
      window_at_ += path_->piece(path_->first()).length;
      path_->drop_first();
    }
    const PlanPiece& piece = path_->piece(path_->first());
    // As far as the geometry goes, which may be many pieces.
    double end = window_at_ + piece.length;
    for (std::uint64_t i = path_->first() + 1; i < path_->added() && end < part.to; ++i) {
      if (path_->piece(i).geometry != piece.geometry) break;
      end += path_->piece(i).length;
    }
    const bool to_end = end + kShortest_mm >= part.to;
    if (to_end) end = part.to;
    phase.s0 = piece.s0 + std::max(done_ - window_at_, 0.0);
    phase.line = piece.line;
    const PathPiece& geometry = path_->geometry(piece);
    bool part_done = to_end;
    if (even) {
      phase.v0 = part.ramp.from();
      phase.a = phase.jerk = 0;
      phase.duration_s = (end - done_) / phase.v0;
      done_ = end;
    } else {
      const SpeedRamp::Stage stage = part.ramp.stage(stage_);
      const double way = stage.way(stage.duration_s);
      double until_s = stage.duration_s;
      bool stage_done = true;
      if (!to_end && stage_at_ + way > end) {
        until_s = stage.time_of(end - stage_at_);
        stage_done = stage.duration_s - until_s < kBriefest_s;
        if (stage_done) until_s = stage.duration_s;
      }
      phase.v0 = stage.speed_at(stage_s_);
      phase.a = stage.accel + stage.jerk * stage_s_;
      phase.jerk = stage.jerk;
      phase.duration_s = until_s - stage_s_;
      if (stage_done) {
        stage_at_ = done_ = stage_at_ + way;
        stage_s_ = 0;
        part_done = ++stage_ == SpeedRamp::kStages;
      } else {
        done_ = end;
        stage_s_ = until_s;
        part_done = false;
      }
    }
    bool last = false;
    if (part_done) {
      done_ = part.to;
      ++part_;
      stage_ = 0;
      stage_s_ = 0;
      stage_at_ = done_;
      last = to_the_end_ && part_ == committed_;
    }
    const bool there = phase.duration_s > kBriefest_s || last;
    if (there) {
      phase.piece = geometry;
      phase.last = last;
    }
    if (last) {
      while (!path_->empty()) path_->drop_first();
      clear();
    }
    if (there) return true;
  }
  return false;
}

Lookahead::Ahead JerkLookahead::ahead() {
  plan();
  Lookahead::Ahead ahead;
  for (std::size_t i = part_; i < parts_.size(); ++i) {
    const double passed =
        i == part_ && parts_[i].to > parts_[i].from
            ? std::clamp((done_ - parts_[i].from) / (parts_[i].to - parts_[i].from), 0.0, 1.0)
            : 0;
    ahead.all_s += parts_[i].duration_s() * (1 - passed);
    if (i < committed_ || parts_[i].capped || (path_->finishing() && !kept_)) ahead.final_s = ahead.all_s;
  }
  return ahead;
}

}  // namespace kinebus
