#pragma once
// Which request of the job link asks for which command of the machine, and which of them it takes now.

#include <optional>

#include "gateway/machine/gateway.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

/// None: the request is no command, or one that has to wait for something first (a job for its text).
std::optional<Command> command_of(const joblink::ClientMessage& request);

void add_commands(joblink::Status& status, const Gateway& gateway);

}  // namespace kinebus
