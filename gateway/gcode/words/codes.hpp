#pragma once
// Which G and M codes exist, what they mean, and which of them exclude one another in a line (modal groups).
// One table feeds the interpreter and the reference (`kinebus gcode`).

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// Threads, in tenths, on a machine with a spindle; to printers G33 calibrates, and G76 is unknown.
inline constexpr int kThread = 330, kRigidTap = 331, kThreadingCycle = 760;

/// G codes of one group exclude one another in a line.
enum class GGroup : std::uint8_t {
  kMotion,
  kNonmodal,
  kUnits,
  kFeedMode,
  kPlane,
  kCutter,
  kToolLength,
  kCoordinates,
  kPathMode,
  kDistance,
  kCentre,
  kTilt,
  kRetract,  ///< where canned cycles go back to
  kSpindleMode,
  kUnknown,
  kHarmless = kUnknown + 1  ///< known elsewhere, without effect here
};
inline constexpr int kGGroups = static_cast<int>(GGroup::kUnknown);

/// M codes with the same group exclude one another in a line.
enum class MGroup : std::uint8_t {
  kStop,  ///< carried out after the line's motion
  kExtrusion,
  kMotors,
  kHotend,
  kBed,
  kChamber,
  kFan,
  kSpindle,
  kJobs,
  kSettings,
  kQuery,
  kOther,     ///< each excludes only itself
  kHarmless,  ///< known elsewhere, without effect here; several in a line, too
  kUnknown
};

/// A code as the reference tells it.
struct CodeEntry {
  int number = 0;  ///< G in tenths
  std::uint8_t group = 0;
  bool text = false;  ///< the rest of its line is one text, not words
  std::string_view words;
  std::string_view meaning;
};
std::span<const CodeEntry> g_codes();
std::span<const CodeEntry> m_codes();

inline constexpr int kCodes = 1000;
extern const std::array<GGroup, kCodes> kGGroupOf;
extern const std::array<MGroup, kCodes> kMGroupOf;

/// A G number in tenths (G92.1: 921) to its group.
inline GGroup g_group(int tenths) {
  return tenths >= 0 && tenths < kCodes ? kGGroupOf[static_cast<std::size_t>(tenths)] : GGroup::kUnknown;
}
inline MGroup m_group(int number) {
  return number >= 0 && number < kCodes ? kMGroupOf[static_cast<std::size_t>(number)] : MGroup::kUnknown;
}

/// Codes whose rest of the line is one text (a name, a message, or what a harmless code says), not words.
bool takes_text(int m_number);
/// Words of Klipper that are accepted without effect, in lower case.
bool harmless_command(std::string_view name);

/// "G92.1"
std::string g_name(int tenths);
std::string m_name(int number);
/// Why an unknown code is refused.
Sentence unknown_g(int tenths);
Sentence unknown_m(int number);

/// What the reference says of "G38.2", "m104", "SET_VELOCITY_LIMIT", "#<_x>", "while"; empty: nothing.
std::string reference_entry(std::string_view code);
/// All of it, a line each.
std::string reference();

}  // namespace kinebus::gcode
