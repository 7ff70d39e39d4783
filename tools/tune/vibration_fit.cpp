#include "tools/tune/vibration_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <utility>

namespace kinebus {
namespace {

// A peak below this is no spring that a shaper could do something about.
constexpr double kLeastPeak = 1.8;
// A second mode is believed where it takes away so much of the squares that one mode leaves. It may lie
// beyond the bands: there it still lifts what is seen below it.
constexpr double kSecondGain = 0.02, kMostSecond = 4;
constexpr int kSteps = 60;

/// ln of gain, noise, frequency and damping; of a second mode its share, as a logit, frequency and damping.
using Vector = std::vector<double>;
using Parameters = Vector;
enum : std::size_t { kGain, kNoise, kFrequency, kDamping, kShare, kFrequency2, kDamping2 };

double square_sum(const Vector& values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

/// Solves a x = b for a symmetric, positive definite a, by rows (Cholesky). Empty: it is not.
Vector solved(std::vector<Vector> a, Vector b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < k; ++i) a[k][k] -= a[k][i] * a[k][i];
    if (!(a[k][k] > 0)) return {};
    a[k][k] = std::sqrt(a[k][k]);
    for (std::size_t r = k + 1; r < n; ++r) {
      for (std::size_t i = 0; i < k; ++i) a[r][k] -= a[r][i] * a[k][i];
      a[r][k] /= a[k][k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < k; ++i) b[k] -= a[k][i] * b[i];
    b[k] /= a[k][k];
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) b[k] -= a[i][k] * b[i];
    b[k] /= a[k][k];
  }
  return b;
}

std::vector<FittedMode> modes_of(const Parameters& p) {
  std::vector<FittedMode> modes{{std::exp(p[kFrequency]), std::min(0.7, std::exp(p[kDamping])), 1}};
  if (p.size() > kShare) {
    const double share = 0.5 / (1 + std::exp(-p[kShare]));
    modes[0].share = 1 - share;
    modes.push_back({std::exp(p[kFrequency2]), std::min(0.7, std::exp(p[kDamping2])), share});
  }
  return modes;
}

/// Levenberg and Marquardt on the logarithms of the bands' energies.
class Search {
 public:
  Search(const Bands& bands, const std::vector<double>& planned, const std::vector<double>& measured)
      : bands_(bands), planned_(planned), measured_(measured) {}

  /// Returns the sum of squares; `p` is the best found.
  double minimise(Parameters& p) const {
    Vector r = residuals(p);
    double cost = square_sum(r), damping = 1e-2;
    for (int step = 0; step < kSteps && damping < kMostDamped; ++step) {
      const double before = cost;
      const std::vector<Vector> j = derivatives(p, r);
      while (damping < kMostDamped && cost == before) try_step(j, damping, p, r, cost);
      if (before - cost < 1e-9 * before) break;
    }
    return cost;
  }

 private:
  static constexpr double kMostDamped = 1e8;

  std::vector<Vector> derivatives(const Parameters& p, const Vector& r) const {
    constexpr double kStep = 1e-5;
    std::vector<Vector> j;
    for (std::size_t k = 0; k < p.size(); ++k) {
      Parameters moved = p;
      moved[k] += kStep;
      j.push_back(residuals(moved));
      for (std::size_t i = 0; i < r.size(); ++i) j[k][i] = (j[k][i] - r[i]) / kStep;
    }
    return j;
  }

  /// One step, taken where it makes the sum smaller.
  void try_step(const std::vector<Vector>& j, double& damping, Parameters& p, Vector& r, double& cost) const {
    std::vector<Vector> square(p.size(), Vector(p.size()));
    Vector slope(p.size());
    for (std::size_t a = 0; a < p.size(); ++a) {
      for (std::size_t b = 0; b < p.size(); ++b)
        square[a][b] = std::inner_product(j[a].begin(), j[a].end(), j[b].begin(), 0.0);
      slope[a] = std::inner_product(j[a].begin(), j[a].end(), r.begin(), 0.0);
    }
    for (std::size_t a = 0; a < p.size(); ++a) square[a][a] += damping * (square[a][a] + 1e-9);
    const Vector by = solved(std::move(square), std::move(slope));
    Parameters next = p;
    for (std::size_t a = 0; a < by.size(); ++a) next[a] -= by[a];
    Vector at_next = residuals(next);
    const double better = square_sum(at_next);
    if (!(better < cost)) {
      damping *= 4;
      return;
    }
    p = std::move(next), r = std::move(at_next), cost = better;
    damping *= 0.3;
  }

  Vector residuals(const Parameters& p) const {
    const std::vector<FittedMode> modes = modes_of(p);
    Vector r(bands_.count);
    for (std::size_t i = 0; i < bands_.count; ++i) {
      const double t = transmissibility(modes, bands_.middle_hz(i));
      const double modelled = std::exp(2 * p[kGain]) * t * t * planned_[i] + std::exp(p[kNoise]);
      r[i] = std::log(measured_[i] / modelled);
    }
    return r;
  }

  const Bands& bands_;
  const std::vector<double>& planned_;
  const std::vector<double>& measured_;
};

}  // namespace

double transmissibility(const std::vector<FittedMode>& modes, double f) {
  std::complex<double> sum = 0;
  for (const FittedMode& m : modes) {
    const std::complex<double> spring(m.frequency_hz * m.frequency_hz,
                                      2 * m.damping_ratio * m.frequency_hz * f);
    sum += m.share * spring / (spring - f * f);
  }
  return std::abs(sum);
}

Result<VibrationFit, std::string> fit_vibration(const Bands& bands, const std::vector<double>& planned,
                                                const std::vector<double>& measured) {
  VibrationFit fit;
  fit.bands = bands;
  for (std::size_t i = 0; i < bands.count; ++i) {
    if (!(planned[i] > 0) || !(measured[i] > 0))
      return Error<std::string>(fmt::format("nothing was recorded at {:.1f} Hz", bands.middle_hz(i)));
    fit.measured.push_back(std::sqrt(measured[i] / planned[i]));
  }
  // The peak among means of three bands: single ones have noise.
  std::size_t peak = 1;
  const auto near = [&](std::size_t i) {
    return fit.measured[i - 1] + fit.measured[i] + fit.measured[i + 1];
  };
  for (std::size_t i = 1; i + 1 < bands.count; ++i)
    if (near(i) > near(peak)) peak = i;
  const Search search(bands, planned, measured);
  const double noise = std::log(1e-3 * std::accumulate(measured.begin(), measured.end(), 0.0) /
                                static_cast<double>(measured.size()));
  Parameters best;
  double cost = -1;
  for (const double damping : {0.05, 0.12, 0.25}) {
    Parameters p{0, noise, std::log(bands.middle_hz(peak)), std::log(damping)};
    const double found = search.minimise(p);
    if (cost >= 0 && found >= cost) continue;
    cost = found;
    best = p;
  }
  std::optional<Parameters> two;
  double cost_of_two = (1 - kSecondGain) * cost;
  for (const double ratio : {0.5, 1.5, 1.9, 2.2, 2.5, 2.8, 3.2}) {
    const double second_hz = ratio * bands.middle_hz(peak);
    if (second_hz < bands.from_hz) continue;
    Parameters p = best;
    p.insert(p.end(), {-1.5, std::log(second_hz), std::log(0.06)});
    const double found = search.minimise(p);
    if (found >= cost_of_two) continue;
    const double at_hz = std::exp(p[kFrequency2]);
    if (at_hz < bands.from_hz || at_hz > kMostSecond * std::exp(p[kFrequency])) continue;
    cost_of_two = found;
    two = p;
  }
  if (two) {
    best = *two;
    cost = cost_of_two;
  }
  fit.modes = modes_of(best);
  fit.gain = std::exp(best[kGain]);
  fit.error_db = 10 / std::log(10.0) * std::sqrt(cost / static_cast<double>(bands.count));
  double highest = 0;
  for (std::size_t i = 0; i < bands.count; ++i) {
    const double t = transmissibility(fit.modes, bands.middle_hz(i));
    highest = std::max(highest, t);
    fit.modelled.push_back(t);
    fit.measured[i] /= fit.gain;
  }
  const double f = fit.modes[0].frequency_hz;
  if (highest < kLeastPeak || f < bands.from_hz || f > bands.middle_hz(bands.count - 1))
    return Error<std::string>(fmt::format("nothing swings between {:.0f} and {:.0f} Hz that a shaper is for",
                                          bands.from_hz, bands.middle_hz(bands.count - 1)));
  return fit;
}

}  // namespace kinebus
