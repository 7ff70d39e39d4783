#pragma once
// The window of a driver card on a bench: before one is opened, and with one.

#include "gui/screenshots/photographer.hpp"

namespace kinebus::gui {

void photograph_bench(Desk& desk, MainWindow& window, Photographer& photographer);

}  // namespace kinebus::gui
