#include "gateway/stream/stream_error.hpp"

#include <cstdio>

namespace kinebus {

namespace {
const char* rule(StreamError::Kind kind) {
  using Kind = StreamError::Kind;
  switch (kind) {
    case Kind::kPose:
      return "the path leaves the machine's reach";
    case Kind::kPhaseOrder:
      return "a phase came when none was asked for";
    case Kind::kStartMismatch:
      return "the run does not start where the axis stands (counts apart)";
    case Kind::kNotAtRest:
      return "the run must begin and end at rest (counts/s)";
    case Kind::kSequence:
      return "the node lost a record (waits for record)";
    case Kind::kCheckpoint:
      return "the node's state differs from the gateway's";
    case Kind::kUnderrun:
      return "the node ran out of records";
    case Kind::kUnknownRecord:
      return "the node expects a record that was never sent (record)";
    case Kind::kSilent:
      return "records were sent but not accepted (ms)";
  }
  return "unknown";
}
}  // namespace

std::string to_string(const StreamError& error) {
  std::string text = rule(error.kind);
  char buffer[96];
  if (error.amount != 0) {
    std::snprintf(buffer, sizeof buffer, ": %.6g", error.amount);
    text += buffer;
  }
  if (error.kind == StreamError::Kind::kPose) text += ": " + to_string(error.pose);
  if (error.node_id != 0) {
    std::snprintf(buffer, sizeof buffer, ", node %u", static_cast<unsigned>(error.node_id));
    text += buffer;
  }
  if (error.axis >= 0) text += error.axis == 0 ? " axis A" : " axis B";
  if (error.line != 0) {
    std::snprintf(buffer, sizeof buffer, ", line %u", error.line);
    text += buffer;
  }
  return text;
}

}  // namespace kinebus
