#pragma once
// Which G and M codes exist, and which of them exclude one another in a line (modal groups).

#include <cstdint>
#include <string>

#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// G codes of one group exclude one another in a line.
enum class GGroup : std::uint8_t {
  kMotion,       ///< G0 G1 G2 G3 G80
  kNonmodal,     ///< G4 G10 G11 G28 G53 G53.1 G92 G92.1 G92.2 G92.3
  kUnits,        ///< G20 G21
  kFeedMode,     ///< G93 G94
  kPlane,        ///< G17 G18 G19
  kCutter,       ///< G40
  kToolLength,   ///< G43 G43.4 G49
  kCoordinates,  ///< G54 .. G59.3
  kPathMode,     ///< G61 G61.1 G64
  kDistance,     ///< G90 G91
  kCentre,       ///< G90.1 G91.1
  kTilt,         ///< G68.2 G69
  kUnknown
};
inline constexpr int kGGroups = static_cast<int>(GGroup::kUnknown);

/// A G number in tenths (G92.1: 921) to its group.
constexpr GGroup g_group(int tenths) {
  switch (tenths) {
    case 0:
    case 10:
    case 20:
    case 30:
    case 800:
      return GGroup::kMotion;
    case 40:
    case 100:
    case 110:
    case 280:
    case 530:
    case 531:
    case 920:
    case 921:
    case 922:
    case 923:
      return GGroup::kNonmodal;
    case 200:
    case 210:
      return GGroup::kUnits;
    case 930:
    case 940:
      return GGroup::kFeedMode;
    case 170:
    case 180:
    case 190:
      return GGroup::kPlane;
    case 400:
      return GGroup::kCutter;
    case 430:
    case 434:
    case 490:
      return GGroup::kToolLength;
    case 540:
    case 550:
    case 560:
    case 570:
    case 580:
    case 590:
    case 591:
    case 592:
    case 593:
      return GGroup::kCoordinates;
    case 610:
    case 611:
    case 640:
      return GGroup::kPathMode;
    case 900:
    case 910:
      return GGroup::kDistance;
    case 901:
    case 911:
      return GGroup::kCentre;
    case 682:
    case 690:
      return GGroup::kTilt;
    default:
      return GGroup::kUnknown;
  }
}

/// M codes with the same group exclude one another in a line.
enum class MGroup : std::uint8_t {
  kStop,       ///< M0 M1 M2 M30: carried out after the line's motion
  kExtrusion,  ///< M82 M83
  kMotors,     ///< M17 M18 M84
  kHotend,     ///< M104 M109
  kBed,        ///< M140 M190
  kChamber,    ///< M141 M191
  kFan,        ///< M106 M107
  kSpindle,    ///< M3 M4 M5
  kJobs,       ///< M20 .. M32
  kSettings,   ///< M500 .. M503
  kQuery,      ///< M105 M114 M115 M119
  kOther,      ///< each excludes only itself
  kHarmless,   ///< known elsewhere, without effect here
  kUnknown
};
MGroup m_group(int number);

/// Codes whose rest of the line is one text (a name, a message, or what a harmless code says), not words.
bool takes_text(int m_number);
/// G codes known elsewhere that change nothing here (bed levelling): accepted with a note.
bool harmless_g(int tenths);

/// "G92.1"
std::string g_name(int tenths);
std::string m_name(int number);
/// Why an unknown code is refused.
Sentence unknown_g(int tenths);
Sentence unknown_m(int number);

}  // namespace kinebus::gcode
