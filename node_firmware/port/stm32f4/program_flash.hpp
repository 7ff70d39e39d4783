#pragma once
// The sectors that hold the program, as the boot loader writes them.

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f4/option_port.hpp"
#include "node_firmware/port/stm32f4/record_port.hpp"

namespace kinebus::stm32 {

/// kSectors: one behind the other, of kBytes together. kProtected: the boot loader's own, where nothing else
/// is to write them, as bits of OPTCR; 0: they stay open.
template <const auto& kSectors, std::uint32_t kBytes, std::uint32_t kProtected>
class ProgramSectors final : public ProgramFlash {
 public:
  std::span<const std::uint8_t> bytes() const override {
    return flash::bytes(kSectors.front().address, kBytes);
  }
  // The header goes first: what a cut leaves of the rest is then no program.
  bool erase() override {
    for (const FlashSector& sector : kSectors)
      if (!flash::erase(sector.number)) return false;
    return true;
  }
  bool program(std::uint32_t offset, std::uint32_t word) override {
    return flash::program(kSectors.front().address + offset, word);
  }
  std::uint8_t unprotected() const override { return options::missing(kProtected); }
  std::span<const std::uint8_t> records() const override { return record::memory(); }
  bool add_record(const BoardRecord& record) override { return record::add(record); }
  bool protect() override { return options::protect(kProtected); }
};

}  // namespace kinebus::stm32
