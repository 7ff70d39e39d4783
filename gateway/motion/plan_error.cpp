#include <string>

#include "gateway/motion/planner.hpp"

namespace kinebus {

std::string to_string(const PlanError& error) {
  const std::string place = "line " + std::to_string(error.line) + ": ";
  switch (error.kind) {
    case PlanError::Kind::kPose:
      return place + "the path leaves the machine's reach: " + to_string(error.pose);
    case PlanError::Kind::kFrame:
      return place +
             "the move's frame differs from the path's; the frame may only change by a position given at "
             "rest";
    case PlanError::Kind::kBadNumber:
      return place + "a coordinate is not a number, or the feed is not greater than 0";
    case PlanError::Kind::kArc:
      return place + "centre, normal, sweep and target do not make an arc";
  }
  return place + "unknown error";
}

}  // namespace kinebus
