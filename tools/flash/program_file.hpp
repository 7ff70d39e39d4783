#pragma once
// A program's image on the disk, looked at before a board is.

#include <cstdint>
#include <string>
#include <vector>

namespace kinebus {

struct ProgramFile {
  std::string file{};
  std::vector<std::uint8_t> bytes{};
  std::string trouble{};           ///< why it cannot be written to any board, with its name; empty: it can
  std::uint32_t node_product = 0;  ///< 1018h:2 of the node that it makes of the board
  std::uint32_t crc = 0;           ///< 1F56h
};

ProgramFile read_program_file(const std::string& file);

}  // namespace kinebus
