#pragma once
// What a node shows by one LED, for who has no bus to ask: after CiA 303-3, with one LED instead of two.

#include <cstdint>

#include "protocol/canopen/nmt.hpp"

namespace kinebus {

struct LedState {
  bool on_bus = true;
  bool fault = false;        ///< a drive has one
  std::uint8_t node_id = 0;  ///< 0: waits for LSS
  NmtState nmt = NmtState::kInitialising;
};

/// Four flashes: no crystal, or another one than the board's.
constexpr bool led_without_clock(std::uint32_t step) {
  return (0b101'0101u >> step % 16 & 1) != 0;
}

/// On, at this time in steps of 65 ms, of which 16 are a round.
constexpr bool led_on(const LedState& state, std::uint32_t step) {
  const auto pattern = [&]() -> std::uint32_t {
    if (!state.on_bus) return 0b101;         // two flashes: no bus
    if (state.fault) return 0x5555;          // flickers: a drive's fault
    if (state.node_id == 0) return 0b10101;  // three flashes: no node id
    if (state.nmt == NmtState::kOperational) return 0xFFFF;
    if (state.nmt == NmtState::kStopped) return 0b1;  // one flash
    return 0x0F0F;                                    // blinks: pre-operational
  };
  return (pattern() >> step % 16 & 1) != 0;
}

}  // namespace kinebus
