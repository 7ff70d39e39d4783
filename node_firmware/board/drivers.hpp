#pragma once
// What a node's program asks of a board's drivers. A port has one class for each; the compiler puts them in,
// so that a seam costs nothing.

#include <concepts>
#include <cstdint>
#include <span>

#include "node_firmware/core/transmit_queue.hpp"
#include "protocol/can/frame.hpp"

namespace kinebus {

/// Standard data frames with (id & mask) == value reach the processor.
struct CanAccept {
  std::uint16_t value = 0, mask = 0x7FF;
  bool remote = false;  ///< remote frames instead of data frames; the mask is 7FFh
  friend constexpr bool operator==(const CanAccept&, const CanAccept&) = default;
};
/// So many filters a program needs at most.
inline constexpr std::size_t kCanFilters = 14;

/// Since power-up; written by interrupts, words read singly.
struct CanEvents {
  std::uint32_t overruns = 0, bus_off = 0, passive = 0;
  friend constexpr bool operator==(const CanEvents&, const CanEvents&) = default;
};

struct SwitchEdge {
  std::uint32_t counts = 0;  ///< local time
  std::uint8_t input = 0;
  bool level = false;
};

/// A CAN controller: frames in the order of their arrival with the local time of it, a transmit queue, and
/// mailboxes that the main loop serves.
template <typename T>
concept CanDriver = requires(T& can, const T& seen, std::span<const CanAccept> filters) {
  { seen.front()->counts } -> std::convertible_to<std::uint32_t>;
  { seen.front()->frame() } -> std::same_as<CanFrame>;
  can.drop();
  { can.queue() } -> std::same_as<TransmitQueue&>;
  can.serve_mailboxes();
  can.accept(filters);
  { seen.events() } -> std::same_as<const CanEvents&>;
  { seen.bus_off() } -> std::same_as<bool>;
};

template <typename T>
concept SwitchDriver = requires(T& switches, const T& seen) {
  { seen.front() } -> std::same_as<const SwitchEdge*>;
  switches.drop();
};

/// Resets the processor when it is not fed for about 100 ms; longer only while flash is written.
template <typename T>
concept WatchdogDriver = requires(T& dog) {
  dog.feed();
  dog.allow_flash();
  dog.back_to_normal();
};

}  // namespace kinebus
