// The owner chooses how much is planned in one turn: with fewer lines there are more turns, not less
// planning.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {
namespace {

struct Turns {
  int checking = 0;
  double checked_s = 0, begun_s = 0, done_s = 0;
};

Turns turns_of(int planning_budget) {
  MachineRig rig;
  Gateway::Options options{.planning_budget = planning_budget};
  options.bus_secret = {.low = 1, .high = 1};
  rig.gateway = std::make_unique<Gateway>(rig.machine, options);
  EXPECT_TRUE(rig.make_ready()) << rig.story();
  std::string text;
  for (int i = 0; i < 4000; ++i) text += i % 2 == 0 ? "G1 X0.2 F6000\n" : "G1 X0\n";
  const BusTime asked = rig.now;
  EXPECT_TRUE(rig.gateway->carry_out(command::Run{std::make_unique<StringSource>(text), "lines"}));
  Turns turns;
  const auto since = [&] { return to_seconds(rig.now - asked); };
  EXPECT_TRUE(
      rig.run_until([&] { return ++turns.checking, rig.gateway->state() == MachineState::kRunning; }, 60s));
  turns.checked_s = since();
  EXPECT_TRUE(rig.run_until([&] { return rig.gateway->status().progress > 0; }, 60s)) << rig.story();
  turns.begun_s = since();
  EXPECT_TRUE(rig.reach(MachineState::kReady, 600s)) << rig.story();
  turns.done_s = since();
  return turns;
}

TEST(PlanningPieces, SmallOnesTakeMoreTurnsAndNotMoreTime) {
  const Turns large = turns_of(400), small = turns_of(50);
  EXPECT_GE(large.checking, 4000 / 400);
  EXPECT_GE(small.checking, 4000 / 50);
  EXPECT_LE(small.checked_s, 1.1 * large.checked_s + 0.002);
  EXPECT_LE(small.begun_s, large.begun_s + 0.02);
  EXPECT_LE(small.done_s, large.done_s + 0.02);
}

}  // namespace
}  // namespace kinebus
