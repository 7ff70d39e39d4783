#pragma once
// Small moves forth and back that make a machine swing, as a job: what runs them is the planner's own road,
// and its limits hold.

#include <cstddef>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

struct Excitation {
  std::size_t axis = 0;              ///< X Y Z of the tool
  double from_hz = 10, to_hz = 120;  ///< equal: this frequency alone, for `single_s`
  double hz_per_s = 2, single_s = 5;
  double accel_per_hz = 60;  ///< mm/s^2: the same speed at all frequencies, as far as limits allow
};

/// From where the machine stands (a job: the bed reference) no farther than 2 mm in + direction. Not shaped:
/// M593 F0.
std::string excitation_job(const MachineDescription& machine, const Excitation& excitation);

/// The acceleration of the tool along the axis as the machine plans that job, mm/s^2, mean of each period.
/// Empty: the job is refused.
std::vector<double> planned_acceleration(const MachineDescription& machine, const Kinematics& kinematics,
                                         const Excitation& excitation, double period_s);

}  // namespace kinebus
