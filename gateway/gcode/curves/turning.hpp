#pragma once
// A turned profile, roughed out in cuts and finished beside it: the moves of G70, G71 and G72.

#include <vector>

#include "gateway/gcode/curves/curve.hpp"
#include "gateway/result.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::gcode {

struct TurningMove {
  Curve curve;
  bool traverse = false;
};

/// What is cut. A pocket is where the profile goes down again, away from the side that the tool comes from.
struct Turning {
  enum class What {
    kAll,      ///< G71, G72: cuts from the start down, each until it meets the profile, pockets in passing
    kOutside,  ///< G71.1, G72.1: pockets are bridged
    kPockets,  ///< G71.2, G72.2: pockets alone
    kFinish,   ///< G70: along the profile
  } what{};
  bool facing = false;      ///< cuts go along v (X) and not along u (Z)
  double allowance_mm = 0;  ///< D: left on the profile; G70: of the first pass, at most
  double depth_mm = 1;      ///< I: from cut to cut
  double retract_mm = 0.5;  ///< R: how far the tool goes up and back before it returns
  double last_mm = 0;       ///< G70 E: allowance of the last pass
  int passes = 1;           ///< G70 P
};

inline constexpr std::size_t kMostTurningMoves = 20'000;

/// `profile`: from `start` on, connected; its first piece is how the tool comes to it. All moves connect,
/// from `start` on. The tool stays on the start's side of the profile, `allowance_mm` from it; between two
/// walls of a pocket it goes up no farther than their middle. Refused: a profile that turns back along the
/// cuts (but G70), an allowance that does not fit, more than kMostTurningMoves. With a bridge or an end below
/// the start a straight piece closes the profile.
Result<std::vector<TurningMove>, Sentence> turn(const std::vector<Curve>& profile, const Point2& start,
                                                const Turning& turning);

}  // namespace kinebus::gcode
