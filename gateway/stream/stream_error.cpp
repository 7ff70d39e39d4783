#include "gateway/stream/stream_error.hpp"

namespace kinebus {

namespace {
const char* rule(StreamError::Kind kind) {
  using Kind = StreamError::Kind;
  switch (kind) {
    case Kind::kPose:
      return phrase("the path leaves the machine's reach");
    case Kind::kPhaseOrder:
      return phrase("a phase came when none was asked for");
    case Kind::kStartMismatch:
      return phrase("the run does not start where the axis stands (counts apart)");
    case Kind::kNotAtRest:
      return phrase("the run must begin and end at rest (counts/s)");
    case Kind::kSequence:
      return phrase("the node lost a record (waits for record)");
    case Kind::kCheckpoint:
      return phrase("the node's state differs from the gateway's");
    case Kind::kTakenOtherwise:
      return phrase("the node has taken a record otherwise than it was sent");
    case Kind::kUnderrun:
      return phrase("the node ran out of records");
    case Kind::kUnknownRecord:
      return phrase("the node expects a record that was never sent (record)");
    case Kind::kSilent:
      return phrase("records were sent but not accepted (ms)");
  }
  return phrase("unknown");
}
}  // namespace

Sentence to_string(const StreamError& error) {
  Sentence text = say(rule(error.kind));
  if (error.amount != 0) text = say("%1: %2", text, printed("%.6g", error.amount));
  if (error.kind == StreamError::Kind::kPose) text = say("%1: %2", text, to_string(error.pose));
  if (error.node_id != 0) text = say("%1, node %2", text, error.node_id);
  if (error.axis >= 0) text = say("%1 axis %2", text, error.axis == 0 ? 'A' : 'B');
  if (error.line != 0) text = say("%1, line %2", text, error.line);
  return text;
}

}  // namespace kinebus
