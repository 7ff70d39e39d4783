// M956: the accelerometer of the tool. What it has felt comes as text, for kinebus tune vibration.

#include "gateway/machine/core.hpp"

namespace kinebus {

/// Begun while nothing runs: bring-up would end it. Ended whenever somebody likes.
Result<std::string, Refusal> Gateway::Core::vibration(std::optional<double> what) {
  using Found = VibrationFound::Stage;
  VibrationSensor* const sensor = devices_.accelerometer();
  if (sensor == nullptr)
    return refused(
        say("the machine has no accelerometer: [accelerometer] of the machine file names its node"));
  if (auto absent = sensor->absent()) return refused(std::move(*absent));
  const VibrationFound& found = sensor->found();
  if (what && *what != 0 && *what != 1) return refused(say("M956 S1 begins to measure, S0 ends it"));
  if (what && *what == 1) {
    if (!state_.is_one_of(MachineState::kReady, MachineState::kUnhomed))
      return refused(say("a measurement begins while nothing runs"));
    sensor->begin();
    return std::string();
  }
  if (what) {
    if (found.stage != Found::kMeasures) return refused(say("nothing is measured: M956 S1 begins it"));
    sensor->end();
    return std::string();
  }
  switch (found.stage) {
    case Found::kNone:
      return std::string("nothing measured");
    case Found::kMeasures:
      return std::string("measuring");
    case Found::kReads:
      return std::string("reading");
    case Found::kFailed:
      return refused(found.failure);
    case Found::kDone:
      break;
  }
  std::string text = printed("rate_hz %.3f", found.rate_hz) + " windows " + std::to_string(found.windows) +
                     " clipped " + std::to_string(found.clipped);
  for (const auto& band : found.energy)
    text += printed("\n%.6g", band[0]) + printed(",%.6g", band[1]) + printed(",%.6g", band[2]);
  return text;
}

}  // namespace kinebus
