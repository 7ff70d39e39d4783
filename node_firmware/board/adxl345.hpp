#pragma once
// An ADXL345 behind SPI: 3200 readings a second into its queue of 32, emptied every 5 ms into the heat node's
// meter. Without one, or when it falls silent, it is looked for again.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/board/byte_bus.hpp"
#include "node_firmware/heat/vibration_meter.hpp"

namespace kinebus {

template <ByteBus Bus>
class Adxl345 {
 public:
  static constexpr std::uint32_t kCount_um_per_s2 = 38'246;  ///< 3.9 mg, to 16 g
  static constexpr std::int16_t kRange = 4095;

  explicit constexpr Adxl345(Bus& bus) : bus_(bus) {}

  heat::VibrationUnit& unit() { return meter_; }
  bool due(LocalTime now) const { return now >= due_; }
  /// When due: takes what it has measured, 0.5 ms of talk at most.
  void serve(LocalTime now) {
    due_ = now + kPeriod;
    std::size_t count = 0;
    if (found_) {
      count = read_queue();
      if (count != 0) heard_ = now;
      found_ = now - heard_ < heat::VibrationMeter::kPatience;
    } else if (now >= look_) {
      look_ = now + heat::VibrationMeter::kPatience;
      found_ = set_up();
      heard_ = now;
    }
    meter_.on_readings(now, std::span(readings_).first(count));
  }

 private:
  // As the data sheet names and numbers them.
  enum Register : std::uint8_t {
    kDeviceId = 0x00,
    kRate = 0x2C,
    kPowerControl = 0x2D,
    kDataFormat = 0x31,
    kData = 0x32,
    kQueueControl = 0x38,
    kQueueStatus = 0x39
  };
  static constexpr std::uint8_t kRead = 0x80, kSeveral = 0x40, kOwnId = 0xE5;
  static constexpr std::uint8_t k3200Hz = 0x0F, kFullResolution16g = 0x0B, kStream = 0x80, kMeasure = 0x08;
  static constexpr std::size_t kQueue = 32;
  static constexpr LocalTime kPeriod = std::chrono::milliseconds{5};
  // From the end of a reading to the next look at the queue.
  static constexpr unsigned kBetween_us = 5;

  std::optional<std::uint8_t> read(Register from) {
    std::array<std::uint8_t, 1> byte{};
    if (!talk(bus_, static_cast<std::uint8_t>(from | kRead), byte)) return std::nullopt;
    return byte[0];
  }
  bool write(Register to, std::uint8_t value) {
    std::array<std::uint8_t, 1> byte{value};
    return talk(bus_, to, byte);
  }
  bool set_up() {
    if (read(kDeviceId) != kOwnId) return false;
    // Still while it is set up; and its queue empty.
    return write(kPowerControl, 0) && write(kRate, k3200Hz) && write(kDataFormat, kFullResolution16g) &&
           write(kQueueControl, 0) && write(kQueueControl, kStream) && write(kPowerControl, kMeasure);
  }
  std::size_t read_queue() {
    const auto status = read(kQueueStatus);
    // One more may be in its output registers. Lines that nobody drives say 63.
    const std::size_t there = status ? *status & 0x3Fu : 0u;
    if (there > kQueue + 1) return 0;
    std::size_t count = 0;
    for (; count < there; ++count) {
      std::array<std::uint8_t, 6> bytes{};
      if (!talk(bus_, kData | kRead | kSeveral, bytes)) break;
      for (std::size_t axis = 0; axis < 3; ++axis)
        readings_[count][axis] = static_cast<std::int16_t>(bytes[2 * axis] | bytes[2 * axis + 1] << 8);
      bus_.wait_us(kBetween_us);
    }
    return count;
  }

  Bus& bus_;
  heat::VibrationMeter meter_{kCount_um_per_s2, kRange};
  std::array<heat::VibrationMeter::Reading, kQueue + 1> readings_{};
  bool found_ = false;
  LocalTime due_{0}, look_{0}, heard_{0};
};

}  // namespace kinebus
