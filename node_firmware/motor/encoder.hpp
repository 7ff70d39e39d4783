#pragma once
// An AS5047-type angle encoder on the motor's shaft: frames with parity, turns counted, loss told.

#include <cstdint>

namespace kinebus::motor {

/// The command that reads the compensated angle; its answer comes with the next frame. Parity bit included.
inline constexpr std::uint16_t kReadAngle = 0xFFFF;
/// 51200 counts a turn over 16384 steps: 3.125 counts, with 32 fractional bits.
constexpr std::int64_t counts_of_steps(int steps) {
  return static_cast<std::int64_t>(steps * 25) << 29;
}
inline constexpr std::int64_t kCountsPerEncoderStep = counts_of_steps(1);

/// Parity of 16 bits. The Cortex-M4 has no instruction for it, and a call is dear 20,000 times a second.
constexpr bool odd_parity(std::uint32_t bits) {
  bits ^= bits >> 8;
  bits ^= bits >> 4;
  return (0x6996u >> (bits & 15) & 1) != 0;
}
static_assert(!odd_parity(0xFFFF) && odd_parity(0x8000) && !odd_parity(0x0101) && odd_parity(0x0111));

class Encoder {
 public:
  /// Frames that may be bad one after another: 1 ms. The position then is not known any more.
  static constexpr int kMostBad = 20;
  /// More steps than this in a control period is no motion (40 rev/s).
  static constexpr int kMostSteps = 40;

  void set_reversed(bool reversed) { reversed_ = reversed; }

  /// One answer each control period. False: parity or error flag or a jump.
  bool on_frame(std::uint16_t frame) {
    const bool sound = !odd_parity(frame) && (frame & 0x4000) == 0;
    const std::uint16_t raw = frame & 0x3FFF;
    if (!sound) return bad();
    if (!known_) {
      known_ = true;
      raw_ = raw;
      bad_ = 0;
      return true;
    }
    int steps = static_cast<int>(static_cast<unsigned>(raw - raw_) & 0x3FFF);
    if (steps >= 0x2000) steps -= 0x4000;
    // After lost frames the motor may be further on.
    const int most = kMostSteps * (1 + bad_);
    if (steps > most || steps < -most) return bad();
    raw_ = raw;
    bad_ = 0;
    position_ += counts_of_steps(reversed_ ? -steps : steps);
    return true;
  }

  bool known() const { return known_; }
  bool lost() const { return lost_; }
  std::uint32_t errors() const { return errors_; }
  /// Counts with 32 fractional bits since the encoder became known.
  std::int64_t position() const { return position_; }
  /// Within the turn: counts with 32 fractional bits.
  std::int64_t absolute() const { return counts_of_steps(reversed_ ? (0x4000 - raw_) & 0x3FFF : raw_); }
  /// Starts anew after a loss.
  void restart() {
    known_ = lost_ = false;
    bad_ = 0;
  }

 private:
  bool bad() {
    ++errors_;
    if (++bad_ >= kMostBad) {
      lost_ = true;
      known_ = false;
      bad_ = kMostBad;
    }
    return false;
  }

  std::int64_t position_ = 0;
  std::uint32_t errors_ = 0;
  std::uint16_t raw_ = 0;
  int bad_ = 0;
  bool known_ = false, lost_ = false, reversed_ = false;
};

}  // namespace kinebus::motor
