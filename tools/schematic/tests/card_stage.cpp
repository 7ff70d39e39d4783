#include <fmt/format.h>

#include <array>
#include <cmath>

#include "node_firmware/port/stm32f405/board.hpp"
#include "tools/schematic/tests/card_check.hpp"

namespace kinebus::schematic {
namespace {

struct MotorPins {
  std::string_view name;
  std::array<std::string_view, 4> pwm;  ///< phase A +, -, phase B +, -
  std::array<std::string_view, 2> current;
  std::string_view enable, over_current, temperature;
};
// As the table of board.hpp has it, in words that a circuit can be asked for.
constexpr std::array<MotorPins, 2> kMotors{
    {{"motor A", {"PA8", "PA9", "PA10", "PA11"}, {"PA0", "PA1"}, "PA4", "PB12", "PC1"},
     {"motor B", {"PC6", "PC7", "PC8", "PC9"}, {"PA2", "PA3"}, "PA5", "PA6", "PC2"}}};

class StageCheck {
 public:
  StageCheck(const Circuit& circuit, const MotorPins& pins, Complaints& found)
      : circuit_(circuit), pins_(pins), found_(found), volts_(circuit.volts(kSupplies)) {}

  void run() {
    for (std::size_t phase = 0; phase < 2; ++phase) check_phase(phase);
    check_enable();
    check_temperature();
  }

 private:
  std::size_t chip(std::string_view pin) const { return circuit_.net("STM32F405RG", pin); }
  double volts(std::size_t net) const { return net == Circuit::kNone ? -1 : volts_[net]; }
  void expect(bool holds, std::string_view words) {
    found_.expect(holds, fmt::format("{}: {}", pins_.name, words));
  }

  /// The half-bridge of a timer output: its middle, or kNone.
  std::size_t half_bridge(std::string_view pwm) {
    const auto drivers = circuit_.on(chip(pwm), "LM5106", "IN");
    if (drivers.size() != 1)
      return expect(false, fmt::format("{} is on no gate driver", pwm)), Circuit::kNone;
    const Part& driver = *drivers[0].part;
    const std::size_t middle = circuit_.net(driver, "HS"), boot = circuit_.net(driver, "HB");
    const auto upper = circuit_.on(circuit_.across(circuit_.net(driver, "HO"), "R"), "NMOS_DUAL", "2");
    const auto lower = circuit_.on(circuit_.across(circuit_.net(driver, "LO"), "R"), "NMOS_DUAL", "4");
    expect(upper.size() == 1 && circuit_.net(*upper[0].part, "1") == middle &&
               circuit_.net(*upper[0].part, "7") == circuit_.rail("VM") &&
               circuit_.net(*upper[0].part, "8") == circuit_.rail("VM"),
           fmt::format("{}: high does not turn the upper MOSFET on", pwm));
    expect(lower.size() == 1 && circuit_.net(*lower[0].part, "3") == circuit_.rail("GND") &&
               circuit_.net(*lower[0].part, "5") == middle && circuit_.net(*lower[0].part, "6") == middle,
           fmt::format("{}: low does not turn the lower MOSFET on", pwm));
    expect(circuit_.net(driver, "VDD") == circuit_.rail("+10V"),
           fmt::format("{}: driver without supply", pwm));
    expect(circuit_.across(boot, "C") == middle && circuit_.across(boot, "DIODE") == circuit_.rail("+10V") &&
               !circuit_.on(boot, "DIODE", "K").empty(),
           fmt::format("{}: no bootstrap", pwm));
    enables_.push_back(circuit_.net(driver, "EN"));
    // 24.3 kOhm: 150 ns by the data sheet's line (80 ns at 10 kOhm, 510 ns at 100 kOhm).
    const auto timing = circuit_.on(circuit_.net(driver, "RDT"), "R");
    const double ohm = timing.size() == 1 ? quantity(timing[0].part->value) : 0;
    const double dead_s = 80e-9 + (ohm - 10e3) * (430e-9 / 90e3);
    expect(std::fabs(dead_s - static_cast<double>(board::kDeadTimeS)) < 10e-9,
           fmt::format("{}: dead time {:.0f} ns", pwm, dead_s * 1e9));
    return middle;
  }

  void check_phase(std::size_t phase) {
    const std::size_t plus = half_bridge(pins_.pwm[2 * phase]), minus = half_bridge(pins_.pwm[2 * phase + 1]);
    const std::size_t out = circuit_.across(plus, "R", 0.01);
    const auto terminal = circuit_.on(out, "CONN_4", phase == 0 ? "1" : "3");
    expect(terminal.size() == 1 && circuit_.net(*terminal[0].part, phase == 0 ? "2" : "4") == minus,
           "windings are not on the motor's connector, or without a shunt of 10 mOhm in the + line");
    const auto amplifiers = circuit_.on(plus, "INA240", "IN+");
    if (amplifiers.size() != 1) return expect(false, "no amplifier at a shunt");
    const Part& amplifier = *amplifiers[0].part;
    expect(circuit_.net(amplifier, "IN-") == out, "an amplifier is not across its shunt");
    expect(circuit_.net(amplifier, "REF1") == circuit_.rail("+3V3A") &&
               circuit_.net(amplifier, "REF2") == circuit_.rail("GND") &&
               circuit_.net(amplifier, "VS") == circuit_.rail("+3V3A"),
           "an amplifier's zero is not half of the converter's reference");
    expect(std::fabs(0.01 * quantity(amplifier.property("Gain")) /
                         static_cast<double>(board::kCurrentVoltsPerAmpere) -
                     1) < 1e-3,
           "shunt and gain are not the firmware's volts per ampere");
    const std::size_t raw = circuit_.net(amplifier, "OUT");
    expect(circuit_.across(raw, "R", 100) == chip(pins_.current[phase]),
           fmt::format("{} does not see its amplifier", pins_.current[phase]));
    check_window(raw);
  }

  /// Two comparators on an amplifier: pull the break input low beyond the firmware's current.
  void check_window(std::size_t raw) {
    const double zero =
        static_cast<double>(board::kReferenceV) * board::kCurrentZero / static_cast<double>(board::kAdcSteps);
    int above = 0, below = 0;
    for (const End& end : circuit_.on(raw, "TLV9024")) {
      const bool inverting = end.pin->name[1] == '-';
      const std::string letter(1, end.pin->name[0]);
      const double amperes = (volts(circuit_.net(*end.part, letter + (inverting ? "+" : "-"))) - zero) /
                             static_cast<double>(board::kCurrentVoltsPerAmpere);
      const double wanted =
          inverting ? static_cast<double>(board::kBreakAmperes) : -static_cast<double>(board::kBreakAmperes);
      expect(std::fabs(amperes - wanted) < 0.02 * static_cast<double>(board::kBreakAmperes),
             fmt::format("a comparator trips at {:.2f} A", amperes));
      ++(inverting ? above : below);
      const std::size_t output = circuit_.net(*end.part, "OUT" + letter);
      expect(circuit_.across(output, "R", 100) == chip(pins_.over_current),
             fmt::format("a comparator does not pull {}", pins_.over_current));
      expect(volts(output) > 3.2, "the comparators are not pulled up");
    }
    expect(above == 1 && below == 1, "an amplifier is not watched in both directions");
  }

  /// Enabled: the enable pin, and not the chip's boot loader, and the first output driven.
  void check_enable() {
    for (const std::size_t enable : enables_)
      expect(enable == enables_.front() && enable != Circuit::kNone, "the drivers are not enabled together");
    if (enables_.empty()) return;
    const auto gates = circuit_.on(enables_.front(), "74LVC1G02", "Y");
    if (gates.size() != 1) return expect(false, "no gate enables the drivers");
    const auto first = circuit_.on(circuit_.net(*gates[0].part, "A"), "74LVC1G00", "Y");
    expect(
        first.size() == 1 && circuit_.net(*first[0].part, "A") == chip(pins_.enable) &&
            circuit_.net(*first[0].part, "B") == circuit_.net("TS3USB221", "S"),
        fmt::format(
            "the drivers are not enabled by {} alone, and off while the USB switch leads to the boot loader",
            pins_.enable));
    const std::size_t floating = circuit_.net(*gates[0].part, "B"), watched = chip(pins_.pwm[0]);
    double top = 0, bottom = 0;
    for (const End& end : circuit_.on(watched, "TLV9022")) {
      const std::string letter(1, end.pin->name[0]);
      const bool inverting = end.pin->name[1] == '-';
      (inverting ? top : bottom) = volts(circuit_.net(*end.part, letter + (inverting ? "+" : "-")));
      expect(circuit_.net(*end.part, "OUT" + letter) == floating,
             "what sees a floating output does not turn the drivers off");
    }
    const double rest = volts(watched);
    expect(bottom > 0.4 && bottom + 0.5 < rest && rest + 0.5 < top && top < 2.9,
           "a floating output is not seen as such");
    for (std::size_t i = 1; i < 4; ++i)
      expect(volts(chip(pins_.pwm[i])) == 0 || volts(chip(pins_.pwm[i])) > 3.2,
             fmt::format("{} rests at no level", pins_.pwm[i]));
  }

  void check_temperature() {
    const std::size_t net = chip(pins_.temperature);
    const auto sensors = circuit_.on(net, "THERMISTOR");
    expect(sensors.size() == 1 && circuit_.across(net, "THERMISTOR", 10e3) == circuit_.rail("GND") &&
               circuit_.across(net, "R", 10e3) == circuit_.rail("+3V3A"),
           fmt::format("{}: no thermistor of 10 kOhm to ground with 10 kOhm to the reference",
                       pins_.temperature));
    if (!sensors.empty())
      expect(quantity(sensors[0].part->property("Beta")) == static_cast<double>(board::kNtcBeta),
             "the thermistor's B is not the firmware's");
  }

  const Circuit& circuit_;
  const MotorPins& pins_;
  Complaints& found_;
  std::vector<double> volts_;
  std::vector<std::size_t> enables_;
};

}  // namespace

std::vector<std::string> check_stages(const Circuit& circuit) {
  Complaints found;
  for (const MotorPins& motor : kMotors) StageCheck(circuit, motor, found).run();
  return found.take();
}

}  // namespace kinebus::schematic
