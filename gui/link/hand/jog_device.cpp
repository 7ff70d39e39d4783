#include "gui/link/hand/jog_device.hpp"
#include "gui/link/hand/space_mouse.hpp"

#ifdef KINEBUS_GAMEPAD
#include "gui/link/hand/gamepad.hpp"
#endif

namespace kinebus::gui {

std::vector<std::unique_ptr<JogDevice>> make_jog_devices() {
  std::vector<std::unique_ptr<JogDevice>> all;
#ifdef KINEBUS_GAMEPAD
  all.push_back(std::make_unique<Gamepad>());
#endif
  all.push_back(std::make_unique<SpaceMouse>());
  return all;
}

}  // namespace kinebus::gui
