#pragma once
// An emulated STM32G0B1xB: Cortex-M0+ of 64 MHz, 128 KiB of flash, FDCAN2.

#include <algorithm>
#include <array>
#include <cstdint>

#include "vcan_tests/emulator/chip.hpp"
#include "vcan_tests/emulator/peripherals/fdcan.hpp"
#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0_adc.hpp"
#include "vcan_tests/emulator/peripherals/stm32g0_usart.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"

namespace kinebus::emulator {

class Stm32g0b1Chip : public Chip {
 public:
  static constexpr std::uint32_t kG0B1 = 0x1000'0467, kG071 = 0x2000'0460;  ///< DBG_IDCODE
  static constexpr std::size_t kFlashBytes = std::size_t{128} * 1024;
  ~Stm32g0b1Chip() override;

  Fdcan& can() override { return can_; }
  std::uint32_t local_counts(Cycle at) override { return tim2_.read(0x24, std::max(at, cpu_.now())); }
  g0::ResetClock& rcc() { return rcc_; }
  const g0::Flash& flash() const { return flash_; }
  const g0::Adc& adc() const { return adc_; }
  /// Pins that the program has made outputs.
  int outputs() const;

  bool write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;

 protected:
  Stm32g0b1Chip(const ElfImage& image, const BoardOptions& options, std::uint32_t crystal_hz,
                std::uint32_t device_id);
  /// A board calls start() when its own parts are there.
  void start();

  g0::ResetClock rcc_;
  g0::Flash flash_;
  std::array<GpioPort, 6> ports_;
  g0::Exti exti_;
  Timer tim2_, tim1_, tim16_, tim17_;
  g0::Usart usart2_;
  g0::Adc adc_;
  g0::Dma dma_;
  Fdcan can_;
  CanMessageRam can_memory_;

 private:
  /// DBG_IDCODE at its start.
  class Debug final : public Peripheral {
   public:
    explicit Debug(std::uint32_t id) : id_(id) {}
    std::uint32_t read(std::uint32_t offset, Cycle) override { return offset == 0 ? id_ : 0; }
    void write(std::uint32_t, std::uint32_t, Cycle) override {}

   private:
    std::uint32_t id_;
  };
  void reset_chip(Rcc::ResetCause cause, Cycle now) override;
  void advance_chip(Cycle now) override;
  Cycle next_of_chip() const override {
    return std::min({tim2_.next_event(), tim1_.next_event(), tim16_.next_event(), tim17_.next_event(),
                     usart2_.next_event(), adc_.next_event(), can_.next_event()});
  }
  bool live(const Rcc::Clock& clock, Cycle now) override { return rcc_.live(clock, now); }
  void after_write(Peripheral& written) override;

  Debug debug_;
};

}  // namespace kinebus::emulator
