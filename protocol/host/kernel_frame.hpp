#pragma once
// CanFrame and Linux' struct can_frame, 16 bytes, one for the other.

#include <linux/can.h>

#include <algorithm>
#include <cstring>

#include "protocol/can/frame.hpp"

namespace kinebus {

inline CanFrame from_kernel(const can_frame& raw) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = std::min<std::uint8_t>(raw.can_dlc, 8);
  std::memcpy(frame.data.data(), raw.data, frame.length);
  return frame;
}

inline can_frame to_kernel(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0u) | (frame.remote ? CAN_RTR_FLAG : 0u);
  raw.can_dlc = frame.length;
  std::memcpy(raw.data, frame.data.data(), frame.length);
  return raw;
}

}  // namespace kinebus
