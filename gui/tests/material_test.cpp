// Temperatures for a material, as the machine file names them: chosen at the heaters, told to the gateway.
#include <gtest/gtest.h>

#include <QAction>
#include <QMenu>
#include <QToolButton>

#include "gui/tests/window_fixture.hpp"

namespace kinebus::gui {
namespace {

class MaterialTest : public WindowTest {
 protected:
  QToolButton* button() const {
    for (auto* found : window->findChildren<QToolButton*>())
      if (found->text() == QStringLiteral("Heat for a material")) return found;
    return nullptr;
  }
  std::vector<joblink::SetTemperature> asked() const {
    std::vector<joblink::SetTemperature> all;
    for (const auto& message : gateway.heard)
      if (message.has_set_temperature()) all.push_back(message.set_temperature());
    return all;
  }
};

TEST_F(MaterialTest, OneThatIsChosenHeatsWhatItNamesBedFirst) {
  auto& pla = *gateway.machine.add_materials();
  pla.set_name("PLA");
  pla.set_hotend_celsius(210);
  pla.set_bed_celsius(60);
  show_connected();
  ASSERT_NE(button(), nullptr);
  ASSERT_TRUE(wait_until([&] { return button()->isVisibleTo(window.get()) && button()->isEnabled(); }));
  const auto actions = button()->menu()->actions();
  ASSERT_EQ(actions.size(), 2);
  EXPECT_TRUE(actions[0]->text().startsWith(QStringLiteral("PLA")));
  EXPECT_TRUE(actions[0]->text().contains(QStringLiteral("210")));
  actions[0]->trigger();
  ASSERT_TRUE(wait_until([&] { return asked().size() == 2; }));
  EXPECT_EQ(asked()[0].kind(), joblink::HEATER_BED);
  EXPECT_EQ(asked()[0].celsius(), 60);
  EXPECT_EQ(asked()[1].kind(), joblink::HEATER_HOTEND);
  EXPECT_EQ(asked()[1].celsius(), 210);
  actions[1]->trigger();
  ASSERT_TRUE(wait_until([&] { return asked().size() == 4; }));
  EXPECT_EQ(asked()[2].celsius(), 0);
  EXPECT_EQ(asked()[3].celsius(), 0);
}

TEST_F(MaterialTest, AMachineFileWithoutAnyShowsNoButton) {
  show_connected();
  ASSERT_NE(button(), nullptr);
  EXPECT_FALSE(button()->isVisibleTo(window.get()));
}

}  // namespace
}  // namespace kinebus::gui
