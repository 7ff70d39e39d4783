#include "tools/simulation/checkers/vibration_checker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus {
namespace {

// Of the tool's acceleration. The last and least of a shaper's pulses changes it by more.
constexpr double kStillShare = 0.01;
constexpr double kSettlePeriods = 0.75, kWatchPeriods = 3;

/// m = R_X(A) R_Z(C) q
FlexibleFrame::Vector to_machine(Frame frame, const Pose& pose) {
  FlexibleFrame::Vector v{pose[kX], pose[kY], pose[kZ]};
  if (frame == Frame::kMachine) return v;
  const double cc = std::cos(pose[kC]), sc = std::sin(pose[kC]);
  const double ca = std::cos(pose[kA]), sa = std::sin(pose[kA]);
  v = {cc * v[0] - sc * v[1], sc * v[0] + cc * v[1], v[2]};
  return {v[0], ca * v[1] - sa * v[2], sa * v[1] + ca * v[2]};
}

Pose to_part(Frame frame, Pose pose) {
  if (frame == Frame::kPart) return pose;
  const double cc = std::cos(pose[kC]), sc = std::sin(pose[kC]);
  const double ca = std::cos(pose[kA]), sa = std::sin(pose[kA]);
  const double y = ca * pose[kY] + sa * pose[kZ], x = pose[kX];
  pose[kZ] = ca * pose[kZ] - sa * pose[kY];
  pose[kX] = cc * x + sc * y;
  pose[kY] = cc * y - sc * x;
  return pose;
}

}  // namespace

VibrationChecker::VibrationChecker(const MachineDescription& machine, const Kinematics& kinematics,
                                   const std::array<FlexibleFrame::Modes, 3>& modes, Planned planned,
                                   ByteSource* text, const Pose& start)
    : frame_(modes),
      planned_(std::move(planned)),
      still_mm_per_s2_(kStillShare * machine.path.tool_accel_mm_per_s2) {
  double slowest_hz = modes[0][0].frequency_hz;
  for (const FlexibleFrame::Modes& m : modes) slowest_hz = std::min(slowest_hz, m[0].frequency_hz);
  settle_s_ = kSettlePeriods / slowest_hz;
  watch_s_ = settle_s_ + kWatchPeriods / slowest_hz;
  if (text != nullptr) path_ = std::make_unique<PathChecker>(machine, kinematics, *text, start);
}

/// Of the plan at the present rate, over the last two milliseconds of path time; none where nothing moves.
FlexibleFrame::Vector VibrationChecker::acceleration(const Sample& sample) const {
  constexpr PathTime kStep = std::chrono::milliseconds{1};
  FlexibleFrame::Vector accel{};
  if (!sample.planned) return accel;
  const auto middle = planned_(sample.tau - kStep), first = planned_(sample.tau - 2 * kStep);
  if (!middle || !first) return accel;
  const double scale = sample.rate * sample.rate / (to_seconds(kStep) * to_seconds(kStep));
  const FlexibleFrame::Vector x0 = to_machine(first->frame, first->pose),
                              x1 = to_machine(middle->frame, middle->pose),
                              x2 = to_machine(sample.planned->frame, sample.planned->pose);
  for (std::size_t i = 0; i < accel.size(); ++i) accel[i] = scale * (x2[i] - 2 * x1[i] + x0[i]);
  return accel;
}

bool VibrationChecker::rate_changes(double rate) {
  constexpr double kSame = 0.01;
  const double before = rates_[next_rate_];
  rates_[next_rate_] = rate;
  next_rate_ = (next_rate_ + 1) % rates_.size();
  return std::abs(rate - before) > kSame;
}

void VibrationChecker::on_sample(const Sample& sample) {
  const double dt_s = last_time_ == BusTime{0} ? 0 : to_seconds(sample.time - last_time_);
  last_time_ = sample.time;
  frame_.move_to(to_machine(Frame::kPart, sample.pose), dt_s);
  const FlexibleFrame::Vector accel = acceleration(sample);
  double change = 0;
  for (std::size_t i = 0; i < accel.size(); ++i) change = std::max(change, std::abs(accel[i] - held_[i]));
  steady_s_ += dt_s;
  if (rate_changes(sample.rate) || change > still_mm_per_s2_) {
    held_ = accel;
    steady_s_ = 0;
  }
  if (steady_s_ >= settle_s_ && steady_s_ <= watch_s_) {
    const FlexibleFrame::Vector bent = frame_.static_deflection_mm(held_);
    double square = 0;
    for (std::size_t i = 0; i < bent.size(); ++i) {
      const double um = 1000 * (frame_.deflection_mm()[i] - bent[i]);
      square += um * um;
    }
    squares_um2_ += square;
    ++samples_;
    if (std::sqrt(square) > peak_um_) {
      peak_um_ = std::sqrt(square);
      peak_line_ = sample.line;
    }
  }
  if (path_ && sample.planned) {
    Sample plan = sample;
    plan.pose = to_part(sample.planned->frame, sample.planned->pose);
    path_->on_sample(plan);
  }
}

double VibrationChecker::rms_um() const {
  return samples_ > 0 ? std::sqrt(squares_um2_ / static_cast<double>(samples_)) : 0;
}

}  // namespace kinebus
