#include "gui/scene/path_reader.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gui {
namespace {

using gcode::kAxisA;
using gcode::kAxisC;
using gcode::kAxisE;
using gcode::kAxisZ;

constexpr int kMaxPieces = 720;
// A move that turns the table while the tool stands in the machine's frame is a curve on the part: within 2
// degrees it leaves its chord by 0.015 mm at 100 mm from the axis.
constexpr double kTurnStep_rad = 2 * std::numbers::pi / 180;
constexpr double kNoExtrusion_mm = 1e-9;
constexpr double kMinutes = 60;

bool turned(const Pose& pose) {
  return pose[kAxisA] != 0 || pose[kAxisC] != 0;
}

Pose between(const Pose& from, const Pose& to, double share) {
  Pose pose = from;
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] += (to[i] - from[i]) * share;
  return pose;
}

}  // namespace

gcode::Options PathReader::any_machine() {
  gcode::Options options;
  options.start = options.home = {0, 0, 20, 0, 0, 0};
  options.default_feed_mm_per_s = 25;
  options.arc_radius_tolerance_mm = 0.01;
  options.a_min_rad = -std::numbers::pi / 2;
  options.a_max_rad = std::numbers::pi / 2;
  options.spindle = true;
  options.tools = 100'000;
  options.probe = gcode::ProbeFitted::kFitted;
  options.retract_length_mm = 0.8;
  options.retract_mm_per_s = options.recover_mm_per_s = 35;
  return options;
}

PathReader::PathReader(Options options)
    : options_(std::move(options)), interpreter_(options_.machine), reader_(interpreter_, 1) {
  at_ = options_.machine.start;
}

void PathReader::add(std::string_view text) {
  features_.add(text);
  while (!text.empty() || reader_.busy()) {
    // Line by line, so that the interpreter's state is that of the commands. What ends the first is not known
    // yet.
    const std::size_t end = reader_.lines() == 0 ? text.find_first_of("\r\n") : text.find(reader_.line_end());
    const std::string_view line =
        reader_.busy() ? std::string_view() : text.substr(0, end == std::string_view::npos ? end : end + 1);
    const bool good = reader_.read(line, commands_).has_value();
    text.remove_prefix(reader_.taken());
    if (!good) reader_.skip_refused();
    drain();
  }
}

ToolPath PathReader::finish() {
  // A last line without an end may be refused; what follows it is the end alone.
  do {
    while (!reader_.finish(commands_)) reader_.skip_refused();
    drain();
  } while (reader_.busy());
  path_.line_count = reader_.lines();
  path_.features = features_.finish();
  path_.refused_lines = reader_.refused();
  // A job that extrudes nothing is a cut: its feed moves are the work.
  if (!extrudes_)
    for (std::size_t i = 0; i < path_.size(); ++i)
      if (path_.feeds_mm_per_min[i] > 0) path_.kinds[i] = PathKind::kWork;
  for (std::size_t i = 1; i < path_.size(); ++i) {
    if (path_.kinds[i] != PathKind::kWork) continue;
    const auto &a = path_.points_mm[i - 1], &b = path_.points_mm[i];
    path_.bounds_mm.add(a);
    path_.bounds_mm.add(b);
    path_.work_length_mm += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  }
  path_.extrudes = extrudes_;
  path_.layers = layers();
  return std::move(path_);
}

void PathReader::drain() {
  if (interpreter_.state().modal.tilted != tilted_) follow_plane();
  for (const canonical::Line& line : commands_) take(line);
  commands_.clear();
}

void PathReader::follow_plane() {
  const gcode::ModalState& m = interpreter_.state().modal;
  if (heights_mm_.empty())
    for (const auto& point : path_.points_mm) heights_mm_.push_back(point[2]);
  planes_.push_back(static_cast<std::uint32_t>(path_.size()));
  tilted_ = m.tilted;
  up_ = {0, 0, 1};
  zero_mm_ = 0;
  if (!tilted_) return;
  up_ = {m.tilt[0][2], m.tilt[1][2], m.tilt[2][2]};
  // In a tilted plane positions are the part's.
  zero_mm_ = up_[0] * m.position[0] + up_[1] * m.position[1] + up_[2] * m.position[2] - m.program[kAxisZ];
}

void PathReader::take(const canonical::Line& line) {
  line_ = line.line;
  if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) {
    straight(feed->target, feed_of(*feed));
  } else if (const auto* traverse = std::get_if<canonical::Traverse>(&line.command)) {
    straight(traverse->target, 0);
  } else if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) {
    turn(*arc);
  } else if (const auto* probe = std::get_if<canonical::Probe>(&line.command)) {
    straight(probe->target, 0);  // as far as it may go
  } else if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) {
    at_ = set->pose;
    frame_ = set->frame;
  } else if (const auto* home = std::get_if<canonical::Home>(&line.command)) {
    Pose target = gcode::in_frame(home->afterwards, home->frame, frame_);
    target[kAxisE] = at_[kAxisE];
    // Homing that begins a job: the path begins where it ends.
    if (path_.size() == 0)
      at_ = target;
    else
      straight(target, 0);
  }
}

/// mm/min; a move of A and C alone: deg/min, as the job wrote it.
double PathReader::feed_of(const canonical::Feed& feed) const {
  const Pose& to = feed.target;
  if (feed.inverse_time_s > 0)
    return std::hypot(to[0] - at_[0], to[1] - at_[1], to[2] - at_[2]) / feed.inverse_time_s * kMinutes;
  const bool turns_alone = to[0] == at_[0] && to[1] == at_[1] && to[2] == at_[2] &&
                           (to[kAxisA] != at_[kAxisA] || to[kAxisC] != at_[kAxisC]);
  return feed.feed_per_s * kMinutes * (turns_alone ? 180 / std::numbers::pi : 1);
}

/// False: nothing to be seen, a retraction for instance.
bool PathReader::begin_move(const Pose& target, bool is_arc) {
  const bool turns = target[kAxisA] != at_[kAxisA] || target[kAxisC] != at_[kAxisC];
  const bool moves = target[0] != at_[0] || target[1] != at_[1] || target[2] != at_[2];
  if (!moves && !turns && !is_arc) return false;
  // The first vertex is where the job begins.
  if (path_.size() == 0) {
    kind_ = PathKind::kTravel;
    put(at_, 0);
  }
  kind_ = target[kAxisE] > at_[kAxisE] + kNoExtrusion_mm ? PathKind::kWork : PathKind::kTravel;
  extrudes_ = extrudes_ || kind_ == PathKind::kWork;
  return true;
}

void PathReader::straight(const Pose& target, double feed_mm_per_min) {
  if (begin_move(target, false)) {
    const double turning =
        std::max(std::abs(target[kAxisA] - at_[kAxisA]), std::abs(target[kAxisC] - at_[kAxisC]));
    if (frame_ == Frame::kMachine && turning > kTurnStep_rad) {
      const int pieces = std::clamp(static_cast<int>(std::ceil(turning / kTurnStep_rad)), 1, kMaxPieces);
      for (int i = 1; i < pieces; ++i)
        put(between(at_, target, static_cast<double>(i) / pieces), feed_mm_per_min);
    }
    put(target, feed_mm_per_min);
  }
  at_ = target;
}

void PathReader::turn(const canonical::Arc& arc) {
  begin_move(arc.target, true);
  using gcode::operator-;
  const gcode::Vector3 start = gcode::xyz(at_) - arc.centre_mm;
  const auto& n = arc.normal;
  // The start as seen from the axis: along it, and across; side is a quarter turn ahead.
  const double along = start[0] * n[0] + start[1] * n[1] + start[2] * n[2];
  const gcode::Vector3 across = {start[0] - along * n[0], start[1] - along * n[1], start[2] - along * n[2]};
  const gcode::Vector3 side = {n[1] * across[2] - n[2] * across[1], n[2] * across[0] - n[0] * across[2],
                               n[0] * across[1] - n[1] * across[0]};
  const gcode::Vector3 way = gcode::xyz(arc.target) - gcode::xyz(at_);
  const double rise = way[0] * n[0] + way[1] * n[1] + way[2] * n[2];
  const double radius = gcode::norm(across), tolerance = options_.arc_tolerance_mm;
  const double feed =
      kMinutes * (arc.inverse_time_s > 0 ? radius * arc.sweep_rad / arc.inverse_time_s : arc.feed_per_s);
  const double step = radius > tolerance ? 2 * std::acos(1 - tolerance / radius) : std::numbers::pi / 4;
  // A turn of many turns is drawn coarser, never without an end.
  const int pieces =
      std::clamp(static_cast<int>(std::ceil(std::min(arc.sweep_rad / step, 1e6))), 1, kMaxPieces);
  for (int i = 1; i < pieces; ++i) {
    const double share = static_cast<double>(i) / pieces, angle = arc.sweep_rad * share;
    Pose pose = between(at_, arc.target, share);
    for (std::size_t axis = 0; axis < 3; ++axis)
      pose[axis] = arc.centre_mm[axis] + (along + rise * share) * n[axis] + std::cos(angle) * across[axis] +
                   std::sin(angle) * side[axis];
    put(pose, feed);
  }
  put(arc.target, feed);
  at_ = arc.target;
}

void PathReader::put(const Pose& pose, double feed_mm_per_min) {
  const bool turns = turned(pose);
  const Pose part =
      frame_ == Frame::kMachine && turns ? gcode::in_frame(pose, Frame::kMachine, Frame::kPart) : pose;
  if (turns && path_.tilts_rad.empty()) path_.tilts_rad.assign(path_.size(), {0.0F, 0.0F});
  if (turns || !path_.tilts_rad.empty())
    path_.tilts_rad.push_back({static_cast<float>(pose[kAxisA]), static_cast<float>(pose[kAxisC])});
  path_.points_mm.push_back(
      {static_cast<float>(part[0]), static_cast<float>(part[1]), static_cast<float>(part[2])});
  path_.lines.push_back(line_);
  path_.kinds.push_back(kind_);
  path_.feeds_mm_per_min.push_back(
      feed_mm_per_min > 0 ? static_cast<std::uint16_t>(std::lround(std::clamp(feed_mm_per_min, 1.0, 65535.0)))
                          : std::uint16_t{0});
  if (!planes_.empty())
    heights_mm_.push_back(
        static_cast<float>(up_[0] * part[0] + up_[1] * part[1] + up_[2] * part[2] - zero_mm_));
}

std::vector<PathLayer> PathReader::layers() const {
  std::vector<PathLayer> found;
  const auto count = static_cast<std::uint32_t>(path_.size());
  std::size_t plane = 0, plane_of_layer = 0;  // how many of planes_ began
  for (std::uint32_t i = 1; i < count; ++i) {
    while (plane < planes_.size() && planes_[plane] <= i) ++plane;
    if (path_.kinds[i] != PathKind::kWork) continue;
    const float z = heights_mm_.empty() ? path_.points_mm[i][2] : heights_mm_[i];
    const bool first = found.empty();
    if (!first && plane == plane_of_layer && std::abs(z - found.back().z_mm) < options_.layer_height_min_mm)
      continue;
    // A layer begins where the travel to it begins, so that every vertex is in one.
    std::uint32_t begin = i;
    while (begin > 0 && path_.kinds[begin - 1] == PathKind::kTravel) --begin;
    if (!first) begin = std::max(begin, found.back().first + 1);
    if (first) begin = 0;
    if (!first) found.back().last = begin;
    found.push_back({begin, count, z});
    plane_of_layer = plane;
  }
  if (found.empty() && count > 0) found.push_back({0, count, path_.points_mm.front()[2]});
  return found;
}

}  // namespace kinebus::gui
