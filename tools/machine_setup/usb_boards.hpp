#pragma once
// What is on USB that has to do with the bus: adapters, boards that wait for a program, consoles.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus {

enum class UsbKind : std::uint8_t {
  kOther,
  kCanAdapter,   ///< speaks gs_usb: the kernel makes a CAN interface of it
  kBootLoader,   ///< an STM32's own boot loader (DFU)
  kNodeConsole,  ///< a node's console
  kKlipper,      ///< a board that still has Klipper's program
};
/// "CAN adapter (gs_usb)"
const char* words_of(UsbKind kind);

struct UsbBoard {
  std::uint16_t vendor = 0, product = 0;
  std::uint8_t bus = 0, address = 0;
  std::string name{}, serial{};  ///< as the device says; empty without permission to ask
  UsbKind kind = UsbKind::kOther;
};

/// `name`: the device's product string; tells a node's console from other serial ports with ST's numbers.
UsbKind usb_kind(std::uint16_t vendor, std::uint16_t product, std::string_view name);
/// What to do with it; "": nothing.
std::string usb_advice(const UsbBoard& board);

struct UsbBoards {
  std::vector<UsbBoard> boards;  ///< but kOther
  std::string trouble;           ///< why nothing can be said; empty: nothing in the way
};
UsbBoards find_usb_boards();

}  // namespace kinebus
