// A job that was interrupted, by whatever, ends as if it had not been: the same path, the same filament.

#include <gtest/gtest.h>

#include <cmath>

#include "gateway/machine/tests/resume_rig.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/nmt.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// Distance of `p` from the polyline of `track`, mm.
double distance_from(const std::vector<Pose>& track, const Pose& p) {
  double best = 1e9;
  for (std::size_t i = 0; i + 1 < track.size(); ++i) {
    const Pose &a = track[i], &b = track[i + 1];
    double ab = 0, ap = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      ab += (b[k] - a[k]) * (b[k] - a[k]);
      ap += (b[k] - a[k]) * (p[k] - a[k]);
    }
    const double t = ab > 0 ? std::clamp(ap / ab, 0.0, 1.0) : 0;
    double d = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = a[k] + t * (b[k] - a[k]) - p[k];
      d += x * x;
    }
    best = std::min(best, d);
  }
  return std::sqrt(best);
}

struct Undisturbed {
  std::vector<Pose> track;
  double filament_mm = 0;
};
Undisturbed undisturbed_on(const MachineDescription& machine) {
  Undisturbed made;
  ResumeRig rig(machine);
  EXPECT_TRUE(rig.begin(0)) << rig.story();
  // Slowly, so that corners are seen in all their roundness.
  EXPECT_TRUE(rig.gateway->carry_out(command::SetFeedOverride{0.1}));
  rig.track_ = &made.track;
  EXPECT_TRUE(rig.finish()) << rig.story();
  made.filament_mm = rig.filament_mm;
  return made;
}
const Undisturbed& undisturbed() {
  static const Undisturbed result = undisturbed_on(default_m1());
  return result;
}

void expect_same_part(const ResumeRig& rig, const std::vector<Pose>& track, double path_um = 5,
                      const Undisturbed& clean = undisturbed()) {
  double worst = 0;
  for (std::size_t i = 0; i < track.size(); i += 3)
    worst = std::max(worst, distance_from(clean.track, track[i]));
  EXPECT_LE(worst * 1000, path_um) << rig.story();
  EXPECT_NEAR(rig.filament_mm, clean.filament_mm, 0.01) << rig.story();
}

TEST(Resume, LostRecordGoesOnFromTheExactPlace) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.6)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  bool lost = false;
  rig.lose_from_gateway = [&](const CanFrame& frame) {
    return frame.id == cob_id::rpdo(3, 2) && !std::exchange(lost, true);
  };
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  EXPECT_TRUE(rig.gateway->status().interrupted);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  expect_same_part(rig, track);
}

TEST(Resume, StopByCommandGoesOnFromTheExactPlace) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(1.1)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  ASSERT_TRUE(rig.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 5s));
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  expect_same_part(rig, track);
}

TEST(Resume, SilentNodeGoesOnAfterBringUpWithoutHoming) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.9)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  rig.lose_to_gateway = [](const CanFrame& frame) { return (frame.id & 0x7F) == 2; };
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 10s)) << rig.story();
  rig.lose_to_gateway = {};
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  EXPECT_EQ(rig.story().find("homing"), rig.story().rfind("homing")) << "homed again\n" << rig.story();
  expect_same_part(rig, track);
}

TEST(Resume, CutBusGoesOnThoughTheNodesStoppedElsewhereThanTheGateway) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.9)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  rig.lose_to_gateway = rig.lose_from_gateway = [](const CanFrame&) { return true; };
  ASSERT_TRUE(rig.reach(MachineState::kAlarm, 10s)) << rig.story();
  rig.lose_to_gateway = rig.lose_from_gateway = {};
  rig.run(1s);
  ASSERT_TRUE(rig.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  expect_same_part(rig, track);
}

// Each moment, in seconds into the job, is a test of its own: a sanitizer needs fewer of them.
class InterruptedAt : public testing::TestWithParam<double> {};

TEST_P(InterruptedAt, AnotherGatewayTakesUpTheJobFromTheJournal) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(GetParam())) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  rig.store();
  // The gateway is gone: its frames stop, and nobody hears the nodes.
  rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1200ms);
  rig.lose_from_gateway = rig.lose_to_gateway = {};
  rig.replace_gateway();
  ASSERT_TRUE(rig.job_noted);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  expect_same_part(rig, track);
}

INSTANTIATE_TEST_SUITE_P(Seconds, InterruptedAt, testing::Values(0.02, 0.4, 0.83, 1.3, 1.71, 2.2, 2.9, 3.4));

class ShapedInterruptedAt : public testing::TestWithParam<double> {
 protected:
  static const MachineDescription& shaped() {
    static const MachineDescription machine = [] {
      MachineDescription m = default_m1();
      m.vibration.every = {ShaperKind::kZvd, 40, 0.1};
      return m;
    }();
    return machine;
  }
  static const Undisturbed& clean() {
    static const Undisturbed undisturbed = undisturbed_on(shaped());
    return undisturbed;
  }

  ResumeRig rig_{shaped()};
  std::vector<Pose> track_;
};

TEST_P(ShapedInterruptedAt, StoppedMotionGoesOnFromTheExactPlace) {
  ASSERT_TRUE(rig_.begin(GetParam())) << rig_.story();
  rig_.track_ = &track_;
  ASSERT_TRUE(rig_.gateway->carry_out(command::Stop{}));
  ASSERT_TRUE(rig_.reach(MachineState::kStopped, 5s));
  ASSERT_TRUE(rig_.gateway->carry_out(command::Clear{}));
  ASSERT_TRUE(rig_.reach(MachineState::kHeld, 5s)) << rig_.story();
  ASSERT_TRUE(rig_.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig_.finish()) << rig_.story();
  expect_same_part(rig_, track_, 5, clean());
}

TEST_P(ShapedInterruptedAt, AnotherGatewayGoesOnFromTheExactPlace) {
  ASSERT_TRUE(rig_.begin(GetParam())) << rig_.story();
  rig_.track_ = &track_;
  rig_.store();
  rig_.lose_from_gateway = rig_.lose_to_gateway = [](const CanFrame&) { return true; };
  rig_.run_for(1200ms);
  rig_.lose_from_gateway = rig_.lose_to_gateway = {};
  rig_.replace_gateway();
  ASSERT_TRUE(rig_.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig_.finish()) << rig_.story();
  expect_same_part(rig_, track_, 5, clean());
}

INSTANTIATE_TEST_SUITE_P(Seconds, ShapedInterruptedAt, testing::Values(0.4, 1.1, 2.9));

TEST(Resume, AnotherGatewayKnowsHowFarTheJobIs) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(1.3)) << rig.story();
  rig.watch();
  rig.run(300ms);
  const MachineStatus before = rig.gateway->status();
  rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
  rig.run_for(60s);
  rig.lose_from_gateway = rig.lose_to_gateway = {};
  rig.replace_gateway();
  const auto as_before = [&](const MachineStatus& s, double more_s) {
    EXPECT_EQ(s.line, before.line);
    EXPECT_NEAR(s.progress, before.progress, 0.1);
    EXPECT_NEAR(s.elapsed_s, before.elapsed_s, 0.5 + more_s) << "the time without a gateway does not count";
  };
  as_before(rig.gateway->status(), 0);
  rig.run_for(10s);
  as_before(rig.gateway->status(), 0);
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.run_until(
      [&] {
        rig.watch();
        return rig.gateway->state() == MachineState::kRunning &&
               rig.gateway->status().doing.starts_with("moving");
      },
      60s))
      << rig.story();
  as_before(rig.gateway->status(), 10);
  ASSERT_TRUE(rig.finish()) << rig.story();
}

TEST(Resume, AnotherGatewayGoesOnWithTheWorkOffsetsOfTheJob) {
  ResumeRig rig;
  ASSERT_TRUE(rig.gateway->take_line("G10 L2 P1 X4 Y-3 Z2", 1));
  ASSERT_TRUE(rig.begin(1.3)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  rig.run(300ms);
  rig.store();
  rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1200ms);
  rig.lose_from_gateway = rig.lose_to_gateway = {};
  rig.replace_gateway();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.finish()) << rig.story();
  for (Pose& pose : track) pose = {pose[kX] - 4, pose[kY] + 3, pose[kZ] - 2, 0, 0, pose[kE]};
  expect_same_part(rig, track);
}

TEST(Resume, GatewayAfterGatewayTakesUpTheSameJob) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.1)) << rig.story();
  std::vector<Pose> track;
  rig.track_ = &track;
  for (const auto after : {300ms, 150ms, 700ms, 20ms}) {
    rig.run(after);
    rig.store();
    rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
    rig.run_for(500ms);
    rig.lose_from_gateway = rig.lose_to_gateway = {};
    rig.replace_gateway();
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
    ASSERT_TRUE(rig.run_until(
        [&] {
          rig.watch();
          return rig.gateway->state() == MachineState::kRunning && rig.gateway->status().rate > 0.2;
        },
        30s))
        << rig.story();
  }
  ASSERT_TRUE(rig.finish()) << rig.story();
  expect_same_part(rig, track);
}

TEST(Resume, AnotherJobUnderTheSameNameIsNotTakenUp) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.5));
  rig.store();
  journal::State state;
  state.take(journal::JobBegin{"part", 5, 1234, {}, {}});
  rig.lose_from_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1s);
  rig.lose_from_gateway = {};
  rig.gateway = std::make_unique<Gateway>(rig.machine, Gateway::Options{.epoch = 9});
  ASSERT_TRUE(rig.gateway->recover(state, std::make_unique<StringSource>(kResumeJob)));
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << rig.story();
  rig.run_for(2s);
  EXPECT_EQ(rig.gateway->state(), MachineState::kReady);
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_NE(rig.story().find("is not the text that was interrupted"), std::string::npos) << rig.story();
}

TEST(Resume, CancelGivesTheInterruptedJobUp) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(0.5));
  rig.store();
  rig.lose_from_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1s);
  rig.lose_from_gateway = {};
  rig.replace_gateway();
  EXPECT_TRUE(rig.gateway->status().interrupted);
  EXPECT_TRUE(rig.gateway->carry_out(command::Cancel{}));
  EXPECT_FALSE(rig.gateway->status().interrupted);
  EXPECT_FALSE(rig.gateway->carry_out(command::Resume{}));
  rig.replace_gateway();
  EXPECT_FALSE(rig.job_noted);
}

TEST(Resume, PowerLossHomesAndGoesBackFromAbove) {
  ResumeRig rig;
  ASSERT_TRUE(rig.begin(1.0)) << rig.story();
  rig.store();
  const MachineStatus before = rig.gateway->status();
  // Nodes and gateway lose their power together; the platform stays where it is.
  rig.lose_from_gateway = rig.lose_to_gateway = [](const CanFrame&) { return true; };
  rig.run_for(1s);
  rig.nodes.send(rig.now, nmt_frame(NmtCommand::kResetNode, 0));
  rig.run_for(100ms);
  rig.lose_from_gateway = rig.lose_to_gateway = {};
  rig.replace_gateway();
  ASSERT_TRUE(rig.gateway->carry_out(command::Resume{}));
  ASSERT_TRUE(rig.reach(MachineState::kHoming, 30s)) << rig.story();
  std::vector<Pose> track;
  ASSERT_TRUE(rig.run_until([&] { return rig.story().find("goes on") != std::string::npos; }, 120s))
      << rig.story();
  // What is shown of the filament goes on as the job has it, wherever its motor counts from.
  const MachineStatus back = rig.gateway->status();
  ASSERT_TRUE(before.job_filament_mm && back.job_filament_mm);
  EXPECT_GT(*before.job_filament_mm, 0.5);
  EXPECT_NEAR(*back.job_filament_mm, *before.job_filament_mm, 0.5);
  EXPECT_NEAR(back.machine_pose[kE] - *back.job_filament_mm,
              before.machine_pose[kE] - *before.job_filament_mm, 0.01);
  rig.track_ = &track;
  ASSERT_TRUE(rig.finish()) << rig.story();
  double worst = 0;
  for (const Pose& pose : track) worst = std::max(worst, distance_from(undisturbed().track, pose));
  // Homing finds its zero again within its repeatability.
  EXPECT_LE(worst, 0.02) << rig.story();
}

TEST(Journal, ACutAtAnyByteLeavesAnEarlierState) {
  journal::State state;
  std::vector<std::uint8_t> bytes;
  std::vector<std::size_t> ends{0};
  std::vector<journal::State> states{state};
  journal::Heat heat{.targets = {}, .spindle_rpm = 3000};
  heat.heater({HeaterKind::kHotend, 1}) = 210;
  heat.heater({HeaterKind::kChamber, 0}) = 45;
  heat.fan(2) = 0.25;
  const std::vector<journal::Record> records{
      journal::Epoch{7},
      journal::JobBegin{"a part", 100, 42, {1, 2, 3, 0, 0, 5}, {{{4, 5, 6}}}},
      journal::Override{1.5},
      journal::Scale{{0, 1.5}},
      journal::RunBegin{PathTime{1000}, {0, 0}, 0, 0},
      journal::Progress{PathTime{5000}, 7, {1, 2, 3}},
      journal::WaitsDone{1},
      journal::Thermal{200, 60, 0.5},
      heat,
      journal::JobTime{7, 12.5, 5, 60},
      journal::Printed{3.5},
      journal::Printed{0},
      journal::RunBegin{PathTime{9000}, {12, 0.25}, 0.2, 0.1},
      journal::Found{PathTime{9500}},
      journal::Interrupted{{14, 0.125}, 0.1},
      journal::JobEnd{}};
  for (const journal::Record& record : records) {
    journal::encode(record, static_cast<std::uint32_t>(ends.size() - 1), bytes);
    state.take(record);
    ends.push_back(bytes.size());
    states.push_back(state);
  }
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    const auto decoded = journal::decode(std::span(bytes).first(cut));
    const auto whole =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), cut) - ends.begin() - 1);
    ASSERT_EQ(decoded.records, whole) << "cut at " << cut;
    ASSERT_EQ(decoded.state, states[whole]) << "cut at " << cut;
    if (cut == bytes.size()) continue;
    // And a byte that is not what was written.
    std::vector<std::uint8_t> wrong(bytes);
    wrong[cut] ^= 0x10;
    ASSERT_LE(journal::decode(wrong).records, whole) << "changed at " << cut;
  }
}

TEST(Journal, AGatewayThatKnewOneHotendOneBedAndOneFanIsUnderstood) {
  journal::State state;
  state.take(journal::JobBegin{.name = "a part"});
  state.take(journal::Thermal{200, 60, 0.5, 1000});
  ASSERT_TRUE(state.heat);
  journal::Heat same{.targets = {}, .spindle_rpm = 1000};
  same.heater(kFirstHotend) = 200;
  same.heater(kFirstBed) = 60;
  same.fan(0) = 0.5;
  EXPECT_EQ(*state.heat, same);
  // What is written of it is the record of today.
  journal::State again;
  for (const journal::Record& record : state.records()) again.take(record);
  EXPECT_EQ(again, state);
}

}  // namespace
}  // namespace kinebus
