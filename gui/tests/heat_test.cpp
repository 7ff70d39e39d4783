// A heater is measured from the machine page: asked first, seen while it is measured, told when it is done.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QLabel>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QString>
#include <stdexcept>

#include "gui/models/nodes_model.hpp"
#include "gui/tests/window_fixture.hpp"
#include "gui/views/heat_panel.hpp"
#include "gui/views/machine_page.hpp"

namespace kinebus::gui {
namespace {

constexpr int kHeaters = 4;  ///< the tab

class HeatTest : public WindowTest {
 protected:
  void SetUp() override {
    show_connected();
    window->show_page(MainWindow::kMachine);
    window->machine_page().show_tab(kHeaters);
    panel = window->findChild<HeatPanel*>();
    ASSERT_NE(panel, nullptr);
    ASSERT_TRUE(wait_until([&] { return button("Measure").isEnabled(); }));
  }
  QPushButton& button(const char* text) const {
    for (auto* found : panel->findChildren<QPushButton*>())
      if (found->text() == QString::fromUtf8(text)) return *found;
    throw std::runtime_error(text);
  }
  void answer(const char* text) {
    auto* question = window->findChild<QMessageBox*>();
    ASSERT_NE(question, nullptr);
    for (auto* choice : question->buttons())
      if (choice->text() == QString::fromUtf8(text)) return choice->click();
    FAIL() << text;
  }
  bool shows(const char* text) const {
    for (const auto* label : panel->findChildren<QLabel*>())
      if (label->text().contains(QString::fromUtf8(text))) return true;
    return false;
  }
  int progress() const { return panel->findChild<QProgressBar*>()->value(); }
  const TuningCurve* curve() const { return desk.tuning.of("hotend"); }
  joblink::Heater& hotend() { return *gateway.status.mutable_heaters(0); }
  void enter(joblink::TuningStage stage, double celsius) {
    hotend().mutable_tuning()->set_stage(stage);
    hotend().mutable_tuning()->set_celsius(210);
    hotend().set_actual_celsius(celsius);
    gateway.send_status();
    ASSERT_TRUE(wait_until([&] {
      const auto& seen = desk.session.status().heaters(0);
      return seen.tuning().stage() == stage && seen.actual_celsius() == celsius;
    }));
  }
  HeatPanel* panel = nullptr;
};

TEST_F(HeatTest, IsMeasuredOnlyByTheAnswerThatSaysSo) {
  button("Measure").click();
  auto* question = window->findChild<QMessageBox*>();
  ASSERT_NE(question, nullptr);
  EXPECT_EQ(question->defaultButton()->text(), QStringLiteral("Not now"));
  EXPECT_EQ(question->escapeButton()->text(), QStringLiteral("Not now"));
  question->defaultButton()->click();
  ASSERT_TRUE(wait_until([&] { return window->findChild<QMessageBox*>() == nullptr; }));
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kTuneHeater), 0);
  button("Measure").click();
  answer("Measure");
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kTuneHeater) == 1; }));
  const joblink::TuneHeater& asked = gateway.heard.back().tune_heater();
  EXPECT_EQ(asked.kind(), joblink::HEATER_HOTEND);
  EXPECT_EQ(asked.index(), 0U);
  EXPECT_DOUBLE_EQ(asked.celsius(), 200) << "the gateway's own choice";
}

TEST_F(HeatTest, TheFieldShowsWhatSomebodyElseMeasuresFor) {
  enter(joblink::TUNING_HEATS, 60);
  auto* field = panel->findChild<NumberField*>();
  ASSERT_NE(field, nullptr);
  ASSERT_TRUE(wait_until([&] { return field->value() == 210; }));
  EXPECT_FALSE(field->isEnabled());
}

TEST_F(HeatTest, WhereTheGatewayDoesNotAllowItTheButtonTellsWhy) {
  gateway.allow({joblink::COMMAND_HOME});
  ASSERT_TRUE(wait_until([&] { return !button("Measure").isEnabled(); }));
  EXPECT_EQ(button("Measure").toolTip(), QStringLiteral("home it first"));
}

TEST_F(HeatTest, ItsCurveAndItsProgressAreSeenAndATargetOfZeroEndsIt) {
  EXPECT_FALSE(button("End").isEnabled());
  EXPECT_EQ(curve(), nullptr);
  enter(joblink::TUNING_BEGINS, 24);
  enter(joblink::TUNING_HEATS, 30);
  gateway.status.set_time_s(gateway.status.time_s() + 10);
  enter(joblink::TUNING_HEATS, 70.5);  // half of the way from 24 to 117
  EXPECT_NEAR(progress(), 250, 1);
  gateway.status.set_time_s(gateway.status.time_s() + 10);
  enter(joblink::TUNING_COOLS, 117);
  ASSERT_NE(curve(), nullptr);
  EXPECT_NEAR(curve()->power_off_s, 20, 2);
  gateway.status.set_time_s(gateway.status.time_s() + 10);
  enter(joblink::TUNING_COOLS, 110);
  EXPECT_GT(progress(), 550);
  EXPECT_TRUE(shows("The power is off"));
  ASSERT_GE(curve()->points.size(), 4U);
  EXPECT_DOUBLE_EQ(curve()->points.front().celsius, 24);
  EXPECT_DOUBLE_EQ(curve()->points.back().celsius, 110);
  ASSERT_TRUE(button("End").isEnabled());
  button("End").click();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kSetTemperature) == 1; }));
  EXPECT_EQ(gateway.heard.back().set_temperature().celsius(), 0);
  EXPECT_EQ(gateway.heard.back().set_temperature().kind(), joblink::HEATER_HOTEND);
}

TEST_F(HeatTest, WhatWasFoundIsToldAndWhereItIsKept) {
  enter(joblink::TUNING_HEATS, 60);
  auto& tuning = *hotend().mutable_tuning();
  tuning.set_power_w(40);
  tuning.set_capacity_j_per_k(16.26);
  tuning.set_loss_w_per_k(0.123);
  tuning.set_dead_s(1.75);
  tuning.set_lag_s(2.5);
  enter(joblink::TUNING_DONE, 100);
  for (const char* value :
       {"40.0 W", "16.3 J/K", "0.123 W/K", "1.75 s", "2.50 s", "keeps them without power"})
    EXPECT_TRUE(shows(value)) << value;
  EXPECT_EQ(progress(), 1000);
  tuning.mutable_failure()->set_text("its node did not store it");
  gateway.send_status();
  EXPECT_TRUE(wait_until([&] { return shows("its node did not store it"); }));
  EXPECT_FALSE(shows("keeps them without power"));
}

TEST_F(HeatTest, OneThatFailedTellsWhyAndTheNextBeginsACurveOfItsOwn) {
  enter(joblink::TUNING_HEATS, 60);
  hotend().mutable_tuning()->mutable_failure()->set_text("full power does not warm its sensor");
  enter(joblink::TUNING_FAILED, 61);
  EXPECT_TRUE(shows("full power does not warm its sensor"));
  EXPECT_TRUE(shows("Not measured"));
  EXPECT_FALSE(button("End").isEnabled());
  hotend().mutable_tuning()->clear_failure();
  enter(joblink::TUNING_BEGINS, 40);
  ASSERT_NE(curve(), nullptr);
  EXPECT_DOUBLE_EQ(curve()->points.front().celsius, 40);
}

// A heat node has no axes: neither path time that it could miss nor a queue.
TEST_F(HeatTest, AHeatNodeIsOperationalWithoutPathTime) {
  auto& node = *gateway.status.add_nodes();
  node.set_id(20);
  node.set_present(true);
  node.set_nmt_state(5);
  gateway.status.mutable_nodes(0)->set_synchronised(false);
  NodesModel nodes(desk.session);
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return nodes.rowCount() == gateway.status.nodes_size(); }));
  const int last = nodes.rowCount() - 1;
  const auto shown = [&](int row, int column) { return nodes.index(row, column).data().toString(); };
  EXPECT_EQ(shown(last, NodesModel::kState), QStringLiteral("Operational"));
  EXPECT_EQ(shown(last, NodesModel::kSync), QString());
  EXPECT_EQ(shown(last, NodesModel::kQueue), QString());
  EXPECT_EQ(shown(0, NodesModel::kState), QStringLiteral("Operational, not in time"));
}

}  // namespace
}  // namespace kinebus::gui
