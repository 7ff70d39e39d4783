#pragma once
// The pages that hold the program, as the boot loader writes them.

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/port/stm32g0b1_ebb/flash_port.hpp"

namespace kinebus::g0b1 {

template <const ebb::Pages& kPages>
class ProgramSectors final : public ProgramFlash {
 public:
  std::span<const std::uint8_t> bytes() const override {
    return {&peripheral<const std::uint8_t>(kPages.address()), kPages.bytes()};
  }
  // The header goes first: what a cut leaves of the rest is then no program.
  bool erase() override { return flash::erase(kPages); }
  /// The lower word of a pair waits for the other one, which comes next.
  bool program(std::uint32_t offset, std::uint32_t word) override {
    if (offset % 8 == 0) {
      low_ = word;
      return true;
    }
    return flash::program(kPages.address() + offset - 4, low_, word);
  }

 private:
  std::uint32_t low_ = 0xFFFF'FFFF;
};

}  // namespace kinebus::g0b1
