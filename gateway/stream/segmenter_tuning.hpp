#pragma once
// The numbers behind the segmenter's choices. None of them is needed for correctness: every segment's error
// is computed exactly before it is given out. They were chosen by the frames that stream_bench's motions
// take.

#include <cstdint>
#include <limits>

#include "protocol/motion/segment.hpp"

namespace kinebus::segmenter {

inline constexpr double kForever = std::numeric_limits<double>::infinity();
inline constexpr double kLongest = kMaxSegmentUnits;
inline constexpr std::int32_t kShortest = 64;  // 1 ms

// First guess.
// The best C1 quadratic spline misses a cubic with q''' = M by 0.00802 M h^3, where position is met and
// velocity is off by M h^2 / 12 at every knot (the Bernoulli polynomial of degree 3). With M = 6 c3:
inline constexpr double kBendError = 6 * 0.00802;  // times c3 h^3
// Share of the tolerance that the first guess aims at. The rest is for what the start state brings along, and
// for a velocity target that is a few percent off (the target times h is 10 tolerances).
inline constexpr double kAim = 0.6;
// A jump J of q''/2 leaves a velocity error of 2 J x when a segment goes x beyond it: a segment stops at a
// jump for which J x^2 / tolerance is above this on both sides, and does not try to cross one above the
// second.
inline constexpr double kStopAtJump = 0.3, kHopeless = 2.5;
// Under a limit of jerk: a velocity error w0 at the start of what hardly bends (what the bend asks for, times
// h, is below the first) is taken back in h = the second / w0, and leaves some 0.6 w0. A jump is aimed at
// from this share of the way to it.
inline constexpr double kStraight = 3, kTakenBack = 3, kNearJump = 0.7;

// End states.
// Weight of velocity against position at the end: by the length of the next segment over this, within these.
inline constexpr double kLeastNext = 0.5, kMostNext = 1.5;
// Position error that an end state may have for the sake of its velocity, in tolerances.
inline constexpr double kMostEndError = 0.55;
// A velocity error w at a knot costs the next segment w h / 3 when it is taken back over two segments.
inline constexpr double kVelocityCost = 1.0 / 3;
// Tolerances that the end state may cost: without a proof that it can be followed, and at all.
// Under a limit of jerk bends begin and end all the time, each with a velocity error that the last segment
// did not have: there a good state costs 2.1 and the position's share, and proofs hardly ever fail.
inline constexpr double kSafeDrift = 0.5, kMostDrift = 2.5, kMostEasedDrift = 3.5;
// Segments looked ahead for the proof; more if those are shorter than this (4 ms); other ends tried if it
// fails.
inline constexpr int kProofDepth = 2, kMoreProofs = 8, kProofs = 16;
inline constexpr std::int32_t kProofUnits = 256;

// Repair: a fit that misses by less than this share of the tolerance is corrected at the one place where it
// misses, if that is behind this part of its length, where the acceleration has some effect.
inline constexpr double kRepairable = 0.3, kRepairFrom = 0.25, kTouch = 0.97, kMostRepairedEndError = 0.8;

// Accelerations may leave those of the motion by this share of what is left to the joint's limit; and a
// motion that is over the limit itself is followed anyway, with this share of the limit to spare.
inline constexpr double kRoomShare = 0.75, kLeastWidening = 0.002;
inline constexpr double kOverLimit = 1.02, kOverLimitWidening = 0.05;

inline constexpr double kImpossible = 100;  // error of a fit that no acceleration within bounds gives
inline constexpr int kTries = 14;           // shorter and shorter

}  // namespace kinebus::segmenter
