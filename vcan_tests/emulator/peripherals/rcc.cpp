#include "vcan_tests/emulator/peripherals/rcc.hpp"

namespace kinebus::emulator {
namespace {
constexpr std::uint32_t kCr = 0x00, kPllCfgr = 0x04, kCfgr = 0x08, kAhb1LpEnr = 0x50, kCsr = 0x74;
constexpr std::uint32_t kAhb1Enr = 0x30, kAhb2Enr = 0x34, kApb1Enr = 0x40, kApb2Enr = 0x44;
constexpr std::uint32_t kInternalHz = 16'000'000;
constexpr std::uint32_t kSecurityOn = 1u << 19, kSecurityFlag = 1u << 7, kCir = 0x0C;
constexpr std::uint32_t kBrownOutReset = 1u << 25, kPowerOnReset = 1u << 27, kPinReset = 1u << 26,
                        kSoftwareResetFlag = 1u << 28, kWatchdogReset = 1u << 29;

bool enables_clocks(std::uint32_t offset) {
  return offset == kAhb1Enr || offset == kAhb2Enr || offset == kApb1Enr || offset == kApb2Enr;
}

std::uint32_t apb_divider(std::uint32_t code) {
  return code < 4 ? 1 : 2u << (code - 4);
}
}  // namespace

void Rcc::reset(ResetCause cause) {
  for (std::uint32_t offset = 0; offset < 0x90; offset += 4) word(offset) = 0;
  fresh_ = {};
  word(kCr) = 0x83;
  word(kPllCfgr) = 0x24003010;
  word(kAhb1LpEnr) = 0x7E6791FF;
  switch (cause) {
    case ResetCause::kPowerOn:
      causes_ |= kPowerOnReset | kPinReset | kBrownOutReset;
      break;
    case ResetCause::kBrownOut:
      causes_ |= kBrownOutReset | kPinReset;
      break;
    case ResetCause::kSoftware:
      causes_ |= kSoftwareResetFlag | kPinReset;
      break;
    case ResetCause::kWatchdog:
      causes_ |= kWatchdogReset | kPinReset;
      break;
  }
}

std::uint32_t Rcc::read(std::uint32_t offset, Cycle) {
  std::uint32_t value = word(offset);
  if (enables_clocks(offset)) fresh(offset).clocks = 0;
  if (offset == kCr) {
    // What is switched on is ready; without the crystal neither it is nor a PLL that runs from it.
    const bool from_crystal = (word(kPllCfgr) & 1u << 22) != 0;
    const std::uint32_t able = crystal_ ? 0x01010001u : from_crystal ? 1u : 0x01000001u;
    value |= (value & able) << 1;
  }
  if (offset == kCfgr) value = (value & ~0xCu) | (value & 3) << 2;
  if (offset == kCsr) value = (value & 1) | (value & 1) << 1 | causes_;
  return value;
}

void Rcc::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  if (enables_clocks(offset)) {
    Fresh& f = fresh(offset);
    if (now >= f.since + kEnableDelay) f.clocks = 0;
    f.clocks = (f.clocks | ~word(offset)) & value;
    f.since = now;
  }
  if (offset == kCsr && (value & 1u << 24) != 0) causes_ = 0;
  word(offset) = value;
}

bool Rcc::set_crystal(bool swings) {
  crystal_ = swings;
  const bool noticed = !swings && (word(kCr) & kSecurityOn) != 0;
  if (noticed) word(kCir) |= kSecurityFlag;
  return noticed;
}

bool Rcc::live(Clock clock, Cycle now) {
  if (!clock_enabled(clock.enable_register, clock.bit)) return false;
  const Fresh& f = fresh(clock.enable_register);
  return (f.clocks >> clock.bit & 1) == 0 || now >= f.since + kEnableDelay;
}

std::optional<std::uint32_t> Rcc::system_hz() {
  const std::uint32_t source = word(kCfgr) & 3;
  if (source == 0) return kInternalHz;
  if (source == 1) return (word(kCr) & 1u << 16) != 0 ? std::optional(facts_.crystal_hz) : std::nullopt;
  if (source != 2 || (word(kCr) & 1u << 24) == 0) return std::nullopt;
  const std::uint32_t pll = word(kPllCfgr);
  const std::uint32_t m = pll & 0x3F, n = pll >> 6 & 0x1FF, p = 2 * ((pll >> 16 & 3) + 1);
  const std::uint32_t input = (pll & 1u << 22) != 0 ? facts_.crystal_hz : kInternalHz;
  if (facts_.pll_r && (pll >> 28 & 7) < 2) return std::nullopt;
  if (m < 2 || n < 50 || n > 432) return std::nullopt;
  const std::uint32_t compare = input / m;
  const std::uint64_t vco = std::uint64_t{compare} * n;
  if (compare < 950'000 || compare > 2'100'000 || vco < 100'000'000 || vco > 432'000'000) return std::nullopt;
  const auto hz = static_cast<std::uint32_t>(vco / p);
  return hz <= 168'000'000 ? std::optional(hz) : std::nullopt;
}

std::optional<std::uint32_t> Rcc::usb_hz() {
  const std::uint32_t pll = word(kPllCfgr);
  const auto system = system_hz();
  const std::uint32_t p = 2 * ((pll >> 16 & 3) + 1), q = pll >> 24 & 0xF;
  if (!system || (word(kCfgr) & 3) != 2 || q < 2 || *system * p % q != 0) return std::nullopt;
  return *system * p / q;
}

std::optional<std::uint32_t> Rcc::apb1_hz() {
  const auto system = system_hz();
  if (!system) return std::nullopt;
  const std::uint32_t hz = *system / apb_divider(word(kCfgr) >> 10 & 7);
  return hz <= 42'000'000 ? std::optional(hz) : std::nullopt;
}

std::optional<std::uint32_t> Rcc::apb2_hz() {
  const auto system = system_hz();
  if (!system) return std::nullopt;
  const std::uint32_t hz = *system / apb_divider(word(kCfgr) >> 13 & 7);
  return hz <= 84'000'000 ? std::optional(hz) : std::nullopt;
}

}  // namespace kinebus::emulator
