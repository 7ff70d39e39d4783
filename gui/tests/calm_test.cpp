// Nothing by accident, and nothing shown that is not known.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QKeyEvent>
#include <QLabel>
#include <QListView>
#include <QMessageBox>
#include <QPoint>
#include <QPushButton>
#include <QSlider>
#include <QStackedWidget>
#include <QString>
#include <QWheelEvent>
#include <map>
#include <memory>
#include <stdexcept>

#include "gui/tests/window_fixture.hpp"
#include "gui/views/notice.hpp"
#include "gui/views/number_field.hpp"
#include "gui/views/top_bar.hpp"

namespace kinebus::gui {
namespace {

void type(QWidget& where, const QString& text) {
  for (const QChar c : text) {
    QKeyEvent press(QEvent::KeyPress, 0, Qt::NoModifier, QString(c));
    QApplication::sendEvent(&where, &press);
  }
  QKeyEvent enter(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier);
  QApplication::sendEvent(&where, &enter);
}

void turn_wheel_over(QWidget& where) {
  QWheelEvent wheel(where.rect().center(), where.mapToGlobal(where.rect().center()), {}, QPoint(0, 120),
                    Qt::NoButton, Qt::NoModifier, Qt::NoScrollPhase, false);
  QApplication::sendEvent(&where, &wheel);
}

class CalmTest : public WindowTest {
 protected:
  void SetUp() override {
    gateway.machine.set_bed_max_celsius(120);
    show_connected();
    window->activateWindow();
    ASSERT_TRUE(wait_until([&] { return desk.session.machine().bed_max_celsius() == 120; }));
  }
  NumberField& bed() {
    for (auto* field : window->findChildren<NumberField*>())
      if (field->accessibleName() == QStringLiteral("Target temperature of the bed")) return *field;
    throw std::runtime_error("no field for the bed");
  }
  int temperatures_sent() const { return gateway.count(joblink::ClientMessage::kSetTemperature); }
  bool shows(const QString& text) const {
    for (const auto* label : window->findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(text)) return true;
    return false;
  }
  QMessageBox* question() const { return window->findChild<QMessageBox*>(); }
};

TEST_F(CalmTest, TheWheelOverAFieldWithoutFocusChangesNothing) {
  NumberField& field = bed();
  field.clearFocus();
  turn_wheel_over(field);
  EXPECT_EQ(field.value(), 0);
  EXPECT_EQ(temperatures_sent(), 0);
}

TEST_F(CalmTest, TheWheelOverTheOverrideOrAChoiceWithoutFocusChangesNothing) {
  QSlider* speed = nullptr;
  for (auto* slider : window->findChildren<QSlider*>())
    if (slider->accessibleName() == QStringLiteral("Feed override in percent")) speed = slider;
  ASSERT_NE(speed, nullptr);
  ASSERT_TRUE(wait_until([&] { return speed->isEnabled(); }));
  speed->clearFocus();
  turn_wheel_over(*speed);
  EXPECT_EQ(speed->value(), 100);
  int choices = 0;
  for (auto* choice : window->findChildren<QComboBox*>()) {
    if (choice->focusPolicy() != Qt::StrongFocus || choice->count() < 2) continue;
    choice->clearFocus();
    choice->setCurrentIndex(1);
    turn_wheel_over(*choice);
    EXPECT_EQ(choice->currentIndex(), 1) << choice->accessibleName().toStdString();
    ++choices;
  }
  EXPECT_GE(choices, 3) << "motor, heater, work coordinates";
  QApplication::processEvents();
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kSetOverride), 0);
}

TEST_F(CalmTest, AlarmsListsAlarmsAndMessagesWhereTheyAreAskedFor) {
  joblink::Event event;
  event.set_id(1);
  event.set_kind(joblink::EVENT_MESSAGE);
  event.set_words("first layer");
  gateway.say(event);
  event.set_id(2);
  event.set_kind(joblink::EVENT_ALARM);
  event.set_code(0xFF85);
  gateway.say(event);
  ASSERT_TRUE(wait_until([&] { return desk.events.rowCount() == 2; }));
  QListView* list = nullptr;
  for (auto* view : window->findChildren<QListView*>())
    if (view->accessibleName() == QStringLiteral("What has happened, newest first")) list = view;
  ASSERT_NE(list, nullptr);
  EXPECT_EQ(list->model()->rowCount(), 1);
  EXPECT_TRUE(list->model()->index(0, 0).data(EventsModel::kIsAlarm).toBool());
  for (auto* box : window->findChildren<QCheckBox*>())
    if (box->text() == QStringLiteral("Messages, too")) box->setChecked(true);
  EXPECT_EQ(list->model()->rowCount(), 2);
}

TEST_F(CalmTest, ANumberOutOfRangeIsRefusedAsAWhole) {
  NumberField& field = bed();
  field.setFocus();
  field.selectAll();
  type(field, QStringLiteral("400"));
  EXPECT_EQ(field.value(), 0);
  EXPECT_EQ(temperatures_sent(), 0);
  EXPECT_EQ(window->notice().words().remove(QChar(0x2066)).remove(QChar(0x2069)),
            QStringLiteral("400 is not within 0 to 120 °C"));
  EXPECT_TRUE(window->notice().isVisible());
  field.selectAll();
  type(field, QStringLiteral("60"));
  EXPECT_EQ(field.value(), 60);
  EXPECT_TRUE(wait_until([&] { return temperatures_sent() == 1; }));
}

TEST_F(CalmTest, ANoticeMovesNothing) {
  const QWidget* page = window->findChild<QStackedWidget*>()->currentWidget();
  const QPoint before = page->mapToGlobal(QPoint(0, 0));
  window->notice().tell(QStringLiteral("out of reach"));
  QApplication::processEvents();
  EXPECT_EQ(page->mapToGlobal(QPoint(0, 0)), before);
}

TEST_F(CalmTest, AnAlarmStaysWhileItIsOpen) {
  joblink::Event event;
  event.set_kind(joblink::EVENT_ALARM);
  event.set_words("a heater is above its limit");
  gateway.status.set_state(joblink::STATE_ALARM);
  gateway.send_status();
  gateway.say(event);
  ASSERT_TRUE(wait_until([&] { return window->notice().isVisible(); }));
  window->notice().tell(QStringLiteral("clear the alarm first"));
  EXPECT_EQ(window->notice().words().count(QLatin1Char('\n')), 1) << window->notice().words().toStdString();
}

TEST_F(CalmTest, QuestionsWaitOnTheHarmlessAnswer) {
  gateway.status.set_state(joblink::STATE_RUNNING);
  gateway.status.set_job("vase.gcode");
  gateway.allow({joblink::COMMAND_HOLD, joblink::COMMAND_CANCEL});
  gateway.send_status();
  QPushButton* cancel = nullptr;
  for (auto* button : window->findChildren<QPushButton*>())
    if (button->text() == QStringLiteral("Cancel")) cancel = button;
  ASSERT_NE(cancel, nullptr);
  ASSERT_TRUE(wait_until([&] { return cancel->isEnabled(); }));
  cancel->click();
  ASSERT_NE(question(), nullptr);
  EXPECT_EQ(question()->defaultButton()->text(), QStringLiteral("Go on"));
  EXPECT_EQ(question()->escapeButton()->text(), QStringLiteral("Go on"));
  question()->defaultButton()->click();
  EXPECT_EQ(gateway.count(joblink::ClientMessage::kCancel), 0);
}

TEST_F(CalmTest, ButtonsStayWhereTheyAreWhateverTheMachineDoes) {
  window->show_page(MainWindow::kJog);
  const auto places = [&] {
    std::map<QString, QPoint> all;
    for (const auto* button : window->findChildren<QPushButton*>())
      for (const char* name : {"Cancel", "Clear stop", "Motors off", "Home"})
        if (button->isVisible() && button->text() == QLatin1String(name))
          all[button->text()] = button->mapToGlobal(QPoint(0, 0));
    return all;
  };
  gateway.status.set_job("vase.gcode");
  gateway.status.set_state(joblink::STATE_RUNNING);
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().job() == "vase.gcode"; }));
  QApplication::processEvents();
  const auto before = places();
  ASSERT_EQ(before.size(), 4U);
  for (const auto state : {joblink::STATE_HOLDING, joblink::STATE_HELD, joblink::STATE_STOPPED,
                           joblink::STATE_ALARM, joblink::STATE_READY}) {
    gateway.status.set_state(state);
    gateway.status.set_interrupted(state == joblink::STATE_STOPPED || state == joblink::STATE_READY);
    gateway.send_status();
    ASSERT_TRUE(wait_until([&] { return desk.session.status().state() == state; }));
    QApplication::processEvents();
    EXPECT_TRUE(places() == before) << state;
  }
}

TEST_F(CalmTest, ADemoWithAJobDoesNotEndByASlip) {
  gateway.status.set_state(joblink::STATE_RUNNING);
  gateway.status.set_job("vase.gcode");
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().job() == "vase.gcode"; }));
  desk.demo = std::make_unique<DemoGateway>();
  EXPECT_FALSE(window->close());
  ASSERT_NE(question(), nullptr);
  question()->defaultButton()->click();
  EXPECT_TRUE(window->isVisible());
  desk.demo.reset();
  EXPECT_TRUE(window->close());
}

TEST_F(CalmTest, ALostLinkIsSaidAndWhatWasKnownIsCalledSo) {
  gateway.status.set_state(joblink::STATE_RUNNING);
  gateway.status.set_job("vase.gcode");
  gateway.status.set_progress(0.42);
  gateway.status.set_positions_known(true);
  gateway.status.mutable_tool()->set_x_mm(12.5);
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return shows(QStringLiteral("12.500")); }));
  gateway.break_link();
  ASSERT_TRUE(wait_until([&] { return desk.session.link_state() == Session::LinkState::kLost; }));
  EXPECT_EQ(window->top_bar().chip().words(), QStringLiteral("Connection lost"));
  EXPECT_TRUE(shows(QStringLiteral("No news for")));
  EXPECT_TRUE(shows(QStringLiteral("Last known position")));
  EXPECT_FALSE(shows(QStringLiteral("No job is running")));
  for (const auto* label : window->findChildren<QLabel*>())
    EXPECT_FALSE(label->text() == QStringLiteral("12.500") && label->isEnabled());
}

}  // namespace
}  // namespace kinebus::gui
