#include "vcan_tests/emulator/physics/tmc_spi_chip.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace kinebus::emulator {
namespace {

namespace spi_reg {
constexpr std::uint8_t kGconf = 0x00, kGstat = 0x01, kIoin = 0x04, kShortConf = 0x09, kDrvConf = 0x0A,
                       kGlobalScaler = 0x0B, kIholdIrun = 0x10, kTpowerdown = 0x11, kTstep = 0x12,
                       kTpwmthrs = 0x13, kTcoolthrs = 0x14, kThigh = 0x15, kChopconf = 0x6C, kCoolconf = 0x6D,
                       kDrvStatus = 0x6F, kPwmconf = 0x70;
}  // namespace spi_reg
// SPI interface timing, with the chip's own clock.
constexpr double kFastestHz = 4e6;
constexpr double kCyclesPerNanosecond = static_cast<double>(kCoreHz) / 1e9;
constexpr auto kAroundSelect = static_cast<Cycle>(10 * kCyclesPerNanosecond);
constexpr int kDatagramBits = 40;

}  // namespace

TmcSpiChip::TmcSpiChip(const SpiDriverParameters& parameters) : p_(parameters) {
  reset_registers();
}

void TmcSpiChip::reset_registers() {
  registers_ = {};
  if (is_5160()) {
    registers_[spi_reg::kGconf] = 0x8;
    registers_[spi_reg::kShortConf] = 0x10606;
    registers_[spi_reg::kDrvConf] = 0x80400;
    registers_[spi_reg::kTpowerdown] = 10;
    registers_[spi_reg::kChopconf] = 0x10410150;
    registers_[spi_reg::kPwmconf] = 0xC40C001E;
  } else {
    registers_[spi_reg::kPwmconf] = 0x50480;
  }
  gstat_ = 1;
  ground_kept_ = supply_kept_ = false;
  shift_ = answer_ = 0;
  latched_ = spi_status();
  selected_ = false;
  bits_ = 0;
}

void TmcSpiChip::on_select(bool selected, Cycle now) {
  if (selected == selected_) return;
  selected_ = selected;
  if (!supplied_) return;
  if (selected) {
    // CSN high for two of the chip's clocks and 10 ns.
    const double least_s = 2 / p_.clock_hz + 10e-9;
    if (static_cast<double>(now - released_at_) < least_s * static_cast<double>(kCoreHz)) ++bad_;
    selected_at_ = now;
    bits_ = 0;
    shift_ = std::uint64_t{latched_} << 32 | answer_;
    return;
  }
  released_at_ = now;
  if (bits_ == 0)
    ++empty_selects_;
  else if (bits_ < kDatagramBits || now - last_clock_ < kAroundSelect)
    ++bad_;
  // What is in the shift register is the command, however it came there.
  execute(shift_ & 0xFF'FFFF'FFFF);
}

std::uint8_t TmcSpiChip::exchange(std::uint8_t sent, const Clock& clock, Cycle now) {
  if (!selected_ || !supplied_) return 0xFF;
  const auto bit_cycles = static_cast<double>(kCoreHz) / clock.hz;
  if (clock.mode != 3 || clock.hz > kFastestHz) ++bad_;
  if (bits_ == 0 &&
      static_cast<double>(now - selected_at_) < 7.5 * bit_cycles + static_cast<double>(kAroundSelect))
    ++bad_;
  auto out = static_cast<std::uint8_t>(shift_ >> 32);
  // Another mode takes each bit at the wrong edge.
  const auto taken = clock.mode == 3 ? sent : static_cast<std::uint8_t>(sent << 1);
  shift_ = (shift_ << 8 | taken) & 0xFF'FFFF'FFFF;
  bits_ += 8;
  last_clock_ = now;
  if (garbled_ > 0 && bits_ == 24) {
    --garbled_;
    out ^= 0x10;
  }
  return out;
}

void TmcSpiChip::execute(std::uint64_t command) {
  const auto address = static_cast<std::uint8_t>(command >> 32 & 0x7F);
  const auto value = static_cast<std::uint32_t>(command);
  if ((command >> 39 & 1) != 0) {
    ++writes_;
    write_register(address, value);
    answer_ = value;
  } else {
    answer_ = read_register(address);
    if (address == spi_reg::kGstat && !is_5160()) gstat_ = charge_pump_low_ ? 4 : 0;
  }
  latched_ = spi_status();
}

std::uint8_t TmcSpiChip::spi_status() const {
  const bool stands = tstep_cycles_ == kNever;
  // A TMC5160's own motion stands where it is to be.
  return static_cast<std::uint8_t>((gstat_ & 3) | (stall_guard_ == 0 ? 4u : 0u) | (stands ? 8u : 0u) |
                                   (is_5160() ? 0x30u : 0u));
}

std::uint32_t TmcSpiChip::read_register(std::uint8_t address) const {
  switch (address) {
    case spi_reg::kGconf:
    case spi_reg::kChopconf:
      return registers_.at(address);
    case spi_reg::kGstat:
      return gstat_;
    case spi_reg::kIoin:
      return (is_5160() ? 0x30000000u : 0x11000000u) | 0x40u | (enabled_ ? 0u : 0x10u);
    case spi_reg::kTstep:
      return 0xFFFFF;
    case spi_reg::kDrvStatus:
      return drv_status();
    default:
      return 0;  // write only, or not there
  }
}

std::uint32_t TmcSpiChip::drv_status() const {
  // Flags of one phase: A.
  std::uint32_t status = stall_guard_ & 0x3FF;
  if (is_5160()) status |= (supply_kept_ ? 1u << 12 : 0u) | (stealth() ? 1u << 14 : 0u);
  status |= (registers_.at(spi_reg::kIholdIrun) >> 8 & 31) << 16;
  status |= (stall_guard_ == 0 ? 1u << 24 : 0u) | (too_hot_ ? 1u << 25 : 0u) |
            (pre_warning_ ? 1u << 26 : 0u) | (ground_kept_ ? 1u << 27 : 0u);
  if (bridges_on() && open_) status |= 1u << 29;
  if (tstep_cycles_ == kNever) status |= 1u << 31;
  return status;
}

bool TmcSpiChip::writable(std::uint8_t address) const {
  const auto in = [address](std::initializer_list<std::uint8_t> list) {
    return std::ranges::find(list, address) != list.end();
  };
  return in({spi_reg::kGconf, spi_reg::kIholdIrun, spi_reg::kTpowerdown, spi_reg::kTpwmthrs,
             spi_reg::kTcoolthrs, spi_reg::kThigh, spi_reg::kChopconf, spi_reg::kCoolconf,
             spi_reg::kPwmconf}) ||
         (is_5160() && in({spi_reg::kGstat, spi_reg::kShortConf, spi_reg::kDrvConf, spi_reg::kGlobalScaler}));
}

void TmcSpiChip::write_register(std::uint8_t address, std::uint32_t value) {
  if (!writable(address)) {
    ++bad_;
    return;
  }
  if (address == spi_reg::kGstat) {
    gstat_ = (gstat_ & ~value) | (charge_pump_low_ ? 4u : 0u);
    return;
  }
  if (address == spi_reg::kGlobalScaler && value > 0 && value < 32) ++bad_;
  // Bit 3 of a TMC2130's GCONF is for commutation by an encoder, bit 17 of both for tests.
  if (address == spi_reg::kGconf && ((value >> 17 & 1) != 0 || (!is_5160() && (value >> 3 & 1) != 0))) ++bad_;
  registers_[address] = value;
  if (address == spi_reg::kChopconf && (value & 0xF) == 0) ground_kept_ = supply_kept_ = false;
  shorts_found();
}

bool TmcSpiChip::bridges_on() const {
  return supplied_ && enabled_ && (registers_.at(spi_reg::kChopconf) & 0xF) != 0 && !too_hot_ &&
         !ground_kept_ && !supply_kept_ && !charge_pump_low_;
}

int TmcSpiChip::microsteps() const {
  return 256 >> std::min(registers_.at(spi_reg::kChopconf) >> 24 & 0xF, 8u);
}

double TmcSpiChip::tstep() const {
  if (tstep_cycles_ == kNever) return 1e9;
  return static_cast<double>(tstep_cycles_) / static_cast<double>(kCoreHz) * p_.clock_hz;
}

bool TmcSpiChip::stealth() const {
  if ((registers_.at(spi_reg::kGconf) >> 2 & 1) == 0) return false;
  return tstep() >= registers_.at(spi_reg::kTpwmthrs);
}

double TmcSpiChip::amperes(std::uint32_t scale) const {
  const std::uint32_t scaler = registers_.at(spi_reg::kGlobalScaler);
  const double global = !is_5160() || scaler == 0 ? 1 : scaler / 256.0;
  const bool fine = !is_5160() && (registers_.at(spi_reg::kChopconf) >> 17 & 1) != 0;
  const double full_v = is_5160() ? 0.325 : fine ? 0.180 : 0.320;
  return global * (scale + 1) / 32.0 * full_v / (p_.sense_ohm + p_.bond_ohm);
}

void TmcSpiChip::on_enable(bool enabled) {
  if (enabled == enabled_) return;
  if (!enabled) {
    ground_kept_ = supply_kept_ = false;
    tstep_cycles_ = kNever;
  }
  enabled_ = enabled;
  shorts_found();
}

void TmcSpiChip::short_to_ground(bool is) {
  shorted_to_ground_ = is;
  shorts_found();
}
void TmcSpiChip::short_to_supply(bool is) {
  shorted_to_supply_ = is;
  shorts_found();
}

void TmcSpiChip::shorts_found() {
  if (bridges_on() && (shorted_to_ground_ || (shorted_to_supply_ && is_5160()))) {
    ground_kept_ = shorted_to_ground_;
    supply_kept_ = shorted_to_supply_ && is_5160();
    gstat_ |= 2;
  }
  update_diag();
}

void TmcSpiChip::set_temperature(double celsius) {
  pre_warning_ = celsius >= 120;
  if (celsius >= 150) {
    too_hot_ = true;
    gstat_ |= 2;
  }
  if (!pre_warning_) too_hot_ = false;
  update_diag();
}

void TmcSpiChip::set_charge_pump_low(bool low) {
  charge_pump_low_ = low;
  if (low) gstat_ |= 4;
}

void TmcSpiChip::set_supply(bool on) {
  if (on && !supplied_) reset_registers();
  supplied_ = on;
  update_diag();
}

void TmcSpiChip::advance(Cycle now) {
  if (now < stands_at_) return;
  stands_at_ = tstep_cycles_ = kNever;
  update_diag();
}

void TmcSpiChip::on_step(bool direction, Cycle now) {
  const int way = 256 / microsteps() * (direction ? 1 : -1);
  const Cycle since = now - last_step_;
  last_step_ = now;
  tstep_cycles_ = since > kCoreHz / 10 ? kNever : since / static_cast<Cycle>(std::abs(way));
  stands_at_ = now + static_cast<Cycle>((1 << 20) / p_.clock_hz * static_cast<double>(kCoreHz));
  if (!bridges_on()) return update_diag();
  const double torque = torque_nm();
  felt_nm_ = std::max(felt_nm_, rotor_.on_field(way, torque));
  since_measure_ += std::abs(way);
  const bool filtered = (registers_.at(spi_reg::kCoolconf) >> 24 & 1) != 0;
  if (since_measure_ >= (filtered ? 4 : 1) * 256) measure_load(torque);
  update_diag();
}

// Each full step, filtered each four; in SpreadCycle only, and moved by SGT: at 63 no load is a stall.
void TmcSpiChip::measure_load(double torque) {
  const int threshold = static_cast<int>(registers_.at(spi_reg::kCoolconf) >> 16 & 0x7F);
  const int sgt = threshold >= 64 ? threshold - 128 : threshold;
  const double share = torque <= 0 ? 1 : std::min(felt_nm_ / torque, 1.0);
  noise_ = noise_ * 1'664'525u + 1'013'904'223u;
  const double noise = p_.load_noise * (static_cast<double>(noise_ >> 8) / (1 << 23) - 1);
  const double result = p_.full_load + (p_.free_load - p_.full_load) * (1 - share) + noise + 4 * sgt;
  stall_guard_ = stealth() ? 0x3FF : static_cast<std::uint32_t>(std::clamp(result, 0.0, 1023.0));
  since_measure_ = 0;
  felt_nm_ = 0;
}

// DIAG1, as the board has it: driven high where GCONF says so.
void TmcSpiChip::update_diag() {
  const std::uint32_t general = registers_.at(spi_reg::kGconf);
  const bool told = (general >> 8 & 1) != 0 && (general >> 13 & 1) != 0;
  diag_ = supplied_ && told && bridges_on() && !stealth() && tstep() <= registers_.at(spi_reg::kTcoolthrs) &&
          stall_guard_ == 0;
}

}  // namespace kinebus::emulator
