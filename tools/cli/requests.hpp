#pragma once
// The requests without parameters, by name.

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// plain(&joblink::ClientMessage::mutable_hold)
template <typename Body>
joblink::ClientMessage plain(Body* (joblink::ClientMessage::*body)()) {
  joblink::ClientMessage message;
  (message.*body)();
  return message;
}

}  // namespace kinebus
