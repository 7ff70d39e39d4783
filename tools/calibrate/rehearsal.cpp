#include "tools/calibrate/rehearsal.hpp"

#include "tools/calibrate/fit/geometry_fit.hpp"
#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/readings.hpp"

namespace kinebus {

Result<MachineDescription, std::string> calibrated(const MachineDescription& machine,
                                                   const MachineDescription& truth,
                                                   const Rehearsal& rehearsal) {
  const std::uint64_t seed = rehearsal.seed;
  const double noise = rehearsal.noise_mm;
  MachineDescription better = machine;
  const auto rail_file = Csv::parse(measure_rails(better, truth, rehearsal.rail_step_mm, noise, seed));
  if (!rail_file) return Error<std::string>(rail_file.error().what);
  const auto rails = rail_samples(*rail_file, better);
  if (!rails) return Error<std::string>(rails.error().what);
  for (JointDescription& joint : better.joints)
    if (const auto own = rails->find(joint.name); own != rails->end())
      apply(fit_rail(own->second, {.anchor = anchor_of(joint), .pitch = rehearsal.pitch_mm}),
            joint.calibration);

  const auto poses = random_poses(better, rehearsal.points, seed);
  const auto point_file = Csv::parse(measure_points(better, truth, poses, noise, seed));
  if (!point_file) return Error<std::string>(point_file.error().what);
  const auto readings = geometry_readings(*point_file);
  if (!readings) return Error<std::string>(readings.error().what);
  const auto legs = believed(better);
  if (!legs) return Error<std::string>("only machines with four legs are calibrated as a whole");
  const GeometryFit fit = fit_geometry(GeometryModel(*legs, *readings), {});
  if (!fit.solved) return Error<std::string>(fit.problem);
  apply(fit.deviation, better);
  return better;
}

}  // namespace kinebus
