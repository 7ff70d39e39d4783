#pragma once
// The whole window, connected to a gateway made of paper.

#include <gtest/gtest.h>

#include <QString>
#include <memory>

#include "gui/link/socket_link.hpp"
#include "gui/tests/fake_gateway.hpp"
#include "gui/tests/wait.hpp"
#include "gui/views/main_window.hpp"

namespace kinebus::gui {

class WindowTest : public testing::Test {
 protected:
  WindowTest() {
    desk.theme.apply(false);
    desk.language.apply(QStringLiteral("en"));
  }
  void show_connected() {
    window = std::make_unique<MainWindow>(desk);
    window->show();
    desk.session.connect_to([path = gateway.socket_path()] { return std::make_unique<SocketLink>(path); },
                            QStringLiteral("fake"));
    ASSERT_TRUE(wait_until([&] { return desk.session.connected() && desk.session.status().time_s() > 0; }));
  }
  FakeGateway gateway;
  Desk desk;
  std::unique_ptr<MainWindow> window;
};

}  // namespace kinebus::gui
