// The heaters beside the machine: all that it has, each with its own target, and which nozzle is in use.
#include <gtest/gtest.h>

#include <QLabel>
#include <QMenu>
#include <QString>
#include <QToolButton>
#include <stdexcept>

#include "gui/tests/window_fixture.hpp"
#include "gui/views/heaters_card.hpp"

namespace kinebus::gui {
namespace {

class HeatersTest : public WindowTest {
 protected:
  void add(const char* name, joblink::HeaterKind kind, std::uint32_t index, double max_celsius) {
    joblink::HeaterInfo& info = *gateway.machine.add_heaters();
    info.set_name(name);
    info.set_kind(kind);
    info.set_index(index);
    info.set_max_celsius(max_celsius);
    joblink::Heater& heater = *gateway.status.add_heaters();
    heater.set_name(name);
    heater.set_kind(kind);
    heater.set_index(index);
    heater.set_actual_celsius(20 + index);
  }
  HeatersCard& card() const {
    auto* found = window->findChild<HeatersCard*>();
    if (found == nullptr) throw std::runtime_error("no card of heaters");
    return *found;
  }
  NumberField* field(const char* name) const {
    for (auto* each : card().findChildren<NumberField*>())
      if (each->isVisibleTo(window.get()) && each->accessibleName() == QString::fromUtf8(name)) return each;
    return nullptr;
  }
  bool shows(const char* text) const {
    for (const auto* label : card().findChildren<QLabel*>()) {
      QString shown = label->text();
      shown.remove(QChar(0x2066)).remove(QChar(0x2069));  // marks of direction
      if (label->isVisibleTo(window.get()) && shown == QString::fromUtf8(text)) return true;
    }
    return false;
  }
};

TEST_F(HeatersTest, OneOfEachIsCalledByItsKind) {
  show_connected();
  EXPECT_TRUE(wait_until([&] { return shows("Nozzle") && shows("Bed"); }));
  EXPECT_FALSE(shows("Chamber"));
  EXPECT_FALSE(shows("Nozzle, in use"));
}

TEST_F(HeatersTest, ASecondNozzleAndAChamberAreHeatedAsThemselves) {
  add("hotend_1", joblink::HEATER_HOTEND, 1, 260);
  add("chamber", joblink::HEATER_CHAMBER, 0, 70);
  show_connected();
  ASSERT_TRUE(wait_until([&] { return shows("Nozzle T1") && shows("Chamber"); }));
  NumberField* second = field("Target temperature of nozzle \u2066T1\u2069");
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->maximum(), 260);
  ASSERT_TRUE(wait_until([&] { return second->isEnabled(); }));
  second->setValue(215);
  emit second->editingFinished();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kSetTemperature) == 1; }));
  EXPECT_EQ(gateway.heard.back().set_temperature().kind(), joblink::HEATER_HOTEND);
  EXPECT_EQ(gateway.heard.back().set_temperature().index(), 1U);
  EXPECT_EQ(gateway.heard.back().set_temperature().celsius(), 215);
  NumberField* chamber = field("Target temperature of the chamber");
  ASSERT_NE(chamber, nullptr);
  EXPECT_EQ(chamber->maximum(), 70);
}

TEST_F(HeatersTest, TheNozzleInUseIsMarked) {
  add("hotend_1", joblink::HEATER_HOTEND, 1, 260);
  show_connected();
  ASSERT_TRUE(wait_until([&] { return shows("Nozzle T0, in use") && shows("Nozzle T1"); }));
  gateway.status.set_hotend_in_use(1);
  gateway.send_status();
  EXPECT_TRUE(wait_until([&] { return shows("Nozzle T0") && shows("Nozzle T1, in use"); }));
}

TEST_F(HeatersTest, AMaterialIsForTheNozzleInUse) {
  add("hotend_1", joblink::HEATER_HOTEND, 1, 260);
  auto& petg = *gateway.machine.add_materials();
  petg.set_name("PETG");
  petg.set_hotend_celsius(240);
  gateway.status.set_hotend_in_use(1);
  show_connected();
  ASSERT_TRUE(wait_until([&] { return shows("Nozzle T1, in use"); }));
  card().findChild<QToolButton*>()->menu()->actions().front()->trigger();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kSetTemperature) == 1; }));
  EXPECT_EQ(gateway.heard.back().set_temperature().index(), 1U);
}

TEST_F(HeatersTest, SeveralFansHaveTheirNames) {
  for (const auto& [name, ratio] : {std::pair("part", 1.0), std::pair("board", 0.4)}) {
    joblink::Output& fan = *gateway.status.add_fans();
    fan.set_name(name);
    fan.set_ratio(ratio);
  }
  show_connected();
  EXPECT_TRUE(wait_until([&] { return shows("Fan part") && shows("Fan board"); }));
  EXPECT_TRUE(shows("100 %") || shows("100%"));
  gateway.status.clear_fans();
  gateway.send_status();
  EXPECT_TRUE(wait_until([&] { return shows("Fan") && !shows("Fan board"); }));
}

}  // namespace
}  // namespace kinebus::gui
