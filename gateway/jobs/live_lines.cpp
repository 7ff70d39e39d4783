#include "gateway/jobs/live_lines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/gcode/programs/program.hpp"
#include "gateway/jobs/job_shaping.hpp"
#include "gateway/jobs/machine_setup.hpp"
#include "gateway/motion/arc_piece.hpp"

namespace kinebus {
namespace {

using Refused = std::optional<Sentence>;

// As in a job's check: the workspace's borders are smooth, between good poses 1 mm apart the path leaves it
// by less than 2 um.
constexpr double kCheckStep_mm = 1;
constexpr double kCheckStep_rad = 0.01;
constexpr double kLongestMove_mm = 1e5;
constexpr double kLongestTurn_rad = 1000;
constexpr double kNoExtrusion_mm = 1e-9;

std::string rounded_celsius(double value) {
  return printed("%.6g C", value);
}

}  // namespace

void merge_limits(canonical::Limits& all, const canonical::Limits& more) {
  const auto take = [](double& old, double value) {
    if (value != 0) old = value;
  };
  for (std::size_t i = 0; i < 6; ++i) {
    take(all.axis_speed_per_s[i], more.axis_speed_per_s[i]);
    take(all.axis_accel_per_s2[i], more.axis_accel_per_s2[i]);
  }
  take(all.print_accel_mm_per_s2, more.print_accel_mm_per_s2);
  take(all.travel_accel_mm_per_s2, more.travel_accel_mm_per_s2);
  take(all.retract_accel_mm_per_s2, more.retract_accel_mm_per_s2);
}

LiveLines::LiveLines(const MachineDescription& machine, const Kinematics& kinematics,
                     const bodies::PrintedPart* printed)
    : machine_(machine), kinematics_(kinematics), way_(machine, kinematics, printed) {
  restart({});
}

void LiveLines::restart(const gcode::WorkOffsets& offsets) {
  const Pose home = kinematics_.bed_reference();
  gcode::Options options = interpreter_options(machine_, home, home);
  options.work_offsets = offsets;
  interpreter_ = gcode::Interpreter(std::move(options));
  limits_ = {};
  path_mode_.reset();
  advance_ = {};
  shaping_ = {};
  cold_noted_ = fan_noted_ = false;
  end(say("no lines are open"));
}

void LiveLines::stand_at(const Pose& pose) {
  // The program's E stays; what it stands for on the machine is where the machine's E is.
  gcode::State state = interpreter_.state();
  gcode::ModalState& m = state.modal;
  double& real_e = (m.away ? m.real_position : m.position)[kE];
  const double shift = pose[kE] - real_e;
  m.e_canonical_base_mm += shift;
  for (double* e : {&m.position[kE], &m.real_position[kE], &m.e_max_mm, &m.real_e_max_mm}) *e += shift;
  real_e = pose[kE];
  interpreter_.restore(state);
  interpreter_.set_position(pose, Frame::kMachine);
}

Result<void, Sentence> LiveLines::set_work_offset(int system, const Pose& offset, bool here,
                                                  const std::optional<Pose>& where) {
  if (where) stand_at(*where);
  return interpreter_.set_work_offset(system, offset, here);
}

Pose LiveLines::program_position(const std::optional<Pose>& where) {
  if (where) stand_at(*where);
  return interpreter_.program_position();
}

void LiveLines::begin(const Pose& pose, const HotendTargets& hotends, gcode::CommandBuffer& out) {
  stand_at(pose);
  place_ = {pose, Frame::kMachine};
  melt_ = {.celsius = hotends, .tool = hotend_in_use()};
  still_.reset();
  answers_due_ = 0;
  if (machine_.tools() > 1) out.push_back({0, canonical::Tool{melt_.tool}});
  if (path_mode_) out.push_back({0, *path_mode_});
  out.push_back({0, limits_});
  if (advance_.advance_s >= 0 || advance_.smooth_s >= 0) out.push_back({0, advance_});
  if (std::any_of(shaping_.axes.begin(), shaping_.axes.end(), [](const auto& axis) { return axis.asks(); }))
    out.push_back({0, shaping_});
}

Result<void, Problem> LiveLines::take(std::string_view line, std::uint32_t number,
                                      gcode::CommandBuffer& out) {
  const auto refuse = [&](std::uint32_t column, Sentence words) {
    return Error<Problem>({Problem::Severity::kError, number, column, std::move(words)});
  };
  const gcode::State before = interpreter_.state();
  const Place place = place_;
  const int answers_due = answers_due_;
  const Melt melt = melt_;
  const std::size_t first = out.size();
  gcode::Program program(interpreter_, gcode::Program::Use::kLines);
  auto read = program.line(line, number, out);
  while (read && program.busy()) read = program.step(out);
  if (!read) {
    if (program.steps() > 0 || out.size() > first) interpreter_.restore(before);
    out.resize(first);
    return refuse(read.error().column, read.error().message);
  }
  if (interpreter_.compensates()) {
    interpreter_.restore(before);
    out.resize(first);
    return refuse(0, say("cutter compensation belongs to a job: it looks ahead, which single lines cannot"));
  }
  for (std::size_t i = first; i < out.size(); ++i) {
    auto words = check(out[i].command);
    const bool reads = std::holds_alternative<canonical::AwaitInput>(out[i].command);
    const bool probes = reads || std::holds_alternative<canonical::Probe>(out[i].command) ||
                        std::holds_alternative<canonical::Mesh>(out[i].command);
    if (reads && program.steps() > 0)
      words = say(
          "a macro or loop with M66 works in a job, not as a line: the lines behind M66 have to know what "
          "it reads");
    else if (probes && program.steps() > 0)
      words =
          say("a macro or loop that probes works in a job, not as a line: the lines behind G38 have to know "
              "what it measures");
    if (!words) {
      answers_due_ += probes ? 1 : 0;
      continue;
    }
    answers_due_ = answers_due;
    interpreter_.restore(before);
    place_ = place;
    melt_ = melt;
    out.resize(first);
    return refuse(0, std::move(*words));
  }
  for (std::size_t i = first; i < out.size(); ++i) {
    if (const auto* mode = std::get_if<canonical::PathMode>(&out[i].command)) path_mode_ = *mode;
    if (const auto* limits = std::get_if<canonical::Limits>(&out[i].command)) merge_limits(limits_, *limits);
    if (const auto* advance = std::get_if<canonical::PressureAdvance>(&out[i].command)) {
      if (advance->advance_s >= 0) advance_.advance_s = advance->advance_s;
      if (advance->smooth_s >= 0) advance_.smooth_s = advance->smooth_s;
    }
    if (const auto* shaping = std::get_if<canonical::InputShaping>(&out[i].command))
      merge_shaping(shaping_, *shaping);
  }
  for (const gcode::Note& note : interpreter_.notes()) notes_.push_back(note.text);
  interpreter_.clear_notes();
  return {};
}

void LiveLines::probed(const gcode::ProbeResult& result) {
  answers_due_ = std::max(0, answers_due_ - 1);
  interpreter_.set_probed(result);
  // Where the line goes on behind its probe, it was checked to its end.
  const gcode::ModalState& m = interpreter_.state().modal;
  place_ = {m.position, m.frame};
}

void LiveLines::input_read(double value) {
  answers_due_ = std::max(0, answers_due_ - 1);
  interpreter_.set_input(value);
}

void LiveLines::levelled(const std::optional<Pose>& stand, Frame frame) {
  answers_due_ = std::max(0, answers_due_ - 1);
  if (!stand || answers_due_ > 0) return;
  interpreter_.set_position(*stand, frame);
  place_ = {*stand, frame};
}

std::vector<Sentence> LiveLines::take_notes() {
  return std::exchange(notes_, {});
}

Refused LiveLines::check(const canonical::Command& command) {
  if (const auto* set = std::get_if<canonical::SetPosition>(&command)) {
    place_ = {set->pose, set->frame};
    return std::nullopt;
  }
  if (const auto* thermal = std::get_if<canonical::Thermal>(&command)) return check_thermal(*thermal);
  if (const auto* tool = std::get_if<canonical::Tool>(&command)) {
    melt_.tool = static_cast<std::uint8_t>(tool->hotend);
    melt_.hot_e_mm = -1e300;
    return std::nullopt;
  }
  if (const auto* shaping = std::get_if<canonical::InputShaping>(&command)) {
    canonical::InputShaping all = shaping_;
    merge_shaping(all, *shaping);
    const auto shaped = shaped_by_job(kinematics_, machine_.vibration, all);
    return shaped ? std::nullopt : std::optional(shaped.error());
  }
  if (const auto* spindle = std::get_if<canonical::Spindle>(&command))
    return wrong_spindle_speed(machine_.spindle, spindle->rpm);
  if (const auto* wait = std::get_if<canonical::AwaitInput>(&command)) {
    if (auto missing = missing_input(machine_, *wait)) return missing;
    return still_ && wait->until != canonical::AwaitInput::Until::kNow ? still_ : std::nullopt;
  }
  if (std::holds_alternative<canonical::SpindleSync>(command))
    return say("a thread belongs to a job: it cannot wait for lines");
  if (std::holds_alternative<canonical::StoredJob>(command))
    return say("stored jobs are managed by the session: M20 to M32 stand alone in a line");
  const auto* feed = std::get_if<canonical::Feed>(&command);
  const auto* traverse = std::get_if<canonical::Traverse>(&command);
  const auto* arc = std::get_if<canonical::Arc>(&command);
  const auto* home = std::get_if<canonical::Home>(&command);
  const auto* probe = std::get_if<canonical::Probe>(&command);
  if (!feed && !traverse && !arc && !home && !probe) return std::nullopt;
  if (still_) return *still_;
  if (probe) return check_straight(probe->target, probe->frame);
  if (home) return check_home(*home);
  if (arc) return check_arc(*arc);
  return feed ? check_straight(feed->target, feed->frame) : check_straight(traverse->target, traverse->frame);
}

Refused LiveLines::check_straight(const Pose& target, Frame frame) {
  if (auto cold = check_extrusion(target)) return cold;
  const Pose from = place_.pose;
  double mm = 0, rad = 0;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    if (!std::isfinite(target[axis])) return say("a move needs numbers");
    const double way = std::abs(target[axis] - from[axis]);
    if (axis == kA || axis == kC)
      rad = std::max(rad, way);
    else if (axis != kE)
      mm = std::hypot(mm, way);
  }
  const auto end = kinematics_.check(frame, target);
  if (!end) return to_string(end.error());
  // The end lies within the workspace: only turns may be long.
  if (!(mm <= kLongestMove_mm && rad <= kLongestTurn_rad)) return say("the move is too long to be checked");
  // At most some hundred thousand, by the two limits above.
  const auto steps = static_cast<int>(std::ceil(std::max(mm / kCheckStep_mm, rad / kCheckStep_rad)));
  const auto at = [&](double i) {
    if (i >= steps) return target;
    Pose pose = from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
      pose[axis] += (target[axis] - from[axis]) * i / steps;
    return pose;
  };
  way_.jump();
  for (int i = 1; i <= std::max(steps, 1); ++i)
    if (auto broken = way_.broken(frame, i - 1, i, at)) return broken;
  place_ = {target, frame};
  return std::nullopt;
}

Refused LiveLines::check_arc(const canonical::Arc& arc) {
  if (auto cold = check_extrusion(arc.target)) return cold;
  Move move;
  move.from = place_.pose;
  move.to = arc.target;
  move.frame = arc.frame;
  if (!shape_arc(arc, place_.pose, move)) return say("centre, plane and target do not make an arc");
  if (!(move.length <= kLongestMove_mm)) return say("the arc is too long to be checked");
  const double turning =
      std::max(std::abs(arc.target[kA] - place_.pose[kA]), std::abs(arc.target[kC] - place_.pose[kC]));
  if (!(turning <= kLongestTurn_rad)) return say("the arc turns too far to be checked");
  const auto steps =
      static_cast<int>(std::ceil(std::max(move.length / kCheckStep_mm, turning / kCheckStep_rad)));
  const auto at = [&](double i) { return point_on(move, move.length * i / steps).x; };
  way_.jump();
  for (int i = 1; i <= steps; ++i)
    if (auto broken = way_.broken(move.frame, i - 1, i, at)) return broken;
  place_ = {arc.target, arc.frame};
  return std::nullopt;
}

/// The machine will go where homing leaves it, in a straight line of the homing frame. From the switches,
/// which lie outside the workspace, this is the way in: then only its end is checked.
Refused LiveLines::check_home(const canonical::Home& home) {
  const auto from = convert_pose(kinematics_, place_.frame, place_.pose, home.frame);
  if (!from) return say("G28: %1", to_string(from.error()));
  Pose target = home.afterwards;
  target[kE] = place_.pose[kE];
  place_ = {*from, home.frame};
  place_.pose[kE] = target[kE];
  if (!kinematics_.check(home.frame, place_.pose)) place_.pose = target;
  return check_straight(target, home.frame);
}

std::uint8_t LiveLines::hotend_in_use() const {
  return static_cast<std::uint8_t>(std::min(interpreter_.state().modal.tool, machine_.tools() - 1));
}

Refused LiveLines::check_extrusion(const Pose& target) {
  const HeaterId id{HeaterKind::kHotend, melt_.tool};
  if (machine_.heater(id) == nullptr || target[kE] - place_.pose[kE] <= kNoExtrusion_mm) return std::nullopt;
  const std::optional<double> celsius = melt_.celsius[melt_.tool % kMostOfAKind];
  if (!celsius) {
    if (!std::exchange(cold_noted_, true))
      notes_.push_back(say("filament is fed before a %1 temperature is set", heater_words(id)));
    return std::nullopt;
  }
  if (*celsius >= machine_.thermal.min_extrude_c) {
    melt_.hot_e_mm = std::max(melt_.hot_e_mm, target[kE]);
    return std::nullopt;
  }
  // As in a job: filament that was taken back goes where it came from.
  if (target[kE] <= melt_.hot_e_mm + kNoExtrusion_mm) return std::nullopt;
  return say("filament would be fed with the %1 at %2; at least %3 is needed", heater_words(id),
             rounded_celsius(*celsius), rounded_celsius(machine_.thermal.min_extrude_c));
}

Refused LiveLines::check_thermal(const canonical::Thermal& thermal) {
  if (auto wrong = wrong_device_command(machine_, thermal)) return wrong;
  if (auto missing = missing_fan(machine_, thermal); missing && !std::exchange(fan_noted_, true))
    notes_.push_back(std::move(*missing));
  // A cold end after a print is no news: only lines that feed filament afterwards are refused.
  if (const auto id = heater_of(thermal); id && id->kind == HeaterKind::kHotend)
    melt_.celsius[id->index % kMostOfAKind] = thermal.value;
  return std::nullopt;
}

}  // namespace kinebus
