// kinebus-gui-screenshots DIR: every page of the program in every language, light and dark, against a real
// demo daemon that prints. tools/screenshots runs it under Xvfb. DIR scenes, DIR bench, DIR killed: the
// machines, the window of a driver card, the gateway that is killed, alone.

#include <QApplication>
#include <QDeadlineTimer>
#include <QDir>
#include <QLatin1String>
#include <QTemporaryDir>
#include <cstdio>
#include <stdexcept>

#include "gui/screenshots/bench_pictures.hpp"
#include "gui/screenshots/demo_job.hpp"
#include "gui/screenshots/killed_gateway.hpp"
#include "gui/screenshots/photographer.hpp"
#include "gui/screenshots/scenes.hpp"
#include "gui/views/connect_page.hpp"
#include "gui/views/heat_panel.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/machine_file_editor.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/main_window.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {

int run(int argc, char** argv) {
  SceneView::choose_format();
  QApplication app(argc, argv);
  QApplication::setOrganizationName(QStringLiteral("kinebus"));
  QApplication::setApplicationName(QStringLiteral("kinebus-gui-screenshots"));
  const QString folder = argc > 1 ? QString::fromLocal8Bit(argv[1]) : QStringLiteral("screenshots");
  const QString part = argc > 2 ? QString::fromLocal8Bit(argv[2]) : QString();
  QDir().mkpath(folder);
  QTemporaryDir scratch;

  Desk desk;
  desk.theme.apply(false);
  desk.language.apply(QStringLiteral("en"));
  MainWindow window(desk);
  window.show();
  Photographer photographer(desk, window, folder);
  if (part == QLatin1String("killed")) {
    photograph_killed_gateway(desk, window, photographer);
    return 0;
  }
  if (part == QLatin1String("bench")) {
    photograph_bench(desk, window, photographer);
    return 0;
  }
  if (part == QLatin1String("scenes")) {
    turn_to(desk, "m1");
    desk.session.home();
    wait("the machine is homed", [&] {
      return desk.session.status().state() == joblink::STATE_READY && desk.session.status().positions_known();
    });
    photograph_m1(desk, window, photographer);
    photograph_other_machines(desk, window, photographer);
    return 0;
  }
  photographer.all(MainWindow::kConnect, QStringLiteral("1-connect"));
  photograph_bench(desk, window, photographer);
  photographer.small(MainWindow::kConnect, QStringLiteral("connect"));

  QObject::connect(&desk.session, &Session::refused, &window,
                   [](const QString& words) { std::fprintf(stderr, "refused: %s\n", qPrintable(words)); });
  window.connect_page().start_demo();
  const auto state = [&] { return desk.session.status().state(); };
  wait("the demo machine answers",
       [&] { return desk.session.connected() && desk.session.machine().joints_size() > 0; });
  window.jobs_page().upload(
      {write_file(scratch.path(), QStringLiteral("vase.gcode"), vase_job(44, 1, 0.7)),
       write_file(scratch.path(), QStringLiteral("bracket-v2.gcode"), vase_job(24, 3, 0.25)),
       write_file(scratch.path(), QStringLiteral("short.gcode"), vase_job(1, 1, 0.7)),
       write_file(scratch.path(), QStringLiteral("too-wide.gcode"), wrong_job())});
  wait("four jobs are stored", [&] { return desk.session.jobs().jobs_size() == 4; });
  bool checked = false;
  desk.session.check_job(QStringLiteral("bracket-v2.gcode"), [&](const auto&) { checked = true; });
  wait("a job is checked", [&] { return checked; });
  desk.session.home();
  wait("the machine is homed",
       [&] { return state() == joblink::STATE_READY && desk.session.status().positions_known(); });
  photographer.all(MainWindow::kJog, QStringLiteral("4-jog"));
  photographer.small(MainWindow::kJog, QStringLiteral("jog"));
  photograph_m1(desk, window, photographer);
  for (const char* line : {"M115", "M114", "M105", "M119"}) say_line(desk, window, line);
  photographer.all(MainWindow::kConsole, QStringLiteral("5-console"));
  photographer.small(MainWindow::kConsole, QStringLiteral("console"));
  wait("still connected", [&] { return desk.session.connected(); });
  window.show_page(MainWindow::kJobs);
  window.jobs_page().select(QStringLiteral("too-wide.gcode"));
  window.jobs_page().check();
  wait("the wrong job is checked", [&] { return !window.jobs_page().checking() && !desk.path.loading(); });
  photographer.all(MainWindow::kJobs, QStringLiteral("3-jobs"));
  photographer.small(MainWindow::kJobs, QStringLiteral("jobs"));
  window.machine_page().show_tab(2);
  window.machine_page().editor().read_if_empty();
  wait("the machine file is here",
       [&] { return !window.machine_page().editor().text().document()->isEmpty(); });
  photographer.all(MainWindow::kMachine, QStringLiteral("9-machine-file"));
  photographer.small(MainWindow::kMachine, QStringLiteral("machine-file"));

  window.machine_page().show_tab(3);
  photographer.all(MainWindow::kMachine, QStringLiteral("10-motors"));
  photographer.small(MainWindow::kMachine, QStringLiteral("motors"));

  wait("still connected", [&] { return desk.session.connected(); });
  // A computer that is too busy for the demo holds it up: the job goes on from its place.
  QDeadlineTimer again(0);
  const auto goes_on = [&] {
    if (again.hasExpired()) {
      if (state() == joblink::STATE_STOPPED) desk.session.clear();
      if (state() == joblink::STATE_HELD) desk.session.resume();
      again.setRemainingTime(1000);
    }
    return state() == joblink::STATE_RUNNING;
  };
  const auto print = [&] {
    desk.session.start_job(QStringLiteral("vase.gcode"));
    wait("a job prints", [&] { return goes_on() && desk.session.status().progress() > 0.3; });
  };
  print();
  wait("its path is shown",
       [&] { return desk.path.scene() != nullptr && desk.path.name() == QStringLiteral("vase.gcode"); });
  window.view_page().scene().look(SceneView::Look::kDiagonal);
  photographer.all(MainWindow::kView, QStringLiteral("2-view"),
                   [&] { window.view_page().scene().fit_machine(); });
  photographer.all(MainWindow::kView, QStringLiteral("2-view-part"), [&] {
    window.view_page().set_colouring(PathColouring::kLayer);
    window.view_page().scene().fit_part();
  });
  window.view_page().set_colouring(PathColouring::kFeature);
  photographer.all(MainWindow::kView, QStringLiteral("2-view-kinds"));
  window.view_page().set_colouring(PathColouring::kPart);
  photographer.one(MainWindow::kView, QStringLiteral("11-scene-m1-printed"));
  photographer.small(MainWindow::kView, QStringLiteral("view"));
  // Faster than the slider goes.
  desk.session.set_override(3);
  wait("three times as fast", [&] { return desk.session.status().feed_override() > 2.9; });
  window.machine_page().show_tab(0);
  photographer.all(MainWindow::kMachine, QStringLiteral("7-machine"));
  // A busy computer takes long for the rest, and the job shall not be over before.
  if (state() == joblink::STATE_RUNNING) desk.session.set_override(0.25);
  window.machine_page().show_tab(1);
  photographer.all(MainWindow::kMachine, QStringLiteral("8-machine-bus"));
  photographer.small(MainWindow::kMachine, QStringLiteral("machine-bus"));
  window.machine_page().show_tab(0);
  photographer.small(MainWindow::kMachine, QStringLiteral("machine"));
  if (state() == joblink::STATE_READY) print();
  desk.session.hold();
  wait("the job is held", [&] { return state() == joblink::STATE_HELD; });
  photographer.small(MainWindow::kView, QStringLiteral("held"));
  desk.session.step_aside();
  wait("it is set aside",
       [&] { return state() == joblink::STATE_READY && desk.session.status().interrupted(); });
  photographer.all(MainWindow::kJog, QStringLiteral("15-aside"));
  photographer.small(MainWindow::kJog, QStringLiteral("aside"));
  desk.session.resume();
  wait("the job goes on", [&] { return state() == joblink::STATE_RUNNING; });
  desk.session.stop();
  wait("stopped", [&] { return state() == joblink::STATE_STOPPED || state() == joblink::STATE_ALARM; });
  photographer.all(MainWindow::kAlarms, QStringLiteral("6-alarms"));
  photographer.small(MainWindow::kAlarms, QStringLiteral("alarms"));
  desk.session.clear();
  wait("the stop is lifted",
       [&] { return state() != joblink::STATE_STOPPED && desk.session.allowed(joblink::COMMAND_CANCEL); });
  desk.session.cancel();
  wait("the job is cancelled",
       [&] { return state() == joblink::STATE_READY && desk.session.status().job().empty(); });
  desk.session.start_job(QStringLiteral("short.gcode"));
  wait("a short job is over", [&] { return desk.record.end() == JobRecord::End::kComplete; });
  photographer.all(MainWindow::kView, QStringLiteral("16-finished"));
  photograph_other_machines(desk, window, photographer);
  turn_to(desk, "corexy_heat");
  desk.session.bring_up();
  wait("it is awake", [&] { return desk.session.allowed(joblink::COMMAND_TUNE_HEATER); });
  desk.session.tune_heater(joblink::HEATER_HOTEND, 0, 0);
  window.machine_page().show_tab(4);
  window.machine_page().heat_panel().choose(QStringLiteral("hotend"));
  const auto stage = [&] {
    const TuningCurve* curve = desk.tuning.of("hotend");
    return curve != nullptr ? curve->stage : joblink::TUNING_NONE;
  };
  wait("its power is off", [&] { return stage() == joblink::TUNING_COOLS; });
  photographer.one(MainWindow::kMachine, QStringLiteral("12-heater-is-measured"));
  wait("a heater is measured",
       [&] { return stage() == joblink::TUNING_DONE || stage() == joblink::TUNING_FAILED; });
  photographer.all(MainWindow::kMachine, QStringLiteral("12-heaters"));
  window.machine_page().show_tab(4);
  photographer.small(MainWindow::kMachine, QStringLiteral("heaters"));
  desk.session.disconnect_from_gateway();
  desk.demo.reset();
  photograph_killed_gateway(desk, window, photographer);
  return 0;
}

}  // namespace
}  // namespace kinebus::gui

int main(int argc, char** argv) {
  try {
    return kinebus::gui::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinebus-gui-screenshots: %s\n", error.what());
    return 1;
  }
}
