#pragma once
// A TMC2209 with its motor, after its datasheet (rev. 1.09): single wire UART with its bit times, registers,
// chopper modes, current scale, StallGuard, DIAG, and what it finds out about motor, heat and supply.

#include <array>
#include <cstdint>
#include <vector>

#include "vcan_tests/emulator/cycle.hpp"
#include "vcan_tests/emulator/physics/driven_rotor.hpp"
#include "vcan_tests/emulator/physics/socketed_driver.hpp"

namespace kinebus::emulator {

struct Tmc2209Parameters {
  double sense_ohm = 0.11, bond_ohm = 0.02;
  double clock_hz = 12.2e6;         ///< its own oscillator, within 4 % of 12 MHz
  double answer_bit_error = 0.015;  ///< its bits are longer than those that it has heard
  double torque_nm_per_a = 0.3;     ///< of the motor
  double free_load = 420;           ///< SG_RESULT of this motor without load ...
  double full_load = 0;             ///< ... and with all that it can turn
  double load_noise = 0;            ///< of SG_RESULT, each way at most
  int pins_resolution = 8;          ///< microsteps by MS1 and MS2 at ground: address 0
};

class Tmc2209 final : public SocketedDriver {
 public:
  Tmc2209() : Tmc2209(Tmc2209Parameters{}) {}
  explicit Tmc2209(const Tmc2209Parameters& parameters);

  // Wire.
  void on_wire(bool high, Cycle now);
  bool pulls_low() const { return pulls_low_; }
  Cycle next_event() const { return sample_at_ < stands_at_ ? sample_at_ : stands_at_; }
  void advance(Cycle now);

  // Pins.
  void on_enable(bool enabled) override;
  void on_step(bool direction, Cycle now) override;
  bool diag() const override { return diag_; }

  // What happens to it.
  void set_supply(bool on);
  void set_answers(bool answers) { answers_ = answers; }
  void garble(int answers) { garbled_ = answers; }  ///< so many, by a bit
  void set_temperature(double celsius);
  void open_phase(bool open) { open_ = open; }
  void short_to_ground(bool is) {
    shorted_ = is;
    short_found();
  }
  void set_load(double nm) { rotor_.set_load(nm); }
  void set_end_stop(double counts, bool above) { rotor_.set_end_stop(counts, above); }

  double rotor_counts() const override { return rotor_.counts(); }
  DrivenRotor& rotor() override { return rotor_; }
  std::uint32_t read_register(std::uint8_t address) const;
  double run_amperes() const { return amperes(registers_.at(0x10) >> 8 & 31); }
  double hold_amperes() const { return amperes(registers_.at(0x10) & 31); }
  bool bridges_on() const;
  int microsteps() const;
  bool interpolates() const { return (registers_.at(0x6C) >> 28 & 1) != 0; }
  bool stealth() const;
  std::uint64_t writes() const { return writes_; }
  std::uint64_t bad_datagrams() const { return bad_; }

 private:
  enum class Hears : std::uint8_t { kNothing, kSync, kByte, kGap, kAnswers, kWaitsForRest };
  void reset_registers();
  void byte_done(unsigned byte, Cycle end);
  void datagram_done(Cycle end);
  void reject(Cycle now);
  void answer(std::uint8_t address, Cycle end);
  void write_register(std::uint8_t address, std::uint32_t value);
  double amperes(std::uint32_t scale) const;
  double torque_nm() const { return p_.torque_nm_per_a * run_amperes() * (open_ ? 0.5 : 1); }
  void measure_load(double nm);
  void short_found();
  void update_diag();

  Tmc2209Parameters p_;
  std::array<std::uint32_t, 128> registers_{};
  bool supplied_ = true, answers_ = true, enabled_ = false;
  int garbled_ = 0;
  std::uint32_t gstat_ = 1;
  std::uint8_t ifcnt_ = 0;
  std::uint64_t writes_ = 0, bad_ = 0;

  // Wire.
  Hears hears_ = Hears::kNothing;
  bool wire_high_ = true, pulls_low_ = false;
  Cycle start_ = 0, second_fall_ = 0, bit_ = 0, sample_at_ = kNever, last_edge_ = 0;
  int bits_ = 0;
  unsigned byte_ = 0;
  std::vector<std::uint8_t> heard_;
  std::vector<bool> answer_bits_;
  std::size_t answer_place_ = 0;

  // Motor and what the chip finds.
  double celsius_ = 40;
  bool too_hot_ = false, pre_warning_ = false, open_ = false, shorted_ = false, short_kept_ = false;
  DrivenRotor rotor_;
  bool diag_ = false;
  Cycle last_step_ = 0, tstep_cycles_ = kNever, stands_at_ = kNever;
  std::uint32_t noise_ = 1;
  std::uint32_t stall_guard_ = 510;
  int steps_since_measure_ = 0;
};

}  // namespace kinebus::emulator
