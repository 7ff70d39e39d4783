#include "node_firmware/core/profile_position.hpp"

#include <algorithm>

#include "protocol/canopen/cia402.hpp"

namespace kinebus {
namespace control = cia402::control;

void ProfilePosition::reset(std::uint16_t word) {
  *this = ProfilePosition{};
  last_bit_ = (word & control::kNewSetPoint) != 0;
}

void ProfilePosition::on_controlword(ProfileTicks now, std::uint16_t word, const SetPoint& next,
                                     Trapezoid& motion) {
  const bool bit = (word & control::kNewSetPoint) != 0;
  const bool edge = bit && !last_bit_;
  last_bit_ = bit;
  if (!bit) {
    refused_ = false;
    acknowledged_ = waiting_;  // stays while there is no room for another
    return;
  }
  if (edge || refused_) accept(now, next, word, motion);
}

void ProfilePosition::accept(ProfileTicks now, const SetPoint& next, std::uint16_t word, Trapezoid& motion) {
  const bool at_once = (word & control::kChangeAtOnce) != 0;
  const bool moving = has_moving_ && !motion.done(now);
  refused_ = moving && !at_once && waiting_;
  if (refused_) return;
  acknowledged_ = true;
  next_ = next;
  if (!moving || at_once) return begin(now, motion);
  waiting_ = true;
  // Without a stop between the two, when both lie in the same direction.
  if ((word & kChangeOnSetPoint) == 0) return;
  const ProfileState state = motion.at(now);
  const bool up = moving_.target > state.position;
  if (up == (next.target > moving_.target)) motion.pass(now, state, moving_.target, moving_.limits);
}

void ProfilePosition::begin(ProfileTicks now, Trapezoid& motion) {
  moving_ = next_;
  has_moving_ = true;
  waiting_ = false;
  motion.move(now, motion.at(now), moving_.target, moving_.limits);
}

void ProfilePosition::on_time(ProfileTicks now, ProfileTicks looked, Trapezoid& motion) {
  if (!waiting_ || !motion.done(now)) return;
  begin(motion.end() >= looked ? motion.end() : now, motion);
  acknowledged_ = last_bit_;
}

void ProfilePosition::resume(ProfileTicks now, Trapezoid& motion) {
  if (has_moving_) motion.move(now, motion.at(now), moving_.target, moving_.limits);
}

std::int64_t ProfilePosition::base(const Trapezoid& motion) const {
  if (waiting_) return next_.target;
  return has_moving_ ? moving_.target : motion.target();
}

}  // namespace kinebus
