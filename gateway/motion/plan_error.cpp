#include "gateway/motion/planner.hpp"

namespace kinebus {

Sentence to_string(const PlanError& error) {
  switch (error.kind) {
    case PlanError::Kind::kPose:
      return say("line %1: the path leaves the machine's reach: %2", error.line, to_string(error.pose));
    case PlanError::Kind::kFrame:
      return say(
          "line %1: the move's frame differs from the path's; the frame may only change by a position given "
          "at rest",
          error.line);
    case PlanError::Kind::kBadNumber:
      return say("line %1: a coordinate is not a number, or the feed is not greater than 0", error.line);
    case PlanError::Kind::kArc:
      return say("line %1: centre, normal, sweep and target do not make an arc", error.line);
  }
  return say("line %1: unknown error", error.line);
}

}  // namespace kinebus
