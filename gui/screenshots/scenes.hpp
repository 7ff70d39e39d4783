#pragma once
// Machines as they stand: at home, tilted, with two bodies that come close.

#include "gui/screenshots/photographer.hpp"

namespace kinebus::gui {

/// M1, which is homed and rests; it is over the bed's reference afterwards.
void photograph_m1(Desk& desk, MainWindow& window, Photographer& photographer);

/// The other machines at home, one after the other, each with a daemon of its own.
void photograph_other_machines(Desk& desk, MainWindow& window, Photographer& photographer);

/// Another daemon is the demo.
void turn_to(Desk& desk, const char* machine);

/// Sends a line, and waits until it is done.
void say_line(Desk& desk, MainWindow& window, const char* line);

}  // namespace kinebus::gui
