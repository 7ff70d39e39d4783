#pragma once
// The BTT EBB36 or EBB42 v1.2, emulated: one TMC2209, whose steps are counted, a hot end, and switches, wired
// as node_firmware/port/stm32g0b1_ebb/board.hpp says.

#include <algorithm>
#include <array>
#include <cstdint>

#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"
#include "vcan_tests/emulator/physics/adxl345.hpp"
#include "vcan_tests/emulator/physics/heated_places.hpp"
#include "vcan_tests/emulator/physics/max31865.hpp"
#include "vcan_tests/emulator/physics/pulled_wire.hpp"
#include "vcan_tests/emulator/physics/tmc2209.hpp"
#include "vcan_tests/emulator/servo_pulses.hpp"
#include "vcan_tests/emulator/stm32g0b1_chip.hpp"

namespace kinebus::emulator {

class EbbBoard : public Stm32g0b1Chip {
 public:
  static constexpr double kCountsPerStep = 16;

  EbbBoard(const ElfImage& image, const BoardOptions& options) : EbbBoard(image, options, kG0B1) {}
  /// With another chip in the G0B1's place.
  EbbBoard(const ElfImage& image, const BoardOptions& options, std::uint32_t device_id);
  ~EbbBoard() override;

  std::uint32_t product_code() const override;
  /// With a boot loader, which looks through the program first.
  BusTime boot_time() const override { return std::chrono::milliseconds{350}; }
  /// Where the rotor is.
  double true_counts(int axis) const override;
  /// 0: probe, 1: filament (PB4), 2: PB3.
  void set_input(int input, bool level) override;
  const StepDriver& driver() const { return driver_; }
  Tmc2209& tmc() { return tmc_; }
  const g0::Usart& usart() const { return usart2_; }
  void clear_edges() { driver_.clear_edges(); }
  /// The hot end at its clamps and TH0, or the MAX31865.
  HeatedPlaces& heated() { return heated_; }
  bool heater_on() const;
  Adxl345Chip& accelerometer() { return accelerometer_; }
  const Spi& spi() const { return spi2_; }
  /// What is plugged into the hot end's place hangs on it, or on TH0: the other is open.
  Max31865Chip& max31865() { return max31865_; }
  const Spi& max31865_spi() const { return spi1_; }
  bool fan_on(int fan) const;
  ServoPulses servo();
  /// A pin that gives power to something is driven, and not to its level without.
  bool anything_on() const;

 private:
  void reset_devices(Cycle now) override;
  void advance_devices(Cycle now) override;
  Cycle next_of_devices() const override {
    return std::min({heated_.next_event(), spi1_.next_event(), spi2_.next_event(), tmc_.next_event(),
                     wire_.next_event()});
  }
  void on_pins(Cycle now);
  void look_at_wire(Cycle now);

  StepDriver driver_;
  Tmc2209 tmc_;
  PulledWire wire_;
  HeatedPlaces heated_;
  Adxl345Chip accelerometer_;
  Max31865Chip max31865_;
  Spi spi1_, spi2_;
};

/// With the program of a heat node.
class EbbHeatBoard final : public EbbBoard {
 public:
  using EbbBoard::EbbBoard;
  std::uint32_t product_code() const override;
};

}  // namespace kinebus::emulator
