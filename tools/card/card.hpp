#pragma once
// One node on a bench, by SDO alone: no machine file, no gateway, no second node. What its two motors draw
// and how warm they are, currents set, a motor jogged and tuned, switches and positions read.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "tools/card/node_sdo.hpp"

namespace kinebus {

class Card {
 public:
  struct Axis {
    cia402::State state{};
    bool position_known = false;
    std::int32_t position_counts = 0;  ///< 6064h
    int run_ma = 0, hold_ma = 0, measured_ma = 0;
    double stage_celsius = 0;
    double supply_volts = 0;
    int tune_state = 0;  ///< 2150h:8
    std::uint16_t error_code = 0;
  };
  struct Input {
    SwitchFunction function{};
    bool active_low = false, active = false;
  };
  struct State {
    std::string name;
    std::uint32_t serial = 0;
    std::array<Axis, 2> axes{};
    std::array<Input, kSwitchInputs> inputs{};
    std::vector<std::uint16_t> errors;  ///< EMCY codes, the last one first
  };
  struct Tuned {
    int resistance_mohm = 0, inductance_uh = 0;
    int encoder_offset = -1;  ///< -1: no encoder
  };

  /// All may throw CardError.
  Card(BusAccess bus, std::uint8_t node) : node_(std::move(bus), node) {}

  State state();
  /// Peak of a phase, mA; count at once, also under power. What is not given stays.
  void set_currents(int axis, std::optional<int> run_ma, std::optional<int> hold_ma);
  /// On: the motor holds where it is; a fault is reset first. Off: it can be turned by hand.
  void power(int axis, bool on);
  /// Switches the motor on and moves it by so many counts. `stop`: asked all the time; true ends the motion
  /// by its ramp. Returns where the motor is then (6064h).
  std::int32_t jog(int axis, std::int64_t counts, double counts_per_s,
                   const std::function<bool()>& stop = {});
  /// Switches the motor on and lets the node measure it: it must be free to turn by a few steps.
  Tuned tune(int axis);
  /// What was set and measured is kept through power-off (1010h). Neither motor may have power.
  void store();

 private:
  std::int64_t read(ObjectAddress address) { return node_.read(address); }
  std::int64_t read(int axis, ObjectAddress base) { return read(on(axis, base)); }
  void write(ObjectAddress address, std::int64_t value) { node_.write(address, value); }
  void write(int axis, ObjectAddress base, std::int64_t value) { write(on(axis, base), value); }
  static ObjectAddress on(int axis, ObjectAddress base);
  cia402::State drive_state(int axis);

  NodeSdo node_;
};

/// "operation enabled", as CiA 402 calls it.
const char* words_of(cia402::State state);
/// "home A"; "" for none.
const char* words_of(SwitchFunction function);

}  // namespace kinebus
