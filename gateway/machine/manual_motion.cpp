#include "gateway/machine/manual_motion.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// Between two poses of a jog: the workspace is checked so often.
constexpr double kCheckStep = 1.0;  // mm
constexpr double kCheckStepRad = 0.01;
constexpr double kLiftStep = 0.25;   // mm
constexpr double kLeastLift = 0.01;  // mm: less frees no nozzle

/// How many poses of a way are looked at.
int checks(double mm, double rad, int most) {
  const double wanted = std::ceil(std::max(mm / kCheckStep, rad / kCheckStepRad));
  return static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(most)));
}

constexpr double kDefaultJogSpeed = 20;       // mm/s
constexpr double kDefaultTurnSpeed = 0.3;     // rad/s
constexpr double kDefaultExtrusionSpeed = 3;  // mm/s of filament

/// Jogs that wait; those that go on alike are one.
constexpr std::size_t kMostWaiting = 16;

Pose difference(const Pose& a, const Pose& b) {
  Pose d{};
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) d[axis] = a[axis] - b[axis];
  return d;
}

/// Of one direction.
bool alike(const Pose& a, const Pose& b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
    ab += a[axis] * b[axis];
    aa += a[axis] * a[axis];
    bb += b[axis] * b[axis];
  }
  return ab > 0 && ab * ab >= (1 - 1e-9) * aa * bb;
}

}  // namespace

Result<canonical::Feed, Refusal> ManualMotion::jog(const command::Jog& asked, const Pose& from,
                                                   const Heat& heat) {
  const Pose& d = asked.delta;
  for (const double value : d)
    if (!std::isfinite(value)) return refused(say("a jog needs numbers"));
  if (!std::isfinite(asked.speed_per_s) || asked.speed_per_s < 0)
    return refused(say("a jog's speed is 0 or more"));
  const double mm = std::sqrt(d[kX] * d[kX] + d[kY] * d[kY] + d[kZ] * d[kZ]);
  const double rad = std::max(std::abs(d[kA]), std::abs(d[kC]));
  if (mm == 0 && rad == 0 && d[kE] == 0) return refused(say("a jog needs a distance"));
  if (d[kE] > 0)
    if (auto cold = heat.too_cold()) return refused(std::move(*cold));
  const int steps = checks(mm, rad, 2000);
  const auto at = [&](double i) {
    Pose pose = from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) pose[axis] += d[axis] * i / steps;
    return pose;
  };
  way_.jump();
  const bool stands_well =
      kinematics_.check(Frame::kMachine, from) && !way_.collision(Frame::kMachine, 0, 0, at);
  int reached = steps;
  for (int i = 1; i <= steps && (mm > 0 || rad > 0); ++i) {
    auto broken = way_.broken(Frame::kMachine, i - 1, i, at);
    if (!broken) continue;
    if (asked.while_held && i > 1) {
      reached = i - 1;
      break;
    }
    // How far the target is outside says more than where the way leaves the workspace.
    const auto end = kinematics_.check(Frame::kMachine, at(steps));
    broken = end ? with_way_out(std::move(*broken)) : to_string(end.error());
    return refused(stands_well ? std::move(*broken)
                               : say("%1: go to the bed reference first", std::move(*broken)));
  }
  const Pose target = at(reached);
  double speed = asked.speed_per_s;
  if (speed == 0) speed = mm > 0 ? kDefaultJogSpeed : rad > 0 ? kDefaultTurnSpeed : kDefaultExtrusionSpeed;
  return canonical::Feed{.target = target, .frame = Frame::kMachine, .feed_per_s = speed};
}

void ManualMotion::begin_jog(BusTime now, const command::Jog& asked, const canonical::Feed& move,
                             const Pose& from) {
  end_jogs();
  jogs_ = asked.while_held ? Jogs::kWhileHeld : Jogs::kBySteps;
  last_begin_ = from;
  last_end_ = move.target;
  direction_ = asked.delta;
  wanted_until_ = now + command::kHeldJogPatience;
}

Result<void, Refusal> ManualMotion::add_jog(const command::Jog& asked, const Heat& heat) {
  const auto move = jog(asked, last_end_, heat);
  if (!move) return Error<Refusal>(move.error());
  const bool joins = !waiting_.empty() && waiting_.back().feed_per_s == move->feed_per_s &&
                     alike(difference(last_end_, last_begin_), asked.delta);
  if (joins) {
    waiting_.back().target = move->target;
  } else {
    if (waiting_.size() >= kMostWaiting) return refused(say("%1 moves are waiting already", kMostWaiting));
    waiting_.push_back(*move);
    last_begin_ = last_end_;
  }
  last_end_ = move->target;
  return {};
}

std::optional<canonical::Feed> ManualMotion::take_jog() {
  if (waiting_.empty()) return std::nullopt;
  const canonical::Feed next = waiting_.front();
  waiting_.pop_front();
  return next;
}

bool ManualMotion::hold_on(BusTime now, const command::Jog& asked) {
  if (!alike(direction_, asked.delta)) return false;
  wanted_until_ = now + command::kHeldJogPatience;
  return true;
}

void ManualMotion::end_jogs() {
  jogs_ = Jogs::kNone;
  waiting_.clear();
}

canonical::Command ManualMotion::reference(const Pose& from) const {
  Pose target = kinematics_.bed_reference();
  target[kE] = from[kE];
  return canonical::Traverse{target, Frame::kMachine};
}

std::optional<Sentence> ManualMotion::in_the_way_to_reference(const Pose& from) {
  way_.jump();
  bool leaving = true;
  return in_the_way(from, kinematics_.bed_reference(), leaving);
}

std::optional<Sentence> ManualMotion::in_the_way(const Pose& from,
                                                 const std::vector<canonical::Line>& moves) {
  bool leaving = true;
  Pose at = from;
  way_.jump();
  for (const canonical::Line& line : moves) {
    if (const auto* traverse = std::get_if<canonical::Traverse>(&line.command)) {
      if (auto near = in_the_way(at, traverse->target, leaving)) return near;
      at = traverse->target;
    } else if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) {
      const auto place = [&](double) { return feed->target; };
      way_.jump();
      const bool stood_so = way_.collision(Frame::kMachine, 0, 0, place).has_value();
      way_.jump();
      if (auto near = stood_so ? std::nullopt : in_the_way(at, feed->target, leaving)) return near;
      at = feed->target;
    }
  }
  return std::nullopt;
}

std::optional<Sentence> ManualMotion::in_the_way(const Pose& from, const Pose& to, bool& leaving) {
  double mm = 0, rad = 0;
  for (const PoseAxis axis : {kX, kY, kZ}) mm = std::hypot(mm, to[axis] - from[axis]);
  for (const PoseAxis axis : {kA, kC}) rad = std::max(rad, std::abs(to[axis] - from[axis]));
  const int steps = checks(mm, rad, 20000);
  const auto at = [&](double i) {
    Pose pose = from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) pose[axis] += (to[axis] - from[axis]) * i / steps;
    return pose;
  };
  for (int i = 0; i <= steps; ++i) {
    auto near = way_.collision(Frame::kMachine, std::max(i - 1, 0), i, at);
    if (near && !leaving) return near;
    leaving = leaving && near;
  }
  return std::nullopt;
}

Sentence ManualMotion::with_way_out(Sentence words) const {
  if (!way_.met_print()) return words;
  return say(
      "%1: what was printed is taken to stand on the table until the next job begins, or the machine is "
      "homed "
      "with no job interrupted",
      std::move(words));
}

std::optional<canonical::Command> ManualMotion::lift(const Pose& from, double z_mm,
                                                     std::optional<Sentence>& kept_from) {
  const double rise_mm = z_mm - from[kZ];
  if (!(rise_mm > kLeastLift)) return std::nullopt;
  const auto steps = static_cast<int>(std::ceil(rise_mm / kLiftStep));
  const auto at = [&](double i) {
    Pose pose = from;
    pose[kZ] += rise_mm * i / steps;
    return pose;
  };
  way_.jump();
  kept_from = way_.broken(Frame::kMachine, 0, 0, at);
  int free = 0;
  while (!kept_from && free < steps) {
    kept_from = way_.broken(Frame::kMachine, free, free + 1, at);
    if (!kept_from) ++free;
  }
  if (rise_mm * free / steps < kLeastLift) return std::nullopt;
  return canonical::Traverse{at(free), Frame::kMachine};
}

void ManualMotion::start(std::vector<canonical::Line> commands, const Pose& from, double override_ratio,
                         Then then) {
  then_ = then;
  runner_.start_commands(std::move(commands), from);
  runner_.set_override(override_ratio);
}

}  // namespace kinebus
