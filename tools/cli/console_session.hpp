#pragma once
// `kinebus console` without a line: G-code by hand, line after line, with history; or from a pipe.

#include "tools/cli/client.hpp"

namespace kinebus {
/// Until the end of the input, `quit` or `exit`. On a terminal a refused line is told and the session goes
/// on; elsewhere the first one ends it. Exit status: 1 when it ended so.
int console_session(Client& client);
/// One line: prints the answer and, with `wait`, comes back when the machine is at rest. 1: it is not ready
/// then.
int console_line(Client& client, const std::string& line, bool wait);
}  // namespace kinebus
