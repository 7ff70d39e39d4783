#pragma once
// Mode 1: set-points by handshake (controlword bits 4, 5, 6, 9; statusword bits 10 and 12), one moving and
// one waiting, from which the axis' Trapezoid is planned.

#include <cstdint>

#include "node_firmware/core/trapezoid.hpp"

namespace kinebus {

class ProfilePosition {
 public:
  struct SetPoint {
    std::int64_t target = 0;  ///< 32 fractional bits
    ProfileLimits limits;
    friend bool operator==(const SetPoint&, const SetPoint&) = default;
  };

  /// Forgets all set-points; the mode begins, or a stop has ended the motion. `word`: its bit 4 is no edge.
  void reset(std::uint16_t word);
  /// Looks at the handshake bits. `next`: what 607Ah and the profile objects say now, absolute.
  void on_controlword(ProfileTicks now, std::uint16_t word, const SetPoint& next, Trapezoid& motion);
  /// The moving one has ended: the waiting one starts, at the instant of the end. An end before `looked` was
  /// seen as a standstill since: then it starts now.
  void on_time(ProfileTicks now, ProfileTicks looked, Trapezoid& motion);
  /// Goes on to the target after a halt.
  void resume(ProfileTicks now, Trapezoid& motion);

  /// What relative targets (bit 6) count from.
  std::int64_t base(const Trapezoid& motion) const;
  bool acknowledged() const { return acknowledged_; }
  bool reached(ProfileTicks now, const Trapezoid& motion) const { return !waiting_ && motion.done(now); }
  static constexpr std::uint16_t kChangeOnSetPoint = 1 << 9;

 private:
  void begin(ProfileTicks now, Trapezoid& motion);
  void accept(ProfileTicks now, const SetPoint& next, std::uint16_t word, Trapezoid& motion);

  SetPoint moving_;
  SetPoint next_;
  bool has_moving_ = false;
  bool waiting_ = false;
  bool refused_ = false;  // bit 4 is set, but there was no room
  bool acknowledged_ = false;
  bool last_bit_ = false;
};

}  // namespace kinebus
