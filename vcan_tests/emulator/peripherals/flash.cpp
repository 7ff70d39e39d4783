#include "vcan_tests/emulator/peripherals/flash.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace kinebus::emulator {
namespace {
constexpr std::uint32_t kKey1 = 0x45670123, kKey2 = 0xCDEF89AB;
constexpr std::uint32_t kProgram = 1, kSectorErase = 2, kStart = 1u << 16, kLock = 1u << 31;
constexpr std::uint32_t kBusy = 1u << 16, kSequenceError = 1u << 7, kSizeError = 1u << 6,
                        kProtectionError = 1u << 4;
constexpr std::uint32_t kOptionKey1 = 0x08192A3B, kOptionKey2 = 0x4C5D6E7F;
constexpr std::uint32_t kOptionLock = 1, kOptionStart = 2, kOptions = 0x0FFFFFEC;
// Data sheet DS8626, x32 parallelism, maximum.
constexpr Cycle kProgramTime = kCoreHz / 1'000'000 * 100;
constexpr Cycle kErase16 = kCoreHz / 1000 * 500, kErase64 = kCoreHz / 1000 * 1100, kErase128 = 2 * kCoreHz;
}  // namespace

FlashController::Sector FlashController::sector(unsigned number) {
  if (number < 4) return {number * 0x4000, 0x4000};
  if (number == 4) return {0x10000, 0x10000};
  return {(number - 4) * 0x20000, 0x20000};
}

void FlashController::reset() {
  acr_ = sr_ = 0;
  cr_ = kLock;
  key_step_ = option_key_step_ = 0;
  optcr_ = options_ | kOptionLock;
  busy_until_ = 0;
}

bool FlashController::take_erased() {
  return std::exchange(erased_, false);
}

std::uint32_t FlashController::read(std::uint32_t offset, Cycle now) {
  switch (offset) {
    case 0x00:
      return acr_;
    case 0x0C:
      return sr_ | (now < busy_until_ ? kBusy : 0);
    case 0x10:
      return cr_;
    case 0x14:
      return optcr_;
    default:
      return 0;
  }
}

void FlashController::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  switch (offset) {
    case 0x00:
      acr_ = value;
      break;
    case 0x04:
      if (key_step_ == 0 && value == kKey1)
        key_step_ = 1;
      else if (key_step_ == 1 && value == kKey2) {
        cr_ &= ~kLock;
        key_step_ = 0;
      } else
        key_step_ = 2;  // a wrong key locks until reset
      break;
    case 0x08:
      if (option_key_step_ == 0 && value == kOptionKey1)
        option_key_step_ = 1;
      else if (option_key_step_ == 1 && value == kOptionKey2) {
        optcr_ &= ~kOptionLock;
        option_key_step_ = 0;
      } else
        option_key_step_ = 2;  // a wrong key locks until reset
      break;
    case 0x0C:
      sr_ &= ~(value & 0xF3);
      break;
    case 0x14:
      write_options(value, now);
      break;
    case 0x10: {
      if ((cr_ & kLock) != 0) break;
      cr_ = value & ~kStart;
      if ((value & kLock) != 0) cr_ |= kLock;
      if ((value & kStart) == 0 || (value & kSectorErase) == 0) break;
      const unsigned number = value >> 3 & 0xF;
      if (number > 11 || write_protected(number)) {
        sr_ |= kProtectionError;
        break;
      }
      const Sector s = sector(number);
      const auto area = memory_.subspan(s.offset, s.size);
      std::fill(area.begin(), area.end(), std::uint8_t{0xFF});
      erased_ = true;
      ++erases_;
      busy_until_ = std::max(busy_until_, now) + (s.size == 0x4000    ? kErase16
                                                  : s.size == 0x10000 ? kErase64
                                                                      : kErase128);
      break;
    }
    default:
      break;
  }
}

// Locked, or while flash is busy, nothing is taken. All options are erased and written anew.
void FlashController::write_options(std::uint32_t value, Cycle now) {
  if ((optcr_ & kOptionLock) != 0 || now < busy_until_) return;
  optcr_ = value & (kOptions | kOptionLock);
  if ((value & kOptionStart) == 0) return;
  options_ = value & kOptions;
  busy_until_ = now + kErase16 + 4 * kProgramTime;
}

double FlashController::brown_out_volts() const {
  constexpr std::array<double, 4> kLevels{2.7, 2.4, 2.1,
                                          1.8};  // BOR_LEV 0 is level 3; 3 is off: power-on reset
  return kLevels[options_ >> 2 & 3];
}

bool FlashController::program_once(std::uint32_t at, std::uint32_t value, int size, Cycle now) {
  if (at + static_cast<std::uint32_t>(size) > one_time_.size()) return false;
  for (int i = 0; i < size; ++i)
    one_time_[at + static_cast<std::uint32_t>(i)] &= static_cast<std::uint8_t>(value >> (8 * i));
  busy_until_ = std::max(busy_until_, now) + kProgramTime;
  ++programs_;
  return true;
}

bool FlashController::program(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  if ((cr_ & kLock) != 0 || (cr_ & kProgram) == 0) {
    sr_ |= kSequenceError;
    return false;
  }
  if (size != 1 << (cr_ >> 8 & 3)) {
    sr_ |= kSizeError;
    return false;
  }
  if (address >= kOneTimeBase) return program_once(address - kOneTimeBase, value, size, now);
  const std::uint32_t at = address - kBase;
  if (at + static_cast<std::uint32_t>(size) > memory_.size()) return false;
  for (unsigned number = 0; number < 12; ++number)
    if (const Sector s = sector(number);
        at >= s.offset && at - s.offset < s.size && write_protected(number)) {
      sr_ |= kProtectionError;
      return false;
    }
  for (int i = 0; i < size; ++i)
    memory_[at + static_cast<std::uint32_t>(i)] &= static_cast<std::uint8_t>(value >> (8 * i));
  busy_until_ = std::max(busy_until_, now) + kProgramTime;
  ++programs_;
  return true;
}

}  // namespace kinebus::emulator
