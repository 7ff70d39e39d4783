#include "tools/card/card.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>

#include "node_firmware/core/node.hpp"
#include "tools/card/card_session.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

// One node, as it comes: nobody has configured it and no gateway speaks. A frame takes 130 us.
class OneCard : public ::testing::Test {
 public:
  OneCard() { node_.emplace(NodeOptions{.identity = {.serial = 77}, .node_id = 5}, now_); }
  Card card(std::uint8_t id = 5) {
    return {{.send = [this](const CanFrame& frame) { node_->on_frame(now_, frame); },
             .receive = [this](LocalTime until) { return receive(until); },
             .now = [this] { return now_; }},
            id};
  }
  std::optional<CanFrame> receive(LocalTime until) {
    for (;; now_ += 1ms) {
      node_->on_time(now_);
      if (each_ms) each_ms();
      if (const auto image = node_->image_to_store(); !image.empty()) {
        flash_.assign(image.begin(), image.end());
        node_->on_image_stored(true);
      }
      if (const auto frame = node_->next_frame()) {
        now_ += 130us;
        return frame;
      }
      if (now_ >= until) return std::nullopt;
    }
  }
  double motor(int axis) { return static_cast<double>(node_->position(now_, axis)) / 4294967296.0; }

  std::function<void()> each_ms;
  LocalTime now_{1s};
  std::optional<LoneNode> node_;
  std::vector<std::uint8_t> flash_;
};

TEST_F(OneCard, ShowsWhatItsSensorsAndSwitchesSay) {
  node_->set_feedback(1, {.supply_mv = 23'900, .temperature_dc = 412, .current_ma = 870});
  node_->on_switch(now_, 2, true);
  now_ += 10ms;
  node_->on_time(now_);
  const Card::State s = card().state();
  EXPECT_EQ(s.name, "Kinebus two-axis node");
  EXPECT_EQ(s.serial, 77u);
  EXPECT_EQ(s.axes[1].measured_ma, 870);
  EXPECT_DOUBLE_EQ(s.axes[1].stage_celsius, 41.2);
  EXPECT_DOUBLE_EQ(s.axes[1].supply_volts, 23.9);
  EXPECT_EQ(s.axes[0].run_ma, 1500);
  EXPECT_EQ(s.axes[0].state, cia402::State::kSwitchOnDisabled);
  EXPECT_FALSE(s.axes[0].position_known);
  EXPECT_EQ(s.inputs[0].function, SwitchFunction::kHomeA);
  EXPECT_FALSE(s.inputs[0].active);
  EXPECT_TRUE(s.inputs[2].active);
  EXPECT_TRUE(s.errors.empty());
}

TEST_F(OneCard, CurrentsCountAtOnceAndAreKeptWhenAsked) {
  card().power(1, true);
  EXPECT_TRUE(node_->drive(1).power);
  card().set_currents(1, 2200, 900);
  EXPECT_EQ(node_->axis_parameter(slot_of_axes(object::kRunCurrent), 1), 2200);
  EXPECT_EQ(node_->axis_parameter(slot_of_axes(object::kHoldCurrent), 1), 900);
  EXPECT_EQ(node_->axis_parameter(slot_of_axes(object::kRunCurrent), 0), 1500) << "the other motor's stay";
  EXPECT_TRUE(node_->drive(1).power) << "under power";
  EXPECT_THROW(card().set_currents(1, std::nullopt, 2300), CardError) << "hold above run";
  EXPECT_THROW(card().set_currents(1, 6000, std::nullopt), CardError) << "more than the board can";
  EXPECT_THROW(card().store(), CardError) << "no memory is written under power";
  EXPECT_TRUE(flash_.empty());
  card().power(1, false);
  card().store();
  LoneNode again({.identity = {.serial = 77}, .node_id = 5}, now_, flash_);
  EXPECT_EQ(again.axis_parameter(slot_of_axes(object::kRunCurrent), 1), 2200);
  EXPECT_FALSE(node_->drive(1).power);
}

TEST_F(OneCard, JogsOneMotorByCountsAndBack) {
  EXPECT_EQ(card().jog(0, 51'200, 51'200), 51'200);
  EXPECT_DOUBLE_EQ(motor(0), 51'200);
  EXPECT_EQ(motor(1), 0);
  EXPECT_TRUE(node_->drive(0).power) << "it holds";
  EXPECT_FALSE(node_->drive(1).power);
  EXPECT_EQ(card().jog(0, -60'000, 100'000), -8'800);
  EXPECT_THROW(card().jog(0, 10, 1e7), CardError) << "faster than 607Fh";
}

TEST_F(OneCard, AJogThatIsInterruptedEndsByItsRampAndDoesNotGoOn) {
  double fastest = 0, before = 0;
  each_ms = [&] {
    fastest = std::max(fastest, std::abs(motor(0) - before));
    before = motor(0);
  };
  const std::int32_t at = card().jog(0, 512'000, 51'200, [&] { return motor(0) > 30'000; });
  EXPECT_GT(at, 30'000);
  EXPECT_LT(at, 60'000);
  EXPECT_LT(fastest, 60) << "counts in a millisecond: no jump";
  const double stands = motor(0);
  for (int i = 0; i < 500; ++i) static_cast<void>(receive(now_ + 1ms));
  EXPECT_EQ(motor(0), stands);
  each_ms = {};
  EXPECT_EQ(card().jog(0, 1000, 51'200), at + 1000) << "and can be moved again";
}

TEST_F(OneCard, AutoTuneIsAskedForAndItsResultRead) {
  int looks = 0;
  each_ms = [&] {
    if (node_->take_tune_request(0)) looks = 1;
    if (looks > 0 && looks < 500) ++looks;
    node_->set_feedback(0, {.tune_state = static_cast<std::uint8_t>(looks == 0 ? 0 : looks < 500 ? 1 : 2)});
    if (looks == 499) node_->set_motor(0, 1250, 2400, 321);
  };
  const Card::Tuned tuned = card().tune(0);
  EXPECT_EQ(tuned.resistance_mohm, 1250);
  EXPECT_EQ(tuned.inductance_uh, 2400);
  EXPECT_EQ(tuned.encoder_offset, 321);
  each_ms = {};
  node_->set_feedback(1, {});
  EXPECT_THROW(card().tune(1), CardError) << "a node without current control never begins";
}

TEST_F(OneCard, AFaultIsToldByNameAndResetWhenItsCauseHasGone) {
  card().power(0, true);
  node_->on_drive_fault(now_, 0, 0x2310);
  const Card::State s = card().state();
  EXPECT_EQ(s.axes[0].state, cia402::State::kFault);
  EXPECT_EQ(s.axes[0].error_code, 0x2310);
  EXPECT_EQ(s.errors.front(), 0x2310);
  try {
    card().power(0, true);
    FAIL() << "the cause is still there";
  } catch (const CardError& error) {
    EXPECT_STREQ(error.what(), "axis A does not switch on: fault, error 2310h");
  }
  node_->on_drive_fault_gone(now_, 0);
  card().power(0, true);
  EXPECT_TRUE(node_->drive(0).power);
}

TEST_F(OneCard, ANodeThatIsNotThereIsNamed) {
  try {
    static_cast<void>(card(9).state());
    FAIL();
  } catch (const CardError& error) {
    EXPECT_STREQ(error.what(), "node 9 does not answer");
  }
}

// Lines that come at their times; the session ends when nothing is left to come.
class OneSession : public OneCard {
 public:
  void at(LocalTime when, const std::string& line) { lines_.emplace_back(now_ + when, line); }
  void run(LocalTime span) {
    const LocalTime end = now_ + span;
    Card one = card(node_id);
    CardSession(one, {.next = [this](LocalTime until) -> std::optional<std::string> {
                        for (;;) {
                          if (!lines_.empty() && now_ >= lines_.front().first) {
                            std::string line = lines_.front().second;
                            lines_.pop_front();
                            return line;
                          }
                          if (now_ >= until) return std::nullopt;
                          static_cast<void>(receive(now_ + 1ms));
                        }
                      },
                      .ended = [this, end] { return now_ >= end; },
                      .tell = [this](const std::string& line) { told.push_back(line); },
                      .now = [this] { return now_; }})
        .run();
  }
  int times(const std::string& words) const {
    return static_cast<int>(std::count_if(told.begin(), told.end(), [&](const std::string& line) {
      return line.find(words) != std::string::npos;
    }));
  }

  std::uint8_t node_id = 5;
  std::vector<std::string> told;

 private:
  std::deque<std::pair<LocalTime, std::string>> lines_;
};

TEST_F(OneSession, TellsTheStateTwiceASecondAndWhatBecomesOfEachLine) {
  at(1s, "current A 1200 600");
  at(2s, "jog A 51200 51200");
  at(2500ms, "current B 900 300");
  run(6s);
  EXPECT_GE(times(R"({"state": {"name": "Kinebus two-axis node", "serial": 77, "motors": [)"), 8);
  EXPECT_EQ(times(R"({"done": "current A"})"), 1);
  EXPECT_GE(times(R"("run_ma": 1200, "hold_ma": 600)"), 1);
  EXPECT_EQ(times(R"({"done": "jog A", "position_counts": 51200, "stopped": false})"), 1);
  EXPECT_EQ(times(R"({"done": "current B"})"), 1) << "what comes while a motor moves waits";
  EXPECT_EQ(motor(0), 51200);
  EXPECT_GE(times(R"("drive": "operation enabled", "has_power": true)"), 1);
}

TEST_F(OneSession, StopEndsAJogByItsRampAndSoDoesTheEndOfTheOtherSide) {
  at(1s, "jog A 5120000 51200");
  at(2s, "stop");
  run(5s);
  EXPECT_EQ(times(R"("stopped": true})"), 1);
  EXPECT_GT(motor(0), 20'000);
  EXPECT_LT(motor(0), 120'000);
  const double there = motor(0);
  at(500ms, "jog A -5120000 51200");
  run(2s);  // and nobody is there any more
  EXPECT_LT(motor(0), there - 10'000);
  EXPECT_GT(motor(0), there - 200'000);
  const double here = motor(0);
  static_cast<void>(receive(now_ + 2s));
  EXPECT_EQ(motor(0), here);
}

TEST_F(OneSession, WhatIsWrongIsRefusedWithWhatWasExpected) {
  const std::pair<const char*, const char*> wrong[] = {
      {"fly A", "fly is no command; expected one of: current A|B RUN_MA HOLD_MA, on A|B"},
      {"current A 1200", "expected: current A|B RUN_MA HOLD_MA"},
      {"current C 1200 600", "motor C; expected A or B"},
      {"current A 1200 6e2", "6e2 is no whole number"},
      {"current A 5001 600", "5001 mA; expected 0 .. 5000"},
      {"current A 500 600", "the hold current, 600 mA, would be above the run current, 500 mA"},
      {"jog A 99999999999999999999 1", "99999999999999999999 is no whole number"},
      {"jog A 512 0", "speed 0 counts/s; expected 1 .. "},
  };
  LocalTime when = 100ms;
  for (const auto& [line, words] : wrong) at(when += 100ms, line);
  run(3s);
  for (const auto& [line, words] : wrong)
    EXPECT_EQ(times(std::string(R"({"refused": ")") + words), 1) << line;
  EXPECT_EQ(times("done"), 0);
}

TEST_F(OneSession, ANodeThatDoesNotAnswerIsToldAndTheSessionGoesOn) {
  node_id = 6;
  run(4s);
  EXPECT_GE(times(R"({"silent": "node 6 does not answer"})"), 2);
}

}  // namespace
}  // namespace kinebus
