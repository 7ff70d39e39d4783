#pragma once
// A gateway that is killed in a print while the window is open: at once, when it is back, and when its job
// goes on.

#include "gui/screenshots/photographer.hpp"

namespace kinebus::gui {

void photograph_killed_gateway(Desk& desk, MainWindow& window, Photographer& photographer);

}  // namespace kinebus::gui
