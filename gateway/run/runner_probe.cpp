// A move that ends where the probe touches: planned as a run of its own, held on the path when the probe
// tells, and the tool's place at the contact by the plan, at the path time that all nodes had then.

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/run/runner.hpp"

namespace kinebus {
namespace {

using Watch = ContactProbe::Watch;

constexpr std::chrono::milliseconds kSteepestRamp{4};
constexpr double kSpeedStep_s = 1e-3;
constexpr PathTime kSpeedStep = std::chrono::milliseconds{1};

}  // namespace

void Runner::begin_probe() {
  ContactProbe* const probe = heat_.probe();
  probing_ = true;
  touched_.reset();
  doing_ = say("probing");
  if (probe == nullptr) {
    probe_wrong_ = say("the machine has no probe");
    return;
  }
  if (probe->pin() == ContactProbe::Pin::kNone) return arm_probe();
  probe->move_pin(ContactProbe::PinOrder::kOut);
  wait_ = Wait::kPinOut;
  doing_ = say("putting the probe's pin out");
}

void Runner::arm_probe() {
  heat_.probe()->arm(pipeline_.probe().away);
  wait_ = Wait::kProbeReady;
  doing_ = say("probing");
}

/// false: not yet, or never, and probe_wrong_ says why.
bool Runner::pin_is(ContactProbe::Pin where) {
  const ContactProbe& probe = *heat_.probe();
  if (probe.pin() == ContactProbe::Pin::kFailed) probe_wrong_ = probe.pin_words();
  return probe.pin() == where;
}

/// Nothing moves before it is in. false: it has none.
bool Runner::draw_pin_in() {
  ContactProbe& probe = *heat_.probe();
  if (probe.pin() == ContactProbe::Pin::kNone) return false;
  probe.move_pin(ContactProbe::PinOrder::kIn);
  wait_ = Wait::kPinIn;
  doing_ = say("drawing the probe's pin in");
  return true;
}

/// By a word of the job; nothing moves before it is there.
void Runner::move_pin(const canonical::ProbePin& asked) {
  using Asked = canonical::ProbePin::What;
  ContactProbe* const probe = heat_.probe();
  if (probe == nullptr || probe->pin() == ContactProbe::Pin::kNone) {
    probe_wrong_ = say("the machine has no probe with a pin");
    return;
  }
  probe->move_pin(pin_order(asked));
  if (asked.what == Asked::kSelfTest) return;
  wait_ = asked.what == Asked::kOut ? Wait::kPinStays : Wait::kPinIn;
  doing_ = asked.what == Asked::kOut ? say("putting the probe's pin out") : say("drawing the probe's pin in");
}

void Runner::give_up_probe() {
  ContactProbe* const probe = heat_.probe();
  if (std::exchange(probing_, false) && probe != nullptr && probe->pin() != ContactProbe::Pin::kNone)
    probe->move_pin(ContactProbe::PinOrder::kIn);
}

/// Before the move: the probe is ready. Behind it: it has said whether it touched.
bool Runner::probe_has_answered() {
  const ContactProbe& probe = *heat_.probe();
  const canonical::Probe& move = pipeline_.probe();
  switch (probe.watch()) {
    case Watch::kWaits:
      if (wait_ != Wait::kProbeReady) return false;
      if (probe.touches() == move.away) return true;
      probe_wrong_ = move.away ? say("the probe touches nothing, so that it cannot let go: nothing has moved")
                               : say("the probe touches before its move: nothing has moved");
      return false;
    case Watch::kNone:
      if (!move.must) {
        end_probe({.contact = false, .at = move.target, .stand = move.target, .frame = move.frame});
        return true;
      }
      probe_wrong_ = move.away ? say("the probe has not let go before the end of its move")
                               : say("the probe has not touched before the end of its move");
      return false;
    case Watch::kFailed:
      probe_wrong_ = say("the probe's node does not answer");
      return false;
    case Watch::kOff:
    case Watch::kArms:
    case Watch::kAsks:
    case Watch::kContact:
      break;
  }
  return false;
}

void Runner::look_at_probe(BusTime now) {
  if (!probing_ || !active_ || suspended_ || wait_ == Wait::kProbeReady || wait_ == Wait::kPinOut) return;
  const ContactProbe* const probe = heat_.probe();
  if (probe == nullptr) return;
  // What is asked for at the end of the way may be that nothing came.
  const bool told =
      probe->watch() == Watch::kContact || (probe->watch() == Watch::kAsks && wait_ != Wait::kProbeEnd);
  if (told && !std::exchange(probe_cut_, true)) rate_.request(0, probe_ramp(now), now);
  if (!probe_cut_) return;
  if (probe->watch() == Watch::kFailed) probe_wrong_ = say("the probe's node does not answer");
  if (probe->watch() == Watch::kWaits && rate_.at_rest(now))
    probe_wrong_ = say("the probe has told of a contact, and its node knows of none");
  if (probe->watch() != Watch::kContact || touched_) return;
  touched_ = planned_pose(rate_.tau(probe->contact()));
  if (!touched_) probe_wrong_ = say("the probe has touched at a time that is not one of its move");
}

/// No joint and not the tool brake harder than they do on their path.
std::chrono::milliseconds Runner::probe_ramp(BusTime now) const {
  const PathTime tau = rate_.tau(now);
  const auto here = planned_pose(tau), next = planned_pose(tau + kSpeedStep);
  if (!here || !next) return kSteepestRamp;
  JointVector from{}, to{};
  if (!kinematics_.inverse(here->frame, here->pose, from) ||
      !kinematics_.inverse(next->frame, next->pose, to))
    return machine_.stop.hold_ramp;
  const double way = std::hypot(next->pose[kX] - here->pose[kX], next->pose[kY] - here->pose[kY],
                                next->pose[kZ] - here->pose[kZ]);
  double ramp_s = way / kSpeedStep_s / machine_.path.tool_accel_mm_per_s2;
  for (std::size_t joint = 0; joint < machine_.joints.size(); ++joint)
    ramp_s = std::max(ramp_s,
                      std::abs(to[joint] - from[joint]) / kSpeedStep_s / machine_.joints[joint].accel_per_s2);
  const std::chrono::milliseconds ramp{static_cast<std::int64_t>(std::ceil(1e3 * ramp_s))};
  return std::clamp(ramp, kSteepestRamp, std::max(kSteepestRamp, machine_.stop.hold_ramp));
}

Runner::Outcome Runner::probe_outcome(BusTime now) {
  const bool rests = rate_.at_rest(now) && rate_.all_sent();
  return rests && touched_ ? Outcome::kProbed : Outcome::kBusy;
}

Runner::Outcome Runner::probed(const Pose& stand) {
  const canonical::Probe& move = pipeline_.probe();
  const auto at = convert_pose(kinematics_, touched_->frame, touched_->pose, move.frame);
  const auto rest = convert_pose(kinematics_, Frame::kMachine, stand, move.frame);
  if (!at || !rest) return fail(last_line_, to_string((at ? rest : at).error()), false);
  gcode::ProbeResult result{.contact = true, .at = *at, .stand = *rest, .frame = move.frame};
  result.at[kE] = result.stand[kE] = move.target[kE];
  feed_.cut();
  start_ = stand;
  end_probe(result);
  wait_ = Wait::kNone;
  draw_pin_in();
  return Outcome::kBusy;
}

void Runner::end_probe(const gcode::ProbeResult& result) {
  probing_ = probe_cut_ = false;
  started_ = finished_ = false;
  doing_ = say("moving");
  learn({.what = journal::Learned::What::kProbed,
         .contact = result.contact,
         .frame = result.frame,
         .at = result.at,
         .stand = result.stand});
  pipeline_.probed(result);
  if (live_) answers_.push_back({.probed = result});
  check_what_follows();
}

/// What the pre-flight could not know: the phase or command that the pipeline has given out.
std::optional<Runner::Failure> Runner::wrong_after_probe(JobPipeline::Step step) {
  using Step = JobPipeline::Step;
  if (step == Step::kPhase) check_->phase(pipeline_.phase());
  if (step == Step::kEvent || step == Step::kBarrier) check_->command(pipeline_.command());
  if (check_->problems().errors() == 0) return std::nullopt;
  for (const Problem& problem : check_->problems().all())
    if (problem.severity == Problem::Severity::kError)
      return Failure{.line = problem.line, .words = problem.words, .stream = false};
  return std::nullopt;
}

}  // namespace kinebus
