#pragma once
// Asks a node by its console (USB or USART) to give way to the chip's own boot loader.

#include <chrono>
#include <string>

namespace kinebus {

/// `port`: the serial port, /dev/ttyACM0. Returns what went wrong; empty: the port has gone, or said nothing
/// against it within `patience`.
std::string request_system_boot(const std::string& port,
                                std::chrono::milliseconds patience = std::chrono::seconds{1});

}  // namespace kinebus
