#pragma once
// The flash controller: keys, word programming that only clears bits, sector erase, busy times. Power can be
// cut in the middle of either.

#include <span>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class FlashController final : public Peripheral {
 public:
  static constexpr std::uint32_t kBase = 0x08000000;
  explicit FlashController(std::span<std::uint8_t> memory) : memory_(memory) {}

  void reset();
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;

  /// A store to flash. True: memory has changed. Without PG, locked, or of the wrong size it is refused with
  /// an error flag.
  bool program(std::uint32_t address, std::uint32_t value, int size, Cycle now);
  /// An erase has changed what was executable.
  bool take_erased();
  /// The processor waits for the flash that long when it fetches during an operation.
  Cycle busy_until() const { return busy_until_; }

  std::uint32_t wait_states() const { return acr_ & 7; }
  std::uint64_t erases() const { return erases_; }
  std::uint64_t programs() const { return programs_; }

  /// From to the end of a sector of the F405: four of 16 KiB, one of 64, seven of 128.
  struct Sector {
    std::uint32_t offset = 0, size = 0;
  };
  static Sector sector(unsigned number);

 private:
  std::span<std::uint8_t> memory_;
  std::uint32_t acr_ = 0, sr_ = 0, cr_ = 1u << 31;
  int key_step_ = 0;
  Cycle busy_until_ = 0;
  bool erased_ = false;
  std::uint64_t erases_ = 0, programs_ = 0;
};

}  // namespace kinebus::emulator
