#pragma once
// Thermistors, heaters and fans of the Octopus. ADC3 converts all inputs round and round, and DMA2 puts what
// it says into a buffer: no instruction takes part.

#include <array>
#include <cstdint>
#include <optional>

#include "node_firmware/board/board_heat.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"

namespace kinebus::stm32 {

class HeatPort {
 public:
  static constexpr int kSensors = octopus::kThermistors.size(), kHeaters = octopus::kHeaterPins.size(),
                       kFans = octopus::kFanPins.size();
  static constexpr std::array<std::uint8_t, 2> kFilamentInputs = octopus::kFilamentInputs;
  static constexpr std::uint8_t kProbeInput = octopus::kProbe;

  /// Conversions begin, and the servo's timer, without pulses.
  void start();
  std::optional<std::uint32_t> take_ratio(int sensor);
  static void set_heater(int heater, bool on) {
    write(octopus::kHeaterPins[static_cast<std::size_t>(heater)], on);
  }
  static void set_fan(int fan, bool on) { write(octopus::kFanPins[static_cast<std::size_t>(fan)], on); }
  static void set_contactor(bool on) { write(octopus::kContactorPin, on); }
  /// Width of the pulses, us; 0: none. In force from the next on.
  static void set_servo(std::uint16_t us) { tim4().CCR[0] = us; }

 private:
  // 480 clocks to sample and 12 to convert, at 10.5 MHz: 47 us. 16 rounds of 5 inputs take 3.8 ms, within a
  // sample's 10 ms.
  static constexpr std::size_t kRounds = 16;
  static constexpr std::uint16_t kTaken = 0xFFFF;  // no conversion says so

  // Written by DMA.
  std::array<volatile std::uint16_t, kRounds * octopus::kThermistors.size()> words_{};
};
static_assert(HeatDriver<HeatPort>);

}  // namespace kinebus::stm32
