#pragma once
// The BTT Octopus with an STM32F446, emulated: stepper drivers that count steps, a hot end and a bed, and
// switches, wired as node_firmware/port/stm32f446_octopus/board.hpp says. The drivers are judges: they note
// when each edge came, and what of a driver's needs was not kept.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "vcan_tests/emulator/peripherals/adc.hpp"
#include "vcan_tests/emulator/peripherals/dma.hpp"
#include "vcan_tests/emulator/peripherals/spi.hpp"
#include "vcan_tests/emulator/physics/heated_places.hpp"
#include "vcan_tests/emulator/physics/pulled_wire.hpp"
#include "vcan_tests/emulator/physics/tmc2209.hpp"
#include "vcan_tests/emulator/physics/tmc_spi_chip.hpp"
#include "vcan_tests/emulator/servo_pulses.hpp"
#include "vcan_tests/emulator/stm32f4_chip.hpp"
#include "vcan_tests/emulator/usb_socket.hpp"

namespace kinebus::emulator {

/// A stepper driver behind step, direction and enable pins.
class StepDriver {
 public:
  struct Edge {
    Cycle at = 0;
    std::int64_t after = 0;  ///< steps, when it has been made
    bool up = false;
  };
  /// Shortest times seen, in cycles.
  struct Shortest {
    Cycle high = kNever, low = kNever, set_up = kNever, hold = kNever;
  };
  void on_pins(bool step, bool direction, bool enabled, Cycle now);
  std::int64_t steps() const { return steps_; }
  bool enabled() const { return enabled_; }
  /// For a chip behind the pins: a rising edge on STEP.
  std::function<void(bool direction, Cycle now)> on_step;
  std::uint64_t while_disabled() const { return while_disabled_; }
  const std::vector<Edge>& edges() const { return edges_; }
  void clear_edges() { edges_.clear(); }
  const Shortest& shortest() const { return shortest_; }

 private:
  bool step_ = false, direction_ = false, enabled_ = false;
  bool stepped_ = false;
  Cycle rose_ = 0, fell_ = 0, turned_ = 0;
  std::int64_t steps_ = 0;
  std::uint64_t while_disabled_ = 0;
  std::vector<Edge> edges_;
  Shortest shortest_;
};

/// What hangs on SPI1: the sockets that are jumpered for it. Nobody selected: the line floats.
class DriverSpiBus final : public SpiDevice {
 public:
  using Chips = std::array<std::optional<TmcSpiChip>, 8>;
  explicit DriverSpiBus(Chips& chips) : chips_(chips) {}
  void select(bool, Cycle) override {}
  std::uint16_t exchange(std::uint16_t sent, Cycle now) override;
  std::function<TmcSpiChip::Clock()> clock;  ///< of the master
  std::function<bool()> connected;           ///< the master's pins
  std::uint8_t floating = 0xFF;
  /// Bytes in which two chips drove the line.
  std::uint64_t fights() const { return fights_; }

 private:
  Chips& chips_;
  std::uint64_t fights_ = 0;
};

class OctopusBoard final : public Stm32f4Chip, public UsbSocket {
 public:
  static constexpr double kCountsPerStep = 16;

  static constexpr std::uint32_t kF446 = 0x1000'0421, kF405 = 0x1007'0413;  ///< DBGMCU_IDCODE

  OctopusBoard(const ElfImage& image, const BoardOptions& options);
  /// With another chip in the F446's place.
  OctopusBoard(const ElfImage& image, const BoardOptions& options, std::uint32_t device_id);
  ~OctopusBoard() override;

  std::uint32_t product_code() const override;
  BusTime boot_time() const override { return std::chrono::milliseconds{350}; }
  /// Where the rotor is.
  double true_counts(int axis) const override;
  void set_input(int input, bool level) override;
  const StepDriver& driver(int axis) const { return drivers_[static_cast<std::size_t>(axis)]; }
  /// What is in the sockets unless something else is plugged in.
  Tmc2209& tmc(int axis) { return chips_[static_cast<std::size_t>(axis)]; }
  /// In the place of a TMC2209, with the jumpers for SPI; before power.
  void plug(int axis, const SpiDriverParameters& parameters);
  TmcSpiChip& spi_driver(int axis) { return *spi_chips_[static_cast<std::size_t>(axis)]; }
  /// Of the motor behind whatever is in the socket.
  DrivenRotor& rotor(int axis) { return socket(static_cast<std::size_t>(axis)).rotor(); }
  DriverSpiBus& driver_spi() { return spi_bus_; }
  /// A jumper leads DIAG to the stop beside the driver.
  void wire_diag(int axis) {
    diag_wired_[static_cast<std::size_t>(axis)] = true;
    const bool level = socket(static_cast<std::size_t>(axis)).diag();
    diag_level_[static_cast<std::size_t>(axis)] = level;
    set_input(axis, level);
  }
  /// Times that a driver and the processor held a wire at different levels, each with force.
  std::uint64_t wire_fights() const { return wire_fights_; }
  void clear_edges() {
    for (StepDriver& driver : drivers_) driver.clear_edges();
  }
  /// On HE0 and T0 a hot end, on the bed's clamps a bed; nothing else is plugged in.
  HeatedPlaces& heated() { return heated_; }
  /// The pin of one of the heat node's heaters is high now.
  bool heater_on(int heater) const;
  bool fan_on(int fan) const;  ///< FAN0 to FAN5
  ServoPulses servo();
  /// A pin that gives power to something is driven, and not to its level without.
  bool anything_on() const;
  /// Pins that the program has made outputs.
  int outputs() const;
  OtgHs& usb() override { return usb_; }
  /// VBUS leads to no pin: without a host the bus just sleeps.
  void set_usb_cable(bool plugged) override;
  bool usb_device_seen() override;

 private:
  void reset_devices(Cycle now) override;
  void advance_devices(Cycle now) override;
  Cycle next_of_devices() const override;
  int clock_offset(std::uint32_t base, std::uint32_t address) const override;
  double analogue(int channel);
  void on_pins(Cycle now);
  SocketedDriver& socket(std::size_t axis);
  const SocketedDriver& socket(std::size_t axis) const;
  void look_at_wire(std::size_t axis, Cycle now);
  void look_at_diag();

  Timer tim1_, tim4_, tim8_;
  Dma dma2_;
  AdcBlock adc_;
  HeatedPlaces heated_;
  bool makers_loader_;  ///< runs first after every reset, and takes the RAM for itself
  OtgHs usb_;
  bool cable_ = false;
  Cycle sleeps_ = kNever;
  std::array<StepDriver, 8> drivers_;
  std::array<Tmc2209, 8> chips_{};
  DriverSpiBus::Chips spi_chips_{};
  DriverSpiBus spi_bus_{spi_chips_};
  Spi spi1_;
  struct Wire {
    PulledWire level;
    bool chip_low = false;  // the driver's part in it, when it was looked at
  };
  std::array<Wire, 8> wires_{};
  Cycle wires_next_ = kNever;  // of wires and drivers, or before it
  std::array<bool, 8> diag_wired_{}, diag_level_{};
  std::uint64_t wire_fights_ = 0;
};

}  // namespace kinebus::emulator
