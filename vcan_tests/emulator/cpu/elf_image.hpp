#pragma once
// The firmware's ELF file: what goes where into flash, and where its symbols are.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kinebus::emulator {

struct ElfImage {
  struct Piece {
    std::uint32_t address = 0;  ///< where it lies in flash (load address)
    std::vector<std::uint8_t> bytes;
  };
  std::vector<Piece> pieces;
  std::map<std::string, std::uint32_t> symbols;

  std::optional<std::uint32_t> symbol(const std::string& name) const;
};

/// Throws std::runtime_error naming the file and what is wrong with it: not there, not a little-endian 32-bit
/// ARM executable, truncated.
ElfImage load_elf(const std::filesystem::path& file);

}  // namespace kinebus::emulator
