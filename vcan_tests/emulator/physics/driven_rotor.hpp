#pragma once
// A stepper motor as its driver sees it: the field turns with the steps, the rotor follows as far as the
// current's torque goes, or slips by an electrical turn.

#include <cmath>
#include <cstdint>
#include <numbers>

namespace kinebus::emulator {

class DrivenRotor {
 public:
  void set_load(double nm) { load_nm_ = nm; }  ///< against every motion
  double load_nm() const { return load_nm_; }
  /// The carriage does not go beyond, counts from where it stood at power-up.
  void set_end_stop(double counts, bool above) { stops_ = true, stop_counts_ = counts, stop_above_ = above; }
  double counts() const { return rotor_; }

  /// The field goes on by `way` counts. Returns the load that is felt.
  double on_field(int way, double torque_nm) {
    field_ += way;
    const double field = static_cast<double>(field_) - slipped_;
    const double lag_limit = kElectricalTurn / 4;
    const double wanted = load_nm_ >= torque_nm
                              ? lag_limit
                              : std::asin(load_nm_ / torque_nm) * kElectricalTurn / (2 * std::numbers::pi);
    double rotor = field - (way > 0 ? wanted : -wanted);
    if (load_nm_ >= torque_nm) rotor = rotor_;
    double load = load_nm_;
    if (stops_ && (stop_above_ ? rotor > stop_counts_ : rotor < stop_counts_)) {
      rotor = stop_counts_;
      load = torque_nm;
    }
    // Half a turn behind, it falls back into the next place.
    if (std::abs(field - rotor) > kElectricalTurn / 2)
      slipped_ += field > rotor ? kElectricalTurn : -kElectricalTurn;
    rotor_ = rotor;
    return load;
  }

 private:
  static constexpr double kElectricalTurn = 1024;  // counts: microsteps of 1/256
  std::int64_t field_ = 0;
  double rotor_ = 0, slipped_ = 0, load_nm_ = 0, stop_counts_ = 0;
  bool stops_ = false, stop_above_ = true;
};

}  // namespace kinebus::emulator
