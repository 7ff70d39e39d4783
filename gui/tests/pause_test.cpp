// A job that is held, set aside, refused, and over: what the desktop offers and says.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QApplication>
#include <QCoreApplication>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QTableView>
#include <stdexcept>

#include "gui/tests/window_fixture.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/machine_file_editor.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/notice.hpp"

namespace kinebus::gui {
namespace {

class PauseTest : public WindowTest {
 protected:
  void SetUp() override {
    gateway.machine.mutable_filament_ways()->set_unload_mm(70);
    gateway.machine.mutable_filament_ways()->set_load_mm(55);
    gateway.machine.mutable_filament_ways()->set_purge_mm(25);
    gateway.jobs["a.gcode"] = "G1 X1 F600\n";
    gateway.jobs["b.gcode"] = "G1 X2 F600\n";
    show_connected();
    ASSERT_TRUE(
        wait_until([&] { return desk.jobs.rowCount() == 2 && desk.session.machine().has_filament_ways(); }));
  }
  QPushButton* button(const char* text) const {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->isVisible() && found->text() == QLatin1String(text)) return found;
    return nullptr;
  }
  bool shows(const QString& text) const {
    for (const auto* label : window->findChildren<QLabel*>())
      if (label->isVisible() && label->text().remove(QChar(0x2066)).remove(QChar(0x2069)).contains(text))
        return true;
    return false;
  }
  void enter(joblink::State state, const char* job) {
    gateway.status.set_state(state);
    gateway.status.set_job(job);
    const double from = desk.session.status().time_s();
    ASSERT_TRUE(wait_until([&] {
      return desk.session.status().time_s() > from + 0.05 && desk.session.status().state() == state &&
             desk.session.status().job() == job;
    }));
  }
};

TEST_F(PauseTest, AHeldJobIsSetAsideAndItsFilamentChanged) {
  gateway.allow({joblink::COMMAND_HOLD, joblink::COMMAND_CANCEL});
  enter(joblink::STATE_RUNNING, "a.gcode");
  ASSERT_NE(button("Set aside"), nullptr);
  EXPECT_FALSE(button("Set aside")->isEnabled());
  ASSERT_NE(button("Cancel"), nullptr);
  const auto cancel_stands = [&] {
    QCoreApplication::sendPostedEvents();  // layouts that wait for their turn
    QCoreApplication::processEvents();
    return button("Cancel")->mapTo(window.get(), QPoint());
  };
  const QPoint place = cancel_stands();
  gateway.allow({joblink::COMMAND_RESUME, joblink::COMMAND_CANCEL, joblink::COMMAND_STEP_ASIDE});
  enter(joblink::STATE_HELD, "a.gcode");
  EXPECT_EQ(cancel_stands(), place) << "nothing moves under the pointer";
  QPushButton* aside = button("Set aside");
  ASSERT_NE(aside, nullptr);
  aside->click();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kStepAside) == 1; }));
  gateway.status.set_interrupted(true);
  gateway.status.set_filament_change(true);
  gateway.allow({joblink::COMMAND_RESUME, joblink::COMMAND_CANCEL, joblink::COMMAND_JOG,
                 joblink::COMMAND_MOVE_FILAMENT});
  enter(joblink::STATE_READY, "a.gcode");
  EXPECT_TRUE(shows(QStringLiteral("Change the filament: load, purge, then resume.")));
  EXPECT_EQ(cancel_stands(), place) << "nothing moves under the pointer";
  for (const char* way : {"Unload", "Load", "Purge"}) {
    ASSERT_NE(button(way), nullptr) << way;
    EXPECT_TRUE(button(way)->isEnabled()) << way;
    button(way)->click();
  }
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kMoveFilament) == 3; }));
  ASSERT_NE(button("Resume"), nullptr);
  button("Resume")->click();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kResume) == 1; }));
}

TEST_F(PauseTest, AFinishedJobTellsTimeFilamentAndItsWorstFigures) {
  gateway.status.set_job_filament_mm(0);
  gateway.status.mutable_nodes(0)->set_sync_error_s(1.5e-6);
  gateway.status.set_bus_load(0.1);
  enter(joblink::STATE_CHECKING, "a.gcode");
  gateway.status.set_rate(1);
  for (const int other : {1, 2}) gateway.status.mutable_nodes(other)->set_queue_records(100);
  // Empty before its motion begins and at its end; in the midst never below a quarter.
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.set_doing("moving");
  gateway.status.set_remaining_s(60);
  gateway.status.mutable_nodes(0)->set_queue_records(100);
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.mutable_nodes(0)->set_queue_records(32);
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.mutable_nodes(0)->set_queue_records(100);
  gateway.status.set_elapsed_s(125);
  gateway.status.set_job_filament_mm(3200);
  gateway.status.mutable_nodes(0)->set_sync_error_s(7.25e-6);
  gateway.status.set_bus_load(0.42);
  gateway.status.mutable_counters()->set_starvation_holds(2);
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.mutable_nodes(0)->set_sync_error_s(1e-6);
  gateway.status.set_bus_load(0.05);
  enter(joblink::STATE_HELD, "a.gcode");
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.mutable_nodes(0)->set_queue_records(0);
  gateway.status.set_remaining_s(1);
  enter(joblink::STATE_RUNNING, "a.gcode");
  gateway.status.set_elapsed_s(0);
  gateway.status.clear_job_filament_mm();
  enter(joblink::STATE_READY, "");
  EXPECT_TRUE(shows(QStringLiteral("Finished.")));
  EXPECT_TRUE(shows(QStringLiteral("2:05")));
  EXPECT_TRUE(shows(QStringLiteral("3.20 m")));
  EXPECT_TRUE(shows(QStringLiteral("7.2 µs")) || shows(QStringLiteral("7.3 µs")));
  EXPECT_TRUE(shows(QStringLiteral("42%")));
  EXPECT_TRUE(shows(QStringLiteral("25%")));
  EXPECT_EQ(desk.record.figures().stalls, 2U);
  // The next one begins from nothing.
  enter(joblink::STATE_RUNNING, "b.gcode");
  EXPECT_EQ(desk.record.figures().filament_mm, 0);
  EXPECT_FALSE(shows(QStringLiteral("Finished.")));
}

TEST_F(PauseTest, AJobThatIsRefusedAtItsStartSaysWhyAndShowsItsOwnFindings) {
  window->show_page(MainWindow::kJobs);
  window->jobs_page().select(QStringLiteral("b.gcode"));
  ASSERT_NE(button("Start"), nullptr);
  ASSERT_TRUE(wait_until([&] { return button("Start") != nullptr && button("Start")->isEnabled(); }));
  button("Start")->click();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kStartJob) == 1; }));
  EXPECT_EQ(desk.path.name(), QStringLiteral("b.gcode")) << "the one that was started is shown";
  enter(joblink::STATE_CHECKING, "b.gcode");
  joblink::Event event;
  event.set_id(11);
  event.set_kind(joblink::EVENT_PROBLEM);
  event.set_line(7);
  event.set_words("error: out of reach");
  gateway.say(event);
  event.set_id(12);
  event.set_kind(joblink::EVENT_FINISHED);
  event.set_line(0);
  event.set_words("the job was not begun: it has 1 errors");
  event.set_advice("correct the lines named, then run it again");
  gateway.say(event);
  enter(joblink::STATE_READY, "");
  EXPECT_TRUE(window->notice().isVisible());
  EXPECT_TRUE(window->notice().words().contains(QStringLiteral("not begun")))
      << window->notice().words().toStdString();
  EXPECT_TRUE(shows(QStringLiteral("Not begun")));
  window->show_page(MainWindow::kJobs);
  QTableView* findings = nullptr;
  for (auto* table : window->findChildren<QTableView*>())
    if (table->accessibleName() == QStringLiteral("What the check has found")) findings = table;
  ASSERT_NE(findings, nullptr);
  EXPECT_EQ(findings->model()->rowCount(), 1);
  EXPECT_TRUE(shows(QStringLiteral("b.gcode: 1 error. It will not start.")));
  // Findings are those of the job that is chosen.
  window->jobs_page().select(QStringLiteral("a.gcode"));
  EXPECT_EQ(findings->model()->rowCount(), 0);
  window->jobs_page().select(QStringLiteral("b.gcode"));
  EXPECT_EQ(findings->model()->rowCount(), 1);
}

TEST_F(PauseTest, AnotherThemeDoesNotCheckTheMachineFileAnew) {
  window->show_page(MainWindow::kMachine);
  window->machine_page().show_tab(2);
  ASSERT_TRUE(wait_until([&] { return shows(QStringLiteral("The file is right.")); }));
  // Colours of the text change, which is a change of the document.
  for (const bool dark : {true, false}) {
    window->set_theme(dark);
    QApplication::processEvents();
    EXPECT_TRUE(shows(QStringLiteral("The file is right."))) << dark;
  }
  window->machine_page().editor().text().appendPlainText(QStringLiteral("# mine"));
  EXPECT_TRUE(shows(QStringLiteral("Checking…")));
  EXPECT_TRUE(wait_until([&] { return shows(QStringLiteral("The file is right.")); }));
}

TEST_F(PauseTest, ReadingTheMachineFileAgainAsksBeforeItDiscards) {
  window->show_page(MainWindow::kMachine);
  window->machine_page().show_tab(2);
  MachineFileEditor& editor = window->machine_page().editor();
  ASSERT_TRUE(wait_until([&] { return !editor.text().document()->isEmpty(); }));
  const auto reads = [&] { return gateway.count(joblink::ClientMessage::kReadMachineFile); };
  const int before = reads();
  button("Read again")->click();
  ASSERT_TRUE(wait_until([&] { return reads() == before + 1; })) << "nothing is lost: at once";
  editor.text().appendPlainText(QStringLiteral("# mine"));
  ASSERT_TRUE(editor.text().document()->isModified());
  button("Read again")->click();
  auto* question = window->findChild<QMessageBox*>();
  ASSERT_NE(question, nullptr);
  EXPECT_EQ(question->defaultButton()->text(), QStringLiteral("Keep my changes"));
  question->defaultButton()->click();
  EXPECT_EQ(reads(), before + 1);
  EXPECT_TRUE(editor.text().toPlainText().contains(QStringLiteral("# mine")));
}

TEST_F(PauseTest, ASavedMachineFileIsTakenByAButton) {
  gateway.machine_file_newer = true;
  window->show_page(MainWindow::kMachine);
  window->machine_page().show_tab(2);
  ASSERT_TRUE(wait_until([&] {
    return button("Restart the gateway") != nullptr && shows(QStringLiteral("The file is right."));
  }));
  gateway.refuse = QStringLiteral("the gateway starts anew when the machine rests");
  button("Restart the gateway")->click();
  ASSERT_TRUE(wait_until([&] { return shows(QStringLiteral("starts anew when the machine rests")); }));
  button("Restart the gateway")->click();
  ASSERT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kRestartGateway) == 2; }));
  ASSERT_TRUE(wait_until([&] { return shows(QStringLiteral("The gateway begins anew.")); }));
}

}  // namespace
}  // namespace kinebus::gui
