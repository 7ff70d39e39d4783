#pragma once
// The flash controller: keys, word programming that only clears bits, sector erase, busy times. Power can be
// cut in the middle of either.

#include <span>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class FlashController final : public Peripheral {
 public:
  static constexpr std::uint32_t kBase = 0x08000000;
  static constexpr std::uint32_t kOneTimeBase = 0x1FFF7800;
  /// `one_time`: memory that no erase reaches; blank.
  explicit FlashController(std::span<std::uint8_t> memory, std::span<std::uint8_t> one_time = {})
      : memory_(memory), one_time_(one_time) {}

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

  /// OPTCR without its lock and start bits: not lost with the power.
  std::uint32_t options() const { return options_; }
  /// Below this supply the chip is reset.
  double brown_out_volts() const;
  std::uint32_t wait_states() const { return acr_ & 7; }
  std::uint64_t erases() const { return erases_; }
  std::uint64_t programs() const { return programs_; }

  /// From to the end of a sector of the F405: four of 16 KiB, one of 64, seven of 128.
  struct Sector {
    std::uint32_t offset = 0, size = 0;
  };
  static Sector sector(unsigned number);

 private:
  bool write_protected(unsigned sector) const { return (options_ >> (16 + sector) & 1) == 0; }
  bool program_once(std::uint32_t at, std::uint32_t value, int size, Cycle now);
  void write_options(std::uint32_t value, Cycle now);

  std::span<std::uint8_t> memory_, one_time_;
  std::uint32_t acr_ = 0, sr_ = 0, cr_ = 1u << 31;
  int key_step_ = 0, option_key_step_ = 0;
  std::uint32_t options_ = 0x0FFFAAEC;  ///< as delivered
  std::uint32_t optcr_ = 0x0FFFAAED;    ///< as written, in force from its start bit on
  Cycle busy_until_ = 0;
  bool erased_ = false;
  std::uint64_t erases_ = 0, programs_ = 0;
};

}  // namespace kinebus::emulator
