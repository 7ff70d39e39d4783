// Homing of the whole machine in virtual time from random poses, with a part on the table: where its motors
// truly are, bodies never touch. The same poses by the thousand, without nodes: kinebus plan --home.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/machine_homing.hpp"
#include "gateway/description/machines_folder.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "tools/simulation/simulation.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

MachineDescription m1_with_bodies() {
  MachineDescription machine = default_m1();
  machine.bodies.emplace();
  machine.bodies->table_radius_mm = 100;
  return machine;
}

/// Measures the bodies where the motors truly are.
class Eye {
 public:
  Eye(const Kinematics& kinematics, const bodies::CollisionModel& model, const Pose& pose)
      : kinematics_(kinematics), model_(model), pose_(pose), start_(measure()) {}

  void look(const JointVector& joints) {
    ASSERT_TRUE(kinematics_.forward(Frame::kMachine, joints, pose_));
    const bodies::Clearance now = measure();
    if (now.mm < least_.mm) least_ = now;
    highest_ = std::max(highest_, pose_[kZ]);
    sank_ = std::max(sank_, highest_ - pose_[kZ]);
  }
  double start_mm() const { return start_.mm; }
  double least_mm() const { return least_.mm; }
  std::string words() const { return model_.words(least_); }
  const Pose& pose() const { return pose_; }
  /// How far the tool has come back towards the table's height, mm.
  double sank_mm() const { return sank_; }

 private:
  bodies::Clearance measure() const {
    return model_.clearance(Frame::kMachine, pose_, bodies::Occasion::kHoming)
        .value_or(bodies::Clearance{.mm = -1});
  }
  const Kinematics& kinematics_;
  const bodies::CollisionModel& model_;
  Pose pose_;
  bodies::Clearance start_;
  bodies::Clearance least_{.mm = std::numeric_limits<double>::infinity()};
  double highest_ = -1e9, sank_ = 0;
};

bool reach(Simulation& simulation, MachineState wanted, BusTime within) {
  return simulation.run_until_state([&](MachineState state) { return state == wanted; },
                                    simulation.now() + within);
}

class Carriages {
 public:
  Carriages(const MachineDescription& machine, const JointVector& joints, std::uint64_t seed)
      : machine_(machine) {
    SimulationOptions options;
    options.seed = seed;
    options.sample_period = 5ms;
    auto nodes = virtual_nodes_of(machine, options.clocks, seed);
    for (std::size_t n = 0; n < nodes.size(); ++n)
      for (std::size_t j = 0; j < machine.joints.size(); ++j)
        if (machine.joints[j].homing && machine.joints[j].node_id == machine.nodes[n].id)
          nodes[n].axes[machine.joints[j].axis].start_counts =
              joints[j] * machine.joints[j].drive.counts_per_unit();
    auto made = std::make_unique<VirtualMachine>(nodes, seed);
    nodes_ = made.get();
    simulation_.emplace(machine_, **kinematics_, options, std::move(made));
    simulation_->run_until(1s);
  }
  Simulation& operator*() { return *simulation_; }
  Simulation* operator->() { return &*simulation_; }
  VirtualMachine& nodes() { return *nodes_; }

 private:
  MachineDescription machine_;
  Result<std::unique_ptr<Kinematics>, GeometryError> kinematics_ = make_kinematics(machine_);
  VirtualMachine* nodes_ = nullptr;
  std::optional<Simulation> simulation_;
};

void home_from(const MachineDescription& machine, const HomingStudy& study, const homing::Start& start,
               std::uint64_t seed) {
  Carriages carriages(machine, start.joints, seed);
  Eye eye(*study.machine().mechanism, *start.model, start.pose);
  const double floor_mm = std::min(eye.start_mm(), 0.2) - 0.02;
  carriages->on_sample = [&](const Sample& sample) { eye.look(sample.joints); };
  ASSERT_TRUE(carriages->gateway().carry_out(command::BringUp{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kUnhomed, 10s));
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kReady, 60s))
      << "ends in state " << to_string(carriages->gateway().state());
  EXPECT_GE(eye.least_mm(), floor_mm) << eye.words();
  for (std::size_t j = 0; j < 4; ++j)
    EXPECT_NEAR(carriages->sample().joints[j], machine.joints[j].homing->switch_position, 0.05);
}

TEST(HomingCampaign, NothingTouchesFromRandomPoses) {
  constexpr std::uint64_t kSeed = 7;
  constexpr int kRuns = 32;
  const MachineDescription machine = m1_with_bodies();
  HomingStudy study(machine);
  study.set_part(100, 200);
  homing::Starts starts(study.machine(), kSeed);
  int on_switch = 0;
  for (int run = 0; run < kRuns; ++run) {
    SCOPED_TRACE("start " + std::to_string(run) + " of seed " + std::to_string(kSeed));
    const std::optional<homing::Start> start = starts.next();
    ASSERT_TRUE(start);
    on_switch += start->on_switch ? 1 : 0;
    home_from(machine, study, *start, kSeed + static_cast<std::uint64_t>(run));
  }
  EXPECT_GE(on_switch, 3) << "some carriages stand on their switches from the beginning";
}

// What was printed so far stands right under the nozzle when the nodes' supply comes back.
TEST(HomingCampaign, MovesAwayFromThePartAfterAPowerLossInAPrint) {
  MachineDescription machine = m1_with_bodies();
  HomingStudy study(machine);
  JointVector joints{};
  ASSERT_TRUE(study.kinematics().inverse(Frame::kMachine, study.kinematics().bed_reference(), joints));
  Carriages carriages(machine, joints, 3);
  ASSERT_TRUE(carriages->gateway().carry_out(command::BringUp{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kUnhomed, 10s));
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kReady, 60s));
  const std::string job = "G21 G90\nG1 X30 Y20 Z60 F12000\nG1 X-30 Y20 F600\nG1 X-30 Y-20\n";
  ASSERT_TRUE(carriages->gateway().carry_out(command::Run{std::make_unique<StringSource>(job), "print"}));
  ASSERT_TRUE(reach(*carriages, MachineState::kRunning, 30s));
  // At a layer of 60 mm height, on the slow line.
  Pose pose = study.kinematics().bed_reference();
  for (int n = 0; n < 400; ++n) {
    carriages->run_until(carriages->now() + 100ms);
    ASSERT_TRUE(study.kinematics().forward(Frame::kMachine, carriages->sample().joints, pose));
    if (std::abs(pose[kZ] - 60) < 0.01 && pose[kX] < 10) break;
  }
  ASSERT_NEAR(pose[kZ], 60, 0.01);
  for (int n = 0; n < carriages.nodes().node_count(); ++n)
    carriages.nodes().set_power(n, carriages->now(), false);
  carriages->run_until(carriages->now() + 500ms);
  for (int n = 0; n < carriages.nodes().node_count(); ++n)
    carriages.nodes().set_power(n, carriages->now(), true);
  carriages->run_until(carriages->now() + 2s);
  ASSERT_TRUE(study.kinematics().forward(Frame::kMachine, carriages->sample().joints, pose));
  ASSERT_LT(pose[kZ], 60.5) << "the motors stand where they stopped";
  machine.bodies->part_radius_mm = 50;
  machine.bodies->part_height_mm = pose[kZ] - 0.2;
  const bodies::Model bodies = make_collision_model(machine);
  Eye eye(study.kinematics(), *bodies, pose);
  EXPECT_NEAR(eye.start_mm(), 0.2, 0.01);
  carriages->on_sample = [&](const Sample& sample) { eye.look(sample.joints); };
  EXPECT_TRUE(carriages->gateway().carry_out(command::MotorsOff{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kOff, 10s)) << to_string(carriages->gateway().state());
  ASSERT_TRUE(carriages->gateway().carry_out(command::BringUp{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kUnhomed, 10s));
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kHoming, 10s));
  carriages->run_until(carriages->now() + 1s);
  EXPECT_GT(eye.pose()[kZ], pose[kZ] + 20) << "first of all away from the part";
  EXPECT_LT(eye.sank_mm(), 0.01) << "and never towards it";
  ASSERT_TRUE(reach(*carriages, MachineState::kReady, 60s));
  EXPECT_GE(eye.least_mm(), 0.18) << eye.words();
}

// M4's rails go at different speeds, and a part may stand right beside its tool.
class M4Homing : public ::testing::Test {
 protected:
  void SetUp() override {
    auto machine = load_machine(machines_folder() / "m4.toml");
    ASSERT_TRUE(machine) << to_string(machine.error());
    machine_ = *machine;
    study_.emplace(machine_);
    Pose pose{20, 120, 60, -12 * kRadPerDeg, 0, 0};
    ASSERT_TRUE(study_->kinematics().inverse(Frame::kPart, pose, start_));
  }

  void bring_up(Carriages& carriages) {
    ASSERT_TRUE(carriages->gateway().carry_out(command::BringUp{}));
    ASSERT_TRUE(reach(*carriages, MachineState::kUnhomed, 10s)) << to_string(carriages->gateway().state());
  }

  /// What the nodes tell of their parameters at a bring-up (2116h), by node id.
  std::map<std::uint8_t, std::uint32_t> fingerprints(Carriages& carriages) {
    std::map<std::uint8_t, std::uint32_t> told;
    carriages.nodes().set_arrival_hook([&told](int station, std::vector<VirtualMachine::Arrival>& arrivals) {
      if (station != VirtualMachine::kGatewayStation) return;
      for (const VirtualMachine::Arrival& a : arrivals) {
        const std::uint8_t node = cob_id::node_of(a.frame.id, cob_id::kSdoReply);
        const auto& d = a.frame.data;
        if (node != 0 && d[0] == 0x43 && d[1] == 0x16 && d[2] == 0x21)
          told[node] = d[4] | static_cast<std::uint32_t>(d[5]) << 8 | static_cast<std::uint32_t>(d[6]) << 16 |
                       static_cast<std::uint32_t>(d[7]) << 24;
      }
    });
    EXPECT_TRUE(carriages->gateway().carry_out(command::MotorsOff{}));
    EXPECT_TRUE(reach(*carriages, MachineState::kOff, 10s));
    EXPECT_TRUE(carriages->gateway().carry_out(command::BringUp{}));
    carriages->run_until(carriages->now() + 5s);
    carriages.nodes().set_arrival_hook({});
    return told;
  }
  void expect_their_own_parameters(Carriages& carriages) {
    const auto told = fingerprints(carriages);
    EXPECT_EQ(told.size(), machine_.nodes.size());
    for (const auto& [node, fingerprint] : told)
      EXPECT_EQ(fingerprint, configure_node(machine_, node).fingerprint) << "node " << int{node};
  }

  MachineDescription machine_;
  std::optional<HomingStudy> study_;
  JointVector start_{};
};

TEST_F(M4Homing, RisesStraightUntilTheFirstRailHasCome) {
  Carriages carriages(machine_, start_, 5);
  Pose from = study_->kinematics().bed_reference();
  ASSERT_TRUE(study_->kinematics().forward(Frame::kPart, start_, from));
  Pose pose = from, farthest = from;
  bool come = false;
  carriages->on_sample = [&](const Sample& sample) {
    for (std::size_t rail = 0; rail < 3; ++rail)
      come = come || sample.joints[rail] >= machine_.joints[rail].homing->switch_position;
    ASSERT_TRUE(study_->machine().mechanism->forward(Frame::kPart, sample.joints, pose));
    if (come) return;
    EXPECT_NEAR(pose[kY], from[kY], 0.05) << "at Z " << pose[kZ];
    EXPECT_NEAR(pose[kA], from[kA], 2e-4);
    farthest = pose;
  };
  bring_up(carriages);
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kReady, 90s)) << to_string(carriages->gateway().state());
  EXPECT_GT(farthest[kZ], from[kZ] + 100);
  for (std::size_t rail = 0; rail < 3; ++rail)
    EXPECT_NEAR(carriages->sample().joints[rail], machine_.joints[rail].homing->switch_position, 0.05);
  carriages->on_sample = {};
  expect_their_own_parameters(carriages);
}

TEST_F(M4Homing, ALiftThatIsStoppedLeavesTheNodesTheirOwnSpeeds) {
  Carriages carriages(machine_, start_, 6);
  bring_up(carriages);
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kHoming, 5s));
  carriages->run_until(carriages->now() + 1s);
  ASSERT_TRUE(carriages->gateway().carry_out(command::Stop{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kStopped, 5s));
  ASSERT_TRUE(carriages->gateway().carry_out(command::Clear{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kUnhomed, 5s)) << to_string(carriages->gateway().state());
  expect_their_own_parameters(carriages);
  ASSERT_TRUE(carriages->gateway().carry_out(command::Home{}));
  ASSERT_TRUE(reach(*carriages, MachineState::kReady, 90s)) << to_string(carriages->gateway().state());
}

}  // namespace
}  // namespace kinebus
