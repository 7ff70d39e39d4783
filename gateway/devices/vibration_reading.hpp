#pragma once
// An accelerometer on a heat node, seen from the gateway: 2271h begins and ends a measurement, 2272h to 2278h
// are read when it has ended, a band after the other. Who asks the node is the link; what it asks next and
// what the answers mean is here.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "gateway/devices/device.hpp"
#include "gateway/devices/heat_node_tuning.hpp"
#include "protocol/canopen/heat_units.hpp"

namespace kinebus {

class VibrationReading {
 public:
  using Question = HeatNodeTuning::Question;
  static constexpr BusTime kSilence = HeatNodeTuning::kSilence;

  /// `axes`: which of the chip's directions lie along X, Y and Z.
  explicit VibrationReading(std::array<std::uint8_t, 3> axes = {0, 1, 2}) : axes_(axes) {}

  void begin(BusTime now);
  /// What was found so far is read; has no effect unless it measures.
  void end();
  /// Has no effect unless it is under way.
  void fail(Sentence why);
  const VibrationFound& found() const { return found_; }

  /// None: nothing is due.
  std::optional<Question> next(BusTime now) const;
  /// To the last question. `value`: what was read.
  void on_answer(BusTime now, AbortCode code, std::uint32_t value);

 private:
  using Stage = VibrationFound::Stage;
  void take_fact(std::uint32_t value);
  void take_energy(std::uint32_t value);

  std::array<std::uint8_t, 3> axes_;
  VibrationFound found_;
  bool begun_ = false, ended_ = false;  ///< the node has been told
  BusTime due_{0}, heard_{0};
  std::size_t read_ = 0;  ///< of the facts, then of all questions for bands
  double count_mm_per_s2_ = 0;
  std::array<int, 3> exponents_{};
};

}  // namespace kinebus
