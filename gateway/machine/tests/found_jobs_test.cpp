// A job that the gateway before has left: what is shown of it, whether homing may be begun with its part on
// the table, and a text that is not the same any more.

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/tests/hand_rig.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A text that can be read so many times.
class OnceSource final : public ByteSource {
 public:
  OnceSource(std::string text, int rewinds) : text_(std::move(text)), rewinds_(rewinds) {}
  std::size_t read(std::span<char> buffer) override { return text_.read(buffer); }
  bool rewind() override { return rewinds_-- > 0 && text_.rewind(); }

 private:
  StringSource text_;
  int rewinds_;
};

class FoundJobs : public HandRig {
 protected:
  static journal::State left() {
    journal::State state;
    state.take(journal::JobBegin{"part", 5, 1234, {}, {}});
    return state;
  }
  ::testing::AssertionResult takes_up(journal::State state, std::unique_ptr<ByteSource> text = nullptr) {
    if (!text) text = std::make_unique<StringSource>("G1 X1\n");
    if (const auto done = rig.gateway->recover(std::move(state), std::move(text)); !done)
      return ::testing::AssertionFailure() << done.error().words;
    return ::testing::AssertionSuccess();
  }
  ::testing::AssertionResult unhomed() {
    if (!asks(command::BringUp{}) || !rig.reach(MachineState::kUnhomed, 30s))
      return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
  /// Homing spares so much; the part is so high by the journal, or else the tool was found so high.
  std::string home_with(double spared_mm, std::optional<double> printed_mm, std::optional<double> tool_mm) {
    MachineDescription machine = with_devices(default_m1());
    machine.homing.spared_part_mm = spared_mm;
    use(machine);
    journal::State state = left();
    if (printed_mm) state.printed = journal::Printed{*printed_mm};
    if (tool_mm) {
      journal::Progress progress;
      const auto kinematics = std::move(*make_kinematics(machine));
      Pose pose = kinematics->bed_reference();
      pose[kZ] = *tool_mm;
      EXPECT_TRUE(kinematics->inverse(Frame::kPart, pose, progress.joints));
      state.progress = progress;
    }
    EXPECT_TRUE(takes_up(std::move(state)));
    EXPECT_TRUE(asks(command::BringUp{}));
    EXPECT_TRUE(rig.run_until([&] { return state_is_rest(); }, 30s)) << rig.story();
    return why_not(command::Home{});
  }
  bool state_is_rest() const { return state() == MachineState::kUnhomed || state() == MachineState::kReady; }
};

TEST_F(FoundJobs, AreShownAsTheJournalKnowsThem) {
  journal::State state = left();
  state.time = journal::JobTime{.line = 17, .elapsed_s = 40, .done_s = 30, .motion_s = 120};
  state.override_ratio = 0.5;
  ASSERT_TRUE(takes_up(std::move(state)));
  MachineStatus s = status();
  EXPECT_EQ(s.line, 17U);
  EXPECT_NEAR(s.progress, 0.25, 1e-9);
  EXPECT_NEAR(s.remaining_s, 180, 1e-9);
  EXPECT_EQ(s.elapsed_s, 40);
  EXPECT_TRUE(s.interrupted);
  EXPECT_EQ(s.job, "part");
  EXPECT_EQ(told(), "- the job part was interrupted: resume to go on with it, or cancel\n");
  rig.run_for(1s);
  EXPECT_EQ(status().elapsed_s, 40) << "nobody works at it";
  use(rig.machine);
  state = left();
  ASSERT_TRUE(takes_up(std::move(state)));
  s = status();
  EXPECT_EQ(s.line, 0U);
  EXPECT_EQ(s.progress, 0);
  EXPECT_EQ(s.elapsed_s, 0);
  state = left();
  state.time = journal::JobTime{.line = 17, .elapsed_s = 40, .done_s = 130, .motion_s = 120};
  use(rig.machine);
  ASSERT_TRUE(takes_up(std::move(state)));
  EXPECT_EQ(status().progress, 1);
  EXPECT_EQ(status().remaining_s, 0);
}

TEST_F(FoundJobs, HomingIsRefusedWhereThePartIsHigherThanItSpares) {
  EXPECT_EQ(
      home_with(250, 300, {}),
      "the part of the interrupted job is 300 mm high and homing spares 250 mm: cancel the job and take "
      "the part off the table, then home");
  EXPECT_EQ(why_not(command::Resume{}).find("the part of the interrupted job is 300 mm high"), 0U);
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_EQ(why_not(command::Home{}), "") << "it is off the table";
}

TEST_F(FoundJobs, ByAMillimetreAndByTheToolWhereNobodyHasNotedTheHeight) {
  EXPECT_EQ(home_with(40, 41, {}), "");
  EXPECT_EQ(home_with(40, 41.01, {}).find("the part of the interrupted job is 41 mm high"), 0U);
  EXPECT_EQ(home_with(40, 10, 60), "") << "what was noted counts";
  EXPECT_EQ(home_with(40, {}, 60).find("the part of the interrupted job is 60 mm high"), 0U);
  EXPECT_EQ(home_with(40, {}, 40), "");
  EXPECT_EQ(home_with(40, {}, {}), "") << "nothing is known";
  EXPECT_EQ(home_with(0, 300, {}), "") << "homing needs no room";
}

TEST_F(FoundJobs, ATextThatIsNotTheSameDoesNotGoOn) {
  const std::string text = "G1 X20 F1200\nG1 X0\n";
  const std::string other =
      ". the job part is not the text that was interrupted: it does not go on -> run it from its beginning\n"
      "= ready\n";
  journal::State same;
  {
    // What it is by its own beginning.
    use(rig.machine, {.journal = true});
    ASSERT_TRUE(ready());
    ASSERT_TRUE(runs(text));
    ASSERT_TRUE(rig.run_until(
        [&] {
          while (const auto record = rig.gateway->next_journal_record()) same.take(*record);
          return same.job.has_value();
        },
        5s));
  }
  const auto ends = [&](journal::State known, std::unique_ptr<ByteSource> source) {
    rig.gateway->on_bus_failure(rig.now, "gone");
    rig.run_for(1s);
    use(rig.machine);
    EXPECT_TRUE(takes_up(std::move(known), std::move(source)));
    EXPECT_TRUE(asks(command::BringUp{}));
    EXPECT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
    told();
    const std::string why = why_not(command::Resume{});
    if (!why.empty()) return why;
    EXPECT_TRUE(rig.run_until([&] { return state_is_rest() || state() == MachineState::kRunning; }, 5s));
    rig.run_for(50ms);
    return told();
  };
  journal::State longer = same, hashed = same;
  ++longer.job->bytes;
  ++hashed.job->hash;
  EXPECT_EQ(ends(longer, std::make_unique<StringSource>(text)), "= checking the job\n" + other);
  EXPECT_FALSE(status().interrupted);
  EXPECT_EQ(status().job, "");
  EXPECT_EQ(ends(hashed, std::make_unique<StringSource>(text)), "= checking the job\n" + other);
  EXPECT_EQ(ends(same, std::make_unique<OnceSource>(text, 0)), "the interrupted job cannot be read");
  EXPECT_EQ(ends(same, std::make_unique<OnceSource>(text, 1)), "= checking the job\n" + other);
  EXPECT_EQ(ends(same, std::make_unique<OnceSource>(text, 2)).find("= checking the job\n= ready\n"), 0U);
}

TEST_F(FoundJobs, AJobThatCannotBeReadTwiceIsNotBegun) {
  ASSERT_TRUE(ready());
  EXPECT_EQ(why_not(command::Run{std::make_unique<OnceSource>("G1 X20 F1200\n", 0), "part"}),
            "the job cannot be read twice: it is checked before it runs");
  EXPECT_EQ(why_not(command::Run{nullptr, "part"}),
            "the job cannot be read twice: it is checked before it runs");
  ASSERT_TRUE(asks(command::Run{std::make_unique<OnceSource>("G1 X20 F1200\n", 1), "part"}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  EXPECT_EQ(told().find("= checking the job\n. the job was not begun: "), 0U);
  EXPECT_NEAR(x(), 0, 2e-3);
}

}  // namespace
}  // namespace kinebus
