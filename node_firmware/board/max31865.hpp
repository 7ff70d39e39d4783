#pragma once
// A MAX31865 behind SPI: a PT100 or PT1000 against a reference resistor, converted on and on and read at
// every sample of the heat node. It has no line that tells of a conversion here, so a reading may be that of
// before.
//
// It has no number by which it could be known either: what was written to it is read back, at every reading.
// A chip that is not there, another one, or one whose supply has sagged does not say it back.
//
// What it finds by itself (its supply's bounds at the inputs) stands in every reading; broken wires it finds
// in a cycle of its own, for which conversions pause: once a second, and more often while there is a fault.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/board/byte_bus.hpp"
#include "node_firmware/heat/thermometry.hpp"
#include "protocol/time.hpp"

namespace kinebus {

struct RtdWiring {
  bool three_wires = false;  ///< else two or four
  bool mains_50hz = false;   ///< what its filter rejects; else 60 Hz
  friend constexpr bool operator==(const RtdWiring&, const RtdWiring&) = default;
};

template <ByteBus Bus>
class Max31865 {
 public:
  explicit constexpr Max31865(Bus& bus) : bus_(bus) {}

  /// What it measures, as parts of heat::kFullRatio; all of them where a wire is open, none where the element
  /// is shorted. nullopt: it does not measure, or does not answer.
  std::optional<std::uint32_t> take(LocalTime now, RtdWiring wiring) {
    if (wiring != wiring_) {
      wiring_ = wiring;
      state_ = State::kAbsent;
      due_ = now;
    }
    if (state_ == State::kAbsent) {
      if (now < due_) return std::nullopt;
      due_ = now + kLook;
      if (!set_up()) return std::nullopt;
      state_ = State::kFirst;
      due_ = now + kFirstConversion;
      broken_ = 0;
      return std::nullopt;
    }
    if (!read()) {
      state_ = State::kAbsent;
      due_ = now;
      return std::nullopt;
    }
    switch (state_) {
      case State::kFirst:
        if (now < due_) return std::nullopt;
        convert(now);
        ratio_ = converted();
        break;
      case State::kCycle:
        broken_ = registers_[kFaults] & kBroken;
        convert(now);
        break;
      case State::kPause:
        if (now >= due_) {
          state_ = State::kConverts;
          due_ = now + (broken_ != 0 ? kAgain : kEvery);
        }
        break;
      case State::kConverts:
        ratio_ = converted();
        if (now >= due_) look_for_breaks();
        break;
      case State::kAbsent:
        break;
    }
    return judged();
  }

 private:
  enum class State : std::uint8_t { kAbsent, kFirst, kConverts, kCycle, kPause };
  // As the data sheet numbers them.
  enum Register : std::uint8_t { kSettings = 0, kHigh = 1, kLow = 2, kHighest = 3, kLowest = 5, kFaults = 7 };
  static constexpr std::uint8_t kWrite = 0x80;
  static constexpr std::uint8_t kBias = 0x80, kAutomatic = 0x40, kThreeWires = 0x10, kLookForBreaks = 0x04,
                                kStillLooks = 0x0C, kForget = 0x02, k50Hz = 0x01;  // settings
  static constexpr std::uint8_t kAbove = 0x80, kBelow = 0x40, kReferenceHigh = 0x20, kReferenceLow = 0x10,
                                kInputLow = 0x08, kVoltage = 0x04;  // faults
  static constexpr std::uint8_t kBroken = kReferenceHigh | kReferenceLow | kInputLow;
  // The thresholds: the last step at both ends; at power-up they are others.
  static constexpr std::array<std::uint8_t, 4> kThresholds{0xFF, 0xFC, 0x00, 0x02};
  static constexpr LocalTime kLook = std::chrono::milliseconds{50};
  // 66 ms at most with the filter for 50 Hz, and some.
  static constexpr LocalTime kFirstConversion = std::chrono::milliseconds{70};
  static constexpr LocalTime kEvery = std::chrono::seconds{1}, kAgain = std::chrono::milliseconds{100};

  std::uint8_t settings() const {
    return static_cast<std::uint8_t>(kBias | (wiring_.three_wires ? kThreeWires : 0) |
                                     (wiring_.mains_50hz ? k50Hz : 0));
  }
  bool talk(std::uint8_t first, std::span<std::uint8_t> bytes) {
    bus_.select(true);
    bus_.wait_us(1);  // 400 ns from select to clock, and between two selects
    bool good = bus_.exchange(first).has_value();
    for (std::uint8_t& byte : bytes) {
      const auto got = good ? bus_.exchange(byte) : std::nullopt;
      good = got.has_value();
      byte = got.value_or(0);
    }
    bus_.select(false);
    bus_.wait_us(1);
    return good;
  }
  bool write_settings(std::uint8_t more) {
    expected_ = static_cast<std::uint8_t>(settings() | (more & (kAutomatic | kLookForBreaks)));
    std::array<std::uint8_t, 1> byte{static_cast<std::uint8_t>(settings() | more)};
    return talk(kWrite | kSettings, byte);
  }
  bool set_up() {
    auto thresholds = kThresholds;
    if (!write_settings(kForget) || !talk(kWrite | kHighest, thresholds) || !read()) return false;
    return write_settings(kAutomatic);
  }
  /// All of its registers, and whether they are those of this chip, set up as it was.
  bool read() {
    if (!talk(kSettings, registers_)) return false;
    for (std::size_t i = 0; i < kThresholds.size(); ++i)
      if (registers_[kHighest + i] != kThresholds[i]) return false;
    // The cycle's bits go away when it is over.
    constexpr std::uint8_t kLasting = static_cast<std::uint8_t>(~kStillLooks);
    return (registers_[kSettings] & kLasting) == (expected_ & kLasting);
  }
  void look_for_breaks() {
    state_ = State::kCycle;
    static_cast<void>(write_settings(kLookForBreaks));
  }
  /// From now on; what it said before is forgotten.
  void convert(LocalTime now) {
    if (state_ == State::kFirst) {
      state_ = State::kConverts;
      due_ = now;
      return;
    }
    static_cast<void>(write_settings(kAutomatic | kForget));
    state_ = State::kPause;
    due_ = now + kFirstConversion;
  }
  std::uint32_t converted() const {
    const std::uint32_t word = static_cast<std::uint32_t>(registers_[kHigh] << 8 | registers_[kLow]);
    return (word >> 1) << 5;
  }
  std::optional<std::uint32_t> judged() {
    const std::uint8_t faults = registers_[kFaults];
    if (faults != 0 && state_ == State::kConverts) static_cast<void>(write_settings(kAutomatic | kForget));
    if ((faults & kVoltage) != 0) return std::nullopt;
    if (broken_ != 0 || (faults & (kAbove | kBroken)) != 0) return heat::kFullRatio;
    if ((faults & kBelow) != 0) return 0;
    return ratio_;
  }

  static_assert(heat::kFullRatio == 1u << 20);

  Bus& bus_;
  std::array<std::uint8_t, 8> registers_{};
  RtdWiring wiring_;
  State state_ = State::kAbsent;
  std::uint8_t expected_ = 0, broken_ = 0;
  std::uint32_t ratio_ = 0;
  LocalTime due_{0};
};

}  // namespace kinebus
