#pragma once
// A TMC5160 or TMC2130 with its motor, after their datasheets (rev. 1.01 and 1.09): SPI with its times and
// answers one datagram late, registers, chopper modes, currents, StallGuard2, and what it finds out about
// motor, heat and supply. A judge: what the datasheet forbids is counted.

#include <array>
#include <cstdint>

#include "vcan_tests/emulator/cycle.hpp"
#include "vcan_tests/emulator/physics/driven_rotor.hpp"
#include "vcan_tests/emulator/physics/socketed_driver.hpp"

namespace kinebus::emulator {

enum class SpiDriverKind : std::uint8_t { kTmc5160, kTmc2130 };

struct SpiDriverParameters {
  SpiDriverKind kind = SpiDriverKind::kTmc5160;
  double sense_ohm = 0.075;  ///< of a TMC2130: 0.11, and 0.02 of its own
  double bond_ohm = 0;
  double clock_hz = 12.2e6;
  double torque_nm_per_a = 0.3;  ///< of the motor
  double free_load = 500;        ///< SG_RESULT of this motor without load, at SGT 0 ...
  double full_load = 0;          ///< ... and with all that it can turn
  double load_noise = 0;         ///< of SG_RESULT, each way at most
};
constexpr SpiDriverParameters tmc2130_parameters() {
  return {.kind = SpiDriverKind::kTmc2130, .sense_ohm = 0.11, .bond_ohm = 0.02, .clock_hz = 13e6};
}

class TmcSpiChip final : public SocketedDriver {
 public:
  explicit TmcSpiChip(const SpiDriverParameters& parameters = {});

  // SPI.
  struct Clock {
    int mode = 3;
    double hz = 1e6;
  };
  void on_select(bool selected, Cycle now);
  /// Eight clocks that end now; gives what the chip sends in them.
  std::uint8_t exchange(std::uint8_t sent, const Clock& clock, Cycle now);
  bool drives_line() const { return supplied_ && answers_ && selected_; }

  /// TSTEP is that of the last step until 2^20 of the chip's clocks have gone by without one.
  void advance(Cycle now);
  void on_enable(bool enabled) override;
  void on_step(bool direction, Cycle now) override;
  bool diag() const override { return diag_; }
  double rotor_counts() const override { return rotor_.counts(); }
  DrivenRotor& rotor() override { return rotor_; }

  // What happens to it.
  void set_supply(bool on);
  void set_answers(bool answers) { answers_ = answers; }
  void garble(int answers) { garbled_ = answers; }  ///< so many, by a bit
  void set_temperature(double celsius);
  void open_phase(bool open) { open_ = open; }
  void short_to_ground(bool is);
  void short_to_supply(bool is);  ///< told by a TMC5160 only
  void set_charge_pump_low(bool low);

  std::uint32_t read_register(std::uint8_t address) const;
  double run_amperes() const { return amperes(registers_.at(0x10) >> 8 & 31); }
  double hold_amperes() const { return amperes(registers_.at(0x10) & 31); }
  bool bridges_on() const;
  int microsteps() const;
  bool interpolates() const { return (registers_.at(0x6C) >> 28 & 1) != 0; }
  bool stealth() const;
  std::uint64_t writes() const { return writes_; }
  /// Datagrams that the datasheet forbids: another mode, too fast a clock, too short times around CSN, less
  /// than 40 bits; and values that it forbids, or registers that the chip does not have.
  std::uint64_t bad_datagrams() const { return bad_; }
  /// Times that CSN was low and no clock came.
  std::uint64_t empty_selects() const { return empty_selects_; }

 private:
  bool is_5160() const { return p_.kind == SpiDriverKind::kTmc5160; }
  void reset_registers();
  void execute(std::uint64_t command);
  void write_register(std::uint8_t address, std::uint32_t value);
  bool writable(std::uint8_t address) const;
  std::uint32_t drv_status() const;
  std::uint8_t spi_status() const;
  double amperes(std::uint32_t scale) const;
  void measure_load(double torque);
  double torque_nm() const { return p_.torque_nm_per_a * run_amperes() * (open_ ? 0.5 : 1); }
  double tstep() const;
  void shorts_found();
  void update_diag();

  SpiDriverParameters p_;
  std::array<std::uint32_t, 128> registers_{};
  bool supplied_ = true, answers_ = true, enabled_ = false;
  int garbled_ = 0;
  std::uint32_t gstat_ = 1;
  std::uint64_t writes_ = 0, bad_ = 0, empty_selects_ = 0;

  // SPI.
  bool selected_ = false;
  std::uint64_t shift_ = 0;
  int bits_ = 0;
  std::uint32_t answer_ = 0;  ///< to the last access
  std::uint8_t latched_ = 0;  ///< status at its end
  Cycle selected_at_ = 0, released_at_ = 0, last_clock_ = 0;

  // Motor and what the chip finds.
  DrivenRotor rotor_;
  bool too_hot_ = false, pre_warning_ = false, open_ = false, charge_pump_low_ = false;
  bool shorted_to_ground_ = false, shorted_to_supply_ = false, ground_kept_ = false, supply_kept_ = false;
  Cycle last_step_ = 0, tstep_cycles_ = kNever, stands_at_ = kNever;
  std::uint32_t stall_guard_ = 0x3FF;
  int since_measure_ = 0;
  double felt_nm_ = 0;  ///< since then
  std::uint32_t noise_ = 1;
  bool diag_ = false;
};

}  // namespace kinebus::emulator
