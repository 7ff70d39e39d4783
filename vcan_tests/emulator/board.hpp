#pragma once
// The dual-stepper board with an STM32F405, emulated: power stages, motors, encoders and switches, wired as
// node_firmware/port/stm32f405/board.hpp says.

#include <array>
#include <cstdint>
#include <memory>

#include "vcan_tests/emulator/peripherals/adc.hpp"
#include "vcan_tests/emulator/peripherals/as5047.hpp"
#include "vcan_tests/emulator/peripherals/quadrature_counter.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"
#include "vcan_tests/emulator/peripherals/ssi_scale.hpp"
#include "vcan_tests/emulator/peripherals/usart.hpp"
#include "vcan_tests/emulator/stm32f4_chip.hpp"
#include "vcan_tests/emulator/usb_socket.hpp"

namespace kinebus::emulator {

class Board final : public Stm32f4Chip, public UsbSocket {
 public:
  Board(const ElfImage& image, const BoardOptions& options);
  ~Board() override;

  std::uint32_t product_code() const override;
  double true_counts(int axis) const override;
  void set_input(int input, bool level) override;
  void set_supply(double volts);
  void set_temperature(int axis, double celsius) { temperature_c_[static_cast<std::size_t>(axis)] = celsius; }
  /// The status LED, active low.
  bool led_lit() const;

  StepperMotor& motor(int axis) { return motors_[static_cast<std::size_t>(axis)]; }
  const StepperMotor& motor(int axis) const { return motors_[static_cast<std::size_t>(axis)]; }
  As5047& encoder(int axis) { return encoders_[static_cast<std::size_t>(axis)]; }
  Timer& pwm(int axis) { return axis == 0 ? tim1_ : tim8_; }
  PowerStage& stage(int axis) { return *stages_[static_cast<std::size_t>(axis)]; }
  Usart& console() { return usart_; }
  OtgHs& usb() override { return usb_; }
  void set_usb_cable(bool plugged) override;
  bool usb_device_seen() override;
  /// As an output drives it: the chip's own boot loader is given USB, and the gate drivers are held off.
  bool system_boot_selected() const;

 private:
  void reset_devices(Cycle now) override;
  void advance_devices(Cycle now) override;
  Cycle next_of_devices() const override;
  void after_run() override;
  int clock_offset(std::uint32_t base, std::uint32_t address) const override;
  SpiDevice& on_encoder_port(std::size_t axis);
  std::uint32_t absolute_position(std::size_t axis, Cycle at);
  void on_pins(Cycle now);
  double analogue(int channel, Cycle at);

  Timer tim1_, tim8_;
  std::array<QuadratureCounter, 2> scales_;  ///< TIM3, TIM4
  AdcBlock adc_;
  std::array<As5047, 2> encoders_;
  std::array<SsiScale, 2> absolute_scales_;
  Spi spi1_, spi3_;
  Usart usart_;
  OtgHs usb_;
  std::array<StepperMotor, 2> motors_;
  std::array<std::unique_ptr<PowerStage>, 2> stages_;
  std::array<double, 2> temperature_c_{};
};

}  // namespace kinebus::emulator
