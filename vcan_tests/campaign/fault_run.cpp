#include "vcan_tests/campaign/fault_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "tools/simulation/checkers/heat_checker.hpp"
#include "tools/simulation/checkers/known_checker.hpp"
#include "tools/simulation/checkers/patience_checker.hpp"
#include "tools/simulation/checkers/queue_checker.hpp"
#include "tools/simulation/checkers/step_checker.hpp"
#include "tools/simulation/checkers/together_checker.hpp"
#include "tools/simulation/simulation.hpp"
#include "vcan_tests/campaign/fault_bounds.hpp"
#include "vcan_tests/campaign/injector.hpp"
#include "vcan_tests/campaign/operator.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kPowerUp = 1s;
/// Bring-up, homing, print, a fault and all that follows it have passed by then, or somebody waits for ever.
constexpr BusTime kLongest = 150s;
/// Heating and cooling take their time; a job rests meanwhile. What is hot is looked at for a while after it.
constexpr BusTime kLongestHot = 600s, kHeating = 250s, kAfterwards = 15s;
/// A switch that does not open: so long after it nothing more is waited for.
constexpr BusTime kStuck = 90s;

class FaultRun {
 public:
  FaultRun(const MachineDescription& machine, const Kinematics& kinematics, const FaultPlan& plan, bool tell)
      : machine_(machine),
        plan_(plan),
        bounds_(bounds_of(plan)),
        injector_(machine, plan),
        tell_(tell),
        heats_(of_heat(plan.faults.at(0).kind)),
        simulation_(machine, kinematics, options_of(plan), injector_.make_nodes()),
        operator_(campaign_job(plan.seed, plan.faults.at(0).kind),
                  plan.faults.at(0).kind != FaultKind::kCancel),
        steps_(machine),
        together_(machine, kinematics, [this](PathTime tau) { return simulation_.planned_pose(tau); }),
        known_(machine),
        patience_(heats_ ? PatienceChecker(kHeating) : PatienceChecker()),
        heat_(machine) {
    result_.seed = plan.seed;
    result_.plan = plan;
    lives_.fill(true);
    for (const NodeDescription& node : machine.nodes)
      if (!node.functions.has_axes()) queues_.leave_out(node.id);
  }

  FaultResult go() {
    const double began = thread_cpu_s();
    connect();
    if (heats_) measure_heaters();
    simulation_.run_until(kPowerUp);
    const BusTime longest = heats_ ? kLongestHot : kLongest;
    while (!operator_.content() && !refused_ && simulation_.now() < longest && patience_.complaint().empty())
      simulation_.run_until(simulation_.now() + 1ms);
    if (heats_) simulation_.run_until(simulation_.now() + kAfterwards);
    judge();
    result_.machine_s = to_seconds(simulation_.now());
    result_.cpu_s = thread_cpu_s() - began;
    result_.trace_hash = simulation_.trace_hash();
    return std::move(result_);
  }

 private:
  SimulationOptions options_of(const FaultPlan& plan) {
    SimulationOptions options;
    options.seed = plan.seed;
    options.journal = true;
    options.gateway_delay = [this](BusTime now) { return injector_.gateway_delay(now); };
    return options;
  }

  static double thread_cpu_s() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  /// The models that tuning finds for these heaters, as 1010h has kept them.
  void measure_heaters() {
    constexpr std::array<std::array<std::uint32_t, 4>, 2> kModels{
        {{3006, 5340, 1423, 1998}, {234, 1527, 7806, 5202}}};
    VirtualMachine& nodes = injector_.machine();
    const BusModel::Port port = nodes.add_stranger(1);
    for (std::size_t heater = 0; heater < kModels.size(); ++heater)
      for (std::size_t i = 0; i < kModels[heater].size(); ++i) {
        CanFrame write{.id = cob_id::kSdoRequest + machine_.nodes[kHeatNode].id, .length = 8};
        write.data[0] = 0x23;
        put_u16_le(std::span(write.data).subspan(1),
                   static_cast<std::uint16_t>(heat_object::kModelRate.index + i));
        write.data[3] = static_cast<std::uint8_t>(heater + 1);
        put_u32_le(std::span(write.data).subspan(4), kModels[heater][i]);
        simulation_.run_until(simulation_.now() + 20ms);
        nodes.bus_for_faults().send(port, simulation_.now(), write);
      }
  }

  void connect() {
    injector_.job = [this] { return std::make_unique<StringSource>(operator_.job()); };
    injector_.attach(simulation_);
    injector_.note = [this](const std::string& words) { note(words); };
    simulation_.in_job = true;
    simulation_.on_sample = [this](const Sample& sample) { take(sample); };
    simulation_.on_probe = [this](const Probe& probe) {
      mask_dead();
      if (measuring_ && path_time_counts()) together_.on_probe(probe, lives_);
    };
    simulation_.on_frame = [this](BusTime, const CanFrame& frame) {
      if (speaks_ != &simulation_.gateway()) queues_.on_new_gateway();
      speaks_ = &simulation_.gateway();
      if (bounds_.clean_bus) queues_.on_frame(frame);
    };
    simulation_.on_event = [this](const MachineEvent& event) {
      operator_.on_event(event);
      if (event.kind == MachineEvent::Kind::kAlarm) ++alarms_;
      note(event.words +
           (event.kind == MachineEvent::Kind::kAlarm ? fmt::format(" [{:04X}]", event.code) : ""));
    };
  }

  void note(const std::string& words) {
    if (tell_) result_.story.push_back(fmt::format("{:9.4f} s  {}", to_seconds(simulation_.now()), words));
  }

  void take(Sample sample) {
    const BusTime now = sample.time;
    VirtualMachine& nodes = injector_.machine();
    Gateway& gateway = simulation_.gateway();
    const bool alive = simulation_.gateway_alive();
    const MachineState state = alive ? gateway.state() : MachineState::kOff;
    if (state == MachineState::kHoming && !homing_seen_)
      homing_seen_ = true, injector_.begin(FaultPhase::kHoming, now);
    if (alive && operator_.job_running() && !job_seen_)
      job_seen_ = true, injector_.begin(FaultPhase::kJob, now);
    if (heats_) watch_heat(sample);
    injector_.on_time(now);
    // A node that was without power counts again when the machine has been brought up with it.
    if (alive && state == MachineState::kReady) lives_.fill(true);
    mask_dead();
    unsigned dead = 0;
    for (std::size_t n = 0; n < static_cast<std::size_t>(sample.node_count); ++n)
      if (!lives_[n]) dead |= 1u << n;
    steps_.on_sample(sample, dead);
    // Whenever motion is queued or under way: through every stop, and as long as nodes hold without a
    // gateway.
    measuring_ = job_seen_ && (!alive || state == MachineState::kRunning || state == MachineState::kHolding ||
                               state == MachineState::kHeld || state == MachineState::kStopping ||
                               state == MachineState::kStopped || state == MachineState::kCancelling);
    if (measuring_) {
      simulation_.locate(sample);
      together_.on_sample(sample, lives_, known_joints(now), injector_.excused_counts() > 0);
    }
    known_.on_nodes(nodes, now, injector_.excused_counts());
    const bool rests =
        state == MachineState::kReady || state == MachineState::kHeld || state == MachineState::kStopped;
    if (alive && rests && now - rest_since_ > 200ms)
      known_.on_gateway(gateway.status(), sample, injector_.excused_counts());
    if (!rests) rest_since_ = now;
    watch_stop(sample);
    if (!alive) return;
    patience_.on_sample(now, state, gateway.path_time(now));
    if (heats_ && !print_seen_ && state == MachineState::kRunning && sample.line > kFirstPrinted)
      print_seen_ = true, injector_.begin(FaultPhase::kPrint, now);
    print_begun_ = print_begun_ || (state == MachineState::kRunning && sample.line > 1);
    if (operator_.begun_again() > begun_again_) {
      ++begun_again_;
      lost_print_ = lost_print_ || print_begun_;
      print_begun_ = false;
    }
    operator_.on_time(now, gateway, injector_.cause_over(now));
    const auto broken = injector_.begun();
    const bool stuck = plan_.faults[0].kind == FaultKind::kHeaterStuck;
    if (stuck && broken && now > *broken + kStuck && state == MachineState::kHeld) operator_.give_up();
    const bool gave_up = operator_.lifted() >= bounds_.attempts;
    refused_ = !job_seen_ && (state == MachineState::kAlarm || state == MachineState::kStopped) &&
               alarms_ > 0 && gave_up;
  }

  void watch_heat(const Sample& sample) {
    heat::HeatPlant& plant = injector_.machine().heat_plant(kHeatNode);
    heat_.on_sample(to_seconds(sample.time), {plant.hot_end().block(), plant.bed().block()},
                    sample.joints[kExtruder]);
  }

  /// Path time means something: on one node at least it runs, or motion waits for it. Else it is a number
  /// that is set anew before the next motion.
  bool path_time_counts() {
    for (int node = 0; node < injector_.machine().node_count(); ++node)
      if (injector_.machine().path_time_counts(node, simulation_.now())) return true;
    return false;
  }

  TogetherChecker::Known known_joints(BusTime now) {
    TogetherChecker::Known known{};
    for (std::size_t j = 0; j < machine_.joints.size(); ++j)
      for (std::size_t n = 0; n < machine_.nodes.size(); ++n)
        if (machine_.nodes[n].id == machine_.joints[j].node_id)
          known[j] = injector_.machine()
                         .believed_counts(static_cast<int>(n), machine_.joints[j].axis, now)
                         .has_value();
    return known;
  }

  void mask_dead() {
    for (std::size_t n = 0; n < lives_.size(); ++n)
      if (static_cast<int>(n) < injector_.machine().node_count() &&
          !injector_.machine().powered(static_cast<int>(n)))
        lives_[n] = false;
  }

  /// From the cause to rest: of every carriage, by its true position.
  void watch_stop(const Sample& sample) {
    const bool moves = std::abs(sample.rate) > 1e-9;
    for (std::size_t j = 0; j < machine_.joints.size(); ++j)
      if (sample.joints[j] != last_joints_[j]) still_since_[j] = sample.time;
    last_joints_ = sample.joints;
    const auto cause = injector_.stop_cause();
    if (!cause || result_.rest_ms > 0 || sample.time < *cause + 2ms || moves) return;
    BusTime last{0};
    for (std::size_t j = 0; j < machine_.joints.size(); ++j) last = std::max(last, still_since_[j]);
    if (sample.time - last < 3ms) return;
    result_.rest_ms = std::max(1e3 * to_seconds(last - *cause), 1e-3);
  }

  void violate(std::string words) { result_.violations.push_back(std::move(words)); }

  void judge() {
    result_.margin_k = heat_.nearest_k();
    if (!heat_.complaint().empty()) violate(heat_.complaint());
    result_.path_um = together_.path_um();
    result_.far_ms = together_.far_samples();
    result_.astray_um = together_.astray_um();
    result_.skew_us = together_.skew_us();
    result_.step_ratio = steps_.max_ratio();
    result_.known_counts = std::max(known_.worst_counts(), known_.worst_shown_counts());
    result_.ramp_ms = injector_.ramp_ms();
    // A station that was bus-off for a moment may have stopped nobody: what came to rest then was the job.
    const bool stopped = operator_.lifted() + operator_.resumed() + operator_.begun_again() > 0;
    if (!stopped && plan_.faults[0].kind == FaultKind::kBusOff) result_.rest_ms = 0;
    if (refused_)
      result_.outcome = FaultOutcome::kRefused;
    else if (!operator_.job_finished())
      result_.outcome = FaultOutcome::kReady;
    else if (operator_.begun_again() > 0)
      result_.outcome = FaultOutcome::kBegunAgain;
    else if (operator_.homed_again())
      result_.outcome = FaultOutcome::kHomedAgain;
    else
      result_.outcome =
          operator_.lifted() + operator_.resumed() > 0 ? FaultOutcome::kContinued : FaultOutcome::kFinished;

    if (!patience_.complaint().empty())
      violate("waits for ever: " + patience_.complaint() + ", " + simulation_.gateway().status().doing);
    else if (!operator_.content() && !refused_)
      violate(fmt::format("not over after {} s, state {}", simulation_.now() / 1s,
                          to_string(simulation_.gateway().state())));
    if (lost_print_) violate("the job had begun, and was neither resumed nor given up");
    if (!bounds_.allows(result_.outcome))
      violate(fmt::format("outcome '{}' is not one of this fault's", to_string(result_.outcome)));
    if (result_.path_um > bounds_.path_um)
      violate(fmt::format("path error {:.2f} um > {} um at {:.4f} s", result_.path_um, bounds_.path_um,
                          together_.path_time_s()));
    if (result_.skew_us > bounds_.skew_us)
      violate(fmt::format("path times {:.2f} us apart > {} us at {:.4f} s", result_.skew_us, bounds_.skew_us,
                          together_.skew_time_s()));
    if (result_.step_ratio > bounds_.step_ratio)
      violate(fmt::format("velocity step {:.5f} of the stop limit at {:.4f} s on {}", result_.step_ratio,
                          steps_.worst_time_s(), steps_.worst_joint()));
    if (known_.worst_counts() > bounds_.known_counts)
      violate(fmt::format("{} believes a wrong position: {:.2f} counts at {:.4f} s", known_.worst(),
                          known_.worst_counts(), known_.worst_time_s()));
    if (known_.worst_shown_counts() > bounds_.known_counts)
      violate(fmt::format("the gateway shows a wrong position: {:.2f} counts at {:.4f} s",
                          known_.worst_shown_counts(), known_.worst_shown_time_s()));
    if (result_.rest_ms > bounds_.rest_ms)
      violate(fmt::format("all at rest only after {:.1f} ms > {} ms", result_.rest_ms, bounds_.rest_ms));
    if (result_.ramp_ms > bounds_.ramp_ms)
      violate(fmt::format("all ramping only after {:.3f} ms > {} ms", result_.ramp_ms, bounds_.ramp_ms));
    if (queues_.findings().overruns > 0)
      violate(fmt::format("{} records without room", queues_.findings().overruns));
    // Numbering begins anew when the queues are dropped, on the way from a stop.
    if (operator_.lifted() + operator_.resumed() == 0 && queues_.findings().out_of_sequence > 0)
      violate(fmt::format("{} records out of sequence", queues_.findings().out_of_sequence));
  }

  const MachineDescription& machine_;
  const FaultPlan plan_;
  const FaultBounds bounds_;
  Injector injector_;
  bool tell_;
  bool heats_;
  Simulation simulation_;
  Operator operator_;
  StepChecker steps_;
  TogetherChecker together_;
  KnownChecker known_;
  PatienceChecker patience_;
  HeatChecker heat_;
  QueueChecker queues_;
  const Gateway* speaks_ = nullptr;
  TogetherChecker::Lives lives_{};
  JointVector last_joints_{};
  std::array<BusTime, std::tuple_size_v<JointVector>> still_since_{};
  BusTime rest_since_{0};
  bool homing_seen_ = false, job_seen_ = false, print_seen_ = false, print_begun_ = false,
       lost_print_ = false, measuring_ = false, refused_ = false;
  int alarms_ = 0, begun_again_ = 0;
  FaultResult result_;
};

}  // namespace

std::string_view to_string(FaultOutcome outcome) {
  constexpr std::array<std::string_view, kFaultOutcomes> kNames{"finished",    "continued", "homed again",
                                                                "begun again", "ready",     "refused"};
  return kNames[static_cast<std::size_t>(outcome)];
}

FaultResult run_faults(const MachineDescription& machine, const Kinematics& kinematics, const FaultPlan& plan,
                       bool tell) {
  return FaultRun(machine, kinematics, plan, tell).go();
}

}  // namespace kinebus
