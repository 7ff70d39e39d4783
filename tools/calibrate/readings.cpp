#include "tools/calibrate/readings.hpp"

#include <cmath>

#include "protocol/joblink/shown_text.hpp"
#include "tools/calibrate/hidden.hpp"

namespace kinebus {

Result<std::map<std::string, std::vector<RailSample>>, CsvError> rail_samples(
    const Csv& csv, const MachineDescription& machine) {
  std::map<std::string, std::vector<RailSample>> out;
  std::map<std::string, double> last;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const std::string name = csv.word(row, "joint");
    const JointDescription* joint = nullptr;
    for (std::size_t i = 0; i < machine.joints.size(); ++i)
      if (machine.joints[i].name == name || std::to_string(i + 1) == name) joint = &machine.joints[i];
    if (joint == nullptr)
      return Error<CsvError>(
          {csv.line(row), "joint \"" + std::string(cut_text(name, 40)) + "\" is none of the machine's"});
    const auto commanded = csv.quantity(row, "commanded"), measured = csv.quantity(row, "measured");
    if (!commanded) return Error<CsvError>(commanded.error());
    if (!measured) return Error<CsvError>(measured.error());
    RailSample s{*commanded, *measured, 1};
    if (csv.has("direction")) {
      const auto direction = csv.plain(row, "direction");
      if (!direction) return Error<CsvError>(direction.error());
      s.direction = *direction < 0 ? -1 : 1;
    } else if (const auto before = last.find(joint->name); before != last.end()) {
      s.direction = s.commanded < before->second ? -1 : 1;
    }
    last[joint->name] = s.commanded;
    s.commanded = drive_from_home(*joint, s.commanded, s.direction) + anchor_of(*joint);
    out[joint->name].push_back(s);
  }
  return out;
}

Result<std::vector<GeometryReading>, CsvError> geometry_readings(const Csv& csv) {
  std::vector<GeometryReading> out;
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    GeometryReading r;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = csv.quantity(row, kAxes[k]);
      if (!v) return Error<CsvError>(v.error());
      r.commanded[k] = *v;
    }
    if (csv.has("a")) {
      const auto a = csv.quantity(row, "a");
      if (!a) return Error<CsvError>(a.error());
      r.commanded[kA] = *a;
    }
    if (csv.has("series")) {
      const auto series = csv.plain(row, "series");
      if (!series) return Error<CsvError>(series.error());
      r.series = static_cast<int>(std::lround(std::min(1e6, std::max(-1e6, *series))));
    }
    if (csv.has("noise")) {
      const auto noise = csv.quantity(row, "noise");
      if (!noise) return Error<CsvError>(noise.error());
      if (!(*noise > 0)) return Error<CsvError>({csv.line(row), "noise must be above 0"});
      r.sigma_mm = *noise;
    }
    if (!csv.word(row, "gauge").empty()) {
      const auto gauge = csv.quantity(row, "gauge");
      if (!gauge) return Error<CsvError>(gauge.error());
      r.kind = GeometryReading::Kind::kGauge;
      r.value_mm[0] = *gauge;
      const std::string axis = csv.word(row, "axis");
      if (axis != "X" && axis != "Y" && axis != "Z")
        return Error<CsvError>({csv.line(row), "axis of the gauge: expected X, Y or Z"});
      r.direction = {axis == "X" ? 1.0 : 0, axis == "Y" ? 1.0 : 0, axis == "Z" ? 1.0 : 0};
    } else if (!csv.word(row, "bar").empty()) {
      const auto bar = csv.quantity(row, "bar");
      if (!bar) return Error<CsvError>(bar.error());
      r.kind = GeometryReading::Kind::kBallBar;
      r.value_mm[0] = *bar;
    } else {
      bool any = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::string name = std::string("measured_") + kAxes[k];
        r.has[k] = !csv.word(row, name).empty();
        if (!r.has[k]) continue;
        const auto v = csv.quantity(row, name);
        if (!v) return Error<CsvError>(v.error());
        r.value_mm[k] = *v;
        any = true;
      }
      if (!any)
        return Error<CsvError>(
            {csv.line(row), "nothing measured: expected measured_x_mm .., gauge_mm or bar_mm"});
    }
    out.push_back(r);
  }
  return out;
}

std::optional<BelievedMachine> believed(const MachineDescription& machine) {
  BelievedMachine b;
  if (const auto* m1 = std::get_if<M1Geometry>(&machine.kinematics))
    b.geometry = *m1;
  else if (const auto* m5 = std::get_if<M5Geometry>(&machine.kinematics))
    b.geometry = *m5;
  else
    return std::nullopt;
  b.geometry = corrected(b.geometry, machine.geometry_calibration.value_or(M1Correction{}));
  for (std::size_t i = 0; i < 4; ++i) b.switch_mm[i] = anchor_of(machine.joints[i]);
  return b;
}

namespace {
/// A nanometre, a nanoradian: what a person can still read in the file.
double rounded(double v, double digit) {
  return std::round(v / digit) * digit;
}
constexpr double kLength_mm = 1e-6, kRatio = 1e-9;
}  // namespace

void apply(const RailFit& fit, JointCalibration& calibration) {
  const double offset = calibration.offset;
  calibration = fit.calibration;
  calibration.offset = offset;
  calibration.scale = rounded(calibration.scale, kRatio);
  for (double* v : {&calibration.backlash, &calibration.periodic_sine, &calibration.periodic_cosine,
                    &calibration.table_start, &calibration.table_step})
    *v = rounded(*v, kLength_mm);
  for (double& v : calibration.table) v = rounded(v, kLength_mm);
}

void apply(const MachineDeviation& d, MachineDescription& machine) {
  if (!machine.geometry_calibration) machine.geometry_calibration.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    M1LegCorrection& leg = machine.geometry_calibration->legs[i];
    const M1LegCorrection& found = d.geometry.legs[i];
    for (std::size_t k = 0; k < 3; ++k) {
      leg.foot_mm[k] = rounded(leg.foot_mm[k] + found.foot_mm[k], kLength_mm);
      leg.rail[k] = rounded(leg.rail[k] + found.rail[k], kRatio);
      leg.attachment_mm[k] = rounded(leg.attachment_mm[k] + found.attachment_mm[k], kLength_mm);
    }
    leg.length_mm = rounded(leg.length_mm + found.length_mm, kLength_mm);
    JointCalibration& c = machine.joints[i].calibration;
    c.offset = rounded(c.offset + d.offset_mm[i], kLength_mm);
    c.scale = rounded((1 + c.scale) * (1 + d.scale[i]) - 1, kRatio);
  }
}

}  // namespace kinebus
