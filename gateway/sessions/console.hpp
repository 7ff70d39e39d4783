#pragma once
// One line typed by a person: a query, a command of a session, or G-code that moves. Motion is planned and
// checked as a job's is, and refused with the reason.

#include <string>
#include <string_view>

#include "gateway/machine/gateway.hpp"

namespace kinebus {

/// False: a line that only asks, or that stops the machine: everyone may say it.
bool needs_control(std::string_view line);

/// The answer, in Marlin's words where there are any.
Result<std::string, Refusal> console_line(Gateway& gateway, std::string_view line);

/// A line of G-code: modes and offsets are set at once, motion begins when the machine is ready.
Result<void, Refusal> run_line(Gateway& gateway, std::string_view line);

}  // namespace kinebus
