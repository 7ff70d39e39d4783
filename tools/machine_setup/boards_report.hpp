#pragma once
// What `kinebus-setup boards` prints.

#include <string>
#include <vector>

#include "tools/machine_setup/bus_boards.hpp"
#include "tools/machine_setup/usb_boards.hpp"

namespace kinebus {

struct BoardsReport {
  std::string interface;
  std::string bus_trouble{};           ///< why nobody on the bus could be asked; empty: they were
  std::vector<std::string> advices{};  ///< what the kernel says of the interface that will be missed one day
  std::vector<BusBoard> bus{};
  UsbBoards usb{};
};

/// A line each, and what to do with one on USB.
std::string as_line(const BusBoard& board);
std::string as_lines(const UsbBoards& usb);
std::string as_text(const BoardsReport& report);
/// One JSON object, indented.
std::string as_json(const BoardsReport& report);

}  // namespace kinebus
