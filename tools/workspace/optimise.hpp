#pragma once
// A machine of M1's kind for a wanted cylinder: a search over rails, attachments and leg length that keeps
// every rule (leg_rules.hpp), bodies among them.

#include <functional>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "tools/workspace/leg_rules.hpp"

namespace kinebus::workspace {

struct Optimised {
  /// The best found, in whole millimetres: nozzle, travel, switches and limits as the room needs them. Where
  /// not all rules are kept: the nearest to it.
  MachineDescription machine;
  Judgement before, after;  ///< all over the room, densely
  int tried = 0;
  bool found() const { return after.holds(); }
};

struct SearchEffort {
  int threads = 2;
  int begins = 6;   ///< places that a search begins at, the start among them
  int tries = 900;  ///< of each
};

/// The geometry of a description that --optimise can do something with; nullptr: another kind of machine.
const M1Geometry* four_legs(const MachineDescription& machine);

/// From `start` and from places all over, drawn from a seed. The tool stays in the frame; legs keep their
/// order and the sides of their rails, attachments lie on the side of their rail and carriages below the
/// platform. Of machines that keep all rules the one of least Judgement::price. `progress`: share done so
/// far, 0..1, from any thread, one at a time. The same on any number of threads.
Optimised optimise(const MachineDescription& start, const Wish& wish, SearchEffort effort = {},
                   const std::function<void(double share)>& progress = {});

}  // namespace kinebus::workspace
