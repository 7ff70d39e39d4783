#include "tools/simulation/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "gateway/description/machine_file.hpp"
#include "tools/simulation/bus/reordering_nodes.hpp"
#include "tools/simulation/checkers/bus_checker.hpp"
#include "tools/simulation/checkers/jerk_checker.hpp"
#include "tools/simulation/checkers/joint_checker.hpp"
#include "tools/simulation/checkers/path_checker.hpp"
#include "tools/simulation/checkers/queue_checker.hpp"
#include "tools/simulation/checkers/skew_checker.hpp"
#include "tools/simulation/checkers/step_checker.hpp"
#include "tools/simulation/checkers/tracking_checker.hpp"
#include "tools/simulation/checkers/vibration_checker.hpp"
#include "tools/simulation/heat_record.hpp"

namespace kinebus {
namespace {

using std::chrono::hours;
using std::chrono::minutes;

double cpu_now() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The nodes' power comes up before the gateway looks for them.
constexpr BusTime kPowerUp = std::chrono::seconds{1};

bool has_extruder(const MachineDescription& machine) {
  return std::any_of(machine.joints.begin(), machine.joints.end(),
                     [](const JointDescription& joint) { return joint.name == "E"; });
}

/// Nothing goes on by itself any more.
bool settled(MachineState s) {
  return s == MachineState::kOff || s == MachineState::kUnhomed || s == MachineState::kReady ||
         s == MachineState::kAlarm || s == MachineState::kStopped || s == MachineState::kHeld;
}

std::unique_ptr<NodeMachine> make_nodes(const MachineDescription& machine, const SimulateOptions& options) {
  const std::uint64_t seed = options.simulation.seed;
  // Switches stand where the machine really has them, not where its description says.
  const MachineDescription& real = options.simulation.plant ? *options.simulation.plant : machine;
  std::unique_ptr<NodeMachine> nodes;
  if (options.make_nodes)
    nodes = options.make_nodes(virtual_nodes_of(real, options.simulation.clocks, seed));
  else
    nodes = virtual_machine_of(real, options.simulation.clocks, seed);
  if (options.reorder <= 1) return nodes;
  return std::make_unique<ReorderingNodes>(std::move(nodes), options.reorder, seed);
}

/// All checkers together, fed by one simulation.
struct Checkers {
  Checkers(const MachineDescription& machine, const Kinematics& kinematics, Simulation& simulation,
           ByteSource& text, const Pose& start)
      : tracking(machine, kinematics, [&simulation](PathTime tau) { return simulation.planned_pose(tau); }),
        path(machine, kinematics, text, start),
        joints(machine),
        jerk(machine, kinematics, [&simulation](PathTime tau) { return simulation.planned_pose(tau); }) {
    for (const NodeDescription& node : machine.nodes)
      if (!node.functions.has_axes()) queues.leave_out(node.id);
  }
  TrackingChecker tracking;
  PathChecker path;
  JointChecker joints;
  JerkChecker jerk;
  SkewChecker skew;
  BusChecker bus;
  QueueChecker queues;
};

class Run {
 public:
  Run(const MachineDescription& machine, const Kinematics& kinematics, const SimulateOptions& options)
      : machine_(machine),
        kinematics_(kinematics),
        options_(options),
        simulation_(machine, kinematics, options.simulation, make_nodes(machine, options)),
        steps_(machine),
        heat_(machine, simulation_.machine()) {
    simulation_.on_sample = [this](const Sample& sample) { take(sample); };
    simulation_.on_probe = [this](const Probe& probe) {
      if (simulation_.in_job) checkers_->skew.on_probe(probe);
    };
    simulation_.on_event = [this](const MachineEvent& event) { note(event); };
    simulation_.on_frame = [this](BusTime when, const CanFrame& frame) {
      if (options_.on_frame) options_.on_frame(when, frame);
      if (!checkers_) return;
      checkers_->jerk.on_frame(when, frame);
      checkers_->joints.on_frame(frame);
      checkers_->queues.on_frame(frame);
    };
  }

  SimulationReport go(std::unique_ptr<ByteSource> job, ByteSource& same_job) {
    const double began = cpu_now();
    report_.seed = options_.simulation.seed;
    if (prepare()) print(std::move(job), same_job);
    report_.max_velocity_step_ratio = steps_.max_ratio();
    report_.worst_step_s = steps_.worst_time_s();
    report_.worst_step_joint = steps_.worst_joint();
    report_.machine_time_s = to_seconds(simulation_.now());
    report_.cpu_s = cpu_now() - began;
    report_.speedup = report_.cpu_s > 0 ? report_.machine_time_s / report_.cpu_s : 0;
    report_.trace_hash = simulation_.trace_hash();
    return report_;
  }

 private:
  void note(const MachineEvent& event) {
    constexpr std::size_t kMessages = 100;
    if (event.kind == MachineEvent::Kind::kAlarm) {
      report_.trouble = true;
      report_.messages.push_back("ALARM " + event.words + " " + event.advice);
    }
    if (event.kind == MachineEvent::Kind::kProblem) {
      report_.trouble = report_.trouble || event.words.starts_with("error");
      if (report_.messages.size() < kMessages)
        report_.messages.push_back(fmt::format("line {}: {}", event.line, event.words));
    }
  }

  bool fail(std::string words) {
    report_.outcome = std::move(words);
    return false;
  }

  bool prepare() {
    Gateway& gateway = simulation_.gateway();
    simulation_.run_until(kPowerUp);
    return finish("bring-up", gateway.carry_out(command::BringUp{}), MachineState::kUnhomed) &&
           finish("homing", gateway.carry_out(command::Home{}), MachineState::kReady) &&
           finish("the move to the bed reference", gateway.carry_out(command::GoToReference{}),
                  MachineState::kReady);
  }

  /// Waits until a command that was accepted has been carried out.
  bool finish(const char* what, const Result<void, Refusal>& accepted, MachineState goal) {
    if (!accepted) return fail(fmt::format("{} was refused: {}", what, accepted.error().words));
    simulation_.run_until_state(settled, minutes{5});
    const MachineState state = simulation_.gateway().state();
    return state == goal || fail(fmt::format("{} ended in state {}", what, to_string(state)));
  }

  void print(std::unique_ptr<ByteSource> job, ByteSource& same_job) {
    Gateway& gateway = simulation_.gateway();
    const Pose start = gateway.status().machine_pose;
    checkers_ = std::make_unique<Checkers>(machine_, kinematics_, simulation_, same_job, start);
    if (const auto& flexible = options_.flexible)
      vibration_ = std::make_unique<VibrationChecker>(
          machine_, kinematics_, flexible->truth,
          [this](PathTime tau) { return simulation_.planned_pose(tau); }, flexible->text.get(), start);
    if (const auto& nozzle = options_.nozzle)
      bead_ = std::make_unique<BeadMeter>(nozzle->truth, nozzle->reference->lines);
    if (const auto run = gateway.carry_out(command::Run{std::move(job), "job"}); !run) {
      fail("the job was refused: " + run.error().words);
      return;
    }
    const auto started = [](MachineState s) { return s != MachineState::kChecking; };
    simulation_.run_until_state(started, hours{1});
    if (gateway.state() != MachineState::kRunning) {
      fail("the job was not begun");
      return;
    }
    begin_ = simulation_.now();
    simulation_.in_job = true;
    const BusTime limit = options_.limit_s > 0 ? BusTime{static_cast<std::int64_t>(options_.limit_s * 1e9)}
                                               : BusTime{hours{500}};
    const auto over = [&](MachineState s) {
      return settled(s) && !(s == MachineState::kHeld && options_.operate);
    };
    const bool ended = simulation_.run_until_state(over, limit);
    report_.job_time_s = to_seconds(simulation_.now() - begin_);
    report_.finished = ended && gateway.state() == MachineState::kReady && !report_.trouble;
    if (report_.finished)
      report_.outcome = "finished";
    else if (!ended && options_.limit_s > 0)
      report_.outcome = "measured to the limit";
    else
      report_.outcome = fmt::format("ended in state {}", to_string(gateway.state()));
    fill();
  }

  void take(Sample sample) {
    steps_.on_sample(sample);
    if (!checkers_) return;
    checkers_->joints.on_sample(sample);
    checkers_->bus.on_sample(sample, simulation_.machine().bus().statistics());
    if (!sample.in_job) return;
    simulation_.locate(sample);
    checkers_->tracking.on_sample(sample);
    checkers_->jerk.on_sample(sample);
    checkers_->path.on_sample(sample);
    if (vibration_) {
      vibration_->on_sample(sample);
      trace(sample);
    }
    if (bead_)
      bead_->move_to({sample.pose[kX], sample.pose[kY], sample.pose[kZ]}, sample.pose[kE], sample.line,
                     to_seconds(options_.simulation.sample_period));
    if (options_.on_sample)
      options_.on_sample(sample, checkers_->path.last_um(), checkers_->path.nearest_line());
    report_.lines = std::max(report_.lines, sample.line);
    heat_.on_sample(to_seconds(sample.time - begin_), sample, simulation_.gateway());
    if (options_.plot != nullptr) plot(sample);
    if (options_.operate) options_.operate(simulation_.gateway(), to_seconds(sample.time - begin_));
    if (options_.on_progress && ++since_progress_ >= 2000) {
      since_progress_ = 0;
      options_.on_progress(simulation_.gateway().status().progress, to_seconds(sample.time - begin_));
    }
  }

  void trace(const Sample& sample) {
    RingingTrace* const trace = options_.flexible->trace;
    if (trace == nullptr || trace->points.size() >= kMostTraced) return;
    trace->period_s = to_seconds(options_.simulation.sample_period);
    const auto& at = vibration_->frame().rigid_mm();
    const auto& off = vibration_->frame().deflection_mm();
    const auto um = [](double mm) { return static_cast<float>(1000 * mm); };
    trace->points.push_back({static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2]),
                             um(off[0]), um(off[1]), um(off[2]), sample.line});
  }

  void plot(const Sample& sample) {
    PlotData::Point point;
    point.time_s = static_cast<float>(to_seconds(sample.time - begin_));
    double square = 0;
    for (const PoseAxis axis : {kX, kY, kZ}) {
      point.tool_mm[axis] = static_cast<float>(sample.pose[axis]);
      square += (sample.pose[axis] - last_pose_[axis]) * (sample.pose[axis] - last_pose_[axis]);
    }
    const double dt = to_seconds(sample.time - last_time_);
    if (dt > 0 && dt < 0.01) point.speed_mm_per_s = static_cast<float>(std::sqrt(square) / dt);
    point.e_mm = sample.pose[kE];
    point.error_um = static_cast<float>(checkers_->tracking.last_tool_um());
    point.bus_load = static_cast<float>(checkers_->bus.last_100ms());
    for (std::size_t j = 0; j < machine_.joints.size() && j < point.joints.size(); ++j)
      point.joints[j] = static_cast<float>(sample.joints[j]);
    point.heat = heat_.heat();
    last_pose_ = sample.pose;
    last_time_ = sample.time;
    options_.plot->joint_count = static_cast<int>(machine_.joints.size());
    options_.plot->add(point);
  }

  void fill() {
    const Checkers& c = *checkers_;
    report_.max_tracking_error_um = c.tracking.max_tool_um();
    report_.rms_tracking_error_um = c.tracking.rms_tool_um();
    report_.worst_tracking_s = c.tracking.worst_time_s() - to_seconds(begin_);
    report_.worst_tracking_line = c.tracking.worst_line();
    report_.samples = c.tracking.samples();
    report_.max_joint_error_counts = c.tracking.max_joint_counts();
    report_.worst_joint_s = c.tracking.worst_joint_time_s() - to_seconds(begin_);
    if (c.tracking.worst_joint() >= 0)
      report_.worst_joint = machine_.joints[static_cast<std::size_t>(c.tracking.worst_joint())].name;
    report_.max_path_error_um = c.path.max_um();
    report_.rms_path_error_um = c.path.rms_um();
    report_.worst_path_s = c.path.worst_time_s() - to_seconds(begin_);
    report_.worst_path_line = c.path.worst_line();
    report_.max_joint_velocity_ratio = c.joints.max_velocity_ratio();
    report_.max_joint_acceleration_ratio = c.joints.max_acceleration_ratio();
    report_.max_measured_acceleration_ratio = c.joints.max_measured_acceleration_ratio();
    report_.max_joint_jerk_ratio = c.jerk.max_ratio();
    report_.max_ramp_jerk_ratio = c.jerk.max_ramp_ratio();
    report_.worst_jerk_s = std::max(0.0, c.jerk.worst_time_s() - to_seconds(begin_));
    report_.worst_jerk_joint = c.jerk.worst_joint();
    if (vibration_)
      report_.vibration = VibrationReport{.rms_um = vibration_->rms_um(),
                                          .peak_um = vibration_->peak_um(),
                                          .plan_deviation_um = vibration_->plan_deviation_um(),
                                          .samples = vibration_->samples(),
                                          .peak_line = vibration_->peak_line()};
    if (bead_ && bead_->beads() > 0) {
      const BeadReference& reference = *options_.nozzle->reference;
      report_.bead = BeadReport{.rms = bead_->rms(),
                                .worst = bead_->worst(),
                                .worst_line = bead_->worst_line(),
                                .beads = bead_->beads(),
                                .reference_rms = reference.klipper.rms,
                                .reference_worst = reference.klipper.worst,
                                .plain_rms = reference.plain.rms,
                                .plain_worst = reference.plain.worst,
                                .reference_time_s = reference.time_s};
    }
    report_.max_node_time_skew_us = c.skew.max_us();
    report_.worst_skew_s = c.skew.worst_time_s() - to_seconds(begin_);
    report_.queue_fullest = c.queues.findings().fullest;
    report_.queue_overruns = c.queues.findings().overruns;
    report_.records_out_of_sequence = c.queues.findings().out_of_sequence;
    report_.bus_load_mean = c.bus.mean();
    report_.bus_load_peak_1s = c.bus.peak_1s();
    report_.heat = heat_.report();
    if (!heat_.complaint().empty()) {
      report_.trouble = true;
      report_.finished = false;
      report_.messages.push_back(heat_.complaint());
    }
    report_.frames = c.bus.frames();
    report_.segments = c.joints.segments();
    const MachineCounters counters = simulation_.gateway().status().counters;
    report_.underruns = counters.underruns;
    report_.sequence_errors = counters.sequence_errors;
    report_.checkpoint_errors = counters.checkpoint_errors;
    report_.bus_slowdowns = counters.bus_slowdowns;
    report_.starvation_holds = counters.starvation_holds;
  }

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  const SimulateOptions& options_;
  Simulation simulation_;
  StepChecker steps_;
  HeatRecord heat_;
  std::unique_ptr<Checkers> checkers_;
  std::unique_ptr<VibrationChecker> vibration_;
  std::unique_ptr<BeadMeter> bead_;
  SimulationReport report_;
  BusTime begin_{0}, last_time_{0};
  Pose last_pose_{};
  int since_progress_ = 0;
};

}  // namespace

SimulationReport simulate(const MachineDescription& machine, std::unique_ptr<ByteSource> job,
                          ByteSource& same_job, const SimulateOptions& options) {
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) {
    SimulationReport report;
    report.outcome = kinematics.error().what.english();
    return report;
  }
  return Run(machine, **kinematics, options).go(std::move(job), same_job);
}

SimulationReport simulate_flexible(const MachineDescription& machine,
                                   const std::function<std::unique_ptr<ByteSource>()>& open,
                                   const FlexibleFrame::Error& error, SimulateOptions options) {
  options.flexible.emplace();
  options.flexible->truth = FlexibleFrame::truth(machine.vibration, error, options.simulation.seed);
  SimulateOptions without = options;
  if (options.ringing != nullptr) {
    without.flexible->trace = &options.ringing->unshaped;
    const bool shapes = machine.vibration.shapes();
    options.flexible->trace = shapes ? &options.ringing->shaped : &options.ringing->unshaped;
  }
  options.flexible->text = open();
  if (has_extruder(machine)) {
    const Nozzle::Truth truth =
        options.nozzle ? options.nozzle->truth
                       : Nozzle::truth(machine.pressure_advance, kNozzleError, options.simulation.seed);
    options.nozzle = NozzlePhysics{
        truth, std::make_shared<BeadReference>(bead_reference(machine, open, truth, options.limit_s))};
  }
  const auto checkers_text = open();
  SimulationReport report = simulate(machine, open(), *checkers_text, options);
  if (!report.vibration) return report;
  VibrationReport& vibration = *report.vibration;
  vibration.unshaped_rms_um = vibration.rms_um;
  vibration.unshaped_peak_um = vibration.peak_um;
  vibration.unshaped_job_time_s = report.job_time_s;
  if (!machine.vibration.shapes()) return report;
  MachineDescription plain = machine;
  plain.vibration = {};
  without.plot = nullptr;
  without.nozzle.reset();
  without.on_frame = nullptr;
  without.on_sample = nullptr;
  const auto text = open();
  const SimulationReport unshaped = simulate(plain, open(), *text, without);
  report.cpu_s += unshaped.cpu_s;
  if (!unshaped.vibration || unshaped.trouble) {
    report.messages.push_back("without shaping: " + unshaped.outcome);
    report.trouble = true;
    return report;
  }
  vibration.unshaped_rms_um = unshaped.vibration->rms_um;
  vibration.unshaped_peak_um = unshaped.vibration->peak_um;
  vibration.unshaped_job_time_s = unshaped.job_time_s;
  return report;
}

}  // namespace kinebus
