#pragma once
// A machine in the midst of a job and another device on its bus; and what an operator does again and again
// after an interruption, on virtual nodes and on the firmware's image alike.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/machine/tests/machine_rig.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/alarm_codes.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {

inline CanFrame text_frame(std::string_view text) {
  const auto frame = parse_frame(text);
  EXPECT_TRUE(frame) << text;
  return frame.value_or(CanFrame{});
}

/// KINEBUS_ROUNDS: as often as wanted by hand.
inline int rounds(int usual) {
  const char* text = std::getenv("KINEBUS_ROUNDS");
  return text != nullptr ? std::atoi(text) : usual;
}

/// So that a long run that is cut short still says how far it came.
inline void tell_rounds(const char* what, int done) {
  if (done % 50 != 0) return;
  std::printf("%s: %d rounds\n", what, done);
  std::fflush(stdout);
}

/// A rig whose job has lines that bend, so that no axis stands at a whole count.
template <typename Machine>
struct StrangerOf : RigOf<Machine> {
  using RigOf<Machine>::RigOf;

  bool begin() {
    using namespace std::chrono_literals;
    return this->gateway->carry_out(command::Run{
               std::make_unique<StringSource>("G1 X60 Y13 F1200\nG1 X7 Y-21\nG1 X55 Y5\nG1 X0 Y0\n"),
               "line"}) &&
           this->run_until(
               [&] {
                 return this->gateway->state() == MachineState::kRunning && this->gateway->status().line >= 1;
               },
               30s);
  }
  bool told_code(std::uint16_t code) const {
    return std::any_of(this->events.begin(), this->events.end(), [&](const MachineEvent& e) {
      return e.kind == MachineEvent::Kind::kAlarm && e.code == code;
    });
  }
  bool says(std::string_view part) const { return this->story().find(part) != std::string::npos; }
  /// Bits that differ from how far anything moves: all carriages stand.
  bool rests() {
    using namespace std::chrono_literals;
    this->run_for(300ms);
    const JointVector still = this->joints();
    this->run_for(300ms);
    return this->joints() == still;
  }
};

template <typename Machine>
void cancel_and_reference(StrangerOf<Machine>& rig, int times) {
  using namespace std::chrono_literals;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  std::mt19937 random(11);
  for (int i = 0; i < times; ++i) {
    ASSERT_TRUE(rig.begin()) << i << rig.story();
    rig.run_for(BusTime{100'000'000 + static_cast<std::int64_t>(random() % 900'000'000)});
    ASSERT_TRUE(rig.gateway->carry_out(command::Cancel{})) << i;
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s)) << i << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::GoToReference{})) << i;
    ASSERT_TRUE(rig.reach(MachineState::kReady, 30s)) << i << rig.story();
    ASSERT_FALSE(rig.told_code(node_emcy::kCheckpoint)) << i << rig.story();
    rig.events.clear();
    tell_rounds("cancel and reference", i + 1);
  }
}

template <typename Machine>
void lose_record_and_resume(StrangerOf<Machine>& rig, int times) {
  using namespace std::chrono_literals;
  ASSERT_TRUE(rig.make_ready()) << rig.story();
  std::mt19937 random(12);
  for (int i = 0; i < times;) {
    rig.lose_from_gateway = {};
    if (rig.gateway->state() == MachineState::kReady) {
      ASSERT_TRUE(rig.begin()) << i << rig.story();
    }
    rig.run_for(BusTime{static_cast<std::int64_t>(random() % 700'000'000)});
    bool lost = false;
    const std::uint8_t node = static_cast<std::uint8_t>(1 + i % 3);
    rig.lose_from_gateway = [&](const CanFrame& frame) {
      return frame.id == cob_id::rpdo(3, node) && !std::exchange(lost, true);
    };
    rig.run_until([&] { return !rig.gateway->may(command::kind<command::Hold>); }, 60s);
    if (rig.gateway->state() == MachineState::kReady) continue;  // the job had ended: nothing was lost
    ASSERT_TRUE(rig.reach(MachineState::kStopped, 10s)) << i << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Clear{})) << i;
    ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << i << rig.story();
    ASSERT_TRUE(rig.gateway->carry_out(command::Resume{})) << i;
    ASSERT_TRUE(rig.reach(MachineState::kRunning, 30s)) << i << rig.story();
    ASSERT_FALSE(rig.told_code(node_emcy::kCheckpoint)) << i << rig.story();
    rig.events.clear();
    tell_rounds("lost record and resume", ++i);
  }
}

}  // namespace kinebus
