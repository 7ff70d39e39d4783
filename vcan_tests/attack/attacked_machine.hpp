#pragma once
// A machine in the midst of a job and another device on its bus that gives it orders: how far the carriages
// are from the path, who is named, and what an operator does until the job is done.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/tests/stranger_rig.hpp"
#include "protocol/bytes.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus {

using namespace std::chrono_literals;

// What corners and quantisation leave between the plan and the carriages, and the 2 us that nodes may differ.
inline constexpr double kOnThePath_um = 5;
// A record that comes before the gateway's own in its place runs until the gateway, which has not sent it,
// has stopped all.
inline constexpr double kForgedRecord_um = 100;
// A drive whose power is switched off on an open bus stands at once; the others stop on the path.
inline constexpr double kDriveOff_um = 300;

/// When the other device gives its orders.
enum class Moment : std::uint8_t {
  kRunning,
  kHeld,   ///< motion waits in the queues
  kReady,  ///< at rest, before the job
};

struct Attacked : StrangerOf<VirtualMachine> {
  explicit Attacked(BusTrust trust) : StrangerOf(with(trust)), kinematics(*make_kinematics(machine)) {
    on_frame = [this](BusTime, const CanFrame& frame) {
      if (frame.id == cob_id::rpdo(3, 2)) record = frame;
      if (frame.id == kRateCobId) rate = frame;
      if (frame.id == kVoucherCobId && !voucher) before_rate = frame;
      if (frame.id == kRateCobId && !voucher) voucher = before_rate;
    };
  }
  static MachineDescription with(BusTrust trust) {
    MachineDescription machine = default_m1();
    machine.bus.trust = trust;
    return machine;
  }
  void sends(std::string_view text) { stranger_sends(text_frame(text)); }
  /// Runs, and looks each millisecond how far a carriage is from the plan at its node's path time.
  void watch(BusTime span) {
    for (const BusTime until = now + span; now < until;) {
      run_for(1ms);
      const auto planned = gateway->planned_pose(nodes.path_time(0, now));
      JointVector wanted{};
      if (!planned || !kinematics->inverse(planned->frame, planned->pose, wanted)) continue;
      const JointVector here = joints();
      for (std::size_t j = 0; j < machine.joints.size(); ++j)
        if (machine.joints[j].homing) off_um = std::max(off_um, 1e3 * std::abs(here[j] - wanted[j]));
    }
  }
  /// The next record that node 2 waits for, but with another acceleration.
  CanFrame next_record() const {
    CanFrame forged{.id = cob_id::rpdo(3, 2), .length = 8};
    const auto sequence = static_cast<std::uint8_t>((record.data[0] + 1) % kSequenceModulus);
    put_u64_le(forged.data,
               encode(Segment{.sequence = sequence, .duration = 200, .acceleration = {40'000, -40'000}}));
    return forged;
  }
  /// Of the record that comes next, a thousand counts off.
  CanFrame wrong_checkpoint() const {
    CanFrame forged{.id = cob_id::rpdo(4, 2), .length = 8};
    const auto sequence = static_cast<std::uint8_t>((record.data[0] + 1) % kSequenceModulus);
    put_u64_le(forged.data, encode(Checkpoint{.sequence = sequence, .position = std::int64_t{1000} << 32}));
    return forged;
  }
  /// What the operator does before the job goes on, or begins.
  std::string take_up(Moment moment) {
    if (moment == Moment::kRunning) return {};
    if (moment == Moment::kHeld) {
      if (gateway->state() == MachineState::kHeld)
        return gateway->carry_out(command::Resume{}) ? "" : "no resume";
      return {};
    }
    std::string how;
    if (gateway->state() != MachineState::kReady) {
      const auto cleared = [&] { return static_cast<bool>(gateway->carry_out(command::Clear{})); };
      if (!run_until(cleared, 5s)) return "no clear";
      const auto at_rest = [&] {
        return gateway->state() == MachineState::kOff || gateway->state() == MachineState::kUnhomed ||
               gateway->state() == MachineState::kReady;
      };
      if (!run_until(at_rest, 5s)) return "no clear";
      how = "clear";
    }
    if (gateway->state() == MachineState::kOff) {
      if (!gateway->carry_out(command::BringUp{})) return "no bring-up";
      const auto up = [&] {
        return gateway->state() == MachineState::kUnhomed || gateway->state() == MachineState::kReady;
      };
      if (!run_until(up, 30s)) return "not up";
      how += ", bring up";
    }
    if (gateway->state() == MachineState::kUnhomed) {
      if (!gateway->carry_out(command::Home{}) || !reach(MachineState::kReady, 120s)) return "no homing";
      how += how.empty() ? "home" : ", home";
    }
    return begin() ? how : "no begin";
  }
  /// Until the job is done: what the operator does for it.
  std::string go_on() {
    std::string how;
    const auto settled = [&] {
      return gateway->state() == MachineState::kStopped || gateway->state() == MachineState::kAlarm ||
             gateway->state() == MachineState::kReady;
    };
    if (!run_until(settled, 120s)) return "does not end";
    if (gateway->state() == MachineState::kReady) return "nothing to do";
    if (!run_until([&] { return static_cast<bool>(gateway->carry_out(command::Clear{})); }, 5s))
      return "no clear";
    how = "clear";
    const auto resumes = [&] { return static_cast<bool>(gateway->carry_out(command::Resume{})); };
    if (!run_until(resumes, 20s)) return how + ", no resume";
    return reach(MachineState::kReady, 180s) ? how + ", resume" : how + ", resume, and not to the end";
  }
  std::string named() const {
    for (const MachineEvent& e : events)
      if (e.kind == MachineEvent::Kind::kAlarm || e.words.find("another device") != std::string::npos)
        return e.words;
    return "-";
  }

  std::unique_ptr<Kinematics> kinematics;
  CanFrame record, rate, before_rate;
  std::optional<CanFrame> voucher;
  double off_um = 0;
};

struct Attack {
  const char* name;
  std::function<void(Attacked&)> make;
  double most_um = kOnThePath_um;
  bool session_goes_on = false;  ///< with a session the job is not even interrupted
  Moment moment = Moment::kRunning;
};

/// Each attack in the midst of a job of its own; prints a row of the table for each.
inline void expect_together(const std::vector<Attack>& attacks, BusTrust trust) {
  const bool session = trust == BusTrust::kSession;
  std::printf("\n### trust = \"%s\"\n\n| attack | off the path | named | then |\n|---|---|---|---|\n",
              session ? "session" : "open");
  for (const Attack& attack : attacks) {
    SCOPED_TRACE(attack.name);
    Attacked rig(trust);
    ASSERT_TRUE(rig.make_ready()) << rig.story();
    if (attack.moment != Moment::kReady) {
      ASSERT_TRUE(rig.begin());
      rig.run_for(300ms);
    }
    if (attack.moment == Moment::kHeld) {
      ASSERT_TRUE(rig.gateway->carry_out(command::Hold{}));
      ASSERT_TRUE(rig.reach(MachineState::kHeld, 5s)) << rig.story();
    }
    rig.events.clear();
    attack.make(rig);
    rig.watch(1500ms);
    const std::string before = rig.take_up(attack.moment);
    rig.watch(1500ms);
    const std::string named = rig.named(), after = rig.go_on();
    const std::string then = before.empty() ? after : before + (after == "nothing to do" ? "" : ", " + after);
    std::printf("| %s | %.1f um | %s | %s |\n", attack.name, rig.off_um, named.c_str(), then.c_str());
    const bool untouched = session && attack.session_goes_on;
    EXPECT_LE(rig.off_um, untouched ? kOnThePath_um : attack.most_um) << rig.story();
    EXPECT_EQ(then.find("no"), then == "nothing to do" ? 0 : std::string::npos) << rig.story();
    EXPECT_TRUE(named != "-" || then == "nothing to do") << rig.story();
    if (!untouched) continue;
    EXPECT_EQ(then, "nothing to do") << rig.story();
  }
}

}  // namespace kinebus
