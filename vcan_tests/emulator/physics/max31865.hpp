#pragma once
// A MAX31865 with a resistance thermometer at its clamps, from the facts of its data sheet, and stricter:
// what that only warns of is a mistake here, times are the longest, and a conversion that was not waited for
// gives what was before.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <random>

#include "vcan_tests/emulator/peripherals/spi.hpp"

namespace kinebus::emulator {

class Max31865Chip final : public SpiDevice {
 public:
  /// As the sheet decodes faults. With FORCE- broken it measures anything, with RTDIN- at ground what seems
  /// right.
  enum class Wires : std::uint8_t { kWhole, kElementOpen, kElementShort, kForceOpen, kGrounded };

  void select(bool selected, Cycle now) override;
  std::uint16_t exchange(std::uint16_t sent, Cycle now) override;
  /// Its supply has sagged.
  void reset();

  std::function<double()> ohm = [] { return 100.0; };  ///< of the element
  double reference_ohm = 430;
  int wires = 2;  ///< that lead to the element: 2, 3, 4
  double lead_ohm = 0;
  Wires state = Wires::kWhole;
  /// What it measures with FORCE- broken; as it comes the worst, what it was before.
  std::optional<double> indeterminate;
  bool voltage = false;   ///< an input is beyond the supply
  bool absent = false;    ///< nobody drives the line back ...
  bool line_low = false;  ///< ... which is low then, else high
  bool stands = false;    ///< it answers, and its converter has stopped
  /// The sheet does not say whether settings that are written anew begin a conversion anew.
  bool writes_restart = false;
  /// As the master has set it.
  std::function<int()> mode = [] { return 3; };
  std::function<double()> clock_hz = [] { return 4e6; };

  /// SPI mode or clock that it does not take, too soon after the select, settings that its sheet forbids.
  std::uint64_t mistakes() const { return mistakes_; }
  std::uint64_t conversions() const { return conversions_; }

 private:
  std::uint8_t read(std::uint8_t address);
  void write(std::uint8_t address, std::uint8_t value, Cycle now);
  void settle(Cycle now);
  void convert();
  void find_breaks();
  bool automatic() const;
  bool open() const;

  std::array<std::uint8_t, 8> registers_ = at_power_up();
  static std::array<std::uint8_t, 8> at_power_up() { return {0, 0, 0, 0xFF, 0xFF, 0, 0, 0}; }
  std::mt19937 random_{5};
  bool selected_ = false, first_ = true;
  std::uint8_t address_ = 0;
  double last_share_ = 0.25;
  Cycle selected_at_ = 0, released_at_ = -kCoreHz, converted_at_ = kNever, looked_at_ = kNever;
  std::uint64_t mistakes_ = 0, conversions_ = 0;
};

}  // namespace kinebus::emulator
