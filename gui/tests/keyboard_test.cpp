// Without a mouse: the demo machine is begun, homed, given a job, and prints it to its end; keys alone.
#include <gtest/gtest.h>

#include <QApplication>
#include <QFile>
#include <QFileDialog>
#include <QLabel>
#include <QLineEdit>
#include <QTemporaryDir>
#include <QTest>

#include "gui/screenshots/demo_job.hpp"
#include "gui/tests/wait.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/main_window.hpp"

namespace kinebus::gui {
namespace {

constexpr int kPatience_ms = 300'000;

class Keyboard : public testing::Test {
 protected:
  Keyboard() {
    desk.theme.apply(false);
    desk.language.apply(QStringLiteral("en"));
    window = std::make_unique<MainWindow>(desk);
    window->show();
    window->activateWindow();
  }
  void press(Qt::Key key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
    QWidget* focus = QApplication::focusWidget();
    if (QWidget* modal = QApplication::activeModalWidget(); modal != nullptr && focus == nullptr)
      focus = modal;
    QTest::keyClick(focus != nullptr ? focus : window.get(), key, modifiers);
    QCoreApplication::processEvents();
  }
  static QString name_of(const QWidget* widget) {
    if (widget == nullptr) return {};
    if (!widget->accessibleName().isEmpty()) return widget->accessibleName();
    const auto* button = qobject_cast<const QAbstractButton*>(widget);
    return button != nullptr ? button->text() : QString();
  }
  /// From one thing to the next, until this one has the focus.
  ::testing::AssertionResult tab_to(const QString& name) {
    QStringList seen;
    for (int i = 0; i < 150; ++i) {
      const QString here = name_of(QApplication::focusWidget());
      if (here == name) return ::testing::AssertionSuccess();
      seen << here;
      press(Qt::Key_Tab);
    }
    return ::testing::AssertionFailure()
           << name.toStdString() << " is not among " << seen.join(QStringLiteral(", ")).toStdString();
  }
  joblink::State state() const { return desk.session.status().state(); }

  Desk desk;
  std::unique_ptr<MainWindow> window;
};

TEST_F(Keyboard, PrintsFromStartToEnd) {
  ASSERT_TRUE(wait_until([&] { return window->isActiveWindow(); }));
  ASSERT_TRUE(tab_to(QStringLiteral("Try the demo")));
  press(Qt::Key_Space);
  ASSERT_TRUE(wait_until([&] { return desk.session.connected() && desk.session.machine().joints_size() > 0; },
                         kPatience_ms));
  press(Qt::Key_4, Qt::ControlModifier);
  ASSERT_EQ(window->page(), MainWindow::kJog);
  ASSERT_TRUE(tab_to(QStringLiteral("Home")));
  press(Qt::Key_Space);
  ASSERT_TRUE(
      wait_until([&] { return state() == joblink::STATE_READY && desk.session.status().positions_known(); },
                 kPatience_ms));

  QTemporaryDir folder;
  QFile file(folder.filePath(QStringLiteral("square.gcode")));
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write("G21 G90\nG1 X10 Y0 Z10 F6000\nG1 X10 Y10\nG1 X-10 Y10\nG1 X-10 Y-10 F1200\nG1 X10 Y-10\n");
  file.close();
  press(Qt::Key_3, Qt::ControlModifier);
  ASSERT_EQ(window->page(), MainWindow::kJobs);
  ASSERT_TRUE(tab_to(QStringLiteral("Choose a file…")));
  press(Qt::Key_Space);
  QFileDialog* dialog = nullptr;
  ASSERT_TRUE(wait_until(
      [&] { return (dialog = window->findChild<QFileDialog*>()) != nullptr && dialog->isVisible(); }));
  ASSERT_TRUE(wait_until([&] { return qobject_cast<QLineEdit*>(QApplication::focusWidget()) != nullptr; }))
      << name_of(QApplication::focusWidget()).toStdString();
  QTest::keyClicks(QApplication::focusWidget(), file.fileName());
  press(Qt::Key_Return);
  ASSERT_TRUE(wait_until([&] { return desk.jobs.rowCount() == 1 && desk.session.jobs().jobs_size() == 1; },
                         kPatience_ms));
  window->activateWindow();
  ASSERT_TRUE(wait_until([&] { return window->isActiveWindow(); }));
  ASSERT_TRUE(tab_to(QStringLiteral("Jobs on the gateway")));
  press(Qt::Key_Home);
  ASSERT_TRUE(tab_to(QStringLiteral("Start")));
  press(Qt::Key_Space);
  ASSERT_TRUE(wait_until([&] { return state() == joblink::STATE_RUNNING; }, kPatience_ms));
  // Paused, and gone on with.
  ASSERT_TRUE(wait_until([&] { return desk.session.allowed(joblink::COMMAND_HOLD); }, kPatience_ms));
  ASSERT_TRUE(tab_to(QStringLiteral("Pause")));
  press(Qt::Key_Space);
  ASSERT_TRUE(wait_until([&] { return state() == joblink::STATE_HELD; }, kPatience_ms));
  ASSERT_TRUE(tab_to(QStringLiteral("Resume")));
  press(Qt::Key_Space);
  ASSERT_TRUE(wait_until([&] { return desk.record.end() == JobRecord::End::kComplete; }, kPatience_ms));
  EXPECT_NEAR(desk.session.status().tool().x_mm(), 10, 1e-2);
  EXPECT_NEAR(desk.session.status().tool().y_mm(), -10, 1e-2);
  bool says_so = false;
  for (const auto* label : window->findChildren<QLabel*>())
    says_so = says_so || (label->isVisible() && label->text() == QStringLiteral("Finished."));
  EXPECT_TRUE(says_so);
}

}  // namespace
}  // namespace kinebus::gui
