#pragma once
// A machine as its agent sees it: what walls, brokers and lists show.

#include <cstdint>
#include <string>

#include "gateway/fleet/job.hpp"

namespace kinebus::fleet {

struct MachineView {
  Machine machine{};
  bool answers = false;
  std::string state{};   ///< in words
  std::string words{};   ///< what is wrong; empty: nothing
  std::int64_t job = 0;  ///< of the queue; 0: none
  double progress = 0;   ///< 0..1
};

}  // namespace kinebus::fleet
