#pragma once
// GPIO ports A to D, SYSCFG's choice of lines, and EXTI.

#include <array>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class GpioPort final : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  /// `modes`: MODER after a reset.
  void reset(std::uint32_t modes = 0);

  /// What is outside drives the pin. Pins nobody drives follow their pull resistor.
  void drive(int pin, bool level);
  void release(int pin);
  /// The level on the pin.
  bool level(int pin) const { return (levels() >> pin & 1) != 0; }
  /// As an output drives it; an input or alternate function: false.
  bool output_high(int pin) const { return (odr_ & outputs_ & 1u << pin) != 0; }
  enum class Mode : std::uint8_t { kInput, kOutput, kAlternate, kAnalogue };
  Mode mode(int pin) const { return static_cast<Mode>(moder_ >> (2 * pin) & 3); }
  bool open_drain(int pin) const { return (otyper_ >> pin & 1) != 0; }
  bool pulled_up(int pin) const { return (pupdr_ >> (2 * pin) & 3) == 1; }
  int alternate(int pin) const {
    return static_cast<int>(afr_[static_cast<std::size_t>(pin / 8)] >> (4 * (pin % 8)) & 0xF);
  }

  std::function<void(Cycle)> on_change;  ///< an output has changed, or what makes one

 private:
  std::uint32_t levels() const;
  void set_modes(std::uint32_t modes);
  std::uint32_t moder_ = 0, otyper_ = 0, ospeedr_ = 0, pupdr_ = 0, odr_ = 0;
  std::uint32_t outputs_ = 0;  // pins that moder_ makes outputs
  std::array<std::uint32_t, 2> afr_{};
  std::uint32_t driven_ = 0, driven_level_ = 0;
};

/// Edges on 16 lines, each from the port that SYSCFG chooses.
class Exti final : public Peripheral {
 public:
  explicit Exti(InterruptLines& lines) : lines_(lines) {}
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  void reset();
  /// The level on `pin` of `port` (0 = A).
  void on_level(int port, int pin, bool level);
  /// An inner line, 16 or above.
  void on_inner_level(int line, bool level);
  /// SYSCFG_EXTICR1..4.
  void select(int index, std::uint32_t value) { source_[static_cast<std::size_t>(index)] = value; }
  std::uint32_t selected(int index) const { return source_[static_cast<std::size_t>(index)]; }

 private:
  void update();
  InterruptLines& lines_;
  std::uint32_t imr_ = 0, rtsr_ = 0, ftsr_ = 0, pr_ = 0;
  std::uint32_t inner_level_ = 0;
  std::array<std::uint32_t, 4> source_{};
  std::array<std::uint16_t, 16> level_{};  // by line: bit per port
};

class SysConfig final : public Peripheral {
 public:
  explicit SysConfig(Exti& exti) : exti_(exti) {}
  std::uint32_t read(std::uint32_t offset, Cycle) override {
    return offset >= 8 && offset < 0x18 ? exti_.selected(static_cast<int>(offset - 8) / 4) : 0;
  }
  void write(std::uint32_t offset, std::uint32_t value, Cycle) override {
    if (offset >= 8 && offset < 0x18) exti_.select(static_cast<int>(offset - 8) / 4, value);
  }

 private:
  Exti& exti_;
};

}  // namespace kinebus::emulator
