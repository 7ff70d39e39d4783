// Probing on the simulated machine, with the plant as judge: the tool's true place by the motors' true
// counts, over the plane that its probe touches.

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "tools/simulation/checkers/skew_checker.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kZ_mm = 3, kSlopeX = 0.012, kSlopeY = -0.02;

double plane(double x, double y) {
  return kZ_mm + kSlopeX * x + kSlopeY * y;
}

/// M1 with a probe on a free input of the node that turns the table, over a tilted plane.
MachineDescription probing_machine(bool active_low = false) {
  MachineDescription machine = default_m1();
  machine.probe.present = true;
  machine.probe.place = {DevicePlace::Where::kNode, machine.nodes.back().id, 5};
  machine.probe.sim_z_mm = kZ_mm;
  machine.probe.sim_slope = {kSlopeX, kSlopeY};
  SwitchInput& input = machine.nodes.back().inputs[4];
  input.function = InputFunction::kProbe;
  input.active_low = active_low;
  return machine;
}

std::string messages(const SimulationReport& report) {
  std::string all = report.outcome;
  for (const std::string& message : report.messages) all += "\n" + message;
  return all;
}

void expect_ended(const SimulationReport& report, const std::string& why) {
  EXPECT_FALSE(report.finished);
  EXPECT_NE(messages(report).find(why), std::string::npos) << messages(report);
  EXPECT_LE(report.max_joint_velocity_ratio, 1.0);
  EXPECT_LE(report.max_velocity_step_ratio, 1.0);
}

struct Place {
  double x, y;
};
constexpr Place kPlaces[] = {{0, 0}, {40, 30}, {-45, 25}, {-30, -50}, {50, -35}};

TEST(ProbingJob, ATiltedPlaneAtFivePlacesIsMeasuredWithinFiveMicrometres) {
  const MachineDescription machine = probing_machine();
  std::string job = "G21 G90\n";
  std::uint32_t line = 1;
  std::map<std::uint32_t, Place> rests;  // by the line that goes to 2 mm above what was measured
  for (const Place& at : kPlaces) {
    job += fmt::format("G0 X{} Y{} Z9\nG38.2 Z1 F600\nG1 Z[#5063 + 2] F600\nG4 P300\nG0 Z9\n", at.x, at.y);
    rests[line + 3] = at;
    line += 5;
  }
  for (const std::uint64_t seed : {1u, 2u}) {
    std::map<std::uint32_t, Pose> found;
    double deepest_mm = 0;
    SimulateOptions options;
    options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
      deepest_mm = std::max(deepest_mm, plane(sample.pose[kX], sample.pose[kY]) - sample.pose[kZ]);
      if (rests.contains(sample.line)) found[sample.line] = sample.pose;
    };
    const SimulationReport report = simulate_on(machine, job, seed, options);
    ASSERT_TRUE(report.finished) << messages(report);
    // Where a move is cut motors come to rest on whole microsteps: as much again as a segment may be off.
    EXPECT_LE(report.max_joint_error_counts, 1.0);
    EXPECT_LE(report.max_joint_acceleration_ratio, 1.0);
    EXPECT_LE(report.max_velocity_step_ratio, 1.0);
    EXPECT_LE(report.max_node_time_skew_us, 2.0);
    ASSERT_EQ(found.size(), std::size(kPlaces));
    for (const auto& [at_line, pose] : found) {
      const double error_um = 1000 * (pose[kZ] - 2 - plane(pose[kX], pose[kY]));
      fmt::print("seed {}: X{:g} Y{:g}: off the plane by {:.2f} um\n", seed, rests[at_line].x,
                 rests[at_line].y, error_um);
      EXPECT_LE(std::abs(error_um), 5.0) << at_line;
      EXPECT_NEAR(pose[kX], rests[at_line].x, 2e-3);
      EXPECT_NEAR(pose[kY], rests[at_line].y, 2e-3);
    }
    fmt::print("seed {}: went on by {:.3f} mm at 10 mm/s, clocks of the nodes within {:.2f} us\n", seed,
               deepest_mm, report.max_node_time_skew_us);
    EXPECT_GT(deepest_mm, 0.0);
    EXPECT_LE(deepest_mm, 0.25);
  }
}

TEST(ProbingJob, AllCarriagesAreTakenAtTheInstantOfTheContact) {
  // The judge is the plant at its own contact: aside, in a direction in which all four carriages move.
  MachineDescription machine = probing_machine(true);
  machine.probe.offset_mm = {20, -10, 1.5};
  double deepest_mm = 0, gap_mm = 1e9;
  Pose rest{};
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    gap_mm = sample.pose[kZ] + 1.5 - plane(sample.pose[kX] + 20, sample.pose[kY] - 10);
    deepest_mm = std::max(deepest_mm, -gap_mm);
    rest = sample.pose;
  };
  const SimulationReport report = simulate_on(
      machine,
      "G0 X-30 Y20 Z9\nG38.2 X10 Y-15 Z-1 F480\nG1 X[#5061 - 20] Y[#5062 + 10] Z[#5063 - 1.5] F60\nG4 P200\n",
      3, options);
  ASSERT_TRUE(report.finished) << messages(report);
  fmt::print("rests where it touched: {:.2f} um from the contact, after {:.3f} mm beyond it\n", 1000 * gap_mm,
             deepest_mm);
  EXPECT_LE(std::abs(gap_mm), 5e-3);
  EXPECT_GT(rest[kX], -28.0);
  EXPECT_LT(rest[kX], 9.0);
}

TEST(ProbingJob, LetsGoAndTellsWhatHasNotBeenFound) {
  // Without contact #5070 is 0 and the job goes on; then down, and up until the probe lets go.
  const MachineDescription machine = probing_machine();
  Pose rest{};
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) { rest = sample.pose; };
  const SimulationReport report = simulate_on(machine,
                                              "G0 X0 Y0 Z9\n"
                                              "G38.3 Z6 F300\n"
                                              "o1 if [#5070 EQ 0]\n"
                                              "  G38.2 Z1 F300\n"
                                              "  G38.4 Z5 F60\n"
                                              "  G1 Z[#5063 + #5070] F300\n"
                                              "o1 endif\nG4 P200\n",
                                              1, options);
  ASSERT_TRUE(report.finished) << messages(report);
  EXPECT_NEAR(rest[kZ], plane(rest[kX], rest[kY]) + 1, 5e-3);
}

TEST(ProbingJob, WhatCannotBeProbedEndsTheJobWithItsReason) {
  const MachineDescription machine = probing_machine();
  expect_ended(simulate_on(machine, "G0 X0 Y0 Z2\nG38.2 Z1 F300\nG0 Z9\n"),
               "the probe touches before its move: nothing has moved");
  expect_ended(simulate_on(machine, "G0 X0 Y0 Z9\nG38.2 Z5 F300\nG0 Z9\n"),
               "the probe has not touched before the end of its move");
  expect_ended(simulate_on(machine, "G0 X0 Y0 Z9\nG38.4 Z12 F300\nG0 Z9\n"),
               "the probe touches nothing, so that it cannot let go: nothing has moved");
  expect_ended(simulate_on(default_m1(), "G0 X0 Y0 Z9\nG38.2 Z5 F300\n"),
               "G38.2 needs a probe: the machine file has no [probe]");
  // What follows from what was measured is checked before it moves.
  expect_ended(simulate_on(machine, "G0 X0 Y0 Z9\nG38.2 Z1 F300\nG0 X[[#5063 - 2] * 5000]\n"), "line 3");
}

/// A machine that is homed and waits for what it is told.
class Probing : public ::testing::Test {
 protected:
  explicit Probing(bool active_low = false)
      : machine_(probing_machine(active_low)), kinematics_(std::move(*make_kinematics(machine_))) {
    SimulationOptions options;
    options.seed = 5;
    simulation_.emplace(machine_, *kinematics_, options);
    simulation_->on_event = [this](const MachineEvent& event) { told_ += event.words.english() + "\n"; };
  }
  bool until(MachineState wanted) {
    return simulation_->run_until_state([&](MachineState s) { return s == wanted; }, 5min);
  }
  Gateway& gateway() { return simulation_->gateway(); }
  void home() {
    simulation_->run_until(1s);
    ASSERT_TRUE(gateway().carry_out(command::BringUp{}));
    ASSERT_TRUE(until(MachineState::kUnhomed));
    ASSERT_TRUE(gateway().carry_out(command::Home{}));
    ASSERT_TRUE(until(MachineState::kReady)) << told_;
    ASSERT_TRUE(gateway().carry_out(command::GoToReference{}));
    ASSERT_TRUE(until(MachineState::kReady)) << told_;
  }
  Pose place() {
    Sample sample = simulation_->sample();
    simulation_->locate(sample);
    return sample.pose;
  }

  MachineDescription machine_;
  std::unique_ptr<Kinematics> kinematics_;
  std::optional<Simulation> simulation_;
  std::string told_;
};

TEST_F(Probing, ALineBehindAProbeWaitsForWhatItMeasures) {
  ASSERT_NO_FATAL_FAILURE(home());
  ASSERT_TRUE(gateway().carry_out(command::OpenLines{"console"}));
  std::uint32_t number = 0;
  const auto line = [&](const char* text) {
    while (gateway().line_room() == 0) simulation_->run_until(simulation_->now() + 10ms);
    const auto taken = gateway().take_line(text, ++number);
    EXPECT_TRUE(taken) << text << ": " << taken.error().words;
  };
  line("G0 X20 Y10 Z9");
  line("G38.2 Z1 F300");
  EXPECT_EQ(gateway().line_room(), 0u);
  line("G1 Z[#5063 + 2 * #5070] F300");
  while (!gateway().lines_idle() && gateway().state() == MachineState::kRunning)
    simulation_->run_until(simulation_->now() + 10ms);
  const Pose pose = place();
  EXPECT_NEAR(pose[kZ], plane(20, 10) + 2, 5e-3) << told_;
}

TEST_F(Probing, AHoldInTheMiddleAndTheNextJobAfterAStop) {
  ASSERT_NO_FATAL_FAILURE(home());
  const auto run = [&] {
    return gateway().carry_out(command::Run{
        std::make_unique<StringSource>("G0 X0 Y0 Z20\nG38.2 Z1 F300\nG1 Z[#5063 + 2] F600\n"), "p"});
  };
  const auto until_low = [&](double z_mm) {
    while (gateway().state() != MachineState::kRunning || gateway().status().line != 2 || place()[kZ] > z_mm)
      simulation_->run_until(simulation_->now() + 5ms);
  };
  ASSERT_TRUE(run());
  until_low(10);
  ASSERT_TRUE(gateway().carry_out(command::Hold{}));
  ASSERT_TRUE(until(MachineState::kHeld));
  simulation_->run_until(simulation_->now() + 1s);
  ASSERT_TRUE(gateway().carry_out(command::Resume{}));
  ASSERT_TRUE(until(MachineState::kReady)) << told_;
  EXPECT_NEAR(place()[kZ], plane(0, 0) + 2, 5e-3) << told_;

  ASSERT_TRUE(run());
  until_low(10);
  ASSERT_TRUE(gateway().carry_out(command::Stop{}));
  ASSERT_TRUE(until(MachineState::kStopped));
  EXPECT_NE(told_.find("the job ends: it was stopped while it probed"), std::string::npos) << told_;
  ASSERT_TRUE(gateway().carry_out(command::Clear{}));
  ASSERT_TRUE(until(MachineState::kReady)) << told_;
  ASSERT_TRUE(run());
  ASSERT_TRUE(until(MachineState::kRunning));
  ASSERT_TRUE(until(MachineState::kReady)) << told_;
  EXPECT_NEAR(place()[kZ], plane(0, 0) + 2, 5e-3) << told_;
}

TEST(ProbingJob, ABrokenWireStopsOnThePathAndALostNodeEndsTheJob) {
  // A probe that opens its contact: the broken wire is a contact in the air, and no carriage jumps.
  for (const bool loses_node : {false, true}) {
    const MachineDescription machine = probing_machine(true);
    auto kinematics = make_kinematics(machine);
    ASSERT_TRUE(kinematics);
    SimulationOptions options;
    options.seed = 5;
    Simulation simulation(machine, **kinematics, options);
    auto& nodes = dynamic_cast<VirtualMachine&>(simulation.machine());
    std::string alarms;
    simulation.on_event = [&](const MachineEvent& event) { alarms += event.words.english() + "\n"; };
    const auto until = [&](MachineState wanted) {
      return simulation.run_until_state([&](MachineState s) { return s == wanted; }, 5min);
    };
    simulation.run_until(1s);
    ASSERT_TRUE(simulation.gateway().carry_out(command::BringUp{}));
    ASSERT_TRUE(until(MachineState::kUnhomed));
    ASSERT_TRUE(simulation.gateway().carry_out(command::Home{}));
    ASSERT_TRUE(until(MachineState::kReady)) << alarms;
    ASSERT_TRUE(simulation.gateway().carry_out(
        command::Run{std::make_unique<StringSource>("G0 X0 Y0 Z30\nG38.2 Z1 F300\nG0 Z40\n"), "probe"}));
    const int node = nodes.node_count() - 1;
    bool broken = false;
    double low_mm = 1e9;
    SkewChecker skew;
    simulation.on_probe = [&](const Probe& probe) {
      if (!broken || !loses_node) skew.on_probe(probe);
    };
    simulation.on_sample = [&](const Sample& taken) {
      Sample sample = taken;
      simulation.locate(sample);
      const bool probes = simulation.gateway().status().line == 2;
      if (probes && !broken && sample.pose[kZ] < 20) {
        broken = true;
        if (loses_node)
          nodes.set_power(node, simulation.now(), false);
        else
          nodes.set_input(node, simulation.now(), 5, false);
      }
      if (broken) low_mm = std::min(low_mm, sample.pose[kZ]);
    };
    simulation.run_until_state(
        [&](MachineState s) { return s == MachineState::kReady || s == MachineState::kAlarm; }, 5min);
    simulation.run_until(simulation.now() + 2s);
    ASSERT_TRUE(broken);
    EXPECT_LE(skew.max_us(), 2.0);
    fmt::print("{}: went on by {:.2f} mm\n", loses_node ? "node lost" : "wire broken", 20 - low_mm);
    if (loses_node) {
      EXPECT_EQ(simulation.gateway().state(), MachineState::kAlarm);
      EXPECT_NE(alarms.find("the job ends: it was stopped while it probed"), std::string::npos) << alarms;
      EXPECT_GT(low_mm, 15.0);
    } else {
      EXPECT_GT(low_mm, 19.7);
      EXPECT_NE(alarms.find("job done"), std::string::npos) << alarms;
    }
  }
}

}  // namespace
}  // namespace kinebus
