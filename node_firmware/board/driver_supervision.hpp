#pragma once
// What nodes and stepper drivers that can be spoken to have to tell each other: currents and other settings
// from the objects; faults and troubles from the drivers.

#include <array>
#include <cstdint>

#include "node_firmware/board/local_clock.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/step/stepper_driver.hpp"
#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus {

/// `socket`: of one axis.
template <typename Socket>
std::uint16_t driver_fault(const Socket& socket) {
  namespace finding = step::finding;
  const auto& chip = socket.chip();
  const std::uint8_t found = chip.findings();
  if (socket.state() == step::DriverState::kStandsAlone) return emcy::kNoError;
  if (chip.lost_settings()) return emcy::kDriverReset;
  if ((found & finding::kShortToGround) != 0) return emcy::kShortToGround;
  if ((found & finding::kShortToSupply) != 0) return emcy::kShortToSupply;
  if ((found & finding::kTooHot) != 0) return emcy::kDriveTemperature;
  if (chip.charge_pump_low()) return emcy::kUnderVoltage;
  if (chip.driver_error()) return emcy::kShortCircuit;
  return chip.open_load() ? emcy::kPhaseOpen : emcy::kNoError;
}

/// Before the bus hears of the board: the drivers get their settings, or are found silent. `Counter`: local
/// time.
template <LocalCounter Counter, typename Drivers>
void settle_drivers(Drivers& drivers) {
  LocalClock<Counter> clock;
  constexpr LocalTime kLongest = std::chrono::seconds{1};
  while (!drivers.settled() && clock.now() < kLongest) drivers.serve(clock.now());
}

/// Axes of which each has such a driver. `Drivers`: step::DriverChain.
template <typename Drivers>
class DriverSupervision {
 public:
  explicit constexpr DriverSupervision(Drivers& drivers) : drivers_(drivers) {}

  /// The axis must not have power, and why; 0: it may.
  std::uint16_t refusal(std::size_t place) const {
    const auto& driver = drivers_.driver(place);
    if (driver.state() == step::DriverState::kSilent) return emcy::kDriverSilent;
    const std::uint16_t fault = driver_fault(driver);
    return fault != emcy::kNoError || driver.usable() ? fault : emcy::kDriverSilent;
  }
  /// With power: it has to go, and why; 0: it may stay. A driver that does not answer any more goes on as it
  /// was told.
  std::uint16_t fault(std::size_t place) const { return driver_fault(drivers_.driver(place)); }
  /// Without power. What a driver has kept of its past is of no account when the axis is switched on.
  void forget(std::size_t place) {
    auto& driver = drivers_.driver(place);
    if (driver.usable()) driver.acknowledge();
  }

  /// Now and then. True: the node was told something.
  bool serve(Node& node, LocalTime now, std::size_t place, int axis, bool powered) {
    auto& driver = drivers_.driver(place);
    driver.set_spoken_to(node.axis_parameter(slot_of_axes(object::kDriverKind), axis) != 0);
    driver.set(settings_of(node, axis));
    const std::int32_t speed = node.axis(axis).velocity(now);
    driver.set_slow_motion(powered && speed != 0 && speed < kSlow && speed > -kSlow);
    node.set_driver(axis, {.state = static_cast<std::uint8_t>(driver.state()),
                           .status = driver.chip().status(),
                           .stall_guard = driver.chip().stall_guard(),
                           .found = driver.chip().found()});
    const bool told = serve_troubles(node, now, place, axis, powered);
    return tell_silence(node, place, powered) || told;
  }

 private:
  enum Trouble : std::uint8_t { kHot = 1, kSilent = 2 };
  static constexpr std::array<std::uint16_t, 2> kCodes{emcy::kDriveTemperature, emcy::kDriverSilent};
  // 1.2 turns/s of 51,200 counts: the driver's open load flag is of no use in fast motion.
  static constexpr std::int32_t kSlow = 60'000;

  static step::DriverSettings settings_of(const Node& node, int axis) {
    const auto value = [&](AxisSlots slots) {
      return static_cast<std::uint32_t>(node.axis_parameter(slots, axis));
    };
    return {.run_ma = static_cast<std::uint16_t>(value(slot_of_axes(object::kRunCurrent))),
            .hold_ma = static_cast<std::uint16_t>(value(slot_of_axes(object::kHoldCurrent))),
            .spread_above = value(slot_of_axes(object::kSpreadCycleAbove)),
            .stall_threshold = static_cast<std::uint8_t>(value(slot_of_axes(object::kStallThreshold))),
            .stall_above = value(slot_of_axes(object::kStallAbove)),
            .homing = node.axis(axis).mode_display() == static_cast<int>(cia402::Mode::kHoming),
            .sense_milliohm = static_cast<std::uint16_t>(value(slot_of_axes(object::kSenseResistor)))};
  }
  // Power is kept, all stop on the path.
  bool serve_troubles(Node& node, LocalTime now, std::size_t place, int axis, bool powered) {
    const auto& driver = drivers_.driver(place);
    std::uint8_t present = 0;
    if (powered && (driver.chip().findings() & step::finding::kPreWarning) != 0) present |= kHot;
    if (powered && driver.state() == step::DriverState::kSilent) present |= kSilent;
    std::uint8_t& was = troubles_[place];
    if (present == was) return false;
    const std::size_t neighbour = place ^ 1;
    const std::uint8_t other = neighbour < troubles_.size() ? troubles_[neighbour] : std::uint8_t{0};
    for (std::size_t i = 0; i < kCodes.size(); ++i) {
      const auto bit = static_cast<std::uint8_t>(1u << i);
      if ((present & ~was & bit) != 0) node.on_axis_trouble(now, axis, kCodes[i]);
      if ((was & ~present & ~other & bit) != 0) node.on_axis_trouble_gone(kCodes[i]);
    }
    was = present;
    return true;
  }
  // One that does not answer from the start on is told once: its socket may be empty. Nobody hears a node
  // without id.
  bool tell_silence(Node& node, std::size_t place, bool powered) {
    const bool silent = drivers_.driver(place).state() == step::DriverState::kSilent;
    if (node.node_id() == 0) return false;
    const bool news = silent && !silence_told_[place] && !powered;
    silence_told_[place] = silent;
    if (!news) return false;
    node.report(emcy::kDriverSilent);
    node.on_axis_trouble_gone(emcy::kDriverSilent);
    return true;
  }

  Drivers& drivers_;
  std::array<std::uint8_t, Drivers::kDrivers> troubles_{};
  std::array<bool, Drivers::kDrivers> silence_told_{};
};

/// Of a board whose drivers are left to themselves.
struct NoDrivers {};
template <>
class DriverSupervision<NoDrivers> {
 public:
  static constexpr std::uint16_t refusal(std::size_t) { return emcy::kNoError; }
  static constexpr std::uint16_t fault(std::size_t) { return emcy::kNoError; }
  static constexpr void forget(std::size_t) {}
  static constexpr bool serve(Node&, LocalTime, std::size_t, int, bool) { return false; }
};

}  // namespace kinebus
