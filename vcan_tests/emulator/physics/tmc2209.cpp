#include "vcan_tests/emulator/physics/tmc2209.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kGconf = 0x00, kGstat = 0x01, kIfcnt = 0x02, kNodeConf = 0x03, kIoin = 0x06,
                       kIholdIrun = 0x10, kTpowerdown = 0x11, kTstep = 0x12, kTpwmthrs = 0x13,
                       kTcoolthrs = 0x14, kVactual = 0x22, kSgthrs = 0x40, kSgResult = 0x41, kCoolconf = 0x42,
                       kChopconf = 0x6C, kDrvStatus = 0x6F, kPwmconf = 0x70;
constexpr Cycle kShortestBit = kCoreHz / 500'000, kLongestBit = kCoreHz / 9'000;

// As the datasheet's example in C has it.
unsigned crc_of(const std::vector<std::uint8_t>& bytes, std::size_t count) {
  unsigned crc = 0;
  for (std::size_t i = 0; i < count; ++i) {
    unsigned byte = bytes[i];
    for (int k = 0; k < 8; ++k) {
      if ((crc >> 7) != (byte & 1))
        crc = ((crc << 1) ^ 7) & 0xFF;
      else
        crc = (crc << 1) & 0xFF;
      byte >>= 1;
    }
  }
  return crc;
}

}  // namespace

Tmc2209::Tmc2209(const Tmc2209Parameters& parameters) : p_(parameters) {
  reset_registers();
}

void Tmc2209::reset_registers() {
  registers_ = {};
  registers_[kGconf] = 0x101;
  registers_[kIholdIrun] = 0x11F10;
  registers_[kTpowerdown] = 20;
  registers_[kChopconf] = 0x10000053;
  registers_[kPwmconf] = 0xC10D0024;
  gstat_ = 1;
  ifcnt_ = 0;
  short_kept_ = false;
  hears_ = Hears::kNothing;
  sample_at_ = kNever;
  pulls_low_ = false;
}

// Wire. A datagram begins with 05h, whose edges give the bit time; every byte begins with a falling edge.
void Tmc2209::on_wire(bool high, Cycle now) {
  if (high == wire_high_) return;
  wire_high_ = high;
  if (!supplied_) return;
  if (hears_ == Hears::kAnswers) return;
  if (hears_ == Hears::kWaitsForRest) {
    last_edge_ = now;
    sample_at_ = now + 12 * bit_;
    return;
  }
  if (high) return;
  if (hears_ == Hears::kNothing) {
    hears_ = Hears::kSync;
    start_ = now;
    second_fall_ = 0;
    heard_.clear();
    sample_at_ = now + 11 * kLongestBit;  // gives up
  } else if (hears_ == Hears::kSync && second_fall_ == 0) {
    second_fall_ = now;
  } else if (hears_ == Hears::kSync && bits_ == 0) {
    bit_ = (now - second_fall_) / 2;
    const auto first = static_cast<double>(second_fall_ - start_) / 2;
    bits_ = 4;
    byte_ = 0x5;
    sample_at_ = start_ + 5 * bit_ + bit_ / 2;
    if (bit_ < kShortestBit || bit_ > kLongestBit || std::abs(first / static_cast<double>(bit_) - 1) > 0.1)
      reject(now);
  } else if (hears_ == Hears::kGap) {
    hears_ = Hears::kByte;
    start_ = now;
    bits_ = 0;
    byte_ = 0;
    sample_at_ = start_ + bit_ + bit_ / 2;
  }
}

void Tmc2209::advance(Cycle now) {
  if (stands_at_ <= now) {
    stands_at_ = tstep_cycles_ = kNever;
    update_diag();
  }
  while (sample_at_ <= now) {
    const Cycle at = sample_at_;
    switch (hears_) {
      case Hears::kSync:
      case Hears::kByte:
        if (const bool not_timed = bit_ == 0 || (hears_ == Hears::kSync && bits_ == 0),
            no_stop_bit = bits_ == 8 && !wire_high_;
            not_timed || no_stop_bit) {
          reject(at);
        } else if (bits_ < 8) {
          byte_ |= (wire_high_ ? 1u : 0u) << bits_++;
          sample_at_ = start_ + (static_cast<Cycle>(bits_) + 1) * bit_ + bit_ / 2;
        } else {
          byte_done(byte_, at);
        }
        break;
      case Hears::kGap:  // longer than 63 bits: what came is forgotten
      case Hears::kWaitsForRest:
        if (hears_ == Hears::kWaitsForRest && !wire_high_) {
          sample_at_ = at + 12 * bit_;
          break;
        }
        hears_ = Hears::kNothing;
        bits_ = 0;
        sample_at_ = kNever;
        break;
      case Hears::kAnswers:
        if (answer_place_ == answer_bits_.size()) {
          pulls_low_ = false;
          hears_ = Hears::kNothing;
          bits_ = 0;
          sample_at_ = kNever;
          break;
        }
        pulls_low_ = !answer_bits_[answer_place_++];
        sample_at_ = at + static_cast<Cycle>(static_cast<double>(bit_) * (1 + p_.answer_bit_error));
        break;
      case Hears::kNothing:
        sample_at_ = kNever;
        break;
    }
  }
}

void Tmc2209::reject(Cycle now) {
  ++bad_;
  hears_ = Hears::kWaitsForRest;
  if (bit_ == 0) bit_ = kLongestBit;
  bits_ = 0;
  sample_at_ = now + 12 * bit_;
}

void Tmc2209::byte_done(unsigned byte, Cycle at) {
  heard_.push_back(static_cast<std::uint8_t>(byte));
  hears_ = Hears::kGap;
  bits_ = 0;
  sample_at_ = at + 63 * bit_;
  if (heard_.size() >= 3 && heard_.size() == ((heard_[2] & 0x80) != 0 ? 8u : 4u))
    datagram_done(at + bit_ / 2);
}

void Tmc2209::datagram_done(Cycle end) {
  hears_ = Hears::kNothing;
  sample_at_ = kNever;
  if ((heard_[0] & 0xF) != 5 || crc_of(heard_, heard_.size() - 1) != heard_.back()) return reject(end);
  if (heard_[1] != 0 || !answers_) return;  // address by MS1, MS2: 0
  if (heard_.size() == 4) return answer(heard_[2], end);
  std::uint32_t value = 0;
  for (std::size_t i = 3; i < 7; ++i) value = value << 8 | heard_[i];
  ++ifcnt_;
  ++writes_;
  write_register(heard_[2] & 0x7F, value);
}

void Tmc2209::answer(std::uint8_t address, Cycle end) {
  const std::uint32_t value = read_register(address);
  if (address == kDrvStatus) measure_load(rotor_.load_nm());
  std::vector<std::uint8_t> bytes{0x05, 0xFF, address};
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  bytes.push_back(static_cast<std::uint8_t>(crc_of(bytes, 7)));
  if (garbled_ > 0) {
    --garbled_;
    bytes[5] ^= 0x10;
  }
  answer_bits_.clear();
  for (const std::uint8_t byte : bytes) {
    answer_bits_.push_back(false);
    for (int bit = 0; bit < 8; ++bit) answer_bits_.push_back((byte >> bit & 1) != 0);
    answer_bits_.push_back(true);
  }
  answer_place_ = 0;
  hears_ = Hears::kAnswers;
  // SENDDELAY: 0 and 1 are 8 bits, 2 and 3 three times as many.
  const std::uint32_t delay = std::max(registers_[kNodeConf] >> 8 & 0xF, 1u) | 1u;
  sample_at_ = end + static_cast<Cycle>(delay) * 8 * bit_;
}

std::uint32_t Tmc2209::read_register(std::uint8_t address) const {
  switch (address) {
    case kGconf:
    case kChopconf:
    case kPwmconf:
      return registers_.at(address);
    case kGstat:
      return gstat_;
    case kIfcnt:
      return ifcnt_;
    case kIoin:
      return 0x21000000u | (enabled_ ? 0u : 1u) | (diag_ ? 0x10u : 0u);
    case kTstep:
      return 0xFFFFF;
    case kSgResult:
      return stall_guard_;
    case kDrvStatus: {
      // Flags of one phase: A.
      std::uint32_t status = (pre_warning_ ? 1u : 0u) | (too_hot_ ? 2u : 0u) | (short_kept_ ? 4u : 0u);
      if (bridges_on() && open_) status |= 0x40u;
      if (celsius_ >= 120) status |= 0x100u;
      if (stealth()) status |= 1u << 30;
      if (tstep_cycles_ == kNever) status |= 1u << 31;
      return status | (registers_.at(kIholdIrun) >> 8 & 31) << 16;
    }
    default:
      return 0;  // write only, or not there
  }
}

void Tmc2209::write_register(std::uint8_t address, std::uint32_t value) {
  if (address == kGstat) {
    gstat_ &= ~(value & 3);
    return;
  }
  if (address < registers_.size()) registers_[address] = value;
  short_found();
}

bool Tmc2209::bridges_on() const {
  return supplied_ && enabled_ && (registers_.at(kChopconf) & 0xF) != 0 && !too_hot_ && !short_kept_;
}

int Tmc2209::microsteps() const {
  if ((registers_.at(kGconf) >> 7 & 1) == 0) return p_.pins_resolution;
  return 256 >> std::min(registers_.at(kChopconf) >> 24 & 0xF, 8u);
}

bool Tmc2209::stealth() const {
  if ((registers_.at(kGconf) >> 2 & 1) != 0) return false;
  const std::uint32_t upper = registers_.at(kTpwmthrs);
  if (tstep_cycles_ == kNever || upper == 0) return true;
  return static_cast<double>(tstep_cycles_) / static_cast<double>(kCoreHz) * p_.clock_hz >= upper;
}

double Tmc2209::amperes(std::uint32_t scale) const {
  // I_scale_analog: by a potentiometer, which stands in the middle here.
  const double reference = (registers_.at(kGconf) & 1) != 0 ? 0.5 : 1;
  const double full_v = (registers_.at(kChopconf) >> 17 & 1) != 0 ? 0.180 : 0.325;
  return reference * (scale + 1) / 32.0 * full_v / (p_.sense_ohm + p_.bond_ohm);
}

void Tmc2209::on_enable(bool enabled) {
  if (enabled == enabled_) return;
  if (enabled_ && !enabled) short_kept_ = false;
  enabled_ = enabled;
  if (!enabled) tstep_cycles_ = kNever;
  short_found();
}

void Tmc2209::short_found() {
  if (shorted_ && bridges_on()) {
    short_kept_ = true;
    gstat_ |= 2;
  }
  update_diag();
}

void Tmc2209::set_temperature(double celsius) {
  celsius_ = celsius;
  pre_warning_ = celsius >= 120;
  if (celsius >= 150) {
    too_hot_ = true;
    gstat_ |= 2;
  }
  if (!pre_warning_) too_hot_ = false;
  update_diag();
}

void Tmc2209::set_supply(bool on) {
  if (on && !supplied_) reset_registers();
  supplied_ = on;
  if (!on) {
    pulls_low_ = false;
    hears_ = Hears::kNothing;
    sample_at_ = kNever;
  }
  update_diag();
}

void Tmc2209::on_step(bool direction, Cycle now) {
  const int way = 256 / microsteps() * (direction ? 1 : -1);
  const Cycle since = now - last_step_;
  last_step_ = now;
  tstep_cycles_ = since > kCoreHz / 10 ? kNever : since / static_cast<Cycle>(std::abs(way));
  // Until then TSTEP is that of the last step.
  stands_at_ = now + static_cast<Cycle>((1 << 20) / p_.clock_hz * static_cast<double>(kCoreHz));
  if (!bridges_on()) return update_diag();
  const double load = rotor_.on_field(way, torque_nm());
  steps_since_measure_ += std::abs(way);
  if (steps_since_measure_ >= 256) {  // each full step
    steps_since_measure_ = 0;
    measure_load(load);
  }
  update_diag();
}

// StallGuard4 sees the load in StealthChop only.
void Tmc2209::measure_load(double nm) {
  const double share = torque_nm() <= 0 ? 1 : std::min(nm / torque_nm(), 1.0);
  noise_ = noise_ * 1'664'525u + 1'013'904'223u;
  const double noise = p_.load_noise * (static_cast<double>(noise_ >> 8) / (1 << 23) - 1);
  const double seen = p_.full_load + (p_.free_load - p_.full_load) * (1 - share) + noise;
  // Bits 9 and 0 are always 0.
  stall_guard_ =
      stealth() ? static_cast<std::uint32_t>(std::lround(std::clamp(seen, 0.0, 510.0))) & 0x1FEu : 0;
}

void Tmc2209::update_diag() {
  const double tstep = tstep_cycles_ == kNever
                           ? 1e9
                           : static_cast<double>(tstep_cycles_) / static_cast<double>(kCoreHz) * p_.clock_hz;
  const bool stall = bridges_on() && stealth() && tstep <= registers_.at(kTcoolthrs) &&
                     stall_guard_ <= 2 * registers_.at(kSgthrs);
  diag_ = supplied_ && (stall || too_hot_ || short_kept_);
}

}  // namespace kinebus::emulator
