#pragma once
// A MAX31865 behind SPI: a PT100 or PT1000 against a reference resistor, converted on and on and looked at
// with every sample of the heat node.
//
// No line tells of a conversion here, and the bus has no check. So
//   - its two thresholds overlap: each conversion is above the one or below the other, which the chip notes.
//     The note is taken away with every reading: the next one stands for a conversion that is new.
//   - a reading counts when two in a row are alike, and what was written stands in them. A chip that is not
//     there, another one, or one whose supply has sagged does not say that.
//   - broken and grounded wires it finds in a cycle of its own, for which conversions pause: once a second,
//     and more often while there is a fault.

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "node_firmware/board/byte_bus.hpp"
#include "node_firmware/heat/thermometry.hpp"
#include "protocol/time.hpp"

namespace kinebus {

template <ByteBus Bus>
class Max31865 {
 public:
  /// No reading is older. Conversions pause for a cycle: 10 ms, then 66 ms to the first, and its sample.
  static constexpr LocalTime kOldest = std::chrono::milliseconds{120};

  explicit constexpr Max31865(Bus& bus) : bus_(bus) {}

  /// What it measures, as parts of heat::kFullRatio; all of them where a wire is open, none where one has
  /// contact to ground. nullopt: it does not measure, or does not answer.
  std::optional<std::uint32_t> take(LocalTime now, heat::RtdWiring wiring) {
    if (wiring != wiring_) {
      wiring_ = wiring;
      state_ = State::kAbsent;
      due_ = now;
    }
    if (state_ == State::kAbsent) {
      if (now >= due_) look_for_it(now);
      return std::nullopt;
    }
    if (!hear() || !is_as_written()) return lose(now);
    if ((registers_[kFaults] & kVoltage) != 0) {
      // An input is beyond its supply: it converts no more until that is forgotten.
      measured_ = false;
      convert();
      return std::nullopt;
    }
    if (state_ == State::kLooks) {
      // What it measured through a broken wire is nothing.
      if (broken_ != 0) measured_ = false;
      broken_ = registers_[kFaults] & (kOpen | kGrounded);
      due_ = now + (broken_ != 0 ? kAgain : kEvery);
      convert();
    } else {
      const bool fresh = (registers_[kFaults] & (kAbove | kBelow)) != 0;
      if (fresh) {
        ratio_ = converted();
        measured_ = true;
        measured_at_ = now;
        convert();
      }
      if (now >= due_ && (fresh || now >= due_ + kOldest)) look_for_breaks();
    }
    if ((broken_ & kOpen) != 0) return heat::kFullRatio;
    if (broken_ != 0) return 0;
    if (!measured_ || now - measured_at_ > kOldest) return std::nullopt;
    return ratio_;
  }

 private:
  enum class State : std::uint8_t { kAbsent, kConverts, kLooks };
  // As the data sheet numbers them.
  enum Register : std::uint8_t { kSettings = 0, kHigh = 1, kLow = 2, kThreshold = 3, kFaults = 7 };
  static constexpr std::uint8_t kWrite = 0x80;
  static constexpr std::uint8_t kBias = 0x80, kAutomatic = 0x40, kThreeWires = 0x10, kLookForBreaks = 0x04,
                                kForget = 0x02, k50Hz = 0x01;  // settings
  // REFIN- high: no current flows. REFIN- or RTDIN- low with FORCE- open: it flows elsewhere.
  static constexpr std::uint8_t kAbove = 0x80, kBelow = 0x40, kOpen = 0x20, kGrounded = 0x18,
                                kVoltage = 0x04;  // faults
  // "Above" from 23,202 steps of 65,536 on, "below" up to 42,330; bits that no dead bus says.
  static constexpr std::array<std::uint8_t, 4> kThresholds{0x5A, 0xA2, 0xA5, 0x5A};
  static constexpr LocalTime kLook = std::chrono::milliseconds{50};
  static constexpr LocalTime kEvery = std::chrono::seconds{1}, kAgain = std::chrono::milliseconds{100};

  using Registers = std::array<std::uint8_t, 8>;

  bool talk(std::uint8_t first, std::span<std::uint8_t> bytes) {
    return kinebus::talk<1>(bus_, first, bytes);  // 400 ns
  }
  bool write_settings(std::uint8_t value) {
    std::array<std::uint8_t, 1> byte{value};
    return talk(kWrite | kSettings, byte);
  }
  std::uint8_t settings() const {
    return static_cast<std::uint8_t>(kBias | (wiring_.three_wires ? kThreeWires : 0) |
                                     (wiring_.mains_60hz ? 0 : k50Hz));
  }
  void look_for_it(LocalTime now) {
    due_ = now + kLook;
    // Its filter is changed when it converts no more.
    auto thresholds = kThresholds;
    if (!talk(kSettings, std::span(registers_).first(1)) ||
        !write_settings(kBias | (registers_[kSettings] & k50Hz)) || !write_settings(settings() | kForget) ||
        !talk(kWrite | kThreshold, thresholds))
      return;
    convert();
    measured_ = false;
    broken_ = 0;
    due_ = now + kEvery;
  }
  std::nullopt_t lose(LocalTime now) {
    state_ = State::kAbsent;
    look_for_it(now);
    return std::nullopt;
  }
  /// All of its registers, twice the same: of four, one that a conversion comes into leaves two.
  bool hear() {
    if (!talk(kSettings, registers_)) return false;
    for (int tries = 0; tries < 3; ++tries) {
      Registers again{};
      if (!talk(kSettings, again)) return false;
      if (std::exchange(registers_, again) == again) return true;
    }
    return false;
  }
  /// The bits of a cycle have gone away by themselves when it is over: within 0.6 ms.
  bool is_as_written() const {
    const std::uint8_t expected = settings() | (state_ == State::kConverts ? kAutomatic : 0);
    return registers_[kSettings] == expected &&
           std::equal(kThresholds.begin(), kThresholds.end(), registers_.begin() + kThreshold);
  }
  /// On and on; what it has noted is forgotten.
  void convert() {
    state_ = State::kConverts;
    static_cast<void>(write_settings(settings() | kAutomatic | kForget));
  }
  void look_for_breaks() {
    state_ = State::kLooks;
    static_cast<void>(write_settings(settings() | kLookForBreaks));
  }
  std::uint32_t converted() const {
    const std::uint32_t word = static_cast<std::uint32_t>(registers_[kHigh] << 8 | registers_[kLow]);
    return (word >> 1) << 5;
  }

  static_assert(heat::kFullRatio == 1u << 20);

  Bus& bus_;
  Registers registers_{};
  heat::RtdWiring wiring_;
  State state_ = State::kAbsent;
  bool measured_ = false;
  std::uint8_t broken_ = 0;
  std::uint32_t ratio_ = 0;
  LocalTime due_{0}, measured_at_{0};
};

}  // namespace kinebus
