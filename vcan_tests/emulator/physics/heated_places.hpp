#pragma once
// What is heated on an emulated board: a hot end and a bed, with all that can break (HeatPlant), driven by
// the levels of two pins and felt by a converter.

#include "node_firmware/port/host/heat_plant.hpp"
#include "vcan_tests/emulator/cycle.hpp"

namespace kinebus::emulator {

class HeatedPlaces {
 public:
  static constexpr Cycle kStep = kCoreHz / 100;  // of ThermalPlant

  /// From `now` on.
  void set_power(bool hot_end, bool bed, Cycle now) {
    count(now);
    on_ = {hot_end, bed};
  }
  void set_contactor(bool closed) { contactor_ = closed; }
  Cycle next_event() const { return next_; }
  void advance(Cycle now) {
    while (now >= next_) {
      count(next_);
      plant_.hot_end().contactor = plant_.bed().contactor = contactor_;
      plant_.hot_end().step(static_cast<double>(on_time_[0]) / static_cast<double>(kStep));
      plant_.bed().step(static_cast<double>(on_time_[1]) / static_cast<double>(kStep));
      on_time_ = {};
      next_ += kStep;
    }
  }
  heat::HeatPlant& plant() { return plant_; }
  heat::ThermalPlant& hot_end() { return plant_.hot_end(); }
  heat::ThermalPlant& bed() { return plant_.bed(); }

 private:
  void count(Cycle now) {
    for (std::size_t i = 0; i < on_.size(); ++i)
      if (on_[i]) on_time_[i] += now - counted_;
    counted_ = now;
  }

  heat::HeatPlant plant_{7};
  std::array<bool, 2> on_{};
  std::array<Cycle, 2> on_time_{};
  bool contactor_ = false;
  Cycle counted_ = 0, next_ = kStep;
};

}  // namespace kinebus::emulator
