#pragma once
// Where the joints' scales or encoders have them beside where they were told to be: rows of a measurement
// file that `kinebus-calibrate rails` reads.

#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

inline constexpr const char* kEncoderHeader = "joint,commanded_mm,measured_mm\n";

/// The axis that drives a joint; nullptr: its node is not there.
const joblink::AxisStatus* axis_of(const joblink::Status& status, const joblink::Joint& joint);

struct EncoderRows {
  std::string csv;                      ///< one row for each joint measured, in the machine's order
  std::vector<std::string> by_scale;    ///< names of joints that a linear scale measures
  std::vector<std::string> by_encoder;  ///< of those of which only the motor's shaft is measured
  std::vector<std::string> silent;      ///< of those whose scale says nothing
};

/// Linear joints by their scales, those without a scale by their motors' encoders, others not at all.
/// `status`: of a machine at rest with positions known.
EncoderRows encoder_rows(const joblink::Status& status, const joblink::MachineInfo& machine);

/// Which joints were measured by what, and what that cannot see; lines that begin with "# ".
std::string source_words(const EncoderRows& rows);

}  // namespace kinebus
