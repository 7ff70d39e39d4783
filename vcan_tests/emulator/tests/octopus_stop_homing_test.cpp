// From the machine file to the rotor: the gateway homes X and Y of a printer at their mechanical stops, on
// the Octopus' real image with models of drivers and motors. Z has its switch.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "gateway/description/machine_rules.hpp"
#include "gateway/description/shipped_machines.hpp"
#include "tools/simulation/simulation.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

/// Other motors than anybody has assumed, and no quiet ones.
constexpr Tmc2209Parameters kMotor{
    .clock_hz = 11.8e6, .torque_nm_per_a = 0.33, .free_load = 352, .full_load = 40, .load_noise = 30};
constexpr SpiDriverParameters kBySpi{
    .clock_hz = 11.7e6, .torque_nm_per_a = 0.33, .free_load = 244, .full_load = 16, .load_noise = 15};

std::unique_ptr<Chip> with_2209(const ElfImage& image, const BoardOptions& options) {
  auto made = std::make_unique<OctopusBoard>(image, options);
  for (const int axis : {0, 1}) made->tmc(axis) = Tmc2209(kMotor);
  return made;
}
std::unique_ptr<Chip> with_5160(const ElfImage& image, const BoardOptions& options) {
  auto made = std::make_unique<OctopusBoard>(image, options);
  for (const int axis : {0, 1}) made->plug(axis, kBySpi);
  return made;
}

MachineDescription printer(std::uint32_t threshold = 80) {
  auto machine = machine_of("cartesian_octopus");
  EXPECT_TRUE(machine) << machine.error();
  for (std::size_t joint : {0u, 1u}) {
    HomingDescription& h = *machine->joints[joint].homing;
    h.method = HomingDescription::kNegativeStop;
    h.fast_per_s = h.slow_per_s = 60;
    h.accel_per_s2 = 1000;
    h.stall_threshold = threshold;
    h.stall_above_per_s = 40;
    h.max_search = 60;
  }
  for (const BrokenRule& rule : broken_rules(*machine)) ADD_FAILURE() << rule.found.english();
  return *machine;
}

/// One board is the nodes of the machine file. Joints' carriages stand where they do; those that find a stop
/// have one instead of a switch.
class OneBoard final : public EmulatedMachine {
 public:
  OneBoard(const ElfImage& image, const std::vector<VirtualNodeOptions>& nodes, BoardMaker make)
      : EmulatedMachine(image, {board_of(nodes, make)}), nodes_(nodes) {
    for (int axis = 0; axis < 2; ++axis) {
      const VirtualAxis& is = nodes[0].axes[static_cast<std::size_t>(axis)];
      DrivenRotor& rotor = octopus().rotor(axis);
      rotor.set_load(0.03);
      rotor.set_end_stop(is.switch_counts - is.start_counts, is.active_above);
      octopus().wire_diag(axis);
    }
  }
  OctopusBoard& octopus() { return board<OctopusBoard>(0); }
  double true_counts(int node, int axis, BusTime at) override {
    return EmulatedMachine::true_counts(0, nodes_[static_cast<std::size_t>(node)].heat ? 0 : 2 * node + axis,
                                        at);
  }
  PathTime path_time(int, BusTime at) override { return EmulatedMachine::path_time(0, at); }
  int node_count() const override { return static_cast<int>(nodes_.size()); }
  heat::HeatPlant* heated(int node) override {
    return nodes_[static_cast<std::size_t>(node)].heat ? &octopus().heated().plant() : nullptr;
  }

 private:
  static EmulatedNodeOptions board_of(const std::vector<VirtualNodeOptions>& nodes, BoardMaker make) {
    EmulatedNodeOptions options;
    options.node_id = nodes[0].node.node_id;
    options.make = make;
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t axis = 0; axis < kAxesPerNode && !nodes[n].heat; ++axis) {
        VirtualAxis& mine = options.board.axes[2 * n + axis];
        mine = nodes[n].axes[axis];
        if (n == 0) mine.switch_input = 0;
        if (mine.switch_input != 0) mine.switch_input += static_cast<int>(2 * n);
      }
    return options;
  }
  std::vector<VirtualNodeOptions> nodes_;
};

struct Bench {
  /// make: nullptr: the program's own virtual nodes.
  explicit Bench(const MachineDescription& description, BoardMaker make = &with_2209) : machine(description) {
    static const ElfImage image = load_elf(KINEBUS_OCTOPUS_IMAGE);
    SimulationOptions options;
    options.sample_period = 20ms;
    options.clocks.offset_max = 20ms;
    auto nodes = virtual_nodes_of(machine, options.clocks, 5);
    // Near their ends: homing takes seconds.
    nodes[0].axes[0].start_counts = nodes[0].axes[0].switch_counts + 31'234;
    nodes[0].axes[1].start_counts = nodes[0].axes[1].switch_counts + 22'222;
    nodes[1].axes[0].start_counts = nodes[1].axes[0].switch_counts - 20'111;
    std::unique_ptr<NodeMachine> made;
    if (make != nullptr) {
      auto board = std::make_unique<OneBoard>(image, nodes, make);
      octopus = &board->octopus();
      made = std::move(board);
    } else {
      made = std::make_unique<VirtualMachine>(nodes, 5);
    }
    simulation.emplace(machine, **kinematics, options, std::move(made));
    simulation->on_event = [this](const MachineEvent& event) {
      if (event.kind == MachineEvent::Kind::kAlarm) alarms += event.words.english() + "\n";
    };
    simulation->run_until(1s);
  }
  bool reach(MachineState wanted, BusTime within) {
    return simulation->run_until_state([&](MachineState state) { return state == wanted; },
                                       simulation->now() + within);
  }
  bool up() {
    EXPECT_TRUE(simulation->gateway().carry_out(command::BringUp{}));
    return reach(MachineState::kUnhomed, 10s);
  }
  bool home() {
    EXPECT_TRUE(simulation->gateway().carry_out(command::Home{}));
    return simulation->run_until_state(
               [](MachineState s) { return s == MachineState::kReady || s == MachineState::kAlarm; },
               simulation->now() + 40s) &&
           simulation->gateway().state() == MachineState::kReady;
  }
  double joint(std::size_t j) { return simulation->sample().joints[j]; }
  /// Nothing steps, drivers keep their power, and no position is known.
  void expect_stands_unhomed() {
    const MachineState state = simulation->gateway().state();
    EXPECT_EQ(state, MachineState::kAlarm) << to_string(state);
    octopus->clear_edges();
    simulation->run_until(simulation->now() + 300ms);
    for (const int axis : {0, 1}) {
      EXPECT_TRUE(octopus->driver(axis).edges().empty());
      EXPECT_TRUE(octopus->driver(axis).enabled());
    }
  }
  MachineDescription machine;
  Result<std::unique_ptr<Kinematics>, GeometryError> kinematics = make_kinematics(machine);
  std::optional<Simulation> simulation;
  OctopusBoard* octopus = nullptr;
  std::string alarms;
};

void expect_homes_at_its_stops(Bench& bench) {
  ASSERT_TRUE(bench.up()) << bench.alarms;
  const double full_step_mm = 0.2, turn_mm = 4 * full_step_mm;
  for (int time = 0; time < 2; ++time) {
    ASSERT_TRUE(bench.home()) << bench.alarms << to_string(bench.simulation->gateway().state());
    for (const std::size_t j : {0u, 1u}) {
      fmt::print("homing {}: joint {} stands at {:.3f} mm\n", time + 1, bench.machine.joints[j].name,
                 bench.joint(j));
      EXPECT_NEAR(bench.joint(j), -110, 0.001) << "at the stop";
    }
    EXPECT_NEAR(bench.joint(2), 210, 0.05);
  }
  // Off the stops the rotors are where the gateway has them, but for where in the load the stop was told.
  ASSERT_TRUE(bench.simulation->gateway().carry_out(
      command::Run{std::make_unique<StringSource>("G21 G90\nG0 X-20 Y-30 Z200\n"), "away"}));
  ASSERT_TRUE(bench.reach(MachineState::kRunning, 20s)) << bench.alarms;
  ASSERT_TRUE(bench.reach(MachineState::kReady, 60s)) << bench.alarms;
  fmt::print("at X -20 Y -30: rotors at {:.3f} and {:.3f}\n", bench.joint(0), bench.joint(1));
  EXPECT_NEAR(bench.joint(0), -20, turn_mm / 2);
  EXPECT_NEAR(bench.joint(1), -30, turn_mm / 2);
  EXPECT_EQ(bench.alarms, "");
}

TEST(OctopusStopHoming, TheGatewayHomesAtStopsAndComesBackToThemAtTheSamePlace) {
  Bench bench(printer());
  expect_homes_at_its_stops(bench);
}

TEST(OctopusStopHoming, WithDriversBySpiToo) {
  MachineDescription machine = printer(150);
  for (const std::size_t joint : {0u, 1u})
    machine.joints[joint].driver = DriverDescription{.sense_resistor_mohm = 75};
  Bench bench(machine, &with_5160);
  expect_homes_at_its_stops(bench);
  for (const int axis : {0, 1}) {
    EXPECT_EQ(bench.octopus->spi_driver(axis).bad_datagrams(), 0u);
    EXPECT_NEAR(bench.octopus->spi_driver(axis).run_amperes(), bench.machine.joints[0].run_current_ma * 1e-3,
                0.03);
  }
}

TEST(OctopusStopHoming, AThresholdThatNeverTellsEndsInWordsAndIsNoPosition) {
  Bench bench(printer(1));
  ASSERT_TRUE(bench.up()) << bench.alarms;
  EXPECT_FALSE(bench.home());
  EXPECT_NE(bench.alarms.find("came to no stop by its driver's load; stall_threshold is too low"),
            std::string::npos)
      << bench.alarms;
  bench.expect_stands_unhomed();
}

TEST(OctopusStopHoming, AThresholdThatTellsAtOnceEndsInWordsAndIsNoPosition) {
  Bench bench(printer(250));
  ASSERT_TRUE(bench.up()) << bench.alarms;
  EXPECT_FALSE(bench.home());
  EXPECT_NE(bench.alarms.find("told a stop where there is none"), std::string::npos) << bench.alarms;
  EXPECT_NE(bench.alarms.find("stall_threshold is too high"), std::string::npos) << bench.alarms;
  bench.expect_stands_unhomed();
  EXPECT_GT(bench.joint(0), -109) << "it has not come to its stop";
}

// Nodes without such drivers, as the program's own virtual ones are, say so before anything moves.
TEST(OctopusStopHoming, NodesWithoutSuchDriversAreRefusedAtBringUp) {
  Bench bench(printer(), nullptr);
  EXPECT_FALSE(bench.up());
  EXPECT_NE(bench.alarms.find("X is to home by its driver's load, and node 1 has no driver there"),
            std::string::npos)
      << bench.alarms;
}

}  // namespace
}  // namespace kinebus::emulator
