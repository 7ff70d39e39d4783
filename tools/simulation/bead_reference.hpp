#pragma once
// The bead that Klipper's algorithm lays, from its published formulas (docs/Kinematics, kin_extruder,
// shaper_defs):
//
//   e(t) = integral over -h .. h of (h - |u|) / h^2 (p(t + u) + K p'(t + u)) du,   2 h = 40 ms,
//
// K where a move of X or Y extrudes, and X and Y by MZV. The planner is this project's, with all of the
// machine's limits and without shaping: print time is that of a machine that does neither.

#include <cstdint>
#include <functional>
#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "tools/simulation/bead.hpp"

namespace kinebus {

struct BeadReference {
  BeadLines lines;  ///< what the job asks for
  struct Errors {
    double rms = 0, worst = 0;
  };
  Errors klipper;
  Errors plain;  ///< no advance and no shaping
  double time_s = 0;
};

/// `open`: the job's text, each time from its beginning; pressure advance is the machine file's, the job
/// shall not say another. limit_s: of motion; 0: all of it.
BeadReference bead_reference(const MachineDescription& machine,
                             const std::function<std::unique_ptr<ByteSource>()>& open,
                             const Nozzle::Truth& truth, double limit_s);

}  // namespace kinebus
