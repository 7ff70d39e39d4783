#pragma once
// SPI master with 8- or 16-bit frames, and what is on the other end of its wires.

#include <optional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class SpiDevice {
 public:
  virtual ~SpiDevice() = default;
  virtual void select(bool selected, Cycle now) = 0;
  /// One frame while selected; gives what the device sends in it.
  virtual std::uint16_t exchange(std::uint16_t sent, Cycle now) = 0;
};

class Spi final : public Peripheral {
 public:
  Spi(InterruptLines& lines, int irq, Cycle bus_divider, SpiDevice& device)
      : lines_(lines), irq_(irq), bus_divider_(bus_divider), device_(device) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return done_; }
  void advance(Cycle now) override;
  void reset();

  /// Clock of SCK in Hz as set.
  double clock_hz() const { return static_cast<double>(kCoreHz) / static_cast<double>(bit_time()); }
  /// CPOL and CPHA, as SPI modes are counted.
  int mode() const { return static_cast<int>((cr1_ & 2) | (cr1_ & 1)); }
  int frame_bits() const { return (cr1_ & 0x800) != 0 ? 16 : 8; }

 private:
  Cycle bit_time() const { return bus_divider_ << ((cr1_ >> 3 & 7) + 1); }
  void begin(std::uint16_t value, Cycle now);
  void update_line();

  InterruptLines& lines_;
  int irq_;
  Cycle bus_divider_;
  SpiDevice& device_;
  std::uint32_t cr1_ = 0, cr2_ = 0;
  std::uint16_t received_ = 0, shifting_ = 0;
  bool full_ = false, overrun_ = false;
  std::optional<std::uint16_t> waiting_;
  Cycle done_ = kNever;
};

}  // namespace kinebus::emulator
