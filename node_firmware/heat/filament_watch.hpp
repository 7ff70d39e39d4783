#pragma once
// A filament sensor: a switch that tells whether there is any, or a wheel whose edges are held against what
// the extruder was told to feed. Lengths are um of filament.

#include <array>
#include <cstddef>
#include <cstdint>

namespace kinebus::heat {

enum class FilamentKind : std::uint8_t { kNone, kSwitch, kMotion };
enum class FilamentState : std::uint8_t {
  kInOrder,
  kOut,     ///< of a switch: none is there
  kStands,  ///< of a wheel: the extruder turns, the filament does not move
  kSlips,   ///< of a wheel: it moves less than it should
};

struct FilamentSettings {
  FilamentKind kind = FilamentKind::kNone;
  bool inverted = false;  ///< the switch is low with filament
  std::uint32_t um_per_edge = 2880;
  std::uint32_t stands_um = 7000, slips_um = 30'000;
  std::uint8_t least_share = 60;  ///< per cent
};

class FilamentWatch {
 public:
  void configure(const FilamentSettings& settings);
  /// Every SensorInput::kSamplePeriod: the level of a switch, the edges of a wheel since the last call.
  void on_sample(bool level, std::uint32_t edges);
  /// Where the extruder is to be now; it may begin and wrap anywhere. Only what it feeds is judged, not what
  /// it draws back and brings again.
  void on_commanded(std::int32_t um);
  /// Somebody has seen to it: what a wheel has told is forgotten.
  void reset();

  FilamentState state() const { return state_; }
  std::int32_t commanded() const { return commanded_; }
  std::int32_t seen() const { return static_cast<std::int32_t>(seen_); }

 private:
  void begin();
  void judge(std::uint32_t forward, std::uint32_t passed);

  /// The slip window moves on by this share of it.
  static constexpr std::size_t kParts = 4;
  struct Part {
    std::uint32_t fed = 0, passed = 0;
  };

  FilamentSettings settings_{};
  FilamentState state_ = FilamentState::kInOrder;
  bool level_ = true;        // as the switch was last
  std::uint32_t alike_ = 0;  // samples in a row
  bool known_ = false;       // commanded_ is of this run
  std::int32_t commanded_ = 0;
  std::int32_t back_ = 0;  // behind the furthest place
  std::uint32_t edges_ = 0, seen_ = 0;
  std::uint32_t still_ = 0;  // fed since the last edge
  std::array<Part, kParts> parts_{};
  std::size_t part_ = 0, full_ = 0;
};

}  // namespace kinebus::heat
