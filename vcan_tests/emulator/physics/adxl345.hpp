#pragma once
// An ADXL345 behind SPI, with the readings of a plant: its registers, its queue in stream mode, and what its
// data sheet asks of who reads it.

#include <array>
#include <cstdint>
#include <deque>

#include "node_firmware/port/host/accelerometer_plant.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"

namespace kinebus::emulator {

class Adxl345Chip final : public SpiDevice {
 public:
  void select(bool selected, Cycle now) override;
  std::uint16_t exchange(std::uint16_t sent, Cycle now) override;
  /// It has lost its power: asleep, and set up by nobody.
  void reset();

  heat::AccelerometerPlant& plant() { return plant_; }
  /// Readings that nobody fetched in time.
  std::uint64_t lost() const { return lost_; }
  /// Looks at the queue too soon after a reading, and settings that are not modelled.
  std::uint64_t mistakes() const { return mistakes_; }

 private:
  std::uint8_t read(std::uint8_t address, Cycle now);
  void write(std::uint8_t address, std::uint8_t value, Cycle now);
  void measure(Cycle now);

  heat::AccelerometerPlant plant_;
  std::array<std::uint8_t, 64> registers_{};
  std::deque<heat::VibrationMeter::Reading> queue_;
  heat::VibrationMeter::Reading out_{};
  bool selected_ = false, first_ = true, reads_ = false, several_ = false, data_read_ = false;
  std::uint8_t address_ = 0;
  Cycle measured_ = 0, read_until_ = 0;
  std::uint64_t lost_ = 0, mistakes_ = 0;
};

}  // namespace kinebus::emulator
