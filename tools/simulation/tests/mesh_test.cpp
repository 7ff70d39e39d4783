// Levelling on the simulated machine, with the plant as judge: the tool's true place by the motors' true
// counts, over the bed that its probe touches.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "gateway/jobs/journal/journal_codec.hpp"
#include "gateway/run/bed_level.hpp"
#include "tools/simulation/tests/simulated_job.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr double kLayer_mm = 0.2;

/// M1 over a bed that is tilted and bent, with a probe on a free input of the node that turns the table.
MachineDescription mesh_machine() {
  MachineDescription machine = default_m1();
  machine.probe.present = true;
  machine.probe.place = {DevicePlace::Where::kNode, machine.nodes.back().id, 5};
  machine.probe.sim_z_mm = 0.15;
  machine.probe.sim_slope = {0.003, -0.002};
  machine.probe.sim_bend_per_m = -0.06;
  machine.nodes.back().inputs[4].function = InputFunction::kProbe;
  machine.mesh.points_x = 5;
  machine.mesh.points_y = 4;
  machine.mesh.x_mm = {-48, 48};
  machine.mesh.y_mm = {-36, 36};
  machine.mesh.lift_mm = 3;
  machine.mesh.depth_mm = 1;
  machine.resume.after_restart = ResumeDescription::Then::kAsk;
  return machine;
}

/// How far the tool is from the bed, less the layer's height: least and greatest.
struct Gap {
  double least_um = std::numeric_limits<double>::max(), most_um = std::numeric_limits<double>::lowest();
  std::uint64_t samples = 0;
  void take(const MachineDescription& machine, const Pose& pose, double z_mm = kLayer_mm) {
    const double um = 1000 * (pose[kZ] - machine.probe.sim_surface_mm(pose[kX], pose[kY]) - z_mm);
    least_um = std::min(least_um, um);
    most_um = std::max(most_um, um);
    ++samples;
  }
};

std::string messages(const SimulationReport& report) {
  std::string all = report.outcome;
  for (const std::string& message : report.messages) all += "\n" + message;
  return all;
}

// Line 1 measures; lines 4 to 9 print.
const std::string kPrint =
    "G29\nG0 X-45 Y-30 Z5\nG1 Z0.2 F1200\n"
    "G1 X45 Y-30 F3000\nG1 X45 Y30\nG1 X-45 Y30\nG1 X-45 Y-30\nG1 X20 Y15\nG2 X20 Y15 I-20 J-15\n"
    "G1 Z5\n";

bool prints(std::uint32_t line) {
  return line >= 5 && line <= 9;
}

TEST(MeshJob, ThePrintKeepsItsDistanceToABentAndTiltedBed) {
  const MachineDescription machine = mesh_machine();
  for (const std::uint64_t seed : {1u, 2u}) {
    Gap gap;
    double lowest_mm = 1e9, highest_mm = -1e9;
    SimulateOptions options;
    options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
      if (!prints(sample.line)) return;
      gap.take(machine, sample.pose);
      lowest_mm = std::min(lowest_mm, sample.pose[kZ]);
      highest_mm = std::max(highest_mm, sample.pose[kZ]);
    };
    const SimulationReport report = simulate_on(machine, kPrint, seed, options);
    ASSERT_TRUE(report.finished) << messages(report);
    fmt::print("seed {}: {} samples {:.2f} to {:.2f} um off {} mm over a bed of {:.3f} mm\n", seed,
               gap.samples, gap.least_um, gap.most_um, kLayer_mm, highest_mm - lowest_mm);
    EXPECT_GT(gap.samples, 1000u);
    EXPECT_GT(highest_mm - lowest_mm, 0.25);
    // Contact within 2 um, and what a spline through five points leaves of a bowl near its border.
    EXPECT_GE(gap.least_um, -6.0);
    EXPECT_LE(gap.most_um, 6.0);
    EXPECT_LE(report.max_joint_velocity_ratio, 1.0);
    EXPECT_LE(report.max_joint_acceleration_ratio, 1.0);
    EXPECT_LE(report.max_velocity_step_ratio, 1.0);
  }
}

TEST(MeshJob, FadesWithTheHeightAndTheTableMayTilt) {
  const MachineDescription machine = mesh_machine();
  // High above, the bed's shape is gone; with the table turned and tilted the distance is along its normal.
  Gap tilted;
  double off_um = 0;
  SimulateOptions options;
  options.on_sample = [&](const Sample& sample, double, std::uint32_t) {
    if (sample.line == 4) off_um = std::max(off_um, 1000 * std::abs(sample.pose[kZ] - 12));
    if (sample.line == 9) tilted.take(machine, sample.pose);
  };
  const SimulationReport report = simulate_on(machine,
                                              "G29\nG0 X-45 Y-30 Z12\nG4 P50\nG1 X45 Y30 F3000\n"
                                              "G43.4\nG1 X20 Y10 Z20 A12 C35 F3000\nG1 Z0.2\nG4 P50\n"
                                              "G1 X-20 Y-15 F1800\nG1 Z20\n",
                                              1, options);
  ASSERT_TRUE(report.finished) << messages(report);
  fmt::print("12 mm above: {:.2f} um; tilted: {:.2f} to {:.2f} um\n", off_um, tilted.least_um,
             tilted.most_um);
  EXPECT_LE(off_um, 2.0);
  EXPECT_GT(tilted.samples, 300u);
  EXPECT_GE(tilted.least_um, -6.0);
  EXPECT_LE(tilted.most_um, 6.0);
}

TEST(MeshJob, ABedThatIsBentTooFarIsRefusedWithItsNumbers) {
  MachineDescription machine = mesh_machine();
  machine.mesh.limit_mm = 0.2;
  const SimulationReport report = simulate_on(machine, kPrint);
  EXPECT_FALSE(report.finished);
  const std::string told = messages(report);
  EXPECT_NE(told.find("mm from the table of the machine file; mesh.limit_mm allows 0.200 mm"),
            std::string::npos)
      << told;
}

/// A machine that is homed, with a gateway that keeps a journal.
class Levelled : public ::testing::Test {
 protected:
  Levelled() : machine_(mesh_machine()), kinematics_(std::move(*make_kinematics(machine_))) {
    SimulationOptions options;
    options.seed = 4;
    options.journal = true;
    simulation_.emplace(machine_, *kinematics_, options);
    simulation_->on_event = [this](const MachineEvent& event) { told_ += event.words.english() + "\n"; };
  }
  bool until(MachineState wanted) {
    return simulation_->run_until_state([&](MachineState s) { return s == wanted; }, 10min);
  }
  Gateway& gateway() { return simulation_->gateway(); }
  void home() {
    simulation_->run_until(simulation_->now() + 1s);
    ASSERT_TRUE(gateway().carry_out(command::BringUp{}));
    ASSERT_TRUE(until(MachineState::kUnhomed));
    ASSERT_TRUE(gateway().carry_out(command::Home{}));
    ASSERT_TRUE(until(MachineState::kReady)) << told_;
    ASSERT_TRUE(gateway().carry_out(command::GoToReference{}));
    ASSERT_TRUE(until(MachineState::kReady)) << told_;
  }
  void line(const char* text) {
    while (gateway().lines_open() && gateway().line_room() == 0)
      simulation_->run_until(simulation_->now() + 10ms);
    const auto taken = gateway().take_line(text, ++number_);
    EXPECT_TRUE(taken) << text << ": " << taken.error().words;
  }
  void finish_lines() {
    while (gateway().state() == MachineState::kRunning && !gateway().lines_idle())
      simulation_->run_until(simulation_->now() + 10ms);
    gateway().close_lines();
    ASSERT_TRUE(until(MachineState::kReady)) << told_;
  }
  Pose place() {
    Sample sample = simulation_->sample();
    simulation_->locate(sample);
    return sample.pose;
  }
  double gap_um(double z_mm) {
    Gap gap;
    gap.take(machine_, place(), z_mm);
    return gap.most_um;
  }

  MachineDescription machine_;
  std::unique_ptr<Kinematics> kinematics_;
  std::optional<Simulation> simulation_;
  std::string told_;
  std::uint32_t number_ = 0;
};

TEST_F(Levelled, LinesMeasureUseAndPutAwayTheMeshAndItOutlivesTheGateway) {
  ASSERT_NO_FATAL_FAILURE(home());
  ASSERT_TRUE(gateway().carry_out(command::OpenLines{"console"}));
  line("G29");
  line("G1 X30 Y-20 Z0.5 F1200");
  ASSERT_NO_FATAL_FAILURE(finish_lines());
  EXPECT_LE(std::abs(gap_um(0.5)), 6.0) << told_;
  const Pose stands = place();
  line("M420 S0");  // nothing moves: the same place has another name
  EXPECT_NEAR(place()[kZ], stands[kZ], 1e-6);
  EXPECT_EQ(gateway().bed().in_force(), nullptr);
  ASSERT_TRUE(gateway().carry_out(command::OpenLines{"console"}));
  line("G1 Z0.7 F600");
  ASSERT_NO_FATAL_FAILURE(finish_lines());
  EXPECT_NEAR(place()[kZ], 0.7, 3e-3);
  line("M420 S1");
  ASSERT_TRUE(gateway().carry_out(command::OpenLines{"console"}));
  line("G1 X-30 Y22 Z0.3 F1200");
  line("M420 Z0");
  line("G91");
  line("G1 Z30 F1200");
  line("G90");
  ASSERT_NO_FATAL_FAILURE(finish_lines());
  EXPECT_LE(std::abs(gap_um(30.3)), 6.0) << told_;
  simulation_->kill_gateway();
  simulation_->run_until(simulation_->now() + 3s);
  ASSERT_TRUE(simulation_->start_gateway());
  ASSERT_NE(gateway().bed().in_force(), nullptr);
  EXPECT_EQ(gateway().bed().in_force()->fade_mm, 0);
  EXPECT_EQ(gateway().bed().kept().size(), 1u);
  EXPECT_EQ(gateway().bed().name(), "default");
}

TEST_F(Levelled, AJobThatHasProbedGoesOnAfterAnotherGatewayHasReadItAgain) {
  ASSERT_NO_FATAL_FAILURE(home());
  // It probes once more by hand, and prints on what it has found: lines 6 to 10.
  const std::string job =
      "G29\nG0 X10 Y5 Z4\nG38.2 Z-1 F480\n#1=#5063\nG0 Z[#1 + 4]\n"
      "G1 X-45 Y-30 Z[#1 - #5063 + 0.2] F1200\nG1 X45 F600\nG1 Y30\nG1 X-45\nG1 Y-30\nG1 Z5\n";
  simulation_->in_job = true;
  for (const std::uint32_t killed_at : {1u, 3u, 8u}) {
    Gap gap;
    simulation_->on_sample = [&](const Sample& taken) {
      Sample sample = taken;
      if (sample.line < 7 || sample.line > 10) return;
      simulation_->locate(sample);
      gap.take(machine_, sample.pose);
    };
    ASSERT_TRUE(gateway().carry_out(command::Run{std::make_unique<StringSource>(job), "levelled"}));
    const auto at = [&] { return gateway().status().line; };
    const BusTime latest = simulation_->now() + 10min;
    while ((gateway().state() != MachineState::kRunning || at() != killed_at) && simulation_->now() < latest)
      simulation_->run_until(simulation_->now() + 10ms);
    simulation_->run_until(simulation_->now() + (killed_at == 1 ? 9s : 300ms));
    ASSERT_EQ(at(), killed_at) << told_;
    simulation_->kill_gateway();
    simulation_->run_until(simulation_->now() + 3s);
    ASSERT_TRUE(simulation_->start_gateway(std::make_unique<StringSource>(job)));
    told_.clear();
    simulation_->run_until(simulation_->now() + 200ms);
    ASSERT_TRUE(gateway().carry_out(command::Resume{}));
    ASSERT_TRUE(until(MachineState::kRunning)) << told_;
    const auto over = [&](MachineState s) {
      return (s == MachineState::kReady && told_.find("job done") != std::string::npos) ||
             s == MachineState::kAlarm;
    };
    ASSERT_TRUE(simulation_->run_until_state(over, 10min)) << told_;
    ASSERT_EQ(gateway().state(), MachineState::kReady) << told_;
    fmt::print("killed in line {}: {} samples, {:.2f} to {:.2f} um off {} mm\n", killed_at, gap.samples,
               gap.least_um, gap.most_um, kLayer_mm);
    EXPECT_GT(gap.samples, 1000u);
    EXPECT_GE(gap.least_um, -6.0) << told_;
    EXPECT_LE(gap.most_um, 6.0) << told_;
  }
}

TEST(MeshKept, AMeshOfAnotherGeometryIsNotUsed) {
  const MachineDescription machine = default_m1();
  MachineDescription moved = machine, faster = machine;
  std::get<M1Geometry>(moved.kinematics).legs[0].length_mm += 0.5;
  faster.joints[0].speed_per_s *= 0.5;
  EXPECT_EQ(geometry_mark(machine), geometry_mark(faster));
  journal::State state;
  state.take(journal::Mesh{identity(machine),
                           geometry_mark(machine),
                           "default",
                           1e9,
                           {{2, 2}, {-50, -50}, {50, 50}, 10, {0, 0.1F, 0.2F, 0.3F}}});
  state.take(journal::MeshInForce{identity(machine), "default"});
  // And what a job had found out: as it comes back from the file, cut at any byte.
  journal::State found = state;
  found.take(journal::JobBegin{.name = "part", .bytes = 3, .hash = 4, .start = {1, 2, 3, 0, 0, 0}});
  found.take(journal::Learned{.what = journal::Learned::What::kBeginning, .mesh = state.meshes[0].grid});
  found.take(journal::RunBegin{PathTime{100}, {2, 0.5}, 0.01, 0.25});
  found.take(journal::Learned{.what = journal::Learned::What::kProbed,
                              .phases = 7,
                              .contact = true,
                              .frame = Frame::kMachine,
                              .at = {1, 2, 0.3, 0, 0, 5},
                              .stand = {1, 2, 0.2, 0, 0, 5}});
  EXPECT_FALSE(found.run);
  ASSERT_TRUE(found.interrupted);
  EXPECT_EQ(found.interrupted->place.phase, 7u);
  EXPECT_EQ(found.interrupted->extruder_shift_mm, 0.25);
  std::vector<std::uint8_t> bytes;
  std::uint32_t number = 0;
  for (const journal::Record& record : found.records()) journal::encode(record, number++, bytes);
  EXPECT_EQ(journal::decode(bytes).state, found);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 7) {
    const auto part = journal::decode(std::span(bytes).first(cut));
    EXPECT_LE(part.state.learned.size(), 2u);
    EXPECT_LT(part.records, number);
  }
  for (const MachineDescription* description :
       std::initializer_list<const MachineDescription*>{&machine, &moved, &faster}) {
    Gateway gateway(*description);
    ASSERT_TRUE(gateway.recover(state, nullptr));
    EXPECT_EQ(gateway.bed().in_force() != nullptr, description != &moved);
    EXPECT_EQ(gateway.bed().kept().size(), 1u);
    std::string told;
    while (auto event = gateway.next_event()) told += event->words.english();
    EXPECT_EQ(told.find("measured with another geometry") != std::string::npos, description == &moved)
        << told;
  }
}

}  // namespace
}  // namespace kinebus
