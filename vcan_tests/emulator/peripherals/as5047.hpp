#pragma once
// A magnetic encoder of the AS5047 kind: 14 bits a turn, frames with even parity, the answer to a command in
// the frame that follows it.

#include <functional>
#include <random>

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
  /// Of each reading; the data sheet says 0.068 degrees, which are 3.1 steps. The same noise in each run.
  void set_noise(double rms_steps) { noise_turns_ = rms_steps / 16384; }
  /// The next answers have a bit turned over.
  void disturb(int answers) { disturbed_ = answers; }
  std::uint64_t frames() const { return frames_; }

 private:
  std::uint16_t read(std::uint16_t address, Cycle now);
  double noise() { return noise_turns_ == 0 ? 0 : noise_turns_ * normal_(random_); }
  bool selected_ = false, unplugged_ = false;
  int disturbed_ = 0;
  bool command_error_ = false;
  std::uint16_t next_ = 0;
  std::uint64_t frames_ = 0;
  double noise_turns_ = 0;
  std::mt19937 random_{5047};
  std::normal_distribution<double> normal_;
};

}  // namespace kinebus::emulator
