// Gamepad and 3D mouse: a deflection is a jog that is held, ends with it, and with the device or the link.
#include <gtest/gtest.h>

#include <QCheckBox>
#include <QLocalServer>
#include <QLocalSocket>
#include <QTemporaryDir>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "gui/link/hand/space_mouse.hpp"
#include "gui/tests/window_fixture.hpp"
#include "gui/views/jog_pad.hpp"

#ifdef KINEBUS_GAMEPAD
#include <SDL2/SDL.h>
#endif

namespace kinebus::gui {
namespace {

class PaperDevice : public JogDevice {
 public:
  QString name() const override { return here ? QStringLiteral("paper stick") : QString(); }
  bool has_dead_man() const override { return true; }
  void listen(bool wanted) override { listened = wanted; }
  void push(JogDevice::Axis axis, float share) {
    Deflection deflection{};
    deflection[axis] = share;
    emit deflected(deflection);
  }
  void go_away() {
    here = false;
    emit deflected({});
    emit name_changed();
  }
  bool here = true, listened = false;
};

class DeviceTest : public WindowTest {
 protected:
  void SetUp() override {
    gateway.status.set_state(joblink::STATE_READY);
    show_connected();
    window->show_page(MainWindow::kJog);
    window->activateWindow();
    ASSERT_TRUE(wait_until([&] { return window->isActiveWindow(); }));
    pad = window->findChild<JogPad*>();
    ASSERT_NE(pad, nullptr);
    ASSERT_TRUE(wait_until([&] { return desk.session.allowed(joblink::COMMAND_JOG); }));
  }
  QCheckBox& box() {
    for (auto* found : window->findChildren<QCheckBox*>())
      if (found->text().startsWith(QStringLiteral("Move by"))) return *found;
    throw std::runtime_error("no box");
  }
  std::vector<joblink::Jog> jogs() const {
    std::vector<joblink::Jog> all;
    for (const auto& message : gateway.heard)
      if (message.has_jog()) all.push_back(message.jog());
    return all;
  }
  bool heard(std::size_t count) {
    return wait_until([&] { return jogs().size() >= count; });
  }
  bool ended() {
    return wait_until([&] {
      const auto all = jogs();
      if (all.empty()) return false;
      const joblink::Pose& last = all.back().delta();
      return last.x_mm() == 0 && last.y_mm() == 0 && last.z_mm() == 0 && last.c_rad() == 0;
    });
  }
  PaperDevice& add() {
    auto made = std::make_unique<PaperDevice>();
    PaperDevice& device = *made;
    pad->follow(std::move(made));
    return device;
  }
  JogPad* pad = nullptr;
};

TEST_F(DeviceTest, ItMovesOnlyWhatIsSwitchedOnAndOnlyWhileItIsDeflected) {
  PaperDevice& device = add();
  EXPECT_TRUE(device.listened);
  EXPECT_TRUE(box().isVisible());
  device.push(JogDevice::kX, 1);
  box().setChecked(true);
  device.push(JogDevice::kX, 0.1F);
  QCoreApplication::processEvents();
  EXPECT_TRUE(jogs().empty()) << "off, and then within the dead zone";
  device.push(JogDevice::kX, 1);
  ASSERT_TRUE(heard(3)) << "asked for again and again";
  for (const joblink::Jog& jog : jogs()) {
    EXPECT_TRUE(jog.while_held());
    EXPECT_GT(jog.delta().x_mm(), 100);
    EXPECT_DOUBLE_EQ(jog.speed_per_s(), 50);
  }
  device.push(JogDevice::kX, 0);
  ASSERT_TRUE(ended());
  const std::size_t all = jogs().size();
  // A little is slow; a turn is in degrees.
  device.push(JogDevice::kC, -0.4F);
  ASSERT_TRUE(heard(all + 2));
  EXPECT_LT(jogs().back().delta().c_rad(), -1);
  EXPECT_NEAR(jogs().back().speed_per_s(), 10 * std::numbers::pi / 180, 1e-9);
  device.push(JogDevice::kC, 0);
  ASSERT_TRUE(ended());
}

TEST_F(DeviceTest, AnotherAxisEndsTheOneBeforeAndAShakyHandDoesNot) {
  PaperDevice& device = add();
  box().setChecked(true);
  device.push(JogDevice::kX, 0.9F);
  ASSERT_TRUE(heard(2));
  JogDevice::Deflection shaky{};
  shaky[JogDevice::kX] = 0.8F;
  shaky[JogDevice::kY] = 0.9F;
  emit device.deflected(shaky);
  ASSERT_TRUE(heard(4));
  EXPECT_GT(jogs().back().delta().x_mm(), 100);
  device.push(JogDevice::kY, 0.9F);
  ASSERT_TRUE(wait_until([&] { return jogs().back().delta().y_mm() > 100; }));
  const auto all = jogs();
  const bool ended_between = std::any_of(all.begin(), all.end(), [](const joblink::Jog& jog) {
    return jog.while_held() && jog.delta().x_mm() == 0 && jog.delta().y_mm() == 0;
  });
  EXPECT_TRUE(ended_between);
  device.push(JogDevice::kY, 0);
  ASSERT_TRUE(ended());
}

TEST_F(DeviceTest, WhoGoesLetsGo) {
  PaperDevice& device = add();
  box().setChecked(true);
  device.push(JogDevice::kZ, 1);
  ASSERT_TRUE(heard(2));
  device.go_away();
  ASSERT_TRUE(ended());
  EXPECT_FALSE(box().isVisible());
  // What comes back moves nothing before it is switched on.
  device.here = true;
  emit device.name_changed();
  const std::size_t all = jogs().size();
  device.push(JogDevice::kZ, 1);
  QCoreApplication::processEvents();
  EXPECT_EQ(jogs().size(), all);
  device.push(JogDevice::kZ, 0);
  box().setChecked(true);
  device.push(JogDevice::kZ, 1);
  ASSERT_TRUE(heard(all + 2));
  window->show_page(MainWindow::kJobs);
  ASSERT_TRUE(ended()) << "the page in front is another";
  EXPECT_FALSE(device.listened);
}

TEST_F(DeviceTest, WhatIsRefusedIsNotAskedForBeforeTheHandLetsGo) {
  PaperDevice& device = add();
  box().setChecked(true);
  gateway.refuse = QStringLiteral("outside the workspace");
  device.push(JogDevice::kX, 1);
  ASSERT_TRUE(heard(2));
  ASSERT_TRUE(ended());
  const std::size_t all = jogs().size();
  for (int i = 0; i < 10; ++i) {
    device.push(JogDevice::kX, i % 2 == 0 ? 0.9F : 1);
    const double from = desk.session.status().time_s();
    ASSERT_TRUE(wait_until([&] { return desk.session.status().time_s() > from; }));
  }
  EXPECT_EQ(jogs().size(), all);
  device.push(JogDevice::kX, 0);
  device.push(JogDevice::kX, 1);
  ASSERT_TRUE(heard(all + 2));
}

/// As spacenavd: eight integers a packet.
class PaperDriver {
 public:
  PaperDriver() {
    server.listen(path());
    QObject::connect(&server, &QLocalServer::newConnection, &server,
                     [this] { client = server.nextPendingConnection(); });
  }
  QString path() const { return folder.filePath(QStringLiteral("spnav.sock")); }
  void tell(std::array<std::int32_t, 8> packet) {
    client->write(reinterpret_cast<const char*>(packet.data()), sizeof packet);
    client->flush();
  }
  QTemporaryDir folder;
  QLocalServer server;
  QLocalSocket* client = nullptr;
};

TEST(SpaceMouse, PushedAwayIsYUpIsZAndSilenceIsRest) {
  PaperDriver driver;
  SpaceMouse mouse(driver.path());
  std::vector<JogDevice::Deflection> all;
  QObject::connect(&mouse, &JogDevice::deflected, &mouse,
                   [&](const JogDevice::Deflection& d) { all.push_back(d); });
  EXPECT_TRUE(mouse.name().isEmpty());
  mouse.listen(true);
  ASSERT_TRUE(wait_until([&] { return driver.client != nullptr && !mouse.name().isEmpty(); }));
  driver.tell({0, 0, 0, -350, 0, 0, 0, 16});
  ASSERT_TRUE(wait_until([&] { return !all.empty(); }));
  EXPECT_FLOAT_EQ(all.back()[JogDevice::kY], 1);
  driver.tell({1, 0, 0, 0, 0, 0, 0, 0});  // a button
  driver.tell({0, 0, 175, 0, 0, 0, 0, 16});
  ASSERT_TRUE(wait_until([&] { return all.size() >= 2; }));
  EXPECT_FLOAT_EQ(all.back()[JogDevice::kZ], 0.5F);
  // The driver says nothing more: it hangs, or the mouse was pulled.
  ASSERT_TRUE(wait_until([&] { return all.back() == JogDevice::Deflection{}; }));
  driver.tell({0, 350, 0, 0, 0, 0, 0, 16});
  ASSERT_TRUE(wait_until([&] { return all.back()[JogDevice::kX] == 1; }));
  driver.client->abort();
  ASSERT_TRUE(wait_until([&] { return all.back() == JogDevice::Deflection{} && mouse.name().isEmpty(); }));
}

#ifdef KINEBUS_GAMEPAD
TEST_F(DeviceTest, AGamepadMovesWhileItsShoulderKeyIsHeld) {
  // As SDL has it, with a stick that is not there.
  SDL_SetMainReady();
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
  ASSERT_EQ(SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER), 0) << SDL_GetError();
  const int index = SDL_JoystickAttachVirtual(SDL_JOYSTICK_TYPE_GAMECONTROLLER, SDL_CONTROLLER_AXIS_MAX,
                                              SDL_CONTROLLER_BUTTON_MAX, 0);
  ASSERT_GE(index, 0) << SDL_GetError();
  SDL_Joystick* stick = SDL_JoystickOpen(index);
  ASSERT_NE(stick, nullptr) << SDL_GetError();
  ASSERT_TRUE(wait_until([&] { return box().isVisible(); }));
  box().setChecked(true);
  SDL_JoystickSetVirtualAxis(stick, SDL_CONTROLLER_AXIS_LEFTY, -32768);
  const double from = desk.session.status().time_s();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().time_s() > from + 0.2; }));
  EXPECT_TRUE(jogs().empty()) << "the dead-man's key is not held";
  SDL_JoystickSetVirtualButton(stick, SDL_CONTROLLER_BUTTON_LEFTSHOULDER, 1);
  ASSERT_TRUE(heard(2));
  EXPECT_GT(jogs().back().delta().y_mm(), 100);
  SDL_JoystickSetVirtualButton(stick, SDL_CONTROLLER_BUTTON_LEFTSHOULDER, 0);
  ASSERT_TRUE(ended());
  const std::size_t all = jogs().size();
  SDL_JoystickSetVirtualButton(stick, SDL_CONTROLLER_BUTTON_LEFTSHOULDER, 1);
  ASSERT_TRUE(heard(all + 2));
  // Pulled.
  SDL_JoystickClose(stick);
  ASSERT_EQ(SDL_JoystickDetachVirtual(index), 0) << SDL_GetError();
  ASSERT_TRUE(ended());
  EXPECT_FALSE(box().isVisible());
  SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}
#endif

}  // namespace
}  // namespace kinebus::gui
