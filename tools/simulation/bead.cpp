#include "tools/simulation/bead.hpp"

#include <cmath>

namespace kinebus {
namespace {

/// The first 20 mm are the skirt's: they take what waiting and priming have left, and count for nothing.
constexpr std::uint64_t kSkirt = 50;

}  // namespace

void BeadLines::add(std::uint32_t line, double length_mm, double filament_mm) {
  constexpr double kNoWay_mm = 1e-6;
  Line& known = lines_[line];
  if (length_mm < kNoWay_mm) known.alone = known.alone || filament_mm > 0;
  if (length_mm <= known.length_mm || length_mm < kNoWay_mm) return;
  known.length_mm = length_mm;
  known.per_mm = filament_mm / length_mm;
}

double BeadLines::filament_per_mm(std::uint32_t line) const {
  const auto found = lines_.find(line);
  return found == lines_.end() || found->second.alone ? 0 : found->second.per_mm;
}

void BeadMeter::move_to(const std::array<double, 3>& tip_mm, double filament_mm, std::uint32_t line,
                        double dt_s) {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) square += (tip_mm[i] - tip_[i]) * (tip_mm[i] - tip_[i]);
  const double fed = filament_mm - filament_, length = std::sqrt(square);
  tip_ = tip_mm;
  filament_ = filament_mm;
  if (!placed_) {
    placed_ = true;
    return;
  }
  const double out = nozzle_.feed(fed, dt_s);
  const double per_mm = lines_->filament_per_mm(line);
  if (!(per_mm > 0)) {
    // A bead that was not whole is no measure: the one that begins next lies elsewhere.
    length_ = asked_ = laid_ = 0;
    return;
  }
  length_ += length;
  asked_ += per_mm * length;
  laid_ += out;
  if (length_ < kBead_mm) return;
  const double error = laid_ / asked_ - 1;
  if (++beads_ > kSkirt) {
    squares_ += error * error;
    if (std::abs(error) > worst_) {
      worst_ = std::abs(error);
      worst_line_ = line;
    }
  }
  length_ = asked_ = laid_ = 0;
}

double BeadMeter::rms() const {
  return beads_ > kSkirt ? std::sqrt(squares_ / static_cast<double>(beads_ - kSkirt)) : 0;
}

}  // namespace kinebus
