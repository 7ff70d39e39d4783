// What the window shows of jobs: findings, layers, what is printed, what may go on.
#include <gtest/gtest.h>

#include <QFile>
#include <QIODevice>
#include <QImage>
#include <QLabel>
#include <QLatin1String>
#include <QPushButton>
#include <QSlider>
#include <QTemporaryDir>
#include <cstdint>
#include <stdexcept>

#include "gui/screenshots/demo_job.hpp"
#include "gui/tests/window_fixture.hpp"
#include "gui/views/jobs_page.hpp"
#include "gui/views/main_window.hpp"
#include "gui/views/view_page.hpp"

namespace kinebus::gui {
namespace {

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

TEST_F(WindowTest, SlidersShowSomeLayersAndTheTopmostMoveByMove) {
  gateway.jobs["part.gcode"] = vase_job(8, 3, 0.25).toStdString();
  show_connected();
  ASSERT_TRUE(wait_until([&] { return desk.jobs.rowCount() == 1; }));
  window->show_page(MainWindow::kJobs);
  window->jobs_page().select(QStringLiteral("part.gcode"));
  window->jobs_page().check();
  ASSERT_TRUE(wait_until([&] { return desk.path.scene() != nullptr; }));
  const ToolPath& path = desk.path.scene()->path;
  ASSERT_GT(path.layers.size(), 5u);
  const auto slider = [&](const char* name) -> QSlider& {
    for (auto* found : window->findChildren<QSlider*>())
      if (found->accessibleName() == QLatin1String(name)) return *found;
    throw std::runtime_error(name);
  };
  QSlider &top = slider("Show the layers up to here"), &bottom = slider("Show the layers from here on"),
          &moves = slider("Show the topmost layer's moves up to here");
  const SceneContent& content = window->view_page().scene().content();
  ASSERT_TRUE(wait_until([&] { return top.isEnabled(); }));
  EXPECT_EQ(content.end_vertex, UINT32_MAX);
  top.setValue(3);
  bottom.setValue(2);
  EXPECT_EQ(content.first_layer, 2u);
  EXPECT_EQ(content.last_layer, 3u);
  EXPECT_EQ(moves.maximum(), static_cast<int>(path.layers[3].last - path.layers[3].first));
  EXPECT_EQ(content.end_vertex, UINT32_MAX);
  moves.setValue(4);
  EXPECT_EQ(content.end_vertex, path.layers[3].first + 4);
  bottom.setValue(4);
  EXPECT_EQ(top.value(), 4) << "the bottom takes the top along";
  EXPECT_EQ(content.end_vertex, UINT32_MAX) << "another layer is whole";
  top.setValue(1);
  EXPECT_EQ(bottom.value(), 1);
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
  // Before a stop is cleared nothing resumes, and the panel says what comes first.
  gateway.allow({});
  gateway.status.set_state(joblink::STATE_STOPPED);
  gateway.send_status();
  const auto says = [&](const QString& text) {
    for (const auto* label : window->findChildren<QLabel*>())
      if (!label->isHidden() && label->text() == text) return true;
    return false;
  };
  EXPECT_TRUE(wait_until([&] {
    return says(QStringLiteral("Interrupted: clear the stop, then resume goes on from its place."));
  }));
  EXPECT_FALSE(enabled(QStringLiteral("Resume")));
  EXPECT_FALSE(says(QStringLiteral("Interrupted: resume goes on from its place.")));
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

TEST_F(WindowTest, WhatAJobHasPrintedStaysOnTheTableUntilItIsTakenOff) {
  gateway.jobs["vase.gcode"] = vase_job(6, 1, 0.7).toStdString();
  show_connected();
  ASSERT_TRUE(wait_until([&] { return desk.jobs.rowCount() == 1; }));
  const SceneContent& shown = window->view_page().scene().content();
  const auto enter = [&](joblink::State state, const char* job, std::uint32_t line) {
    gateway.status.set_state(state);
    gateway.status.set_job(job);
    gateway.status.set_line(line);
    gateway.send_status();
  };
  const auto vertex = [&](std::uint32_t line) {
    return static_cast<std::uint32_t>(desk.path.scene()->path.vertex_at_line(line));
  };
  enter(joblink::STATE_RUNNING, "vase.gcode", 200);
  ASSERT_TRUE(wait_until([&] { return desk.path.scene() != nullptr && shown.done_vertex == vertex(200); }));
  // Cancelled: the rest is not made, and will not be.
  enter(joblink::STATE_CANCELLING, "vase.gcode", 230);
  ASSERT_TRUE(wait_until([&] { return shown.done_vertex == vertex(230); }));
  enter(joblink::STATE_READY, "", 0);
  ASSERT_TRUE(wait_until([&] { return desk.session.status().job().empty(); }));
  EXPECT_EQ(shown.done_vertex, vertex(230));
  // Who homes has taken it off.
  enter(joblink::STATE_HOMING, "", 0);
  ASSERT_TRUE(wait_until([&] { return shown.done_vertex == UINT32_MAX; }));
  // A job that comes to its end is made whole.
  enter(joblink::STATE_RUNNING, "vase.gcode", 300);
  ASSERT_TRUE(wait_until([&] { return shown.done_vertex == vertex(300); }));
  enter(joblink::STATE_READY, "", 0);
  ASSERT_TRUE(wait_until([&] { return shown.done_vertex == UINT32_MAX; }));
}

}  // namespace
}  // namespace kinebus::gui
