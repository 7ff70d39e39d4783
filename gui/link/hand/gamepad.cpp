#include "gui/link/hand/gamepad.hpp"

#include <SDL2/SDL.h>

#include <chrono>

namespace kinebus::gui {
namespace {
using namespace std::chrono_literals;
constexpr auto kPoll = 16ms;

float share(SDL_GameController* pad, SDL_GameControllerAxis axis) {
  return static_cast<float>(SDL_GameControllerGetAxis(pad, axis)) / 32768.0F;
}
}  // namespace

Gamepad::Gamepad(QObject* parent) : JogDevice(parent), poll_(this) {
  poll_.setInterval(kPoll);
  connect(&poll_, &QTimer::timeout, this, &Gamepad::look);
}

Gamepad::~Gamepad() {
  if (pad_ != nullptr) SDL_GameControllerClose(pad_);
  if (begun_) SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

void Gamepad::listen(bool wanted) {
  if (wanted == poll_.isActive()) return;
  if (!wanted) {
    poll_.stop();
    close();
    return;
  }
  if (!begun_) {
    SDL_SetMainReady();
    // Signals are the program's, and the window is not SDL's.
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
    begun_ = SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) == 0;
    if (!begun_) return;
  }
  poll_.start();
  look();
}

void Gamepad::look() {
  SDL_GameControllerUpdate();
  SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);  // nobody else takes them
  if (pad_ != nullptr && SDL_GameControllerGetAttached(pad_) == SDL_FALSE) close();
  for (int i = 0; pad_ == nullptr && i < SDL_NumJoysticks(); ++i)
    if (SDL_IsGameController(i) == SDL_TRUE) open(i);
  if (pad_ == nullptr) return;
  Deflection now{};
  if (SDL_GameControllerGetButton(pad_, SDL_CONTROLLER_BUTTON_LEFTSHOULDER) != 0) {
    now[kX] = share(pad_, SDL_CONTROLLER_AXIS_LEFTX);
    now[kY] = -share(pad_, SDL_CONTROLLER_AXIS_LEFTY);
    now[kZ] = -share(pad_, SDL_CONTROLLER_AXIS_RIGHTY);
    now[kC] = -share(pad_, SDL_CONTROLLER_AXIS_RIGHTX);
  }
  if (now == last_) return;
  last_ = now;
  emit deflected(now);
}

void Gamepad::open(int index) {
  pad_ = SDL_GameControllerOpen(index);
  if (pad_ == nullptr) return;
  name_ = QString::fromUtf8(SDL_GameControllerName(pad_));
  if (name_.isEmpty()) name_ = tr("gamepad");
  emit name_changed();
}

void Gamepad::close() {
  if (pad_ == nullptr) return;
  SDL_GameControllerClose(pad_);
  pad_ = nullptr;
  name_.clear();
  last_ = {};
  emit deflected({});
  emit name_changed();
}

}  // namespace kinebus::gui
