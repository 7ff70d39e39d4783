#pragma once
// What faults happen to: the machine and the job.

#include <cstddef>
#include <cstdint>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "vcan_tests/campaign/fault.hpp"

namespace kinebus {

/// M1 with an E-stop input on every node; for faults of heat with hot end, bed, fan and filament sensors on a
/// heat node.
MachineDescription campaign_machine(FaultKind kind = FaultKind::kNone);
/// The place of its filament among the joints.
inline constexpr std::size_t kExtruder = 5;

/// Lines, arcs, tilts of all lengths and speeds within the workspace; some 3 s of motion, 15 with heat.
std::string campaign_job(std::uint64_t seed, FaultKind kind);
/// A line from which on it has heated and moves.
inline constexpr std::uint32_t kFirstPrinted = 6;

}  // namespace kinebus
