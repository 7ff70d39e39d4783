#pragma once
// Thermistor, resistance thermometer, heater, fans, the probe's servo and the accelerometer of the EBB. The
// ADC converts on and on and adds 256 results up by itself: no instruction takes part.

#include <array>
#include <cstdint>
#include <optional>

#include "node_firmware/board/adxl345.hpp"
#include "node_firmware/board/board_heat.hpp"
#include "node_firmware/board/max31865.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"
#include "node_firmware/port/stm32g0b1_ebb/spi_port.hpp"

namespace kinebus::g0b1 {

class HeatPort {
 public:
  static constexpr std::uint8_t kMax31865Sensors = 1;  // the first: TH0, or that
  static constexpr int kSensors = 1, kHeaters = 1, kFans = ebb::kFans.size();
  static constexpr std::array<std::uint8_t, 2> kFilamentInputs = ebb::kFilamentInputs;
  static constexpr std::uint8_t kProbeInput = ebb::kProbe;

  /// Conversions begin, and the servo's timer, without pulses. Before, and for ever on another chip, nothing
  /// is driven and nothing measured. False: the converter does not start.
  bool start();
  std::optional<std::uint32_t> take_ratio(int sensor);
  void set_heater(int, bool on) { drive(ebb::kHeater, on); }
  void set_fan(int fan, bool on) { drive(ebb::kFans[static_cast<std::size_t>(fan)], on); }
  /// The board has no switch for its supply.
  static void set_contactor(bool) {}
  /// nullptr: the board is not its own.
  Adxl345<SpiPort<Spi2>>* accelerometer() { return started_ ? &accelerometer_ : nullptr; }
  const Adxl345<SpiPort<Spi2>>* accelerometer() const { return started_ ? &accelerometer_ : nullptr; }
  Max31865<SpiPort<Spi1>>* max31865(int) { return started_ ? &max31865_ : nullptr; }
  /// Width of the pulses, us; 0: none. In force from the next on.
  void set_servo(std::uint16_t us) {
    if (started_) tim17().CCR[0] = us;
  }

 private:
  void drive(const stm32::OutputPin& pin, bool on) {
    if (started_) write(pin, on);
  }
  bool started_ = false;
  SpiPort<Spi2> accelerometer_spi_;
  Adxl345<SpiPort<Spi2>> accelerometer_{accelerometer_spi_};
  SpiPort<Spi1> max31865_spi_;
  Max31865<SpiPort<Spi1>> max31865_{max31865_spi_};
};
static_assert(HeatDriver<HeatPort>);

}  // namespace kinebus::g0b1
