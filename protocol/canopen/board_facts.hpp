#pragma once
// Who a board is: for its object table, its data sheet, and the images that it takes.

#include <cstdint>
#include <string_view>

namespace kinebus {

/// What a board is called and known by.
struct BoardFacts {
  std::string_view name{};               ///< for programs' options: --board NAME
  std::string_view order_code{};         ///< of its image and data sheet: kinebus-node.elf, kinebus-node.eds
  std::string_view device_name{};        ///< 1008h
  std::string_view hardware_version{};   ///< 1009h
  std::string_view description{};        ///< of the data sheet
  std::uint32_t device_type = 0;         ///< 1000h
  std::uint32_t product_code = 0;        ///< 1018h:2
  std::uint32_t revision = 0x0001'0000;  ///< 1018h:3
  std::uint32_t hardware = 0;            ///< chip and pin map, as a program's image names them
  /// A board of several nodes: so many ids in a row, from the one that LSS gives; serial numbers likewise.
  std::uint8_t consecutive_ids = 1;
};

}  // namespace kinebus
