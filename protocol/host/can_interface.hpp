#pragma once
// What the kernel says of a CAN interface (rtnetlink), and what is wrong with it for Kinebus.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kinebus {

struct CanInterface {
  std::string kind;  ///< "can": a controller; "vcan", "vxcan": no wire, and so no bit rate
  bool up = false;
  std::string driver;                ///< the kernel's, such as "gs_usb"; empty: none, or not told
  std::uint32_t transmit_queue = 0;  ///< txqueuelen, frames; without a wire none is needed
  // Of a controller; 0: not set, or not told by its driver.
  std::uint32_t bit_rate = 0;    ///< bit/s
  std::uint32_t restart_ms = 0;  ///< from bus-off to the next attempt; 0: never by itself
  bool listen_only = false;
  bool bus_off = false;
};

/// Of the answer to RTM_GETLINK, header included; nullopt: it is none.
std::optional<CanInterface> read_link(std::span<const std::uint8_t> message);
/// nullopt: the kernel does not tell, which says nothing.
std::optional<CanInterface> ask_kernel(const std::string& name);

/// Why no node can be spoken to through it, and what to do; "": nothing is in the way.
std::string obstacle(const std::string& name, const CanInterface& interface);
/// What will be missed one day, and what to do.
std::vector<std::string> advice(const std::string& name, const CanInterface& interface);

}  // namespace kinebus
