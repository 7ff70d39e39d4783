#pragma once
// A TMC2209 that is soldered to the board, in a DriverSocket's place: there is nothing to be found out, and
// no room for what speaks to other chips.

#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/step/tmc2209.hpp"

namespace kinebus::step {

class SolderedDriver {
 public:
  void set(const DriverSettings& settings) { chip_.set(settings); }
  void set_spoken_to(bool spoken_to) {
    if (spoken_to == spoken_to_) return;
    spoken_to_ = spoken_to;
    const DriverSettings settings = chip_.settings();
    chip_ = {};  // as after a reset
    chip_.set(settings);
  }
  void set_slow_motion(bool slow) { chip_.set_slow_motion(slow); }
  void acknowledge() { chip_.acknowledge(); }

  std::optional<Exchange> next(LocalTime now) { return spoken_to_ ? chip_.next(now) : std::nullopt; }
  void on_heard(const Exchange&, std::span<const std::uint8_t> bytes) { chip_.on_heard(bytes); }

  DriverState state() const { return spoken_to_ ? chip_.state() : DriverState::kStandsAlone; }
  bool usable() const { return !spoken_to_ || chip_.usable(); }
  bool busy() const { return spoken_to_ && chip_.busy(); }
  const tmc2209::Driver& chip() const { return chip_; }

 private:
  tmc2209::Driver chip_;
  bool spoken_to_ = true;
};

}  // namespace kinebus::step
