#include "vcan_tests/emulator/peripherals/as5047.hpp"

#include <bit>
#include <cmath>

namespace kinebus::emulator {
namespace {

constexpr std::uint16_t kRead = 1u << 14, kErrorFlag = 1u << 14, kParity = 1u << 15, kData = 0x3FFF;

std::uint16_t with_even_parity(std::uint16_t frame) {
  frame &= static_cast<std::uint16_t>(~kParity);
  return std::popcount(frame) % 2 != 0 ? static_cast<std::uint16_t>(frame | kParity) : frame;
}

}  // namespace

void As5047::select(bool selected, Cycle) {
  selected_ = selected;
}

std::uint16_t As5047::read(std::uint16_t address, Cycle now) {
  switch (address) {
    case kAngle:
    case kAngleRaw: {
      const double t = (turns ? turns(now) : 0) + noise();
      return static_cast<std::uint16_t>(static_cast<std::int64_t>(std::floor((t - std::floor(t)) * 16384)) &
                                        kData);
    }
    case kMagnitude:
      return 0x1200;
    case kDiagnosis:
      return 0x0180;  // offset compensation ready, magnet in range
    case kErrors: {
      const bool error = command_error_;
      command_error_ = false;
      return error ? 4 : 0;
    }
    default:
      return 0;
  }
}

std::uint16_t As5047::exchange(std::uint16_t sent, Cycle now) {
  if (unplugged_ || !selected_) return 0xFFFF;  // the pull-up resistor
  ++frames_;
  std::uint16_t answer =
      with_even_parity(static_cast<std::uint16_t>(next_ | (command_error_ ? kErrorFlag : 0)));
  if (std::popcount(sent) % 2 != 0) {
    command_error_ = true;
    next_ = 0;
  } else {
    next_ = (sent & kRead) != 0 ? read(sent & kData, now) : 0;
  }
  if (disturbed_ > 0) {
    --disturbed_;
    answer ^= 1u << 5;
  }
  return answer;
}

}  // namespace kinebus::emulator
