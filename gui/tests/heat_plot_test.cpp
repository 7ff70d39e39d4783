// Temperatures over time: what is kept of them, however long it takes, and that they are drawn.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QImage>
#include <QPixmap>

#include "gui/models/heat_history.hpp"
#include "gui/tests/window_fixture.hpp"
#include "gui/views/heat_plot.hpp"
#include "gui/views/machine_page.hpp"

namespace kinebus::gui {
namespace {

using Span = HeatHistory::Span;

joblink::Status status_at(double time_s, const char* job = "", double elapsed_s = 0) {
  joblink::Status status;
  status.set_time_s(time_s);
  status.set_job(job);
  status.set_elapsed_s(elapsed_s);
  status.set_state(joblink::STATE_READY);
  for (const char* name : {"hotend", "bed", "chamber"}) {
    auto& heater = *status.add_heaters();
    heater.set_name(name);
    heater.set_actual_celsius(20 + time_s / 100);
    heater.set_target_celsius(210);
    if (heater.name() == "hotend") heater.set_power(0.5);
  }
  auto& fan = *status.add_fans();
  fan.set_name("part");
  fan.set_ratio(0.25);
  return status;
}

TEST(HeatHistory, KeepsAllHeatersTenMinutesAndALongJobWithinItsBounds) {
  Session session;
  HeatHistory history(session);
  constexpr int kJob_s = 10 * 3600;
  for (int i = 0; i < 100; ++i) history.take(status_at(i));
  EXPECT_TRUE(history.samples(Span::kJob).empty());
  for (int i = 0; i < kJob_s; ++i) history.take(status_at(100 + i, "part", i));
  const auto& recent = history.samples(Span::kRecent);
  const auto& job = history.samples(Span::kJob);
  EXPECT_EQ(recent.size(), 601u);
  EXPECT_EQ(recent.back().time_s - recent.front().time_s, HeatHistory::kRecent_s);
  ASSERT_EQ(recent.back().heaters.size(), 3u);
  EXPECT_EQ(recent.back().heaters[0].power, 0.5F);
  EXPECT_LT(recent.back().heaters[2].power, 0) << "its node does not tell";
  EXPECT_EQ(recent.back().fans, std::vector<float>{0.25F});
  EXPECT_LE(job.size(), HeatHistory::kMostOfJob);
  EXPECT_GT(job.size(), HeatHistory::kMostOfJob / 4);
  EXPECT_EQ(job.front().time_s, 100);
  EXPECT_GT(job.back().time_s, kJob_s - 60);

  // When it is over it stays, until the next one begins.
  for (int i = 0; i < 50; ++i) history.take(status_at(100 + kJob_s + i));
  EXPECT_GT(job.size(), 100u);
  history.take(status_at(200 + kJob_s, "part", 0));
  EXPECT_EQ(job.size(), 1u);
}

TEST(HeatHistory, AnotherMachineOrAnotherGatewayBeginsAnew) {
  Session session;
  HeatHistory history(session);
  for (int i = 0; i < 20; ++i) history.take(status_at(i));
  history.take(status_at(5));
  EXPECT_EQ(history.samples(Span::kRecent).size(), 1u);
  joblink::Status other = status_at(7);
  other.mutable_heaters(0)->set_name("hotend2");
  history.take(other);
  EXPECT_EQ(history.samples(Span::kRecent).size(), 1u);
  EXPECT_EQ(history.heaters().front(), "hotend2");
}

/// As a gateway tells what was before: a time each ten seconds.
joblink::HeatCourse course_until(double last_s, const char* job) {
  joblink::HeatCourse course;
  for (const char* name : {"hotend", "bed", "chamber"}) course.add_heaters(name);
  course.add_fans("part");
  course.set_job_name(job);
  course.set_job_elapsed_s(last_s - 100);
  for (auto* samples : {course.mutable_recent(), course.mutable_job()}) {
    samples->set_period_s(10);
    for (double time_s = 100; time_s <= last_s; time_s += 10) {
      samples->add_time_s(time_s);
      for (int heater = 0; heater < 3; ++heater) {
        samples->add_actual_decicelsius(1500 + heater);
        samples->add_target_decicelsius(2000);
        samples->add_power_permille(heater == 2 ? -1 : 400);
      }
      samples->add_fan_permille(300);
    }
  }
  return course;
}

TEST(HeatHistory, WhoComesInMidJobHasTheWholeOfIt) {
  Session session;
  HeatHistory history(session);
  // The first status is here before the answer.
  history.take(status_at(1001, "part", 901));
  history.take(course_until(1000, "part"));
  history.take(status_at(1012, "part", 912));
  const auto& job = history.samples(Span::kJob);
  ASSERT_EQ(job.size(), 93u);
  EXPECT_EQ(job.front().time_s, 100);
  EXPECT_FLOAT_EQ(job.front().heaters[1].celsius, 150.1F);
  EXPECT_FLOAT_EQ(job.front().heaters[0].target, 200);
  EXPECT_FLOAT_EQ(job.front().heaters[0].power, 0.4F);
  EXPECT_LT(job.front().heaters[2].power, 0);
  EXPECT_FLOAT_EQ(job.front().fans[0], 0.3F);
  EXPECT_EQ(job.back().time_s, 1012);
  EXPECT_GT(history.samples(Span::kRecent).size(), 50u);
}

TEST(HeatHistory, WhatTheGatewayHasOfAJobBeforeIsNotMixedWithAnother) {
  Session session;
  HeatHistory history(session);
  history.take(status_at(1001, "next", 0.5));
  history.take(course_until(1000, ""));
  history.take(status_at(1002, "next", 1.5));
  EXPECT_EQ(history.samples(Span::kJob).size(), 1u);
  EXPECT_EQ(history.samples(Span::kJob).front().time_s, 1002);
}

TEST(HeatHistory, ListsThatDoNotFitTogetherAreNotTaken) {
  Session session;
  HeatHistory history(session);
  joblink::HeatCourse broken = course_until(1000, "part");
  broken.mutable_job()->add_power_permille(1);
  broken.mutable_recent()->mutable_fan_permille()->RemoveLast();
  history.take(broken);
  EXPECT_TRUE(history.samples(Span::kJob).empty());
  EXPECT_TRUE(history.samples(Span::kRecent).empty());
}

class HeatPlotTest : public WindowTest {};

TEST_F(HeatPlotTest, AllHeatersAreDrawnInBothSpansAndDirections) {
  show_connected();
  HeatHistory history(desk.session);
  HeatPlot plot(history, desk.theme);
  plot.resize(560, 280);
  const auto colours = [&] {
    const QImage image = plot.grab().toImage();
    const ThemeColours& c = desk.theme.colours();
    int found = 0;
    for (const QColor& of : {c.danger, c.accent, c.good}) {
      bool there = false;
      for (int y = 0; y < image.height() && !there; ++y)
        for (int x = 0; x < image.width() && !there; ++x) there = image.pixelColor(x, y) == of;
      found += there;
    }
    return found;
  };
  EXPECT_EQ(colours(), 0) << "nothing is known yet";
  for (int i = 0; i < 300; ++i) history.take(status_at(i * 2, "part", i * 2));
  EXPECT_EQ(colours(), 3);
  plot.show_span(Span::kJob);
  EXPECT_EQ(colours(), 3);
  plot.setLayoutDirection(Qt::RightToLeft);
  EXPECT_EQ(colours(), 3);
  EXPECT_FALSE(plot.findChild<QComboBox*>()->itemText(1).isEmpty());
}

TEST_F(HeatPlotTest, StandsOnTheMachinePage) {
  show_connected();
  window->show_page(MainWindow::kMachine);
  EXPECT_NE(window->machine_page().findChild<HeatPlot*>(), nullptr);
}

}  // namespace
}  // namespace kinebus::gui
