#pragma once
// A picture of a board's pins, drawn from the same table that its firmware is built with: what is connected
// to each pin, which way it goes, and what it is after a reset.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "node_firmware/port/stm32/pin_table.hpp"

namespace kinebus {

struct WiringPage {
  std::string_view name;    ///< of the board
  std::string_view folder;  ///< of the port, from the repository's root
  std::string_view file;    ///< of the picture there
  std::string_view title;
  std::string_view subtitle;
  std::span<const stm32::Pin> pins;
};
/// Every board whose picture stands in its README.
std::span<const WiringPage> wiring_pages();

/// "PF13"
std::string pin_name(const stm32::Pin& pin);
/// As SVG. Two pages of one table are the same bytes.
std::string draw_wiring(const WiringPage& page);

}  // namespace kinebus
