// The jog keys: a click is a step, what is held moves until it is let go.
#include <gtest/gtest.h>

#include <QApplication>
#include <QEvent>
#include <QKeyEvent>
#include <QPushButton>
#include <QString>
#include <stdexcept>
#include <vector>

#include "gui/tests/window_fixture.hpp"

namespace kinebus::gui {
namespace {

class JogTest : public WindowTest {
 protected:
  void SetUp() override {
    gateway.status.set_state(joblink::STATE_READY);
    show_connected();
    window->set_language(QStringLiteral("en"));
    window->show_page(MainWindow::kJog);
    ASSERT_TRUE(wait_until([&] { return button("X+").isEnabled(); }));
  }
  QPushButton& button(const char* name) {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->accessibleName() == QString::fromUtf8(name)) return *found;
    throw std::runtime_error(name);
  }
  void key(QEvent::Type type, bool repeated = false) {
    QKeyEvent event(type, Qt::Key_Right, Qt::NoModifier, {}, repeated);
    QApplication::sendEvent(&button("X+"), &event);
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
};

TEST_F(JogTest, ClicksAreSteps) {
  button("X+").click();
  button("X+").click();
  ASSERT_TRUE(heard(2));
  for (const joblink::Jog& jog : jogs()) {
    EXPECT_FALSE(jog.while_held());
    EXPECT_DOUBLE_EQ(jog.delta().x_mm(), 1);
  }
}

TEST_F(JogTest, AButtonThatIsHeldMovesUntilItIsLetGo) {
  QPushButton& up = button("Z+");
  emit up.pressed();
  ASSERT_TRUE(heard(4));
  for (const joblink::Jog& jog : jogs()) {
    EXPECT_TRUE(jog.while_held());
    EXPECT_GT(jog.delta().z_mm(), 100);
  }
  emit up.released();
  ASSERT_TRUE(wait_until([&] { return jogs().back().delta().z_mm() == 0; }));
  EXPECT_TRUE(jogs().back().while_held());
  const std::size_t all = jogs().size();
  button("X+").click();
  ASSERT_TRUE(heard(all + 1));
  EXPECT_EQ(jogs().size(), all + 1) << "nothing is asked for again";
  EXPECT_FALSE(jogs().back().while_held());
}

TEST_F(JogTest, TheProbesPinIsMovedWhereThereIsOne) {
  const auto named = [this](const char* text) {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->text() == QString::fromUtf8(text)) return found;
    throw std::runtime_error(text);
  };
  EXPECT_FALSE(named("Pin out")->isVisible());
  gateway.status.set_probe_pin(joblink::PROBE_PIN_IN);
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return named("Pin out")->isVisible() && named("Pin out")->isEnabled(); }));
  named("Pin out")->click();
  named("End alarm")->click();
  const auto orders = [this] {
    std::vector<joblink::MoveProbePin::Order> all;
    for (const auto& message : gateway.heard)
      if (message.has_move_probe_pin()) all.push_back(message.move_probe_pin().order());
    return all;
  };
  ASSERT_TRUE(wait_until([&] { return orders().size() == 2; }));
  EXPECT_EQ(orders(), (std::vector{joblink::MoveProbePin::OUT, joblink::MoveProbePin::RESET}));
}

TEST_F(JogTest, TheKeyboardsRepetitionIsNoClick) {
  key(QEvent::KeyPress);
  for (int i = 0; i < 20; ++i) {
    key(QEvent::KeyRelease, true);
    key(QEvent::KeyPress, true);
  }
  key(QEvent::KeyRelease);
  ASSERT_TRUE(heard(1));
  EXPECT_EQ(jogs().size(), 1U);
  EXPECT_DOUBLE_EQ(jogs().back().delta().x_mm(), 1);
}

TEST_F(JogTest, WhatIsHeldEndsWhenTheGatewayRefusesIt) {
  QPushButton& up = button("Z+");
  emit up.pressed();
  ASSERT_TRUE(heard(2));
  emit desk.session.refused(QStringLiteral("outside the workspace"));
  ASSERT_TRUE(wait_until([&] { return jogs().back().delta().z_mm() == 0; }));
  const std::size_t all = jogs().size();
  emit up.released();
  button("X+").click();
  ASSERT_TRUE(heard(all + 1));
  EXPECT_EQ(jogs().size(), all + 1);
  EXPECT_DOUBLE_EQ(jogs().back().delta().x_mm(), 1);
}

}  // namespace
}  // namespace kinebus::gui
