#include "tools/tune/vibration_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>

namespace kinebus {
namespace {

// A peak below this is no spring that a shaper could do something about.
constexpr double kLeastPeak = 1.8;
// A second mode is believed where it takes away so much of the squares of the one that is left.
constexpr double kSecondGain = 0.15;
constexpr int kSteps = 60;

/// ln of gain, noise, frequency and damping; of a second mode its share, as a logit, frequency and damping.
using Parameters = Eigen::VectorXd;
enum : int { kGain, kNoise, kFrequency, kDamping, kShare, kFrequency2, kDamping2 };

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
    Eigen::VectorXd r = residuals(p);
    double cost = r.squaredNorm(), damping = 1e-2;
    for (int step = 0; step < kSteps && damping < 1e8; ++step) {
      constexpr double kStep = 1e-5;
      Eigen::MatrixXd j(r.size(), p.size());
      for (Eigen::Index k = 0; k < p.size(); ++k) {
        Parameters moved = p;
        moved[k] += kStep;
        j.col(k) = (residuals(moved) - r) / kStep;
      }
      const Eigen::MatrixXd square = j.transpose() * j;
      const Eigen::VectorXd slope = j.transpose() * r;
      for (;;) {
        Eigen::MatrixXd damped = square;
        damped.diagonal() += damping * (square.diagonal().array() + 1e-9).matrix();
        const Parameters next = p - damped.ldlt().solve(slope);
        const Eigen::VectorXd at_next = residuals(next);
        const double better = at_next.squaredNorm();
        if (std::isfinite(better) && better < cost) {
          const bool done = cost - better < 1e-9 * cost;
          p = next, r = at_next, cost = better;
          damping *= 0.3;
          if (done) return cost;
          break;
        }
        damping *= 4;
        if (damping >= 1e8) return cost;
      }
    }
    return cost;
  }

 private:
  Eigen::VectorXd residuals(const Parameters& p) const {
    const std::vector<FittedMode> modes = modes_of(p);
    Eigen::VectorXd r(static_cast<Eigen::Index>(bands_.count));
    for (std::size_t i = 0; i < bands_.count; ++i) {
      const double t = transmissibility(modes, bands_.middle_hz(i));
      const double modelled = std::exp(2 * p[kGain]) * t * t * planned_[i] + std::exp(p[kNoise]);
      r[static_cast<Eigen::Index>(i)] = std::log(measured_[i] / modelled);
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
  std::vector<double> sorted = fit.measured;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 20),
                   sorted.end());
  const Search search(bands, planned, measured);
  const double noise = std::log(1e-3 * std::accumulate(measured.begin(), measured.end(), 0.0) /
                                static_cast<double>(measured.size()));
  Parameters best(4);
  double cost = -1;
  for (const double damping : {0.05, 0.12, 0.25}) {
    Parameters p(4);
    p << 0, noise, std::log(bands.middle_hz(peak)), std::log(damping);
    const double found = search.minimise(p);
    if (cost >= 0 && found >= cost) continue;
    cost = found;
    best = p;
  }
  std::optional<Parameters> two;
  double cost_of_two = (1 - kSecondGain) * cost;
  for (const double ratio : {0.5, 1.5, 2.0, 2.5, 3.0}) {
    const double second_hz = ratio * bands.middle_hz(peak);
    if (second_hz < bands.from_hz || second_hz > bands.middle_hz(bands.count - 1)) continue;
    Parameters p(7);
    p << best, -1.5, std::log(second_hz), std::log(0.06);
    const double found = search.minimise(p);
    if (found >= cost_of_two) continue;
    const double at_hz = std::exp(p[kFrequency2]);
    if (at_hz < bands.from_hz || at_hz > 1.2 * bands.middle_hz(bands.count - 1)) continue;
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
