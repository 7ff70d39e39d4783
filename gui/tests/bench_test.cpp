// The window of a card on a bench: what it asks of kinebus-card, and what it shows of its answers. The
// program is a script that says what cards say and writes down what it is told.
#include <gtest/gtest.h>

#include <QApplication>
#include <QDeadlineTimer>
#include <QEventLoop>
#include <QFile>
#include <QLabel>
#include <QPushButton>
#include <QString>
#include <QTemporaryDir>
#include <functional>

#include "gui/views/bench_window.hpp"
#include "gui/views/language.hpp"
#include "gui/views/theme.hpp"

namespace kinebus::gui {
namespace {

constexpr const char* kScript = R"script(#!/bin/sh
echo "started $*" >> "$BENCH_LOG"
motor='{"drive": "operation enabled", "has_power": true, "position_known": false, "position_counts": 76800, "run_ma": 1500, "hold_ma": 800, "measured_ma": 790, "stage_celsius": 41.5, "supply_volts": 24.1, "error_code": 0}'
other='{"drive": "fault", "has_power": false, "position_known": false, "position_counts": 0, "run_ma": 900, "hold_ma": 300, "measured_ma": 0, "stage_celsius": 30, "supply_volts": 24.1, "error_code": 8976}'
state() { echo '{"state": {"name": "Kinebus two-axis node", "serial": 77, "motors": ['"$motor, $other"'], "switches": [{"active": true, "function": "home A"}, {"active": false, "function": ""}], "errors": [8976]}}'; }
state
while read -r line; do
  echo "$line" >> "$BENCH_LOG"
  case "$line" in
    jog*) ;;
    stop) echo '{"done": "jog A", "position_counts": 12345, "stopped": true}' ;;
    tune*) echo '{"done": "tune A", "resistance_mohm": 1400, "inductance_uh": 2900, "encoder_offset": -1}' ;;
    store) echo '{"refused": "motor A has power"}' ;;
    *) echo '{"done": "'"$line"'"}' ;;
  esac
  state
done
echo ended >> "$BENCH_LOG"
)script";

class BenchTest : public testing::Test {
 protected:
  BenchTest() {
    QFile program(folder.filePath(QStringLiteral("kinebus-card")));
    EXPECT_TRUE(program.open(QIODevice::WriteOnly));
    program.write(kScript);
    program.close();
    program.setPermissions(program.permissions() | QFileDevice::ExeOwner);
    qputenv("BENCH_LOG", folder.filePath(QStringLiteral("log")).toUtf8());
  }
  ~BenchTest() override { language.apply(QStringLiteral("en")); }

  QString log() const {
    QFile file(folder.filePath(QStringLiteral("log")));
    return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
  }
  QString words(const QWidget& window) const {
    QString all;
    for (const QLabel* label : window.findChildren<QLabel*>()) all += label->text() + QLatin1Char('\n');
    return all;
  }
  QPushButton* button(const QWidget& window, const QString& text, int nth = 0) const {
    for (QPushButton* each : window.findChildren<QPushButton*>())
      if (each->text() == text && nth-- == 0) return each;
    ADD_FAILURE() << "no button " << text.toStdString();
    return nullptr;
  }
  void until(const std::function<bool()>& so) {
    for (const QDeadlineTimer end(20'000); !so() && !end.hasExpired();)
      QApplication::processEvents(QEventLoop::AllEvents, 50);
    EXPECT_TRUE(so());
  }

  QTemporaryDir folder;
  Theme theme;
  Language language;
};

TEST_F(BenchTest, ShowsACardAndSendsWhatIsAskedOfIt) {
  BenchWindow window(theme, folder.filePath(QStringLiteral("kinebus-card")));
  window.show();
  EXPECT_FALSE(button(window, QStringLiteral("Set currents"))->isEnabled());
  button(window, QStringLiteral("Open"))->click();
  until([&] { return words(window).contains(QStringLiteral("Kinebus two-axis node")); });
  EXPECT_TRUE(log().startsWith(QStringLiteral("started --interface ")));
  EXPECT_TRUE(log().contains(QStringLiteral("--node 1 session")));
  const QString shown = words(window);
  for (const char* expected :
       {"holds", "fault", "error", "2310h", "1.500", "0.79 A", "\u00B0C", "24.1 V", "1 \u25CF", "2 \u25CB"})
    EXPECT_TRUE(shown.contains(QString::fromUtf8(expected))) << expected << '\n' << shown.toStdString();

  button(window, QStringLiteral("Set currents"))->click();
  until([&] { return log().contains(QStringLiteral("current A 1500 800")); });
  until([&] { return button(window, QStringLiteral("On"))->isEnabled(); });
  button(window, QStringLiteral("On"))->click();
  EXPECT_FALSE(button(window, QStringLiteral("Back"))->isEnabled()) << "until the motor has turned";
  until([&] { return log().contains(QStringLiteral("jog A 51200 51200")); });
  button(window, QStringLiteral("Stop the motor"))->click();
  until([&] { return words(window).contains(QStringLiteral("Stopped by its ramp")); });
  button(window, QStringLiteral("Measure the motor"))->click();
  until([&] { return words(window).contains(QStringLiteral("1.400 \u03A9, 2.900 mH")); });
  button(window, QStringLiteral("Keep"))->click();
  until([&] { return words(window).contains(QStringLiteral("motor A has power")); });
  EXPECT_TRUE(button(window, QStringLiteral("Let go"))->isEnabled());
  EXPECT_TRUE(button(window, QStringLiteral("Hold"))->isEnabled()) << "motor B has no power";
  window.close();
  until([&] { return log().contains(QStringLiteral("ended")); });
  until([&] { return !window.card().runs(); });
}

TEST_F(BenchTest, SaysSoInEveryLanguageWhenTheProgramIsNotThere) {
  for (const auto& choice : Language::choices()) {
    language.apply(choice.code);
    BenchWindow window(theme, {});
    window.show();
    QString told;
    QObject::connect(&window.card(), &BenchCard::ended, &window, [&](const QString& why) { told = why; });
    window.card().start(QStringLiteral("can0"), 1);
    EXPECT_TRUE(told.contains(QStringLiteral("kinebus-cli"))) << choice.code.toStdString();
    EXPECT_TRUE(words(window).contains(told)) << choice.code.toStdString();
  }
}

}  // namespace
}  // namespace kinebus::gui
