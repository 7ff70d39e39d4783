#include "vcan_tests/emulator/physics/max31865.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kSettings = 0, kHigh = 1, kLow = 2, kFaults = 7;
constexpr std::uint8_t kBias = 0x80, kAutomatic = 0x40, kOneShot = 0x20, kThreeWires = 0x10, kCycle = 0x0C,
                       kByItself = 0x04, kForget = 0x02, k50Hz = 0x01;
constexpr std::uint8_t kAbove = 0x80, kBelow = 0x40, kReferenceHigh = 0x20, kReferenceLow = 0x10,
                       kInputLow = 0x08, kVoltage = 0x04;
constexpr Cycle of_us(Cycle us) {
  return us * kCoreHz / 1'000'000;
}
constexpr Cycle kQuiet = 2 * kCoreHz / 5'000'000;  // 400 ns

}  // namespace

void Max31865Chip::reset() {
  registers_ = at_power_up();
  converted_at_ = looked_at_ = kNever;
  selected_ = false;
}

bool Max31865Chip::open() const {
  constexpr double kNoCurrent_ohm = 1e6;
  return state == Wires::kElementOpen || ohm() > kNoCurrent_ohm;
}

bool Max31865Chip::automatic() const {
  return (registers_[kSettings] & kAutomatic) != 0;
}

void Max31865Chip::select(bool selected, Cycle now) {
  if (selected == selected_) return;
  selected_ = selected;
  first_ = true;
  settle(now);
  if (selected && now - released_at_ < kQuiet) ++mistakes_;
  (selected ? selected_at_ : released_at_) = now;
}

/// What has come to its end until now.
void Max31865Chip::settle(Cycle now) {
  const bool slow = (registers_[kSettings] & k50Hz) != 0;
  if (voltage) registers_[kFaults] |= kVoltage;
  while (converted_at_ <= now) {
    convert();
    converted_at_ = automatic() ? converted_at_ + of_us(slow ? 21'000 : 17'600) : kNever;
  }
  if (looked_at_ <= now) {
    find_breaks();
    looked_at_ = kNever;
    registers_[kSettings] &= static_cast<std::uint8_t>(~kCycle);
  }
}

void Max31865Chip::convert() {
  // It converts no more until that fault is forgotten, or nothing.
  if (stands || (registers_[kFaults] & kVoltage) != 0 || (registers_[kSettings] & kBias) == 0) return;
  ++conversions_;
  double leads = wires == 2 ? 2 * lead_ohm : 0;
  // Told the wrong number of wires it takes one lead too many, or too few, off.
  const bool told_three = (registers_[kSettings] & kThreeWires) != 0;
  if (wires == 3 && !told_three) leads = lead_ohm;
  if (wires != 3 && told_three) leads -= lead_ohm;
  double share = (ohm() + leads) / reference_ohm;
  if (open()) share = 2;
  if (state == Wires::kElementShort) share = 0;
  if (state == Wires::kForceOpen) share = indeterminate.value_or(last_share_);
  last_share_ = share;
  std::normal_distribution<double> noise(0, 0.3);
  const double steps = std::floor(share * 32768 + noise(random_));
  const auto code = static_cast<std::uint16_t>(std::clamp(steps, 0.0, 32767.0));
  const auto threshold = [&](std::size_t at) { return (registers_[at] << 8 | registers_[at + 1]) >> 1; };
  if (code >= threshold(3)) registers_[kFaults] |= kAbove;
  if (code <= threshold(5)) registers_[kFaults] |= kBelow;
  registers_[kHigh] = static_cast<std::uint8_t>(code >> 7);
  registers_[kLow] = static_cast<std::uint8_t>(code << 1);
}

void Max31865Chip::find_breaks() {
  if (open() || state == Wires::kForceOpen) registers_[kFaults] |= kReferenceHigh;
  if (state == Wires::kGrounded) registers_[kFaults] |= kReferenceLow | kInputLow;
}

std::uint8_t Max31865Chip::read(std::uint8_t address) {
  if (address >= registers_.size()) return 0xFF;
  if (address == kLow)
    return static_cast<std::uint8_t>(registers_[kLow] | (registers_[kFaults] != 0 ? 1 : 0));
  return registers_[address];
}

void Max31865Chip::write(std::uint8_t address, std::uint8_t value, Cycle now) {
  if (address >= 3 && address <= 6) registers_[address] = value;
  if (address != kSettings) {
    if (address < 3 || address > 6) ++mistakes_;  // read only
    return;
  }
  const std::uint8_t before = registers_[kSettings];
  // The notch must not move while it converts on and on, nor by the word that ends that.
  if (automatic() && ((before ^ value) & k50Hz) != 0) ++mistakes_;
  const bool forgets = (value & kForget) != 0;
  if (forgets && (value & (kOneShot | kCycle)) != 0) ++mistakes_;
  // One-shots and manual cycles are not modelled; none begins without bias or in automatic mode.
  if ((value & kOneShot) != 0 || ((value & kCycle) != 0 && (value & kCycle) != kByItself)) ++mistakes_;
  const bool looks = (value & kCycle) == kByItself;
  if (looks && ((value & kBias) == 0 || (value & kAutomatic) != 0)) ++mistakes_;
  if ((value & kAutomatic) != 0 && (value & kBias) == 0) ++mistakes_;
  registers_[kSettings] = static_cast<std::uint8_t>(value & ~kForget);
  if (forgets) registers_[kFaults] = 0;
  if (looks) looked_at_ = now + of_us(600);
  if (!automatic())
    converted_at_ = kNever;
  else if ((before & kAutomatic) == 0 || writes_restart)
    converted_at_ = now + of_us((value & k50Hz) != 0 ? 66'000 : 55'000);
}

std::uint16_t Max31865Chip::exchange(std::uint16_t sent, Cycle now) {
  if (!selected_ || absent) return absent && line_low ? 0 : 0xFF;
  const double hz = clock_hz();
  if ((mode() != 1 && mode() != 3) || hz > 5e6) ++mistakes_;
  settle(now);
  if (first_) {
    const auto length = static_cast<Cycle>(8 * static_cast<double>(kCoreHz) / hz);
    if (now - length - selected_at_ < kQuiet) ++mistakes_;
    first_ = false;
    address_ = static_cast<std::uint8_t>(sent);
    return 0;
  }
  const std::uint8_t address = address_ & 0x7F;
  const bool writes = (address_ & 0x80) != 0;
  address_ = static_cast<std::uint8_t>((address_ & 0x80) | ((address + 1) & 0x7F));
  if (!writes) return read(address);
  write(address, static_cast<std::uint8_t>(sent), now);
  return 0;
}

}  // namespace kinebus::emulator
