#pragma once
// A tool that swings on its frame: two damped springs in each direction, driven by where the simulated motors
// have the tool. The truth that vibration is judged by, never what shaping assumes.

#include <array>
#include <cstdint>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

class FlexibleFrame {
 public:
  using Vector = std::array<double, 3>;  ///< X Y Z, mm

  /// How far the truth is from what the machine file says. Each direction has each sign by the seed.
  struct Error {
    double frequency = 0.10, damping = 0.30;
  };
  struct Mode {
    double frequency_hz = 0, damping_ratio = 0;
    double share = 1;  ///< of the tool's motion on this spring, of all its springs 1
  };
  using Modes = std::array<Mode, 2>;

  /// Directions for which the file states no frequency swing as one with 45 Hz and 10 % damping.
  static std::array<Modes, 3> truth(const VibrationDescription& assumed, const Error& error,
                                    std::uint64_t seed);

  /// One that nobody has described: 28 .. 75 Hz, 3 to 15 % damping, a second mode two to three times as fast.
  static std::array<Modes, 3> hidden(std::uint64_t seed);

  explicit FlexibleFrame(const std::array<Modes, 3>& modes) : modes_(modes) {}

  /// The tool as the motors have it, `dt_s` after the call before; between the two it moves in a straight
  /// line. The first call sets it down at rest.
  void move_to(const Vector& rigid_mm, double dt_s);
  const Vector& rigid_mm() const { return rigid_; }
  /// How far the tool is from there.
  const Vector& deflection_mm() const { return deflection_; }
  /// Of the tool itself, as something on it would feel it.
  Vector acceleration_mm_per_s2() const;
  /// Where a constant acceleration would hold it.
  Vector static_deflection_mm(const Vector& accel_mm_per_s2) const;
  const Mode& main_mode(std::size_t axis) const { return modes_[axis][0]; }

 private:
  /// Deviation of a mode from the moving frame, and its rate of change.
  struct State {
    double x = 0, v = 0;
  };
  std::array<Modes, 3> modes_;
  std::array<std::array<State, 2>, 3> states_{};
  Vector rigid_{}, speed_{}, deflection_{};
  bool placed_ = false;
};

}  // namespace kinebus
