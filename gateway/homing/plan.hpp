#pragma once
// In which order the joints of a machine look for their home switches.
//
// Where they stand is unknown, and a part may stand under the tool. What is known is the direction to each
// switch, and so what the tool does while a group of joints goes there: it leaves the table, keeps its
// distance, or comes nearer. Joints that move the tool together (the carriages of one mechanism) go together,
// so that at first the mechanism moves as one; each stands still on its own switch until all have come. First
// go those that take tool and table apart, last those that would bring them together.
//
// Joints that go at different speeds move the tool sideways while they take it away, and a part may stand
// right beside it. Where some rates take it straight away from everywhere (carriages on parallel rails: equal
// ones), they go at these first, until one has come to its switch.

#include <cstdint>
#include <span>
#include <vector>

#include "gateway/kinematics/kinematics.hpp"

namespace kinebus::homing {

/// A joint that homes; mm or rad.
struct Joint {
  std::size_t joint = 0;  ///< of the kinematics
  std::uint8_t node =
      1;              ///< the joints of one node leave their switches one after the other, then the next's
  bool moves = true;  ///< false: takes the present position, without a switch
  bool positive = false;  ///< the direction to the switch
  bool entering = true;   ///< the edge is taken on the way onto the switch; else on the way off it
  double fast_per_s = 40, slow_per_s = 4, accel_per_s2 = 500;
  double switch_position = 0;
  std::uint8_t order = 0;  ///< as the machine file states it; 0: it does not
  /// At a stop, by its driver's load: it first goes so far the other way, and does so again before it comes
  /// to the stop for the second time. 0: at a switch.
  double back_off = 0;

  double direction() const { return positive ? 1 : -1; }
  /// From the edge to rest, when it comes fast.
  double overrun() const { return 0.5 * fast_per_s * fast_per_s / accel_per_s2; }
  double slow_overrun() const { return 0.5 * slow_per_s * slow_per_s / accel_per_s2; }
};

enum class Effect : std::uint8_t {
  kParts,  ///< tool and table go apart
  kKeeps,  ///< their distance along the table's normal stays
  kNears,
};

/// Joints that go together.
struct Stage {
  std::vector<Joint> joints;
  Effect effect = Effect::kKeeps;
  /// How fast the tool leaves the table, at the bed reference; < 0: comes nearer.
  double parting_mm_per_s = 0;
  /// How fast each of `joints` goes in the lift, 0: stands. Empty: there is none, their own speeds do it or
  /// no speeds can. After it they go at their own.
  std::vector<double> lift_per_s;
};

struct Plan {
  std::vector<Stage> stages;
  bool stated = false;  ///< the order is the machine file's own
};

/// The order that the machine file states when it does so for each joint, else the one that follows from the
/// kinematics.
Plan make_plan(const Kinematics& kinematics, std::span<const Joint> joints);

}  // namespace kinebus::homing
