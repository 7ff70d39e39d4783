#pragma once
// Measurement files in the calibration's own terms.

#include <map>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/calibrate/csv.hpp"
#include "tools/calibrate/fit/geometry_model.hpp"
#include "tools/calibrate/fit/rail_fit.hpp"

namespace kinebus {

/// Columns: joint (its name, or its number from 1), commanded_mm, measured_mm,
/// and direction (1 or -1; left out: by the row before of the same joint). `machine`: with the calibration
/// that was in force, which is taken out again, so that what comes of it is whole.
Result<std::map<std::string, std::vector<RailSample>>, CsvError> rail_samples(
    const Csv& csv, const MachineDescription& machine);

/// Columns: x_mm, y_mm, z_mm, a_deg: commanded. Then of each row what it has:
///   measured_x_mm, measured_y_mm, measured_z_mm   touch probe or tracker (any of the three; empty: not
///   measured) gauge_mm, axis (X, Y or Z), series            dial gauge on the table bar_mm, series ball bar
/// noise_um, if there is one, is the readings' standard deviation (10 um else).
Result<std::vector<GeometryReading>, CsvError> geometry_readings(const Csv& csv);

/// Four-leg machines only; nullopt for others.
std::optional<BelievedMachine> believed(const MachineDescription& machine);

/// Puts what was found into the machine's calibration, on top of what is there.
void apply(const RailFit& fit, JointCalibration& calibration);
void apply(const MachineDeviation& deviation, MachineDescription& machine);

}  // namespace kinebus
