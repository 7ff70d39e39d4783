// The whole window under a real X server (xvfb-run) with software OpenGL, against a gateway made of paper.
#include <gtest/gtest.h>
#include <time.h>

#include <QAbstractEventDispatcher>
#include <QAbstractItemModel>
#include <QApplication>
#include <QByteArray>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QEvent>
#include <QFile>
#include <QIODevice>
#include <QImage>
#include <QKeyEvent>
#include <QLatin1String>
#include <QMainWindow>
#include <QPushButton>
#include <QRgb>
#include <QSettings>
#include <QSize>
#include <QStringList>
#include <QTableView>
#include <QTemporaryDir>
#include <QTimer>
#include <QWidget>
#include <set>

#include "gui/link/socket_link.hpp"
#include "gui/screenshots/demo_job.hpp"
#include "gui/tests/fake_gateway.hpp"
#include "gui/tests/wait.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/machine_page.hpp"
#include "gui/views/main_window.hpp"
#include "gui/views/top_bar.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {

double cpu_ms(clockid_t whose) {
  timespec t{};
  clock_gettime(whose, &t);
  return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_nsec) * 1e-6;
}

double peak_memory_mb() {
  QFile file(QStringLiteral("/proc/self/status"));
  if (!file.open(QIODevice::ReadOnly)) return 0;
  for (const QByteArray& line : file.readAll().split('\n'))
    if (line.startsWith("VmHWM:")) return line.mid(6).trimmed().split(' ').first().toDouble() / 1024;
  return 0;
}

/// How long the event loop was away at most between two rounds: by the clock, and by what this thread itself
/// computed. The computer's other programs lengthen the first, never the second.
class Watchdog : public QObject {
 public:
  Watchdog() {
    timer_.setInterval(0);
    connect(&timer_, &QTimer::timeout, this, [this] {
      const double cpu = cpu_ms(CLOCK_THREAD_CPUTIME_ID),
                   wall = static_cast<double>(clock_.nsecsElapsed()) * 1e-6;
      if (last_wall_ > 0) {
        most_cpu_ms = std::max(most_cpu_ms, cpu - last_cpu_);
        most_wall_ms = std::max(most_wall_ms, wall - last_wall_);
      }
      last_cpu_ = cpu;
      last_wall_ = wall;
    });
    clock_.start();
    timer_.start();
  }
  /// Its looks cost time themselves: not while that of something else is measured.
  void rest() {
    timer_.stop();
    last_wall_ = 0;
  }
  void go_on() { timer_.start(); }
  double most_cpu_ms = 0, most_wall_ms = 0;

 private:
  QTimer timer_;
  QElapsedTimer clock_;
  double last_cpu_ = 0, last_wall_ = 0;
};

class WindowTest : public testing::Test {
 protected:
  WindowTest() {
    desk.theme.apply(false);
    desk.language.apply(QStringLiteral("en"));
  }
  void show_connected() {
    window = std::make_unique<MainWindow>(desk);
    window->show();
    desk.session.connect_to([path = gateway.socket_path()] { return std::make_unique<SocketLink>(path); },
                            QStringLiteral("fake"));
    ASSERT_TRUE(wait_until([&] { return desk.session.connected() && desk.session.status().time_s() > 0; }));
  }
  FakeGateway gateway;
  Desk desk;
  std::unique_ptr<MainWindow> window;
};

int colours_in(const QImage& image) {
  std::set<QRgb> colours;
  for (int y = 0; y < image.height(); y += 3)
    for (int x = 0; x < image.width(); x += 3) colours.insert(image.pixel(x, y));
  return static_cast<int>(colours.size());
}

TEST_F(WindowTest, EveryPageIsDrawnInEveryLanguageAndTheme) {
  show_connected();
  for (const auto& language : Language::choices())
    for (const bool dark : {false, true}) {
      window->set_language(language.code);
      window->set_theme(dark);
      for (int page = 0; page < MainWindow::kPages; ++page) {
        window->show_page(static_cast<MainWindow::Page>(page));
        QCoreApplication::processEvents();
        const QImage image = window->grab().toImage();
        EXPECT_GT(colours_in(image), 30) << "page " << page << " in " << language.code.toStdString();
        const int ground = image.pixelColor(120, image.height() - 4).lightness();
        EXPECT_TRUE(dark ? ground < 90 : ground > 150) << "page " << page << " dark " << dark;
      }
    }
}

TEST_F(WindowTest, NoCellOfTheMachinePageIsCutInAnyLanguage) {
  show_connected();
  window->resize(1280, 720);
  window->show_page(MainWindow::kMachine);
  for (const auto& language : Language::choices()) {
    window->set_language(language.code);
    QCoreApplication::processEvents();
    for (const QTableView* table : window->findChildren<QTableView*>()) {
      if (!table->isVisible()) continue;
      const QAbstractItemModel& model = *table->model();
      for (int column = 0; column < model.columnCount(); ++column) {
        if (table->isColumnHidden(column)) continue;
        QStringList texts{model.headerData(column, Qt::Horizontal).toString()};
        for (int row = 0; row < model.rowCount(); ++row) texts << model.index(row, column).data().toString();
        for (const QString& text : texts)
          EXPECT_LE(table->fontMetrics().horizontalAdvance(text) + 4, table->columnWidth(column))
              << language.code.toStdString() << ": " << text.toStdString();
      }
    }
  }
}

TEST_F(WindowTest, ArrowsJogAlsoAfterAButtonWasClicked) {
  gateway.status.set_state(joblink::STATE_READY);
  show_connected();
  window->set_language(QStringLiteral("en"));
  window->show_page(MainWindow::kJog);
  QPushButton* home = nullptr;
  for (QPushButton* button : window->findChildren<QPushButton*>())
    if (button->isVisible() && button->text() == QStringLiteral("Home")) home = button;
  ASSERT_NE(home, nullptr);
  home->setFocus();
  QKeyEvent press(QEvent::KeyPress, Qt::Key_Right, Qt::NoModifier);
  QApplication::sendEvent(home, &press);
  EXPECT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kJog) == 1; }));
}

TEST_F(WindowTest, PersianRunsFromRightToLeftAndBack) {
  show_connected();
  window->set_language(QStringLiteral("fa"));
  EXPECT_EQ(window->layoutDirection(), Qt::RightToLeft);
  EXPECT_TRUE(
      wait_until([&] { return window->top_bar().stop_button().text().trimmed() == QStringLiteral("ایست"); }));
  window->set_language(QStringLiteral("tr"));
  EXPECT_EQ(window->layoutDirection(), Qt::LeftToRight);
  EXPECT_TRUE(
      wait_until([&] { return window->top_bar().stop_button().text().trimmed() == QStringLiteral("DUR"); }));
}

TEST_F(WindowTest, StopIsOnEveryPageAndReachesTheGateway) {
  show_connected();
  for (int page = 0; page < MainWindow::kPages; ++page) {
    window->show_page(static_cast<MainWindow::Page>(page));
    EXPECT_TRUE(window->top_bar().stop_button().isVisible() && window->top_bar().stop_button().isEnabled());
  }
  window->top_bar().stop_button().click();
  EXPECT_TRUE(wait_until([&] { return gateway.count(joblink::ClientMessage::kStop) == 1; }));
}

TEST_F(WindowTest, StateIsSaidInPlainWords) {
  show_connected();
  for (const auto& [state, words] : {std::pair{joblink::STATE_UNHOMED, "Not homed"},
                                     {joblink::STATE_RUNNING, "Printing"},
                                     {joblink::STATE_ALARM, "Alarm"}}) {
    gateway.status.set_state(state);
    EXPECT_TRUE(wait_until([&] { return window->top_bar().chip().words() == QLatin1String(words); }))
        << words;
  }
}

TEST_F(WindowTest, FitsIntoASmallScreen) {
  show_connected();
  for (const auto& language : Language::choices()) {
    window->set_language(language.code);
    EXPECT_LE(window->minimumSizeHint().width(), 1280) << language.code.toStdString();
    EXPECT_LE(window->minimumSizeHint().height(), 720) << language.code.toStdString();
  }
}

TEST_F(WindowTest, LayoutIsRemembered) {
  show_connected();
  QTemporaryDir folder;
  QSettings settings(folder.filePath(QStringLiteral("layout.ini")), QSettings::IniFormat);
  window->view_page().set_colouring(PathColouring::kMargin);
  window->resize(1180, 690);
  window->save(settings);
  window = std::make_unique<MainWindow>(desk);
  window->restore(settings);
  EXPECT_EQ(window->size(), QSize(1180, 690));
  EXPECT_EQ(window->view_page().scene().content().colouring, PathColouring::kMargin);
}

TEST_F(WindowTest, FindingOfTheCheckLeadsToItsPlace) {
  gateway.jobs["part.gcode"] = vase_job(3, 3, 0.25).toStdString();
  auto& problem = *gateway.preflight.add_problems();
  problem.set_error(true);
  problem.set_line(120);
  problem.set_words("out of reach");
  gateway.preflight.mutable_summary()->set_errors(1);
  show_connected();
  ASSERT_TRUE(wait_until([&] { return desk.jobs.rowCount() == 1; }));
  window->show_page(MainWindow::kJobs);
  window->jobs_page().select(QStringLiteral("part.gcode"));
  window->jobs_page().check();
  ASSERT_TRUE(wait_until([&] { return window->view_page().scene().content().marked_vertex != UINT32_MAX; }));
  const auto vertex = window->view_page().scene().content().marked_vertex;
  EXPECT_EQ(desk.path.scene()->path.lines[vertex], 120u);
}

TEST_F(WindowTest, AnInterruptedJobOffersToGoOnOrToBeCancelled) {
  show_connected();
  const auto enabled = [&](const QString& text) {
    for (const auto* button : window->findChildren<QPushButton*>())
      if (button->text() == text && !button->isHidden() && button->isEnabled()) return true;
    return false;
  };
  gateway.status.set_state(joblink::STATE_UNHOMED);
  gateway.allow({joblink::COMMAND_HOME});
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().state() == joblink::STATE_UNHOMED; }));
  EXPECT_FALSE(enabled(QStringLiteral("Resume")));
  gateway.allow({joblink::COMMAND_HOME, joblink::COMMAND_RESUME, joblink::COMMAND_CANCEL});
  gateway.status.set_job("part.gcode");
  gateway.status.set_interrupted(true);
  gateway.send_status();
  ASSERT_TRUE(wait_until([&] { return desk.session.status().interrupted(); }));
  EXPECT_TRUE(enabled(QStringLiteral("Resume")));
  EXPECT_TRUE(enabled(QStringLiteral("Cancel")));
}

TEST_F(WindowTest, AButtonThatCanDoNothingTellsWhyInTheGatewaysWords) {
  show_connected();
  const auto button = [&](const QString& text) -> QPushButton* {
    for (auto* found : window->findChildren<QPushButton*>())
      if (found->text() == text) return found;
    return nullptr;
  };
  QPushButton* reference = button(QStringLiteral("Bed reference"));
  ASSERT_NE(reference, nullptr);
  ASSERT_TRUE(wait_until([&] { return reference->isEnabled(); }));
  const QString does = reference->toolTip();
  gateway.allow({joblink::COMMAND_HOME});
  ASSERT_TRUE(wait_until([&] { return !reference->isEnabled(); }));
  EXPECT_EQ(reference->toolTip(), QStringLiteral("home it first"));
  gateway.allow({joblink::COMMAND_REFERENCE});
  ASSERT_TRUE(wait_until([&] { return reference->isEnabled(); }));
  EXPECT_EQ(reference->toolTip(), does);
}

TEST_F(WindowTest, TheJobsLinesAreSeen) {
  show_connected();
  window->show_page(MainWindow::kView);
  QTemporaryDir folder;
  QFile file(folder.filePath(QStringLiteral("floor.gcode")));
  ASSERT_TRUE(file.open(QIODevice::WriteOnly));
  file.write(vase_job(1, 1, 0.25));
  file.close();
  SceneView& scene = window->view_page().scene();
  ASSERT_TRUE(wait_until([&] { return scene.frames() > 0; }));
  scene.content().show_machine = scene.content().show_reach = false;
  desk.path.show_file(file.fileName());
  ASSERT_TRUE(wait_until([&] { return desk.path.scene() != nullptr && !scene.renderer().copying(); }));
  scene.look(SceneView::Look::kTop);
  scene.fit_part();
  const auto picture = [&](std::uint32_t done) {
    scene.content().done_vertex = done;
    scene.redraw();
    EXPECT_TRUE(wait_until([&] { return scene.at_rest(); }));
    return scene.grabFramebuffer();
  };
  scene.content().show_remaining = false;
  const QImage with = picture(UINT32_MAX), without = picture(0);
  int seen = 0;
  for (int y = 0; y < with.height(); ++y)
    for (int x = 0; x < with.width(); ++x) seen += with.pixel(x, y) != without.pixel(x, y) ? 1 : 0;
  // The floor is a disc of radius 31 mm, a third of it beads of 0.42 mm, in a picture of about 90 mm by 130
  // mm.
  EXPECT_GT(seen, with.width() * with.height() / 25);
}

TEST_F(WindowTest, LeavingTheGatewayEmptiesEveryPage) {
  show_connected();
  ASSERT_TRUE(wait_until([&] { return desk.session.machine().joints_size() > 0; }));
  desk.session.disconnect_from_gateway();
  EXPECT_EQ(window->page(), MainWindow::kConnect);
  for (int page = 0; page < MainWindow::kPages; ++page) {
    window->show_page(static_cast<MainWindow::Page>(page));
    EXPECT_FALSE(window->grab().isNull());
  }
}

/// A job in the window's view of the machine, and what its thread takes for it.
class ShownJob {
 public:
  ShownJob(Desk& desk, SceneView& scene, int lines, const QString& path)
      : desk_(desk), scene_(scene), lines_(lines), path_(path) {
    QFile file(path);
    if (file.open(QIODevice::WriteOnly)) file.write(long_job(lines));
  }

  /// From the file to the first whole picture. False: it does not come.
  bool show() {
    clock_.start();
    const double others_from = others_ms();
    const auto before = desk_.path.scene();
    desk_.path.show_file(path_);
    const auto is_there = [&] { return desk_.path.scene() != nullptr && desk_.path.scene() != before; };
    if (!wait_until(is_there, kPatience_ms)) return false;
    reading_ms = others_ms() - others_from;
    scene_.redraw();  // a short job's picture may have come with the news of it
    const bool shown = wait_until(
        [&, painted = scene_.frames()] {
          return scene_.frames() > painted && !scene_.renderer().copying() &&
                 scene_.renderer().lines_drawn() > 0;
        },
        kPatience_ms);
    first_picture_s = static_cast<double>(clock_.nsecsElapsed()) * 1e-9;
    scene_.fit_part();
    return shown && desk_.path.scene()->path.line_count >= static_cast<std::uint32_t>(lines_);
  }

  /// The view turns, picture by picture: what one takes is measured.
  bool turn() {
    const double thread_from = cpu_ms(CLOCK_THREAD_CPUTIME_ID), all_from = cpu_ms(CLOCK_PROCESS_CPUTIME_ID);
    const std::size_t from = scene_.frames();
    clock_.restart();
    while (scene_.frames() < from + kFrames) {
      scene_.content().camera.orbit(2, 0);
      scene_.redraw();
      if (!wait_until([&, before = scene_.frames()] { return scene_.frames() > before; }, kPatience_ms))
        return false;
    }
    thread_ms = (cpu_ms(CLOCK_THREAD_CPUTIME_ID) - thread_from) / kFrames;
    process_ms = (cpu_ms(CLOCK_PROCESS_CPUTIME_ID) - all_from) / kFrames;
    frames_per_s = kFrames / (static_cast<double>(clock_.nsecsElapsed()) * 1e-9);
    quick_lines = scene_.renderer().lines_drawn();
    return true;
  }

  bool rest() {
    return wait_until([&] { return scene_.at_rest(); }, kPatience_ms);
  }

  int lines() const { return lines_; }

  static constexpr int kPatience_ms = 120'000, kFrames = 60;
  double first_picture_s = 0;  ///< by the clock
  double reading_ms = 0;       ///< processor time of the other threads until all is read
  double frames_per_s = 0, thread_ms = 0, process_ms = 0;
  std::size_t quick_lines = 0;

 private:
  static double others_ms() { return cpu_ms(CLOCK_PROCESS_CPUTIME_ID) - cpu_ms(CLOCK_THREAD_CPUTIME_ID); }

  Desk& desk_;
  SceneView& scene_;
  int lines_;
  QString path_;
  QElapsedTimer clock_;
};

TEST_F(WindowTest, MillionLineJobIsShownWithoutBlockingTheWindow) {
  show_connected();
  window->show_page(MainWindow::kView);
  QTemporaryDir folder;
  SceneView& scene = window->view_page().scene();
  ASSERT_TRUE(scene.error().isEmpty()) << scene.error().toStdString();
  // The machine is there, and the first look at it.
  ASSERT_TRUE(wait_until([&] { return scene.frames() > 3 && scene.content().camera != Camera{}; }));
  ShownJob small(desk, scene, 6'000, folder.filePath(QStringLiteral("short.gcode")));
  ShownJob big(desk, scene, 1'000'000, folder.filePath(QStringLiteral("long.gcode")));
  ASSERT_TRUE(small.show());
  ASSERT_TRUE(small.turn());
  ASSERT_TRUE(small.rest());
  Watchdog watchdog;
  ASSERT_TRUE(big.show());
  ASSERT_TRUE(big.turn());
  watchdog.rest();
  ASSERT_TRUE(big.turn());
  watchdog.go_on();
  ASSERT_TRUE(big.rest());
  for (const ShownJob* job : {&small, &big})
    std::printf(
        "%d lines: %.0f ms of processor time to read, first picture after %.2f s by the clock\n"
        "while turning %.0f frames/s by the clock; a frame of %zu lines takes %.1f ms of the window's "
        "thread, "
        "%.1f ms of all threads\n",
        job->lines(), job->reading_ms, job->first_picture_s, job->frames_per_s, job->quick_lines,
        job->thread_ms, job->process_ms);
  std::printf(
      "%zu lines at rest, peak memory %.0f MB; longest work of the window's thread at once %.1f ms (by the "
      "clock, with all else that runs here, %.1f ms)\n",
      scene.renderer().lines_drawn(), peak_memory_mb(), watchdog.most_cpu_ms, watchdog.most_wall_ms);
  // Whatever the computer: a picture does not cost more for a longer job, beyond the lines that it may have
  // (1.4 to 1.9 times the short job's measured). How many pictures a second that makes is told above.
  EXPECT_LE(big.quick_lines, SceneRenderer::budget_for("llvmpipe").quick_lines);
  EXPECT_LE(big.thread_ms, 3 * small.thread_ms);
  // The job is read elsewhere and drawn in slices: the window is never away for more than a share of what the
  // job takes, which is four passes over its lines: read, put in levels, coloured, copied.
  EXPECT_LE(watchdog.most_cpu_ms, big.reading_ms / 5);
  EXPECT_LE(peak_memory_mb(), 600);
}

TEST(StartUp, RatioToAnEmptyWindowIsReported) {
  const auto first_paint_ms = [](QWidget& shown) {
    shown.show();
    QElapsedTimer clock;
    clock.start();
    shown.grab();
    return static_cast<double>(clock.nsecsElapsed()) * 1e-6;
  };
  QElapsedTimer clock;
  clock.start();
  QMainWindow empty;
  first_paint_ms(empty);
  const double empty_ms = static_cast<double>(clock.nsecsElapsed()) * 1e-6;
  clock.restart();
  Desk desk;
  desk.theme.apply(false);
  desk.language.apply(QStringLiteral("en"));
  MainWindow window(desk);
  first_paint_ms(window);
  const double window_ms = static_cast<double>(clock.nsecsElapsed()) * 1e-6;
  std::printf("window usable after %.0f ms, an empty Qt window after %.0f ms: ratio %.1f\n", window_ms,
              empty_ms, window_ms / empty_ms);
  EXPECT_TRUE(window.isVisible());
}

}  // namespace
}  // namespace kinebus::gui

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  kinebus::gui::SceneView::choose_format();
  QCoreApplication::setApplicationName(QStringLiteral("kinebus-gui-test"));
  QApplication app(argc, argv);
  return RUN_ALL_TESTS();
}
