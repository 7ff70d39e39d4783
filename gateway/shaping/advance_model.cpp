#include "gateway/shaping/advance_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace kinebus {
namespace {

/// dE/ds: circles add nothing to it.
double filament_slope(const PhaseAdvance::Filament& c, double s) {
  return c[1] + s * (2 * c[2] + s * 3 * c[3]);
}

double filament_at(const PhaseAdvance::Filament& c, double s) {
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

}  // namespace

bool moves_tool(const Phase& phase) {
  constexpr double kRounding = 1e-8;  // of moves of filament alone
  for (const double t : {0.0, 0.5 * phase.duration_s, phase.duration_s}) {
    const Pose along = phase.piece.evaluate(phase.s(t)).x1;
    if (std::max({std::abs(along[kX]), std::abs(along[kY]), std::abs(along[kZ])}) > kRounding) return true;
  }
  return false;
}

double AdvanceModel::at(double v) const {
  const double linear = advance_s * v;
  switch (kind) {
    case AdvanceKind::kLinear:
      break;
    case AdvanceKind::kTanh:
      return linear + nonlinear_mm * std::tanh(v / nonlinear_mm_per_s);
    case AdvanceKind::kReciprocal:
      return linear + nonlinear_mm * (1 - 1 / (1 + v / nonlinear_mm_per_s));
  }
  return linear;
}

double AdvanceModel::slope_s(double v) const {
  const double ratio = v / nonlinear_mm_per_s, steep = nonlinear_mm / nonlinear_mm_per_s;
  switch (kind) {
    case AdvanceKind::kLinear:
      break;
    case AdvanceKind::kTanh: {
      const double t = std::tanh(ratio);
      return advance_s + steep * (1 - t * t);
    }
    case AdvanceKind::kReciprocal:
      return advance_s + steep / ((1 + ratio) * (1 + ratio));
  }
  return advance_s;
}

double AdvanceModel::most_bend_s2_per_mm() const {
  const double bend = nonlinear_mm / (nonlinear_mm_per_s * nonlinear_mm_per_s);
  switch (kind) {
    case AdvanceKind::kLinear:
      break;
    case AdvanceKind::kTanh:
      return 4 / (3 * std::sqrt(3.0)) * bend;
    case AdvanceKind::kReciprocal:
      return 2 * bend;
  }
  return 0;
}

PhaseAdvance::PhaseAdvance(const Phase& phase, const Filament& c, const AdvanceModel& model) : model_(model) {
  if (!model.acts()) return;
  double least = 0, most = 0;
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double slope = filament_slope(c, phase.s(t * phase.duration_s));
    least = std::min(least, slope);
    most = std::max(most, slope);
  }
  if (!(most > 0)) return;
  const bool even = phase.a == 0 && phase.jerk == 0 && c[2] == 0 && c[3] == 0;
  if (least < 0) find_turns(phase, c);
  way_ = least < 0 || (model.kind != AdvanceKind::kLinear && !even) ? Way::kNumeric : Way::kProportional;
}

double PhaseAdvance::flow(const Phase& phase, const Filament& c, double t) {
  return std::max(0.0, filament_slope(c, phase.s(t)) * phase.speed(t));
}

/// Flow is 0 where dE/ds is, and bent there: what is integrated as a polynomial ends at such places.
void PhaseAdvance::find_turns(const Phase& phase, const Filament& c) {
  std::array<double, 2> places{};
  int count = 0;
  if (c[3] != 0) {
    const double half = c[2] / (3 * c[3]), square = half * half - c[1] / (3 * c[3]);
    if (square > 0) {
      places = {-half - std::sqrt(square), -half + std::sqrt(square)};
      count = 2;
    }
  } else if (c[2] != 0) {
    places[0] = -c[1] / (2 * c[2]);
    count = 1;
  }
  const double end = phase.s(phase.duration_s);
  for (int i = 0; i < count; ++i)
    if (const double s = places[static_cast<std::size_t>(i)]; s > phase.s0 && s < end)
      turns_[static_cast<std::size_t>(turn_count_++)] = time_at(phase, s);
  if (turn_count_ == 2 && turns_[1] < turns_[0]) std::swap(turns_[0], turns_[1]);
}

double PhaseAdvance::stretch(const Phase& phase, const Filament& c, double from, double to) const {
  // Gauss and Legendre, five places.
  constexpr std::array<std::array<double, 2>, 5> kPlaces = {{{0.046910077030668, 0.118463442528095},
                                                             {0.230765344947158, 0.239314335249683},
                                                             {0.5, 0.284444444444444},
                                                             {0.769234655052842, 0.239314335249683},
                                                             {0.953089922969332, 0.118463442528095}}};
  double sum = 0;
  for (const auto& [place, weight] : kPlaces)
    sum += weight * (to - from) * model_.at(flow(phase, c, from + place * (to - from)));
  return sum;
}

PhaseAdvance::Sum PhaseAdvance::at(const Phase& phase, const Filament& c, double t) const {
  if (way_ == Way::kNothing) return {};
  const double v = flow(phase, c, t), s = phase.s(t), rate = phase.speed(t);
  const double change =
      v > 0 ? (2 * c[2] + 6 * c[3] * s) * rate * rate + filament_slope(c, s) * phase.accel(t) : 0;
  Sum sum{0, model_.at(v), model_.slope_s(v) * change};
  if (way_ == Way::kProportional) {
    // Of one flow, or in proportion to it.
    sum.x = model_.kind == AdvanceKind::kLinear
                ? model_.advance_s * (filament_at(c, s) - filament_at(c, phase.s0))
                : sum.x1 * t;
    return sum;
  }
  double from = 0;
  for (int i = 0; i < turn_count_ && turns_[static_cast<std::size_t>(i)] < t; ++i) {
    sum.x += stretch(phase, c, from, turns_[static_cast<std::size_t>(i)]);
    from = turns_[static_cast<std::size_t>(i)];
  }
  sum.x += stretch(phase, c, from, t);
  return sum;
}

}  // namespace kinebus
