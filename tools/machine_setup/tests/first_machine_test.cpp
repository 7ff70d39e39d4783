#include "tools/machine_setup/first_machine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/shipped_machines.hpp"
#include "gateway/description/tests/uncommented_keys.hpp"
#include "gateway/jobs/job_plan.hpp"
#include "tools/machine_setup/demo_print.hpp"

namespace kinebus {
namespace {

struct Shipped {
  const char* name;
  FirstMachine first;
};
const Shipped kShipped[] = {
    {"m1_octopus_ebb", {.machine = SetupMachine::kM1, .boards = BoardSet::kOctopusEbb}},
    {"m1_octopus_ebb_heat", {.machine = SetupMachine::kM1, .boards = BoardSet::kOctopusEbbHeat}},
    {"delta_octopus", {.machine = SetupMachine::kDelta}},
    {"corexy_octopus", {.machine = SetupMachine::kCoreXy}},
    {"cartesian_octopus", {.machine = SetupMachine::kCartesian}},
};

constexpr std::string_view kJob =
    "M190 S60\nM109 S210\nM106 S255\nG1 X0 Y0 Z5 F6000\nG1 X30 Y10 E2 F3000\nG1 X-20 Y15 E5\nG2 X0 Y35 I20 "
    "J0 E7\n"
    "G1 X0 Y0 Z8 F6000\nM107\nM104 S0\nM140 S0\n";

std::string problems_of(const MachineDescription& machine, std::string_view text_of_job = kJob) {
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) return "no kinematics";
  StringSource source{std::string(text_of_job)};
  JobPlan job(machine, **kinematics, source);
  while (!job.step(1000)) {
  }
  std::string text;
  for (const Problem& problem : job.problems().all())
    text += fmt::format("line {}: ", problem.line) + problem.words + "\n";
  return text;
}

TEST(FirstMachine, TheShippedFilesAreWhatASetUpWrites) {
  for (const Shipped& each : kShipped) {
    const auto all = shipped_machines();
    const auto file =
        std::find_if(all.begin(), all.end(), [&](const ShippedMachine& m) { return m.name == each.name; });
    ASSERT_NE(file, all.end()) << each.name;
    EXPECT_EQ(file->text, file_text(each.first, make_description(each.first)))
        << "kinebus-setup file writes gateway/description/machines/" << each.name << ".toml";
  }
}

TEST(FirstMachine, EveryMachineOnEverySetLoadsIsTheSameAndPassesAJob) {
  for (std::size_t m = 0; m < setup_machines().size(); ++m)
    for (std::size_t b = 0; b < board_sets().size(); ++b)
      for (const bool probe : {false, true}) {
        const FirstMachine first{
            .machine = static_cast<SetupMachine>(m),
            .boards = static_cast<BoardSet>(b),
            .heat_node = static_cast<BoardSet>(b) == BoardSet::kCards ? std::uint8_t{20} : std::uint8_t{0},
            .probe = probe};
        const MachineDescription d = make_description(first);
        const auto read = parse_machine(file_text(first, d), "written.toml");
        ASSERT_TRUE(read) << d.name << "\n" << to_string(read.error());
        EXPECT_TRUE(*read == d) << d.name;
        EXPECT_EQ(uncommented_keys(file_text(first, d)), "") << d.name;
        EXPECT_EQ(d.heaters.size(), 2u) << d.name;
        for (const HeaterDescription& heater : d.heaters) EXPECT_TRUE(heater.place.on_node()) << d.name;
        EXPECT_EQ(problems_of(d), "") << d.name;
        EXPECT_EQ(problems_of(d, demo_print(d)), "") << d.name;
      }
}

TEST(FirstMachine, ADemoPrintHeatsWhatThereIsAndFeedsNothingWithoutAHotEnd) {
  const MachineDescription hot = make_description({.machine = SetupMachine::kCartesian});
  const std::string print = demo_print(hot);
  for (const char* words : {"M109 S205", "M190 S60", "M106", " E", "M104 S0", "M140 S0"})
    EXPECT_NE(print.find(words), std::string::npos) << words;
  MachineDescription cold =
      make_description({.machine = SetupMachine::kCartesian, .boards = BoardSet::kCards});
  EXPECT_TRUE(cold.heaters.empty());
  const std::string dry = demo_print(cold);
  for (const char* words : {"M104", "M190", "M106", " E"})
    EXPECT_EQ(dry.find(words), std::string::npos) << words;
  EXPECT_EQ(problems_of(cold, dry), "");
  cold = hot;
  for (HeaterDescription& heater : cold.heaters) heater.max_c = 50;
  EXPECT_EQ(demo_print(cold).find("S60"), std::string::npos) << "no hotter than the file allows";
}

TEST(FirstMachine, EachPartIsAtAConnectorOfItsOwn) {
  for (const Shipped& each : kShipped) {
    const BoardPlan plan = plan_of(each.first);
    std::set<std::string> connectors;
    for (const MotorPlace& motor : plan.motors) EXPECT_TRUE(connectors.insert(motor.connector).second);
    EXPECT_EQ(plan.motors.size(), joints_of(each.first.machine));
    // Ids of one board do not reach into those of the next, and heat has ids of its own.
    std::set<int> ids;
    for (const BoardRole& role : plan.roles)
      for (int i = 0; i < role.ids; ++i) EXPECT_TRUE(ids.insert(role.first_id + i).second) << each.name;
    for (const MotorPlace& motor : plan.motors) EXPECT_TRUE(ids.contains(motor.node)) << each.name;
  }
}

}  // namespace
}  // namespace kinebus
