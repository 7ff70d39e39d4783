#pragma once

#include <cstdint>

#include "gateway/pose.hpp"

namespace kinebus {

/// The exact planned pose, before any sampling.
struct PlannedPose {
  Pose pose{};
  Frame frame = Frame::kPart;
  std::uint32_t line = 0;
};

}  // namespace kinebus
