#pragma once
// The dual-stepper board with an STM32F405, emulated: processor, peripherals, power stages, motors, encoders
// and switches, wired as node_firmware/port/stm32f405/board.hpp says. One crystal: time is the processor's
// cycles.

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/simulation/bus/virtual_machine.hpp"
#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/peripherals/adc.hpp"
#include "vcan_tests/emulator/peripherals/as5047.hpp"
#include "vcan_tests/emulator/peripherals/bxcan.hpp"
#include "vcan_tests/emulator/peripherals/flash.hpp"
#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/otg_hs.hpp"
#include "vcan_tests/emulator/peripherals/power_control.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"
#include "vcan_tests/emulator/peripherals/usart.hpp"
#include "vcan_tests/emulator/peripherals/watchdog.hpp"
#include "vcan_tests/emulator/physics/power_stage.hpp"
#include "vcan_tests/emulator/physics/stepper_motor.hpp"

namespace kinebus::emulator {

struct BoardOptions {
  std::array<std::uint32_t, 3> unique_id{};
  std::array<StepperParameters, 2> motors{};
  PowerStageParameters stage{};
  std::array<VirtualAxis, 2> axes{};             ///< where the carriages stand, and their switches
  std::array<double, 2> encoder_offset_turns{};  ///< how the magnet is glued on
  double supply_v = 24;
  double temperature_c = 30;
};

class Board final : public Devices {
 public:
  Board(const ElfImage& image, const BoardOptions& options);
  ~Board() override;

  /// Runs up to `limit` and at most a basic block further.
  void run(Cycle limit);
  Cycle now() const { return cpu_.now(); }
  /// Power off and on again: RAM is lost, flash is kept.
  void power_cycle();

  // CAN, for who joins boards to a bus.
  BxCan& can() { return can_; }
  /// A frame ends on the bus at `at`, not before now().
  void deliver(Cycle at, const CanFrame& frame) { incoming_.push_back({at, frame}); }
  void sent(Cycle at, int mailbox) { incoming_.push_back({at, {}, mailbox}); }

  /// True carriage position at the last run(), counts (51200 a turn) from the joint's zero.
  double true_counts(int axis) const;
  double start_counts(int axis) const { return options_.axes[static_cast<std::size_t>(axis)].start_counts; }
  /// TIM2's count at a time not long after now().
  std::uint32_t local_counts(Cycle at) { return tim2_.read(0x24, std::max(at, cpu_.now())); }
  /// The level on switch input 0..6 from outside; inputs that an axis drives follow it.
  void set_input(int input, bool level);
  void set_supply(double volts);
  void set_temperature(int axis, double celsius) { temperature_c_[static_cast<std::size_t>(axis)] = celsius; }

  /// The chip's own supply, 3.3 V by itself: what the detector (PVD) makes of it, and a reset below the
  /// brown-out level of the option bytes; RAM keeps. Not what flash and core do below 2.7 V.
  void set_chip_supply(double volts);
  void set_crystal(bool swings);
  /// The status LED, active low.
  bool led_lit() const;

  CortexM4& cpu() { return cpu_; }
  const CortexM4& cpu() const { return cpu_; }
  StepperMotor& motor(int axis) { return motors_[static_cast<std::size_t>(axis)]; }
  const StepperMotor& motor(int axis) const { return motors_[static_cast<std::size_t>(axis)]; }
  As5047& encoder(int axis) { return encoders_[static_cast<std::size_t>(axis)]; }
  Timer& pwm(int axis) { return axis == 0 ? tim1_ : tim8_; }
  PowerStage& stage(int axis) { return *stages_[static_cast<std::size_t>(axis)]; }
  Usart& console() { return usart_; }
  OtgHs& usb() { return usb_; }
  /// A cable with a host at its other end: VBUS comes or goes.
  void set_usb_cable(bool plugged);
  /// A host finds a full-speed device at the cable: pins, clocks and the core are as they must be for that.
  bool usb_device_seen();
  /// As an output drives it: the chip's own boot loader is given USB, and the gate drivers are held off.
  bool system_boot_selected() const;
  Rcc& rcc() { return rcc_; }
  FlashController& flash() { return flash_; }
  const ElfImage& image() const { return image_; }
  std::uint64_t resets() const { return resets_; }
  std::uint64_t watchdog_resets() const { return watchdog_resets_; }
  /// Accesses to addresses where the board has nothing: a mistake of the program, or of this emulation.
  const std::vector<std::uint32_t>& strange_accesses() const { return strange_; }
  /// Accesses to peripherals whose clock was off, or had been on for too short a time: what was written there
  /// is lost, and what was read is 0.
  const std::vector<std::uint32_t>& lost_accesses() const { return lost_; }

  // Devices.
  std::uint32_t read(std::uint32_t address, int size, Cycle now) override;
  void write(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;
  bool write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;
  Cycle next_event() const override { return next_event_; }
  void advance(Cycle now) override;

 private:
  struct Incoming {
    Cycle at = 0;
    CanFrame frame;
    int sent_mailbox = -1;
  };
  struct Place {
    Peripheral* peripheral = nullptr;
    std::uint32_t base = 0;
    std::optional<Rcc::Clock> clock;
  };
  void map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
           std::optional<Rcc::Clock> clock = std::nullopt);
  bool reached(const Place& place, std::uint32_t address, Cycle now);
  Place find(std::uint32_t address);
  void reset(Rcc::ResetCause cause);
  void schedule();
  void on_pins(Cycle now);
  void look_at_switches(Cycle now);
  void drive_input(int input, bool level);
  double analogue(int channel, Cycle at);

  const ElfImage& image_;
  BoardOptions options_;
  CortexM4 cpu_;
  Rcc rcc_;
  FlashController flash_;
  PowerControl power_control_;
  std::array<GpioPort, 4> ports_;
  Exti exti_;
  SysConfig sysconfig_;
  Timer tim1_, tim8_, tim2_;
  AdcBlock adc_;
  std::array<As5047, 2> encoders_;
  Spi spi1_, spi3_;
  BxCan can_;
  Usart usart_;
  Watchdog watchdog_;
  OtgHs usb_;
  std::array<StepperMotor, 2> motors_;
  std::array<std::unique_ptr<PowerStage>, 2> stages_;
  std::array<double, 2> temperature_c_{};

  std::array<Place, 512> places_{};  // by KiB from 0x40000000
  std::deque<Incoming> incoming_;
  std::array<int, 2> switch_level_{-1, -1};
  Cycle next_event_ = 0;
  std::uint32_t boot_ = 0;
  std::uint64_t resets_ = 0, watchdog_resets_ = 0;
  std::vector<std::uint32_t> strange_, lost_;
};

}  // namespace kinebus::emulator
