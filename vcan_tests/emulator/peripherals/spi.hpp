#pragma once
// SPI master with 8- or 16-bit frames, and what is on the other end of its wires.
//
// That of an STM32G0 has a FIFO: frames are as long as CR2 says, and of bytes it tells each only where CR2
// asks for that. Two bytes by one store are not modelled: the width of a store is not seen here.

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
  /// `bus_divider`: cycles a clock of its bus, times 1 / `bus_parts`.
  Spi(InterruptLines& lines, int irq, Cycle bus_divider, SpiDevice& device, bool fifo = false,
      Cycle bus_parts = 1)
      : lines_(lines),
        irq_(irq),
        bus_divider_(bus_divider),
        bus_parts_(bus_parts),
        fifo_(fifo),
        device_(device) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return done_; }
  void advance(Cycle now) override;
  void reset();

  /// Clock of SCK in Hz as set.
  double clock_hz() const { return static_cast<double>(kCoreHz) / static_cast<double>(bit_time()); }
  /// CPOL and CPHA, as SPI modes are counted.
  int mode() const { return static_cast<int>((cr1_ & 2) | (cr1_ & 1)); }
  int frame_bits() const {
    if (fifo_) return static_cast<int>(cr2_ >> 8 & 15) + 1;
    return (cr1_ & 0x800) != 0 ? 16 : 8;
  }

 private:
  Cycle bit_time() const { return (bus_divider_ << ((cr1_ >> 3 & 7) + 1)) / bus_parts_; }
  bool tells() const { return full_ && (!fifo_ || frame_bits() > 8 || (cr2_ & 0x1000) != 0); }
  void begin(std::uint16_t value, Cycle now);
  void update_line();

  InterruptLines& lines_;
  int irq_;
  Cycle bus_divider_, bus_parts_;
  bool fifo_;
  SpiDevice& device_;
  std::uint32_t cr1_ = 0, cr2_ = 0;
  std::uint16_t received_ = 0, shifting_ = 0;
  bool full_ = false, overrun_ = false;
  std::optional<std::uint16_t> waiting_;
  Cycle done_ = kNever;
};

}  // namespace kinebus::emulator
