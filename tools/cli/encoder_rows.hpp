#pragma once
// Where the joints' encoders have them beside where they were told to be: rows of a measurement file that
// `kinebus-calibrate rails` reads.

#include <string>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

inline constexpr const char* kEncoderHeader = "joint,commanded_mm,measured_mm\n";

/// One row for each linear joint with an encoder, in the machine's order; empty: none has one, or none is
/// heard. `status`: of a machine at rest with positions known.
std::string encoder_rows(const joblink::Status& status, const joblink::MachineInfo& machine);

}  // namespace kinebus
