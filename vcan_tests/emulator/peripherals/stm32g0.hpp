#pragma once
// Peripherals of the STM32G0B1 that differ from the STM32F4's: RCC, EXTI, flash, DMA with its multiplexer
// (RM0444; times of the data sheet DS13560 at their worst).

#include <array>
#include <functional>
#include <span>

#include "vcan_tests/emulator/peripherals/plain_registers.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"

namespace kinebus::emulator::g0 {

class ResetClock final : public PlainRegisters {
 public:
  explicit ResetClock(std::uint32_t crystal_hz) : crystal_hz_(crystal_hz) {
    reset(Rcc::ResetCause::kPowerOn);
  }
  void reset(Rcc::ResetCause cause);
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  /// A peripheral's clock is on, and since that was written either the register was read back or some cycles
  /// have gone by.
  bool live(const Rcc::Clock& clock, Cycle now);
  /// What the registers ask for; 0: settings outside the chip's limits.
  std::uint32_t system_hz();

 private:
  static constexpr Cycle kEnableDelay = 16;
  std::uint32_t crystal_hz_, causes_ = 0;
  std::uint32_t fresh_register_ = 0, fresh_ = 0;
  Cycle since_ = 0;
};

/// Edges on 16 lines, each from the port that EXTICR chooses.
class Exti final : public Peripheral {
 public:
  explicit Exti(InterruptLines& lines) : lines_(lines) {}
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  void reset();
  void on_level(int port, int pin, bool level);

 private:
  void update();
  InterruptLines& lines_;
  std::uint32_t rising_ = 0, falling_ = 0, rose_ = 0, fell_ = 0, mask_ = 0;
  std::array<std::uint32_t, 4> source_{};
  std::array<std::uint16_t, 16> level_{};
};

/// 64 pages of 2 KiB in one bank; double words, each once after an erase, the lower word first.
class Flash final : public Peripheral {
 public:
  static constexpr std::uint32_t kBase = 0x08000000, kPage = 2048;
  explicit Flash(std::span<std::uint8_t> memory) : memory_(memory) {}
  void reset();
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  /// A store to flash. True: memory has changed.
  bool program(std::uint32_t address, std::uint32_t value, int size, Cycle now);
  bool take_erased();
  Cycle busy_until() const { return busy_until_; }
  std::uint32_t wait_states() const { return acr_ & 7; }
  std::uint64_t erases() const { return erases_; }
  std::uint64_t errors() const { return errors_; }

 private:
  bool fail(std::uint32_t flag);
  std::span<std::uint8_t> memory_;
  std::uint32_t acr_ = 0x600, sr_ = 0, cr_ = 1u << 31;
  int key_step_ = 0;
  std::uint32_t low_at_ = 0, low_ = 0;  // of a double word whose upper word has not come; 0: none
  bool blank_ = false;
  Cycle busy_until_ = 0;
  bool erased_ = false;
  std::uint64_t erases_ = 0, errors_ = 0;
};

/// DMA1 with its channels 1 to 7, and the DMAMUX: words from memory to a peripheral, bytes from one to
/// memory. The ports' pins it does not reach: they hang on the processor's own bus.
class Dma final : public Peripheral {
 public:
  static constexpr int kChannels = 7;
  explicit Dma(InterruptLines& lines) : lines_(lines) {}
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  void reset();
  /// The peripheral of this request line asks for a word.
  void on_request(std::uint32_t line, Cycle at);

  std::function<std::uint32_t(std::uint32_t address)> fetch;
  std::function<void(std::uint32_t address, std::uint32_t word, Cycle at)> put;
  std::function<std::uint8_t(std::uint32_t address, Cycle at)> take;   ///< from a peripheral
  std::function<void(std::uint32_t address, std::uint8_t byte)> keep;  ///< in memory

 private:
  struct Channel {
    std::uint32_t ccr = 0, cndtr = 0, cpar = 0, cmar = 0, left = 0, request = 0;
  };
  void update();
  InterruptLines& lines_;
  std::array<Channel, kChannels> channels_{};
  std::uint32_t flags_ = 0;
};

}  // namespace kinebus::emulator::g0
