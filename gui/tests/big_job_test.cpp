// A job of a million lines in the window, and how long the window takes to open.
#include <gtest/gtest.h>
#include <time.h>

#include <QByteArray>
#include <QElapsedTimer>
#include <QFile>
#include <QIODevice>
#include <QMainWindow>
#include <QTemporaryDir>
#include <QTimer>
#include <QWidget>
#include <algorithm>

#include "gui/screenshots/demo_job.hpp"
#include "gui/tests/window_fixture.hpp"
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
  // The machine is there, and the first look at it. How many pictures come by themselves until nothing
  // changes any more is chance: some are one.
  ASSERT_TRUE(wait_until([&] {
    if (scene.frames() <= 3) scene.redraw();
    return scene.frames() > 3 && scene.content().camera != Camera{};
  })) << scene.frames();
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
