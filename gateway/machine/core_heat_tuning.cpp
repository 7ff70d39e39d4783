// A heater that its node measures: begun, told of, and asked for by M303.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

/// A letter's number in the rest of a line; none: the letter is not there, or has none.
std::optional<double> number_after(std::string_view text, char letter) {
  text = text.substr(0, text.find_first_of(";("));
  const std::size_t at = text.find_first_of(
      std::string{letter, static_cast<char>(std::tolower(static_cast<unsigned char>(letter)))});
  if (at == std::string_view::npos) return std::nullopt;
  const std::string rest(text.substr(at + 1, 24));
  char* end = nullptr;
  const double value = std::strtod(rest.c_str(), &end);
  return end != rest.c_str() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string tenths(double value) {
  return printed("%.1f", value);
}

}  // namespace

Result<void, Refusal> Gateway::Core::on(command::TuneHeater& asked) {
  if (interrupted())
    return refused(say("an interrupted job waits: cancel it, or resume it, before a heater is measured"));
  if (auto begun = heat_.tune(asked.heater, asked.celsius); !begun) return begun;
  heat_idle_since_ = now_;
  tuned_ = asked.heater;
  tuning_told_ = TuningStage::kNone;
  return {};
}

void Gateway::Core::tell_of_tuning() {
  if (!tuned_) return;
  const HeaterTuning tuning = heat_.tuning(*tuned_);
  if (tuning.stage == tuning_told_) return;
  tuning_told_ = tuning.stage;
  const HeaterDescription* heater = machine_.heater(*tuned_);
  const std::string name = "heater." + (heater != nullptr ? heater->name : std::string());
  const HeaterModel& m = tuning.model;
  switch (tuning.stage) {
    case TuningStage::kHeats:
      events_.message(now_, say("%1 is measured, to be good at %2 C: full power for half of the way", name,
                                std::lround(tuning.celsius)));
      return;
    case TuningStage::kCools:
      events_.message(now_, say("%1: the power is off, its curve is followed", name));
      return;
    case TuningStage::kFailed:
      tuned_.reset();
      events_.message(now_, say("%1 was not measured: %2", name, tuning.failure));
      return;
    case TuningStage::kDone:
      tuned_.reset();
      events_.message(
          now_, say("%1: at %2 W it has %3 J/K, a dead time of %4 s, a lag of %5 s, and loses %6 W/K", name,
                    tenths(m.power_w), tenths(m.capacity_j_per_k), printed("%.2f", m.dead_s),
                    printed("%.2f", m.lag_s), printed("%.3f", m.loss_w_per_k)));
      if (!tuning.failure.empty()) events_.message(now_, say("%1: %2", name, tuning.failure));
      return;
    default:
      return;
  }
}

/// Each time that one is to heat: what its node knows of it is what it is watched by.
void Gateway::Core::tell_of_the_unmeasured() {
  unmeasured_told_.resize(machine_.heaters.size());
  for (std::size_t i = 0; i < machine_.heaters.size(); ++i) {
    const HeaterDescription& heater = machine_.heaters[i];
    const HeaterStatus status = devices_.heater(heater.id());
    const bool tell = status.target_celsius > 0 && status.measured == Measured::kNotYet;
    if (tell && !unmeasured_told_[i])
      events_.message(now_, say("%1 was never measured: a heater or sensor that has slipped half out of its "
                                "hole may stay unseen. Measure it: tune, or M303",
                                "heater." + heater.name));
    unmeasured_told_[i] = tell;
  }
}

/// Marlin: E, -1 the bed, -2 the chamber; RepRapFirmware: H, 0 the bed, then hot ends, or T; others: P, a hot
/// end. S: the temperature. Cycles (C) and what to do with the result (U) need no word: one heating-up
/// measures it, and it is kept.
Result<std::string, Refusal> Gateway::Core::measure_heater(std::string_view words) {
  const auto e = number_after(words, 'E'), h = number_after(words, 'H'), t = number_after(words, 'T');
  const auto p = number_after(words, 'P');
  const double which = h ? *h - 1 : e ? *e : t ? *t : p.value_or(0);
  if (which != std::floor(which) || which < -2 || which > 254)
    return refused(
        say("M303 names a heater by a whole number: E0 or H1 the first hot end, E-1 or H0 the bed"));
  command::TuneHeater asked;
  asked.heater = which == -1   ? kFirstBed
                 : which == -2 ? HeaterId{HeaterKind::kChamber, 0}
                               : HeaterId{HeaterKind::kHotend, static_cast<std::uint8_t>(which)};
  asked.celsius = number_after(words, 'S').value_or(0);
  if (auto begun = carry_out(asked); !begun) return Error<Refusal>(begun.error());
  return std::string();
}

}  // namespace kinebus
