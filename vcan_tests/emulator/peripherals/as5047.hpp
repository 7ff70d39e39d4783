#pragma once
// A magnetic encoder of the AS5047 kind: 14 bits a turn, frames with even parity, the answer to a command in
// the frame that follows it.

#include <functional>

#include "vcan_tests/emulator/peripherals/spi.hpp"

namespace kinebus::emulator {

class As5047 final : public SpiDevice {
 public:
  static constexpr std::uint16_t kAngle = 0x3FFF, kAngleRaw = 0x3FFE, kMagnitude = 0x3FFD,
                                 kDiagnosis = 0x3FFC, kErrors = 0x0001;

  void select(bool selected, Cycle now) override;
  std::uint16_t exchange(std::uint16_t sent, Cycle now) override;

  /// Turns of the magnet at a time, any real number.
  std::function<double(Cycle)> turns;
  void unplug(bool unplugged) { unplugged_ = unplugged; }
  /// The next answers have a bit turned over.
  void disturb(int answers) { disturbed_ = answers; }
  std::uint64_t frames() const { return frames_; }

 private:
  std::uint16_t read(std::uint16_t address, Cycle now);
  bool selected_ = false, unplugged_ = false;
  int disturbed_ = 0;
  bool command_error_ = false;
  std::uint16_t next_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace kinebus::emulator
