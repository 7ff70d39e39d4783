// The job as a whole: what its check tells, what text it is, and its time.

#include "gateway/machine/print_job.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class PrintJobTest : public ::testing::Test {
 protected:
  void check(std::string text, int budget = 1000) {
    print.begin_check(std::make_unique<StringSource>(std::move(text)), {}, {});
    for (turns = 1; !print.check(5s, budget); ++turns) ASSERT_LT(turns, 10000);
  }
  std::string told() {
    std::string text;
    while (const auto event = events.pop()) {
      EXPECT_EQ(event->kind, MachineEvent::Kind::kProblem);
      EXPECT_EQ(event->when, 5s);
      text += std::to_string(event->line) + " " + event->words.english().substr(0, 5) + "\n";
    }
    return text;
  }

  int turns = 0;
  MachineDescription machine = default_m1();
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));
  std::vector<NodeAxes> axes = node_axes(machine);
  StreamGroup group{*kinematics, axes, stream_options(machine)};
  PathRate rate;
  Devices devices;
  Heat heat{machine, devices};
  EventQueue events;
  journal::Queue journal;
  PrintJob print{machine, *kinematics, group, rate, heat, events, journal, nullptr};
};

TEST_F(PrintJobTest, EachProblemIsToldOnceWithItsLine) {
  check("G1 X10 F1200\nG1 X900\nG1 X5\nG1 X10\nG1 X-900\n", 1);
  EXPECT_GT(turns, 1);
  EXPECT_EQ(print.errors(), 2U);
  EXPECT_EQ(told(), "2 error\n5 error\n");
  check("G1 X900 F1200\n");
  EXPECT_EQ(told(), "1 error\n") << "the next check tells its own";
  EXPECT_EQ(print.errors(), 1U);
  check("M112\n");
  EXPECT_EQ(told(), "1 warni\n");
  EXPECT_EQ(print.errors(), 0U);
  check("G1 X10 F1200\n");
  EXPECT_EQ(print.errors(), 0U);
  EXPECT_NEAR(print.report().motion_s, 0.5, 0.2);
  print.forget_report();
  EXPECT_EQ(print.report().motion_s, 0);
}

TEST_F(PrintJobTest, ATextIsTheSameByItsLengthAndWhatIsInIt) {
  check("G1 X10 F1200\n");
  print.rename("part");
  const journal::JobBegin begun = print.record({1, 2, 3, 4, 5, 6});
  EXPECT_EQ(begun.name, "part");
  EXPECT_EQ(begun.bytes, 13U);
  EXPECT_EQ(begun.start, (Pose{1, 2, 3, 4, 5, 6}));
  EXPECT_TRUE(print.is_the_text_of(begun));
  journal::JobBegin longer = begun, other = begun;
  ++longer.bytes;
  ++other.hash;
  EXPECT_FALSE(print.is_the_text_of(longer));
  EXPECT_FALSE(print.is_the_text_of(other));
  check("G1 X11 F1200\n");
  EXPECT_FALSE(print.is_the_text_of(begun));
}

TEST_F(PrintJobTest, GrowthIsNotedByMillimetres) {
  EXPECT_TRUE(print.growth_is_due(0)) << "nothing was noted of this job";
  EXPECT_FALSE(print.growth_is_due(0.999));
  EXPECT_TRUE(print.growth_is_due(1));
  EXPECT_FALSE(print.growth_is_due(1.999));
  EXPECT_TRUE(print.growth_is_due(7));
  EXPECT_FALSE(print.growth_is_due(7.5));
}

TEST_F(PrintJobTest, ItsPlaceIsNotedInMotionAlone) {
  EXPECT_FALSE(print.progress_is_due(1s, false));
  EXPECT_FALSE(print.progress_is_due(1s, true)) << "between two runs there is none";
}

TEST_F(PrintJobTest, ItsClockGoesOnWithWhatWasBefore) {
  EXPECT_FALSE(print.clock_runs());
  print.stop_clock_at(40);
  EXPECT_EQ(print.elapsed_s(100s), 40);
  print.begin_clock(100s, print.elapsed_s(100s));
  EXPECT_TRUE(print.clock_runs());
  EXPECT_EQ(print.elapsed_s(103s), 43);
  print.begin_clock(200s);
  EXPECT_EQ(print.elapsed_s(203s), 3);
}

}  // namespace
}  // namespace kinebus
