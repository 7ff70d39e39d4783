#pragma once
// What is plugged into a driver's socket: a TMC2209 behind the one wire of its UART, a TMC5160 or a TMC2130
// behind SPI, which has that wire as its select. Found out by asking for a version, the one way and then the
// other, until a chip has answered; from then on it is spoken to in its own way alone.

#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "node_firmware/step/tmc2209.hpp"
#include "node_firmware/step/tmc_spi.hpp"

namespace kinebus::step {

class DriverSocket {
 public:
  void set(const DriverSettings& settings) { plugged().set(settings); }
  void set_spoken_to(bool spoken_to) {
    if (spoken_to == spoken_to_) return;
    spoken_to_ = spoken_to;
    searched_ = false;
    plug<tmc2209::Driver>();
  }
  void set_slow_motion(bool slow) { plugged().set_slow_motion(slow); }
  void acknowledge() { plugged().acknowledge(); }

  std::optional<Exchange> next(LocalTime now) {
    if (!spoken_to_) return std::nullopt;
    if (chip().found() == 0 && chip().state() == DriverState::kSilent) {
      const bool both = bus() == DriverBus::kSpi;
      searched_ = searched_ || both;
      if (both && chip().rests(now)) return std::nullopt;
      both ? plug<tmc2209::Driver>() : plug<tmc_spi::Driver>();
    }
    return plugged().next(now);
  }
  void on_heard(const Exchange& exchange, std::span<const std::uint8_t> bytes) {
    // Otherwise it is not the one that was spoken to.
    if (exchange.bus == bus()) plugged().on_heard(bytes);
  }

  DriverState state() const {
    if (!spoken_to_) return DriverState::kStandsAlone;
    if (chip().found() != 0) return chip().state();
    return searched_ ? DriverState::kSilent : DriverState::kUnasked;
  }
  bool usable() const { return !spoken_to_ || chip().usable(); }
  bool busy() const { return spoken_to_ && (chip().found() != 0 ? chip().busy() : !searched_); }
  /// The one that was found, or is looked for.
  const StepperDriver& chip() const {
    if (const auto* spi = std::get_if<tmc_spi::Driver>(&chip_)) return *spi;
    return *std::get_if<tmc2209::Driver>(&chip_);
  }

 private:
  StepperDriver& plugged() {
    if (auto* spi = std::get_if<tmc_spi::Driver>(&chip_)) return *spi;
    return *std::get_if<tmc2209::Driver>(&chip_);
  }
  DriverBus bus() const {
    return std::holds_alternative<tmc_spi::Driver>(chip_) ? DriverBus::kSpi : DriverBus::kUart;
  }
  template <typename Chip>
  void plug() {
    const DriverSettings settings = chip().settings();
    chip_.emplace<Chip>();
    plugged().set(settings);
    if (searched_) plugged().expect_nobody();
  }

  std::variant<tmc2209::Driver, tmc_spi::Driver> chip_;
  bool spoken_to_ = true;
  bool searched_ = false;  ///< both ways, in vain
};

}  // namespace kinebus::step
