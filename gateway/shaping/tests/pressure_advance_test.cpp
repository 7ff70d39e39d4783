// Pressure advance against its formula, summed up from the planner's phases, and against the extruder's
// limits.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gateway/motion/tests/test_machine.hpp"
#include "gateway/shaping/motion_shaper.hpp"

namespace kinebus {
namespace {

using probe::Job;

constexpr FilamentLimits kFilament{
    .speed_mm_per_s = 40, .accel_mm_per_s2 = 2000, .flow_accel_mm_per_s2 = 200, .rests = true};

struct Planned {
  std::vector<Phase> phases;
  double duration_s = 0;
};

/// As a job does: the model of each change holds for the lines behind its own.
struct Change {
  std::uint32_t line = 0;
  AdvanceModel model;
};

Planned plan_of(const probe::Lines& lines, const MotionLimits& limits = {}, std::uint32_t rest_before = 0) {
  Planner planner(probe::m1(), limits);
  EXPECT_TRUE(planner.limit_filament(kFilament));
  Planned out;
  Phase phase;
  const auto pull = [&] {
    while (planner.next(phase)) {
      out.phases.push_back(phase);
      out.duration_s += phase.duration_s;
    }
  };
  for (const canonical::Line& line : lines) {
    if (line.line == rest_before) {
      EXPECT_TRUE(planner.limit_filament(kFilament));
    }
    EXPECT_TRUE(planner.add(line));
    if (!planner.wants_more()) pull();
  }
  EXPECT_TRUE(planner.finish());
  pull();
  return out;
}

std::vector<Phase> advanced(const std::vector<Phase>& phases, const PathShaper::Shapers& shapers,
                            std::vector<Change> changes) {
  MotionShaper shaper(shapers, AdvanceWindow(changes.front().model));
  EXPECT_TRUE(shaper.active());
  std::vector<Phase> out;
  Phase phase;
  std::size_t next = 0;
  for (const Phase& p : phases) {
    for (; next < changes.size() && changes[next].line < p.line; ++next)
      shaper.set_advance(changes[next].model);
    shaper.push(p);
    while (shaper.next(phase)) out.push_back(phase);
  }
  EXPECT_TRUE(shaper.empty());
  return out;
}

/// With a rest wherever filament alone and a bead meet, and behind the lines at which the advance changes.
std::vector<Phase> with_rests(const std::vector<Phase>& phases, double rest_s,
                              const std::vector<Change>& changes = {}) {
  if (rest_s == 0) return phases;
  const auto moves = [](const Phase& p) {
    const Pose v = p.at(0.5 * p.duration_s).x1;
    return std::hypot(v[kX], v[kY], v[kZ]) > 0;
  };
  std::vector<Phase> out;
  for (const Phase& p : phases) {
    const auto feeds = [&](const Phase& q) { return moves(q) && q.at(0.5 * q.duration_s).x1[kE] > 0; };
    const bool meet = !out.empty() && moves(out.back()) != moves(p) && (feeds(out.back()) || feeds(p));
    const bool changes_here =
        !out.empty() && std::any_of(changes.begin(), changes.end(), [&](const Change& change) {
          return change.line >= out.back().line && change.line < p.line;
        });
    if (meet || changes_here) {
      Phase rest = p;
      rest.v0 = rest.a = rest.jerk = 0;
      rest.duration_s = rest_s;
      rest.line = out.back().line;
      rest.last = false;
      out.push_back(rest);
      out.push_back(p);
      continue;
    }
    out.push_back(p);
  }
  return out;
}

/// One quantity over the time of a chain of phases, at rest before and behind it, every 50 us.
class Track {
 public:
  static constexpr double kStep_s = 50e-6;
  template <typename Of>
  Track(const std::vector<Phase>& phases, Of of) {
    double start = 0, t = 0;
    for (const Phase& p : phases) {
      for (; t < start + p.duration_s; t += kStep_s) values_.push_back(of(p, t - start));
      start += p.duration_s;
    }
    if (!phases.empty()) values_.push_back(of(phases.back(), phases.back().duration_s));
  }
  explicit Track(std::vector<double> values) : values_(std::move(values)) {}
  double at(double t) const {
    const double place = std::clamp(t / kStep_s, 0.0, static_cast<double>(values_.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(place), values_.size() - 2);
    return values_[i] + (place - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }
  double end_s() const { return static_cast<double>(values_.size() - 1) * kStep_s; }
  /// Mean over t - half .. t + half.
  double mean(double t, double half) const {
    constexpr int kParts = 200;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) sum += at(t - half + 2 * half * (i + 0.5) / kParts);
    return sum / kParts;
  }

 private:
  std::vector<double> values_;
};

double e_of(const Phase& p, double t) {
  return p.at(t).x[kE];
}

/// What a model asks for, along the plan.
Track asked_by(const std::vector<Phase>& phases, const std::vector<Change>& changes) {
  return Track(phases, [&](const Phase& p, double t) {
    const PosePoint at = p.at(t);
    const AdvanceModel* model = &changes.front().model;
    for (const Change& change : changes)
      if (change.line < p.line) model = &change.model;
    const bool moves = std::hypot(at.x1[kX], at.x1[kY], at.x1[kZ]) > 0;
    return moves && at.x1[kE] > 0 ? model->at(at.x1[kE]) : 0;
  });
}

struct Worst {
  double off_mm = 0, speed = 0, accel = 0;
};

/// The published formulas, summed up in steps of 50 us: beads' filament as a vector along the tip, averaged
/// by the pulses; its length is what flows, and A of that what is asked for. Where the tip nearly halts in a
/// blend, its part of s flows along it.
class Expected {
 public:
  Expected(const std::vector<Phase>& phases, const std::vector<Change>& changes, const InputShaper& shaper)
      : e_(phases, e_of), asked_(asked_by(phases, changes)), bends_(shaper.all().size() > 1) {
    if (!bends_) return;
    const AdvanceModel& model = changes.front().model;
    std::vector<Track> axes;
    for (const PoseAxis axis : {kX, kY, kZ})
      axes.emplace_back(phases, [axis](const Phase& p, double t) {
        const PosePoint at = p.at(t);
        const double rate = p.speed(t);
        return rate > 0 && at.x1[kE] > 0 ? at.x1[kE] * at.x1[axis] / rate : 0;
      });
    double fed = 0, way = 0;
    std::vector<double> saved, asked;
    const double step = Track::kStep_s, lasts_s = axes[0].end_s() + shaper.duration_s();
    for (double t = 0; t < lasts_s + 0.1; t += step) {
      double square = 0, planned = 0;
      for (const Track& axis : axes) {
        double flow = 0;
        for (const auto& pulse : shaper.all()) flow += pulse.weight * rest_outside(axis, t - pulse.time_s);
        square += flow * flow;
      }
      for (const auto& pulse : shaper.all()) {
        double one = 0;
        for (const Track& axis : axes) one += std::pow(rest_outside(axis, t - pulse.time_s), 2);
        planned += pulse.weight * std::sqrt(one);
      }
      saved.push_back(fed - way);
      asked.push_back(model.at(std::sqrt(square)));
      fed += std::sqrt(square) * step;
      way += planned * step;
    }
    saved_ = Track(std::move(saved));
    asked_ = Track(std::move(asked));
  }
  /// Filament at t of the shaped plan, before the advance.
  double plain(double t, const InputShaper& shaper) const {
    double e = bends_ ? saved_.at(t) : 0;
    for (const InputShaper::Pulse& pulse : shaper.all()) e += pulse.weight * e_.at(t - pulse.time_s);
    return e;
  }
  const Track& asked() const { return asked_; }

 private:
  static double rest_outside(const Track& track, double t) {
    return t < 0 || t > track.end_s() ? 0 : track.at(t);
  }
  Track e_, asked_, saved_{std::vector<double>{0, 0}};
  bool bends_;
};

Worst measure(const std::vector<Phase>& in, const std::vector<Phase>& out, const std::vector<Change>& changes,
              const InputShaper& shaper) {
  const AdvanceModel& model = changes.front().model;
  const double half = 0.5 * model.smooth_s, reach = AdvanceWindow(model).reach_s();
  const Expected expected(in, changes, shaper);
  const Track result(out, e_of);
  Worst worst;
  for (double t = 0; t < result.end_s(); t += 0.71e-3) {
    const double at = t - reach;
    double e = expected.plain(at, shaper) + expected.asked().mean(at, half);
    if (model.melt_s > 0)
      e += model.melt_s / model.smooth_s *
           (expected.asked().mean(at + half, half) - expected.asked().mean(at - half, half));
    worst.off_mm = std::max(worst.off_mm, std::abs(result.at(t) - e));
  }
  for (const Phase& p : out)
    for (const double t : {0.0, 0.5 * p.duration_s, p.duration_s}) {
      worst.speed = std::max(worst.speed, std::abs(p.at(t).x1[kE]));
      worst.accel = std::max(worst.accel, std::abs(p.at(t).x2[kE]));
    }
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    EXPECT_NEAR(out[i].at(out[i].duration_s).x1[kE], out[i + 1].at(0).x1[kE], 1e-5) << "phase " << i;
    EXPECT_NEAR(out[i].at(out[i].duration_s).x[kE], out[i + 1].at(0).x[kE], 1e-8) << "phase " << i;
  }
  EXPECT_NEAR(out.back().at(out.back().duration_s).x[kE], expected.plain(1e9, shaper), 2e-4);
  EXPECT_LE(std::abs(out.back().at(out.back().duration_s).x1[kE]), 1e-6);
  EXPECT_LE(std::abs(out.front().at(0).x1[kE]), 1e-6);
  return worst;
}

TEST(PressureAdvance, IsTheMeanOfWhatTheModelAsksForAlongThePlan) {
  const std::vector<Change> models = {
      {0, {.advance_s = 0.05, .smooth_s = 0.02}},
      {0, {.advance_s = 0.04, .melt_s = 0.006}},
      {0, {.kind = AdvanceKind::kTanh, .advance_s = 0.02, .nonlinear_mm = 0.05, .nonlinear_mm_per_s = 2}},
      {0,
       {.kind = AdvanceKind::kReciprocal, .advance_s = 0.01, .nonlinear_mm = 0.1, .nonlinear_mm_per_s = 3}}};
  for (const Change& model : models)
    for (const ShaperKind kind : {ShaperKind::kNone, ShaperKind::kMzv}) {
      const InputShaper shaper = make_shaper(kind, 45, 0.1);
      const Planned in = plan_of(probe::random_print(7, 250));
      const auto out = advanced(in.phases, {shaper, shaper, shaper}, {model});
      const std::vector<Phase> rested =
          with_rests(in.phases, shaper.duration_s() + AdvanceWindow(model.model).reach_s());
      EXPECT_GT(rested.size(), in.phases.size());
      const Worst worst = measure(rested, out, {model}, shaper);
      EXPECT_LE(worst.off_mm, 2e-4);
      double duration_s = 0, rested_s = 0;
      for (const Phase& p : out) duration_s += p.duration_s;
      for (const Phase& p : rested) rested_s += p.duration_s;
      EXPECT_NEAR(duration_s, rested_s + 2 * AdvanceWindow(model.model).reach_s() + shaper.duration_s(),
                  1e-5);
    }
}

TEST(PressureAdvance, LeavesTheToolOnItsPath) {
  const Planned in = plan_of(probe::random_print(3, 150));
  const AdvanceModel model{.advance_s = 0.08};
  const auto out = advanced(in.phases, {}, {{0, model}});
  for (const PoseAxis axis : {kX, kY, kZ}) {
    const auto of = [axis](const Phase& p, double t) { return p.at(t).x[axis]; };
    const Track plan(with_rests(in.phases, 0.5 * model.smooth_s), of), result(out, of);
    for (double t = 0; t < result.end_s(); t += 1e-3)
      ASSERT_NEAR(result.at(t), plan.at(t - 0.5 * model.smooth_s), 2e-3) << t;
  }
}

TEST(PressureAdvance, ARetractionAndItsRecoveryArePlain) {
  Job job;
  job.feed(30).by({0, 0, 0, 0, 0, -1}).by({0, 0, 0, 0, 0, 1});
  const Planned in = plan_of(job.lines());
  const auto out = advanced(in.phases, {}, {{0, {.advance_s = 0.1}}});
  const Track plan(in.phases, e_of), result(out, e_of);
  for (double t = 0; t < result.end_s(); t += 1e-3) EXPECT_NEAR(result.at(t), plan.at(t - 0.0075), 1e-4);
}

TEST(PressureAdvance, StaysWithinTheSharesThatItWasPlannedFor) {
  // Of 3000 mm/s^2 and 60 mm/s kFilament leaves 1000 and 20. 200 mm/s^2 of flow times 2 K / w, and with the
  // melt 2 K / w + 4 K T / w^2, are as much; whatever is printed.
  for (const AdvanceModel& model : {AdvanceModel{.advance_s = 0.05, .smooth_s = 0.02},
                                    AdvanceModel{.advance_s = 0.025, .melt_s = 0.01, .smooth_s = 0.02}})
    for (const bool jerk : {false, true}) {
      const std::uint64_t seed = jerk ? 1 : 2;
      MotionLimits limits;
      if (jerk) limits.tool_jerk_mm_per_s3 = 100'000;
      probe::Lines lines = probe::random_print(seed, 200);
      for (canonical::Line& line : lines)  // thick beads
        if (auto* feed = std::get_if<canonical::Feed>(&line.command)) feed->target[kE] *= 4;
      const Planned in = plan_of(lines, limits);
      const auto out = advanced(in.phases, {}, {{0, model}});
      const Worst worst = measure(in.phases, out, {{0, model}}, {});
      EXPECT_LE(worst.speed, 60.5);
      EXPECT_LE(worst.accel, 3000 * 1.005);
    }
}

TEST(PressureAdvance, AnotherAdvanceHoldsFromItsLineOn) {
  Job job;
  job.feed(50);
  for (int i = 0; i < 6; ++i) job.by({20, i % 2 ? 15.0 : 0.0, 0, 0, 0, 1});
  const std::uint32_t line = job.lines()[3].line;
  const AdvanceModel first{.advance_s = 0.02}, second{.advance_s = 0.09};
  const Planned in = plan_of(job.lines(), {}, line + 1);
  const std::vector<Change> changes = {{0, first}, {line, second}};
  const auto out = advanced(in.phases, {}, changes);
  const Worst worst = measure(with_rests(in.phases, 0.5 * first.smooth_s, changes), out, changes, {});
  EXPECT_LE(worst.off_mm, 2e-4);
  // A step of A would be a jump of E'. What is left of one advance and the beginning of the next ask for half
  // of the extruder each: of flow that accelerates by 200 mm/s^2, and K / w.
  EXPECT_LE(worst.accel, 200 * std::max(1 + 2 * second.advance_s / second.smooth_s,
                                        (first.advance_s + second.advance_s) / first.smooth_s));
}

TEST(AdvanceModel, SlopesAreThoseOfTheirCurves) {
  for (const AdvanceKind kind : {AdvanceKind::kLinear, AdvanceKind::kTanh, AdvanceKind::kReciprocal}) {
    const AdvanceModel m{.kind = kind, .advance_s = 0.03, .nonlinear_mm = 0.08, .nonlinear_mm_per_s = 2.5};
    EXPECT_EQ(m.at(0), 0);
    for (const double v : {0.0, 0.5, 2.5, 9.0}) {
      EXPECT_NEAR(m.slope_s(v), (m.at(v + 1e-6) - m.at(v)) / 1e-6, 1e-5);
      EXPECT_LE(m.slope_s(v), m.steepest_s());
    }
  }
  EXPECT_FALSE(AdvanceModel{}.acts());
}

}  // namespace
}  // namespace kinebus
