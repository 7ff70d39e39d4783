#include "tools/calibrate/fit/geometry_model.hpp"

#include <cassert>
#include <cmath>
#include <map>

#include "gateway/kinematics/m1_forward.hpp"

namespace kinebus {

namespace {
constexpr std::size_t kLegs = 4, kPerLeg = 11, kTilt = kLegs * kPerLeg, kOwn = kTilt + 2;
}  // namespace

/// A machine with its deviations, made ready once for many poses.
struct DeviatedMachine {
  DeviatedMachine(const BelievedMachine& believed, const MachineDeviation& d)
      : deviation(d),
        geometry(corrected(believed.geometry, d.geometry)),
        fixed_tool(with_tool_in_frame(geometry)),
        legs(geometry) {}
  MachineDeviation deviation;
  M1Geometry geometry, fixed_tool;
  LegTable legs;
};

GeometryModel::GeometryModel(const BelievedMachine& machine, std::vector<GeometryReading> readings)
    : machine_(machine), readings_(std::move(readings)) {
  auto made = make_m1_kinematics(machine.geometry);
  assert(made);
  believed_ = std::move(*made);
  const auto add = [&](std::string name, double prior, std::string unit = "mm") {
    parameters_.push_back({std::move(name), prior, true, std::move(unit)});
  };
  for (std::size_t i = 0; i < kLegs; ++i) {
    const std::string leg = "leg" + std::to_string(i + 1) + " ";
    for (const char* axis : {"x", "y", "z"}) add(leg + "foot " + axis, 1);
    for (const char* axis : {"x", "y"}) add(leg + "rail lean " + axis, 2e-3, "rad");
    for (const char* axis : {"x", "y", "z"}) add(leg + "attachment " + axis, 1);
    add(leg + "length", 1);
    add(leg + "switch offset", 1);
    add(leg + "scale", 2e-3, "ratio");
  }
  add("table tilt about x", 5e-3, "rad");
  add("table tilt about y", 5e-3, "rad");
  for (std::size_t k = kTilt; k < kOwn; ++k) parameters_[k].machine = false;
  std::map<std::pair<int, int>, std::size_t> series;
  for (const GeometryReading& r : readings_) {
    std::size_t at = kOwn;
    if (r.kind != GeometryReading::Kind::kPoint) {
      const bool bar = r.kind == GeometryReading::Kind::kBallBar;
      const auto [place, fresh] =
          series.try_emplace({static_cast<int>(r.kind), r.series}, parameters_.size());
      at = place->second;
      const std::string name = (bar ? "ball " : "gauge ") + std::to_string(r.series);
      if (fresh && bar)
        for (const char* axis : {" x", " y", " z"}) parameters_.push_back({name + axis, 1000, false, "mm"});
      else if (fresh)
        parameters_.push_back({name + " zero", 1000, false, "mm"});
    }
    series_at_.push_back(at);
    if (r.kind == GeometryReading::Kind::kPoint)
      for (const bool has : r.has) residual_count_ += has ? 1 : 0;
    else
      ++residual_count_;
    Commanded c;
    c.reached = believed_->inverse(Frame::kPart, r.commanded, c.joints).has_value();
    commanded_.push_back(c);
  }
}

std::vector<double> GeometryModel::start() const {
  std::vector<double> x(parameters_.size(), 0.0);
  std::vector<int> count(parameters_.size(), 0);
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const GeometryReading& r = readings_[i];
    const std::size_t at = series_at_[i];
    if (r.kind == GeometryReading::Kind::kGauge) {
      double along = 0;
      for (std::size_t k = 0; k < 3; ++k) along += r.direction[k] * r.commanded[k];
      x[at] += (r.value_mm[0] - along - x[at]) / ++count[at];
    } else if (r.kind == GeometryReading::Kind::kBallBar) {
      // The ball lies below the circle or sphere that the bar was led around; Newton finds the place.
      ++count[at];
      for (std::size_t k = 0; k < 3; ++k) x[at + k] += (r.commanded[k] - x[at + k]) / count[at];
    }
  }
  for (std::size_t i = 0; i < readings_.size(); ++i)
    if (readings_[i].kind == GeometryReading::Kind::kBallBar && count[series_at_[i]] > 0) {
      x[series_at_[i] + 2] -= readings_[i].value_mm[0] / 2;
      count[series_at_[i]] = 0;
    }
  return x;
}

MachineDeviation GeometryModel::deviation(const std::vector<double>& x) {
  MachineDeviation d;
  for (std::size_t i = 0; i < kLegs; ++i) {
    const double* p = x.data() + i * kPerLeg;
    d.geometry.legs[i] = {{p[0], p[1], p[2]}, {p[3], p[4], 0}, {p[5], p[6], p[7]}, p[8]};
    d.offset_mm[i] = p[9];
    d.scale[i] = p[10];
  }
  return d;
}

std::optional<std::array<double, 4>> GeometryModel::tool_at(const DeviatedMachine& machine,
                                                            const JointVector& joints,
                                                            const Pose& near) const {
  JointVector true_joints{};
  for (std::size_t i = 0; i < kLegs; ++i)
    true_joints[i] = joints[i] + machine.deviation.offset_mm[i] +
                     machine.deviation.scale[i] * (joints[i] - machine_.switch_mm[i]);
  PlatformPose platform = platform_at(machine.geometry, Frame::kPart, near);
  if (!(solve_platform(machine.legs, machine.fixed_tool, true_joints, platform) < kForwardTolerance_mm))
    return std::nullopt;
  const Pose pose = pose_at(machine.geometry, Frame::kPart, platform, 0, 0);
  return std::array<double, 4>{pose[kX], pose[kY], pose[kZ], pose[kA]};
}

std::optional<std::array<double, 4>> GeometryModel::tool(const MachineDeviation& deviation,
                                                         const Pose& commanded) const {
  JointVector joints{};
  if (!believed_->inverse(Frame::kPart, commanded, joints)) return std::nullopt;
  return tool_at(DeviatedMachine(machine_, deviation), joints, commanded);
}

std::optional<std::vector<double>> GeometryModel::residuals(const std::vector<double>& x) const {
  const DeviatedMachine machine(machine_, deviation(x));
  std::vector<double> out;
  out.reserve(residual_count_);
  for (std::size_t i = 0; i < readings_.size(); ++i) {
    const GeometryReading& r = readings_[i];
    if (!commanded_[i].reached) return std::nullopt;
    const auto t = tool_at(machine, commanded_[i].joints, r.commanded);
    if (!t) return std::nullopt;
    const double per_sigma = 1 / r.sigma_mm;
    const std::size_t at = series_at_[i];
    if (r.kind == GeometryReading::Kind::kPoint) {
      for (std::size_t k = 0; k < 3; ++k)
        if (r.has[k]) out.push_back((r.value_mm[k] - (*t)[k]) * per_sigma);
    } else if (r.kind == GeometryReading::Kind::kGauge) {
      // A table that is tilted in its bearing lifts a gauge that stands on it by its lever.
      const double z = (*t)[2] + x[kTilt] * (*t)[1] - x[kTilt + 1] * (*t)[0];
      const double along = r.direction[0] * (*t)[0] + r.direction[1] * (*t)[1] + r.direction[2] * z;
      out.push_back((r.value_mm[0] - along - x[at]) * per_sigma);
    } else {
      const double distance = std::hypot((*t)[0] - x[at], (*t)[1] - x[at + 1], (*t)[2] - x[at + 2]);
      out.push_back((r.value_mm[0] - distance) * per_sigma);
    }
  }
  return out;
}

std::optional<std::vector<double>> GeometryModel::jacobian(const std::vector<double>& x) const {
  std::vector<double> out(residual_count_ * x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    // A thousandth of what the parameter may be: far above the solver's rounding, far below its bends.
    const double h = std::min(1e-3 * parameters_[k].prior, 1e-2);
    std::vector<double> y = x;
    y[k] = x[k] + h;
    const auto high = residuals(y);
    y[k] = x[k] - h;
    const auto low = residuals(y);
    if (!high || !low) return std::nullopt;
    for (std::size_t i = 0; i < residual_count_; ++i)
      out[i * x.size() + k] = ((*high)[i] - (*low)[i]) / (2 * h);
  }
  return out;
}

}  // namespace kinebus
