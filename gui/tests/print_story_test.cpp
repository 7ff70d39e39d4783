// A print as people have them, in the window and against the real daemon: an object is left out, the colour
// is changed, the filament runs out, and the rest is printed to its end. With KINEBUS_PICTURES=FOLDER in the
// environment each moment is a picture there.
#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAction>
#include <QDir>
#include <QFile>
#include <QLabel>
#include <QMenu>
#include <QMessageBox>
#include <QPushButton>
#include <QScreen>
#include <QTemporaryDir>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "gateway/description/machines_folder.hpp"
#include "gui/link/demo_gateway.hpp"
#include "gui/link/socket_link.hpp"
#include "gui/tests/wait.hpp"
#include "gui/views/desk.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/main_window.hpp"

namespace kinebus::gui {
namespace {

constexpr int kPatience_ms = 120'000;
constexpr int kLayers = 14, kChangeBehind = 6;
constexpr double kLayer_mm = 0.3, kFirst_mm = 0.3, kAside_mm = 20;

/// Two squares of 10 mm, layer by layer, 4 mm of filament each; in lines so short that the planner does not
/// hold the whole job. The colour is changed behind a layer.
QByteArray two_squares() {
  QByteArray text =
      "G21 G90 M83 G64 P0.005 Q0\nM109 S200\nEXCLUDE_OBJECT_DEFINE NAME=left\nEXCLUDE_OBJECT_DEFINE "
      "NAME=right\n";
  for (int layer = 0; layer < kLayers; ++layer) {
    for (const int side : {-1, 1}) {
      text += QByteArray("EXCLUDE_OBJECT_START NAME=") + (side < 0 ? "left\n" : "right\n");
      text += "G1 E-0.5 F1800\nG0 X" + QByteArray::number(side * kAside_mm - 5) + " Y-5 Z" +
              QByteArray::number(kFirst_mm + kLayer_mm * layer) + "\nG1 E0.5 F1800\nG91\nF2400\n";
      for (const char* way : {"X0.05", "Y0.05", "X-0.05", "Y-0.05"})
        for (int i = 0; i < 200; ++i) text += QByteArray("G1") + way + "E0.005\n";
      text += "G90\nEXCLUDE_OBJECT_END\n";
    }
    if (layer + 1 == kChangeBehind) text += "M600\n";
  }
  return text + "G1 E-0.5 F1800\nG0 X0 Y0 Z20\nM104 S0\n";
}

/// M1 with a spool that ends within the print, and a hot end that is hot soon.
QByteArray machine_file() {
  QFile file(QString::fromStdString((machines_folder() / "m1.toml").string()));
  EXPECT_TRUE(file.open(QIODevice::ReadOnly));
  QByteArray text = file.readAll();
  const QByteArray slow = "sim_power_w = 40 ";
  EXPECT_TRUE(text.contains(slow));
  text.replace(slow, "sim_power_w = 400 ");
  return text +
         "\n[filament_sensor.spool]\nkind = \"switch\"\nwhere = \"simulated\"\nsim_length_mm = 55\n"
         "[pause]\nlift_mm = 10\nunload_mm = 30\nload_mm = 30\npurge_mm = 5\nload_mm_per_s = 20\n";
}

class PrintStory : public testing::Test {
 protected:
  PrintStory() {
    desk.theme.apply(false);
    desk.language.apply(QStringLiteral("en"));
    window = std::make_unique<MainWindow>(desk);
    window->show();
    QObject::connect(&demo, &DemoGateway::failed, &desk.session, [&](const QString& why) { trouble = why; });
    QObject::connect(&desk.session, &Session::refused, &desk.session,
                     [&](const QString& why) { refusals << why; });
    QObject::connect(&demo, &DemoGateway::ready, &desk.session, [&] {
      desk.session.connect_to([path = demo.socket_path()] { return std::make_unique<SocketLink>(path); },
                              QStringLiteral("demo"));
    });
    QObject::connect(&desk.session, &Session::status_changed, &desk.session, [&] { watch(); });
  }
  QString write(const char* name, const QByteArray& text) {
    QFile file(folder.filePath(QLatin1String(name)));
    EXPECT_TRUE(file.open(QIODevice::WriteOnly));
    file.write(text);
    return file.fileName();
  }
  void watch() {
    const joblink::Status& s = desk.session.status();
    moved = moved || s.state() != joblink::STATE_READY;
    if (s.state() != joblink::STATE_RUNNING || s.tool().z_mm() > kFirst_mm + kLayer_mm * kLayers) return;
    // While it prints the height stays from one status to the next.
    const bool prints = std::abs(s.tool().z_mm() - std::exchange(height_mm, s.tool().z_mm())) < 1e-3;
    double& top_mm = s.tool().x_mm() < 0 ? left_top_mm : right_top_mm;
    if (prints && std::abs(std::abs(s.tool().x_mm()) - kAside_mm) < 5.1)
      top_mm = std::max(top_mm, s.tool().z_mm());
  }
  joblink::State state() const { return desk.session.status().state(); }
  QPushButton* button(const char* text) const {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->isVisible() && found->text() == QLatin1String(text)) return found;
    return nullptr;
  }
  /// As soon as it may be pressed.
  ::testing::AssertionResult press(const char* text) {
    if (!wait_until([&] { return button(text) != nullptr && button(text)->isEnabled(); }, kPatience_ms))
      return ::testing::AssertionFailure() << text << " cannot be pressed; " << said();
    button(text)->click();
    return ::testing::AssertionSuccess();
  }
  bool shows(const char* text) const {
    for (const auto* label : window->findChildren<QLabel*>())
      if (label->isVisible() && label->text().contains(QLatin1String(text))) return true;
    return false;
  }
  std::string said() const {
    return trouble.toStdString() + " " + refusals.join(QLatin1Char('|')).toStdString() + " " +
           desk.session.status().state_words() + ": " + desk.session.status().doing();
  }
  /// A filament key: pressed, and carried out.
  ::testing::AssertionResult moves_filament(const char* key) {
    if (auto pressed = press(key); !pressed) return pressed;
    moved = false;
    if (wait_until(
            [&] {
              return moved && state() == joblink::STATE_READY &&
                     desk.session.allowed(joblink::COMMAND_MOVE_FILAMENT);
            },
            kPatience_ms))
      return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << key << ": " << said();
  }
  // Without them the scene is not drawn: software takes a core for it.
  static QString pictures() { return qEnvironmentVariable("KINEBUS_PICTURES"); }
  void picture(const char* name) {
    const QString where = pictures();
    if (where.isEmpty()) return;
    QDir().mkpath(where);
    for (int i = 0; i < 12; ++i) QCoreApplication::processEvents(QEventLoop::AllEvents, 20);
    // The screen: menus and questions are windows of their own.
    EXPECT_TRUE(window->screen()->grabWindow(0).save(where + QLatin1Char('/') + QLatin1String(name) +
                                                     QStringLiteral(".png")));
  }

  QTemporaryDir folder;
  Desk desk;
  DemoGateway demo;
  std::unique_ptr<MainWindow> window;
  QString trouble;
  QStringList refusals;
  double left_top_mm = 0, right_top_mm = 0, height_mm = 0;
  bool moved = false;  ///< since a filament key was pressed
};

TEST_F(PrintStory, AnObjectLeftOutAColourAndAnEmptySpoolEndInAWholePrint) {
  demo.start(write("machine.toml", machine_file()));
  ASSERT_TRUE(wait_until([&] { return desk.session.connected() && desk.session.machine().joints_size() > 0; },
                         kPatience_ms))
      << said();
  window->jobs_page().upload({write("squares.gcode", two_squares())});
  ASSERT_TRUE(wait_until([&] { return desk.session.jobs().jobs_size() == 1; }, kPatience_ms)) << said();
  desk.session.home();
  ASSERT_TRUE(
      wait_until([&] { return state() == joblink::STATE_READY && desk.session.status().positions_known(); },
                 kPatience_ms))
      << said();
  window->show_page(MainWindow::kJobs);
  window->jobs_page().select(QStringLiteral("squares.gcode"));
  ASSERT_TRUE(press("Start"));
  if (!pictures().isEmpty()) window->show_page(MainWindow::kView);

  // One object is left out.
  ASSERT_TRUE(wait_until([&] { return state() == joblink::STATE_RUNNING && right_top_mm > 0; }, kPatience_ms))
      << said();
  ASSERT_EQ(desk.session.status().objects_size(), 2) << said();
  ASSERT_TRUE(press("Leave an object out"));
  QMenu* menu = nullptr;
  QAction* right = nullptr;
  for (auto* shown : window->findChildren<QMenu*>())
    for (QAction* action : shown->actions())
      if (shown->isVisible() && action->text() == QLatin1String("right")) menu = shown, right = action;
  ASSERT_NE(right, nullptr);
  picture("0-which");
  right->trigger();
  menu->close();
  auto* question = window->findChild<QMessageBox*>();
  ASSERT_NE(question, nullptr);
  picture("1-leave-out");
  for (QAbstractButton* answer : question->buttons())
    if (question->buttonRole(answer) == QMessageBox::DestructiveRole) answer->click();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().objects(1).left_out(); }, kPatience_ms))
      << said();

  // The colour is changed.
  ASSERT_TRUE(
      wait_until([&] { return state() == joblink::STATE_READY && desk.session.status().filament_change(); },
                 kPatience_ms))
      << said();
  const double left_at_change_mm = left_top_mm;
  EXPECT_TRUE(shows("Change the filament: load, purge, then resume."));
  picture("2-change-the-colour");
  ASSERT_TRUE(moves_filament("Load"));
  ASSERT_TRUE(moves_filament("Purge"));
  ASSERT_TRUE(press("Resume"));

  // The spool is empty: the job is held, and does not go on without filament.
  ASSERT_TRUE(wait_until([&] { return state() == joblink::STATE_HELD; }, kPatience_ms)) << said();
  ASSERT_EQ(desk.session.status().filament_sensors_size(), 1);
  EXPECT_EQ(desk.session.status().filament_sensors(0).condition(), joblink::FILAMENT_OUT) << said();
  const double left_at_end_of_spool_mm = left_top_mm;
  EXPECT_GT(left_at_end_of_spool_mm, left_at_change_mm - 1e-3);
  EXPECT_TRUE(shows("there is no filament any more"));
  picture("3-spool-empty");
  ASSERT_TRUE(press("Set aside"));
  ASSERT_TRUE(wait_until(
      [&] { return state() == joblink::STATE_READY && desk.session.allowed(joblink::COMMAND_MOVE_FILAMENT); },
      kPatience_ms))
      << said();
  ASSERT_TRUE(moves_filament("Unload"));
  picture("4-new-spool");
  ASSERT_TRUE(moves_filament("Load"));
  ASSERT_TRUE(moves_filament("Purge"));
  EXPECT_EQ(desk.session.status().filament_sensors(0).condition(), joblink::FILAMENT_IN_ORDER);
  ASSERT_TRUE(press("Resume"));
  ASSERT_TRUE(wait_until([&] { return desk.record.end() == JobRecord::End::kComplete; }, kPatience_ms))
      << said();
  EXPECT_TRUE(shows("Finished."));
  picture("5-finished");

  const double top_mm = kFirst_mm + kLayer_mm * (kLayers - 1);
  std::printf("left to %.2f mm of %.2f, right to %.2f; changed at %.2f, spool empty at %.2f\n", left_top_mm,
              top_mm, right_top_mm, left_at_change_mm, left_at_end_of_spool_mm);
  EXPECT_NEAR(left_top_mm, top_mm, 0.05);
  EXPECT_LT(right_top_mm, left_at_change_mm);
  EXPECT_LT(left_at_end_of_spool_mm, top_mm);
}

}  // namespace
}  // namespace kinebus::gui
