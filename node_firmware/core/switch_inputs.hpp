#pragma once
// The switch inputs of a node: polarity, debouncing, function. An edge counts from when it happened, not from
// when debouncing believed it, and carries the positions that were latched then.

#include <array>
#include <cstdint>
#include <optional>

#include "protocol/canopen/node_objects.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Positions of both axes at one instant, 32 fractional bits.
using LatchedPositions = std::array<std::int64_t, kAxesPerNode>;

/// What the linear scales of both axes count at one instant.
using ScaleCounts = std::array<std::int32_t, kAxesPerNode>;

/// A level that lasted for the debounce time.
struct SwitchEvent {
  int input = 0;
  SwitchFunction function = SwitchFunction::kNone;
  bool active = false;
  LocalTime at{0};  ///< the edge itself
  LatchedPositions latched{};
  ScaleCounts scales{};
};

class SwitchInputs {
 public:
  struct Config {
    SwitchFunction function = SwitchFunction::kNone;
    bool active_low = false;
    LocalTime debounce{500'000};
    friend constexpr bool operator==(const Config&, const Config&) = default;
  };

  /// Levels stay as they are; what they mean may change at once, without an event.
  void configure(int input, const Config& config);
  /// A raw level, time-stamped by the port. A repetition of the known level is harmless.
  void on_level(LocalTime at, int input, bool level, const LatchedPositions& latched,
                const ScaleCounts& scales = {});
  /// The earliest level that has lasted long enough by `now`; pull until empty.
  std::optional<SwitchEvent> next_event(LocalTime now);
  /// When next_event() will have something, LocalTime::max(): never.
  LocalTime next_deadline() const;

  /// Bit 0: input 1, debounced, polarity applied.
  std::uint8_t active_inputs() const;
  /// The same as it is told: a change stays until told(), or for kShown, so that a pulse is seen which is
  /// over before a frame could go out.
  std::uint8_t shown_inputs() const { return shown_; }
  static constexpr LocalTime kShown{20'000'000};
  void show(LocalTime now);
  void told() { untold_ = 0; }
  bool active(SwitchFunction function) const;
  bool configured(SwitchFunction function) const;
  std::uint32_t glitches() const { return glitches_; }  ///< pulses shorter than the debounce time

 private:
  struct Input {
    Config config;
    bool level = false;    // debounced
    bool pending = false;  // the other level has come at `since`
    LocalTime since{0};
    LatchedPositions latched{};
    ScaleCounts scales{};
    bool active() const { return level != config.active_low; }
  };
  std::array<Input, kSwitchInputs> inputs_{};
  std::uint32_t glitches_ = 0;
  std::uint8_t shown_ = 0, untold_ = 0;  // bit 0: input 1
  bool changed_ = false;                 // what is shown may not be what is
  LocalTime shown_at_{0};
};

}  // namespace kinebus
