#include "tools/tune/tune_vibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gateway/description/machine_file.hpp"
#include "tools/drawing/chart.hpp"
#include "tools/simulation/accelerometer.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus {
namespace {

using nlohmann::json;

constexpr double kBand_hz = 0.5;
// Of the plan: readings may come at any rate.
constexpr double kPlanned_s = 1e-3;

Bands bands_of(const Excitation& e) {
  // The sweep's ends are only half shaken.
  const double from = e.from_hz + 1, to = e.to_hz - 1;
  return {from, kBand_hz, static_cast<std::size_t>(std::max(0.0, (to - from) / kBand_hz))};
}

std::vector<double> column(const AccelerationReadings& readings, std::size_t axis) {
  std::vector<double> values;
  values.reserve(readings.mm_per_s2.size());
  for (const auto& reading : readings.mm_per_s2) values.push_back(reading[axis]);
  return values;
}

Result<VibrationFit, std::string> fit_recording(const Bands& bands, std::vector<double> planned,
                                                const AccelerationReadings& readings, std::size_t axis) {
  return fit_vibration(bands, energy_spectrum(std::move(planned), kPlanned_s, bands),
                       energy_spectrum(column(readings, axis), readings.period_s, bands));
}

AxisVibration found(const ShaperRating& r) {
  // As many digits as a person would write.
  return {r.kind, std::round(10 * r.frequency_hz) / 10, std::round(1000 * r.damping_ratio) / 1000};
}

json json_of(const ShaperRating& r) {
  return {{"shaper", shaper_name(r.kind)},        {"frequency_hz", r.frequency_hz},
          {"damping_ratio", r.damping_ratio},     {"vibration_left_worst", r.left},
          {"vibration_left", r.left_as_measured}, {"deviation_um", 1000 * r.deviation_mm},
          {"accel_mm_per_s2", r.accel_mm_per_s2}};
}

}  // namespace

Result<VibrationTuning, std::string> tune_vibration(
    const MachineDescription& machine, const TuneVibration& how,
    const std::array<std::optional<VibrationRecording>, 3>& readings) {
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) return Error<std::string>(kinematics.error().what.english());
  VibrationTuning tuning;
  tuning.machine = machine;
  tuning.shared = turns_part(**kinematics);
  ShaperQuestion question;
  question.accel_mm_per_s2 = machine.path.tool_accel_mm_per_s2;
  question.deviation_mm = how.deviation_mm > 0 ? how.deviation_mm : machine.vibration.deviation_mm;
  question.slowest_rate = how.slowest_rate > 0 ? how.slowest_rate : machine.vibration.slowest_rate;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    AxisTuning& axis = tuning.axes[i];
    if (!readings[i]) {
      axis.problem = "not measured";
      continue;
    }
    Excitation excitation = how.excitation;
    excitation.axis = i;
    const NodeSpectrum* const summed = std::get_if<NodeSpectrum>(&*readings[i]);
    Bands bands = bands_of(excitation);
    if (summed != nullptr)
      bands = summed->bands(bands.from_hz, bands.from_hz + bands.width_hz * static_cast<double>(bands.count));
    if (bands.count < 10) return Error<std::string>("a sweep over at least 10 Hz is needed");
    const double period_s = summed != nullptr ? summed->period_s() : kPlanned_s;
    std::vector<double> planned = planned_acceleration(machine, **kinematics, excitation, period_s);
    if (planned.empty()) return Error<std::string>("this machine cannot plan the excitation");
    auto fit =
        summed != nullptr
            ? fit_vibration(bands, as_the_node(planned, *summed, bands), summed->of(i, bands))
            : fit_recording(bands, std::move(planned), std::get<AccelerationReadings>(*readings[i]), i);
    if (!fit) {
      axis.problem = fit.error();
      continue;
    }
    axis.fit = std::move(*fit);
    if (tuning.shared)
      question.axes.push_back(axis.fit->modes);
    else
      question.axes = {axis.fit->modes};
    axis.ratings = rate_shapers(question);
  }
  VibrationDescription& v = tuning.machine.vibration;
  bool any = false;
  for (AxisTuning& axis : tuning.axes) {
    if (!axis.fit) continue;
    if (tuning.shared) axis.ratings = rate_shapers(question);
    axis.best = static_cast<std::size_t>(&best_shaper(axis.ratings) - axis.ratings.data());
    any = true;
  }
  if (!any) return tuning;
  v.deviation_mm = question.deviation_mm;
  v.slowest_rate = question.slowest_rate;
  if (tuning.shared) {
    for (const AxisTuning& axis : tuning.axes)
      if (axis.fit) v.every = found(axis.ratings[axis.best]);
    v.x = v.y = v.z = std::nullopt;
    return tuning;
  }
  std::optional<AxisVibration>* const own[] = {&v.x, &v.y, &v.z};
  for (std::size_t i = 0; i < tuning.axes.size(); ++i)
    if (tuning.axes[i].fit) *own[i] = found(tuning.axes[i].ratings[tuning.axes[i].best]);
  return tuning;
}

Result<AccelerationReadings, std::string> shake_simulated(const MachineDescription& machine,
                                                          const Excitation& excitation,
                                                          const std::array<FlexibleFrame::Modes, 3>& truth,
                                                          std::uint64_t seed) {
  const std::string text = excitation_job(machine, excitation);
  FlexibleFrame frame(truth);
  Accelerometer accelerometer({}, seed);
  AccelerationReadings readings;
  SimulateOptions options;
  options.simulation.seed = seed;
  readings.period_s = to_seconds(options.simulation.sample_period);
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    frame.move_to({sample.pose[kX], sample.pose[kY], sample.pose[kZ]},
                  readings.mm_per_s2.empty() ? 0 : readings.period_s);
    readings.mm_per_s2.push_back(accelerometer.read(frame.acceleration_mm_per_s2()));
  };
  StringSource same(text);
  const SimulationReport report = simulate(machine, std::make_unique<StringSource>(text), same, options);
  if (!report.finished)
    return Error<std::string>(report.outcome +
                              (report.messages.empty() ? "" : ": " + report.messages.front()));
  return readings;
}

json to_json(const VibrationTuning& tuning) {
  json axes = json::object();
  for (std::size_t i = 0; i < tuning.axes.size(); ++i) {
    const AxisTuning& axis = tuning.axes[i];
    json& out = axes[std::string(1, "XYZ"[i])];
    if (!axis.fit) {
      out = {{"problem", axis.problem}};
      continue;
    }
    json modes = json::array(), ratings = json::array(), spectrum = json::array();
    for (const FittedMode& m : axis.fit->modes)
      modes.push_back(
          {{"frequency_hz", m.frequency_hz}, {"damping_ratio", m.damping_ratio}, {"share", m.share}});
    for (const ShaperRating& r : axis.ratings) ratings.push_back(json_of(r));
    const Bands& bands = axis.fit->bands;
    for (std::size_t b = 0; b < bands.count; ++b)
      spectrum.push_back({bands.middle_hz(b), axis.fit->measured[b], axis.fit->modelled[b]});
    out = {{"modes", modes},
           {"fit_error_db", axis.fit->error_db},
           {"recommended", json_of(axis.ratings[axis.best])},
           {"shapers", ratings},
           {"spectrum_hz_measured_modelled", spectrum}};
  }
  return {{"axes", axes}, {"one_shaper_for_all", tuning.shared}};
}

std::string to_table(const VibrationTuning& tuning) {
  std::string text;
  const auto shapers = [&text](const AxisTuning& axis) {
    text += fmt::format("  {:8} {:>8} {:>10} {:>14} {:>13} {:>18}\n", "shaper", "Hz", "left", "left at worst",
                        "off the path", "acceleration");
    for (const ShaperRating& r : axis.ratings)
      text += fmt::format("{} {:8} {:8.1f} {:8.1f} % {:12.1f} % {:10.1f} um {:10.0f} mm/s^2\n",
                          &r == &axis.ratings[axis.best] ? '*' : ' ', shaper_name(r.kind), r.frequency_hz,
                          100 * r.left_as_measured, 100 * r.left, 1000 * r.deviation_mm, r.accel_mm_per_s2);
  };
  const AxisTuning* last = nullptr;
  for (std::size_t i = 0; i < tuning.axes.size(); ++i) {
    const AxisTuning& axis = tuning.axes[i];
    if (!axis.fit) {
      text += fmt::format("{}: {}\n", "XYZ"[i], axis.problem);
      continue;
    }
    const double last_hz = axis.fit->bands.middle_hz(axis.fit->bands.count - 1);
    for (const FittedMode& m : axis.fit->modes)
      text += fmt::format("{}: swings at {:.2f} Hz, damping ratio {:.3f}, {:.0f} % of the motion{}\n",
                          "XYZ"[i], m.frequency_hz, m.damping_ratio, 100 * m.share,
                          m.frequency_hz > last_hz ? " (a guess: beyond what was shaken)" : "");
    text += fmt::format("   the spectrum is within {:.1f} dB rms of that\n", axis.fit->error_db);
    last = &axis;
    if (!tuning.shared) shapers(axis);
  }
  if (tuning.shared && last != nullptr) {
    text += "X, Y and Z share a shaper, as the machine turns or tilts the part:\n";
    shapers(*last);
  }
  return text;
}

std::string draw_tuning(const VibrationTuning& tuning) {
  using drawing::Point;
  constexpr double kRow = 300, kTop = 120;
  constexpr std::string_view kMeasured = "#c9a27a", kFitted = "#29788e", kShaped = "#c0392b";
  const auto rows = std::count_if(tuning.axes.begin(), tuning.axes.end(),
                                  [](const AxisTuning& a) { return a.fit.has_value(); });
  drawing::Document document(1100, kTop + kRow * static_cast<double>(std::max<std::ptrdiff_t>(rows, 1)));
  document.heading(
      40, "Vibration of " + tuning.machine.name,
      "How many times its frame's acceleration the tool feels; red: what the shaper lets through");
  double top = kTop;
  for (std::size_t i = 0; i < tuning.axes.size(); ++i) {
    const AxisTuning& axis = tuning.axes[i];
    if (!axis.fit) continue;
    const VibrationFit& fit = *axis.fit;
    const ShaperRating& r = axis.ratings[axis.best];
    const InputShaper shaper = make_shaper(
        r.kind,
        frequency_for_rates(r.kind, r.frequency_hz, r.damping_ratio, tuning.machine.vibration.slowest_rate),
        r.damping_ratio);
    std::vector<Point> measured, modelled, shaped;
    double highest = 1;
    for (std::size_t b = 0; b < fit.bands.count; ++b) {
      const double f = fit.bands.middle_hz(b);
      measured.push_back({f, fit.measured[b]});
      modelled.push_back({f, fit.modelled[b]});
      shaped.push_back({f, fit.modelled[b] * residual_vibration(shaper, f, 0)});
      highest = std::max({highest, fit.measured[b], fit.modelled[b]});
    }
    const double y_step = drawing::round_step(highest, 5);
    const drawing::Chart chart{
        .area = {90, top, 960, 200},
        .x_low = fit.bands.from_hz,
        .x_high = fit.bands.from_hz + fit.bands.width_hz * static_cast<double>(fit.bands.count),
        .y_low = 0,
        .y_high = y_step * std::ceil(highest / y_step)};
    const std::string title = fmt::format("{}: {:.1f} Hz, damping ratio {:.3f}", "XYZ"[i],
                                          fit.modes[0].frequency_hz, fit.modes[0].damping_ratio);
    drawing::draw_frame(document, chart, {.x_step = 10, .y_step = y_step, .title = title, .x_name = "Hz"});
    drawing::draw_points(document, chart, measured, kMeasured);
    drawing::draw_curve(document, chart, modelled, kFitted, 2);
    drawing::draw_curve(document, chart, shaped, kShaped, 1.5);
    const drawing::LegendEntry legend[] = {
        {"measured", kMeasured},
        {"fitted", kFitted},
        {fmt::format("{} at {:.1f} Hz", shaper_name(r.kind), r.frequency_hz), kShaped}};
    drawing::draw_legend(document, {1050, top - 12}, legend);
    top += kRow;
  }
  return document.svg();
}

}  // namespace kinebus
