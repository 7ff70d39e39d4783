#pragma once
// Which lines of a print host need control of the machine.

#include "gateway/sessions/serial/line_reader.hpp"

namespace kinebus::serial {

/// False: it only asks, or concerns the line itself. Stops need no control.
bool changes_machine(const Code& code);

}  // namespace kinebus::serial
