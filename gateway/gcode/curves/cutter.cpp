#include "gateway/gcode/curves/cutter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace kinebus::gcode {
namespace {

constexpr double kStill_mm = 1e-9;
// Ends that miss one another by less are joined: less than anything follows, more than rounding makes.
constexpr double kJoin_mm = 1e-5;
// How much farther from a flat outside corner the tool may be than its radius, so that a curve of many short
// lines gets no arc at each.
constexpr double kMiter_mm = 1e-4;
constexpr double kHalfTurn = std::numbers::pi;

constexpr std::size_t kExtruder = 5;

double axis_dot(const Pose& pose, const CutterPath::Axis3& axis) {
  return pose[0] * axis[0] + pose[1] * axis[1] + pose[2] * axis[2];
}

Pose* target_of(canonical::Command& command) {
  if (auto* move = std::get_if<canonical::Traverse>(&command)) return &move->target;
  if (auto* move = std::get_if<canonical::Feed>(&command)) return &move->target;
  if (auto* move = std::get_if<canonical::Arc>(&command)) return &move->target;
  return nullptr;
}

/// What has no place in the order of motion, or must not wait.
bool passes_at_once(const canonical::Command& command) {
  return std::holds_alternative<canonical::Query>(command) ||
         std::holds_alternative<canonical::EmergencyStop>(command) ||
         std::holds_alternative<canonical::StoredJob>(command) ||
         std::holds_alternative<canonical::Settings>(command);
}

double speed_of(const canonical::Command& command) {
  if (const auto* move = std::get_if<canonical::Feed>(&command)) return move->feed_per_s;
  if (const auto* move = std::get_if<canonical::Traverse>(&command)) return move->speed_per_s;
  if (const auto* move = std::get_if<canonical::Arc>(&command)) return move->feed_per_s;
  return 0;
}

std::string in_mm(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.4g mm", value);
  return text.data();
}

bool refuse(Sentence& error, Sentence words) {
  error = std::move(words);
  return false;
}

}  // namespace

Point2 CutterPath::plane(const Pose& pose) const {
  return {axis_dot(pose, u_), axis_dot(pose, v_)};
}
double CutterPath::height(const Pose& pose) const {
  return axis_dot(pose, w_);
}
Pose CutterPath::with_plane(const Pose& pose, const Point2& point) const {
  Pose moved = pose;
  const double w = height(pose);
  for (std::size_t i = 0; i < 3; ++i) moved[i] = u_[i] * point[0] + v_[i] * point[1] + w_[i] * w;
  return moved;
}

void CutterPath::begin(CutterSide side, double radius_mm, const Axis3& u, const Axis3& v, const Axis3& w,
                       const Pose& tool, Frame frame, const Point2& tip) {
  *this = {};
  left_mm_ = side == CutterSide::kLeft ? radius_mm : -radius_mm;
  u_ = u;
  v_ = v;
  w_ = w;
  frame_ = frame;
  tip_ = tip;
  tool_ = programmed_ = tool;
}

bool CutterPath::end(std::vector<canonical::Line>& out, Sentence& error) {
  const bool good = !has_last_ || flush(last_.tool.to, out, error);
  has_last_ = false;
  return good;
}

bool CutterPath::take(canonical::Line line, std::vector<canonical::Line>& out, Sentence& error) {
  if (Pose* const target = target_of(line.command)) return take_move(line, *target, out, error);
  if (!has_last_ || passes_at_once(line.command)) {
    out.push_back(std::move(line));
    return true;
  }
  if (held_.size() >= kMostHeld)
    return refuse(error, say("more than %1 lines without a move in the plane while cutter compensation is on",
                             kMostHeld));
  held_.push_back(std::move(line));
  return true;
}

bool CutterPath::take_move(canonical::Line& line, Pose& target, std::vector<canonical::Line>& out,
                           Sentence& error) {
  for (const std::size_t axis : {3U, 4U})
    if (std::abs(target[axis] - programmed_[axis]) > kStill_mm)
      return refuse(error, say("%1 cannot stand while cutter compensation is on: end it with G40 first",
                               axis == 3 ? "A" : "C"));
  const bool still = !std::holds_alternative<canonical::Arc>(line.command) &&
                     length_of(plane(target) - plane(programmed_)) <= kStill_mm;
  if (still) {
    if (std::abs(height(target) - height(programmed_)) > kStill_mm) apart_ = true;
    programmed_ = target;
    if (has_last_) {
      if (held_.size() >= kMostHeld)
        return refuse(
            error,
            say("more than %1 lines without a move in the plane while cutter compensation is on", kMostHeld));
      held_.push_back(std::move(line));
      return true;
    }
    tool_ = target;
    out.push_back(std::move(line));
    return true;
  }
  Piece next;
  if (!read(line, target, next, error)) return false;
  std::optional<Curve> round;
  if (!has_last_ && next.wall.arc && length_of(tip_) > 0) centre_first(next, speed_of(line.command), out);
  const bool good =
      has_last_ ? turn_corner(next, speed_of(line.command), round, out, error) : enter(next, error);
  if (!good) return false;
  keep_wall(next);
  if (round && !keep_track(*round, true, error)) return false;
  last_ = next;
  has_last_ = true;
  programmed_ = target;
  held_.clear();
  held_.push_back(std::move(line));
  return true;
}

bool CutterPath::read(const canonical::Line& line, const Pose& target, Piece& next, Sentence& error) const {
  next.line = line.line;
  next.traverse = std::holds_alternative<canonical::Traverse>(line.command);
  next.level = std::abs(height(target) - height(programmed_)) <= kStill_mm;
  next.entry = !has_last_;
  next.wall.from = plane(programmed_);
  next.wall.to = plane(target);
  if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) {
    Pose centre{};
    std::copy(arc->centre_mm.begin(), arc->centre_mm.end(), centre.begin());
    next.wall.arc = true;
    next.wall.centre = plane(centre);
    next.wall.radius = length_of(next.wall.from - next.wall.centre);
    next.wall.sweep = arc->sweep_rad;
    Pose normal{};
    std::copy(arc->normal.begin(), arc->normal.end(), normal.begin());
    next.wall.turn = height(normal) > 0 ? 1 : -1;
  }
  next.tool = offset(next.wall, left_mm_);
  next.start = next.tool.from;
  if (next.wall.arc && !(next.tool.radius > kJoin_mm))
    return refuse(error, say("the arc's radius of %1 is not greater than the tool's, %2, on its inside",
                             in_mm(next.wall.radius), in_mm(std::abs(left_mm_))));
  return true;
}

/// Before an arc as lead-in a lathe's tool goes so that its middle is where the arc begins, as LinuxCNC has
/// it.
void CutterPath::centre_first(const Piece& next, double speed_per_s, std::vector<canonical::Line>& out) {
  tool_ = with_centre(tool_, plane(tool_));
  out.push_back({next.line, canonical::Feed{tool_, frame_, speed_per_s, 0}});
}

/// The lead-in: from where the tool is to beside the first move's end.
bool CutterPath::enter(Piece& next, Sentence& error) const {
  const double radius = std::abs(left_mm_);
  const double size = next.wall.arc ? next.wall.radius : length_of(next.wall.to - next.wall.from);
  if (!(size > radius))
    return refuse(
        error,
        next.wall.arc
            ? say("the lead-in is too tight: the arc's radius of %1 is not greater than the tool's, %2",
                  in_mm(size), in_mm(radius))
            : say("the lead-in is too short: the first move is %1 long, not more than the tool's "
                  "radius, %2",
                  in_mm(size), in_mm(radius)));
  next.start = plane(tool_) - tip_;
  if (!next.wall.arc) return true;
  // The circle through both that has the programmed arc's direction at the end.
  const Point2 end = next.tool.to, way = next.start - end;
  const Point2 inward = left_of(direction_at_end(next.wall)) * next.wall.turn;
  const double depth = dot(way, inward);
  if (!(depth > kStill_mm))
    return refuse(error, say("no lead-in arc of this direction leads from here to beside the path"));
  const double tool_radius = dot(way, way) / (2 * depth);
  next.tool.radius = tool_radius;
  next.tool.centre = end + inward * tool_radius;
  next.tool.from = next.start;
  const Point2 a = next.start - next.tool.centre, b = end - next.tool.centre;
  double sweep = next.wall.turn * std::atan2(cross(a, b), dot(a, b));
  if (sweep <= 0) sweep += 2 * kHalfTurn;
  next.tool.sweep = sweep;
  return true;
}

/// Ends the last move where the corner to `next` says, and brings the tool to where that one begins.
bool CutterPath::turn_corner(Piece& next, double speed_per_s, std::optional<Curve>& round,
                             std::vector<canonical::Line>& out, Sentence& error) {
  const double radius = std::abs(left_mm_);
  const Point2 before = direction_at_end(last_.wall), after = direction_at_start(next.wall);
  const double angle = std::atan2(cross(before, after), dot(before, after));
  const double half = std::abs(angle) / 2;
  // Where an arc goes on smoothly but for its last digits, what is too near is of the second order.
  const bool smooth = (last_.wall.arc || next.wall.arc) && radius * (1 - std::cos(angle)) <= kJoin_mm;
  if (smooth || 2 * radius * std::sin(half) <= kJoin_mm) {
    next.start = last_.tool.to;
    return flush(last_.tool.to, out, error);
  }
  const bool back = std::abs(angle) > kHalfTurn - 1e-9;
  if (!back && angle * left_mm_ > 0) {
    Point2 corner{};
    if (!meet_inside(next, corner))
      return refuse(error, say("the tool, of radius %1, does not come into the inside corner between line %2 "
                               "and this one without cutting into them",
                               in_mm(radius), last_.line));
    next.start = corner;
    return flush(corner, out, error);
  }
  if (!last_.wall.arc && !next.wall.arc && half < kHalfTurn / 4 &&
      radius * (1 / std::cos(half) - 1) <= kMiter_mm) {
    const Point2 corner = last_.tool.to + before * (radius * std::tan(half));
    next.start = corner;
    return flush(corner, out, error);
  }
  const Point2 end = last_.tool.to;
  if (!flush(end, out, error)) return false;
  go_round(next.wall.from, std::abs(angle), next, speed_per_s, out);
  if (next.traverse) return true;
  round.emplace();
  round->arc = true;
  round->centre = next.wall.from;
  round->radius = radius;
  round->turn = left_mm_ > 0 ? -1 : 1;
  round->sweep = std::abs(angle);
  round->from = end;
  round->to = next.tool.from;
  return true;
}

/// About an outside corner, to where `next` begins.
void CutterPath::go_round(const Point2& corner, double angle, const Piece& next, double speed_per_s,
                          std::vector<canonical::Line>& out) {
  const auto give = [&](const Point2& to, canonical::Command command) {
    tool_ = with_centre(tool_, to);
    *target_of(command) = tool_;
    out.push_back({next.line, std::move(command)});
  };
  if (!next.traverse) {
    canonical::Arc arc;
    arc.frame = frame_;
    const Pose centre = with_centre(tool_, corner);
    std::copy_n(centre.begin(), arc.centre_mm.size(), arc.centre_mm.begin());
    const double turn = left_mm_ > 0 ? -1 : 1;
    for (std::size_t i = 0; i < 3; ++i) arc.normal[i] = turn * w_[i];
    arc.sweep_rad = angle;
    arc.feed_per_s = speed_per_s;
    give(next.tool.from, arc);
    return;
  }
  // Traverses have no arcs: lines that touch the circle on its outside.
  const int corners = angle > kHalfTurn / 2 ? 2 : 1;
  const double step = (left_mm_ > 0 ? -1 : 1) * angle / corners;
  const double farther = 1 / std::cos(step / 2);
  const Point2 spoke = last_.tool.to - corner;
  for (int i = 0; i < corners; ++i) {
    const double at = step * (i + 0.5);
    const Point2 turned = spoke * std::cos(at) + left_of(spoke) * std::sin(at);
    give(corner + turned * farther, canonical::Traverse{{}, frame_, speed_per_s});
  }
  give(next.tool.from, canonical::Traverse{{}, frame_, speed_per_s});
}

/// Cuts the ends of both paths off where they meet. False: they do not, before the other ends.
bool CutterPath::meet_inside(Piece& next, Point2& corner) const {
  const Curve& last = last_.tool;
  const double last_length = last.arc ? last.radius * last.sweep : length_of(last.to - last.from);
  const double next_length =
      next.tool.arc ? next.tool.radius * next.tool.sweep : length_of(next.tool.to - next.tool.from);
  const Meetings met = meetings(last, next.tool);
  double least = -1, from_start = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(met.count); ++i) {
    const Point2& point = met.points[i];
    // From the last one's end back, and from the next one's start on.
    Curve reversed = last;
    std::swap(reversed.from, reversed.to);
    reversed.turn = -last.turn;
    const double cut = distance_along(reversed, point), start = distance_along(next.tool, point);
    if (cut < -kStill_mm || start < -kStill_mm || start > next_length + kStill_mm) continue;
    if (last.arc && cut > last_length + kStill_mm) continue;
    if (least >= 0 && cut + start >= least) continue;
    least = cut + start;
    from_start = start;
    corner = point;
  }
  if (least < 0) return false;
  // What is left of the last one still leads forward.
  if (!last.arc && dot(corner - last_.start, last_.tool.to - last_.start) < -kStill_mm) return false;
  next.tool.from = corner;
  if (next.tool.arc) next.tool.sweep = std::max(0.0, next.tool.sweep - from_start / next.tool.radius);
  return true;
}

/// Gives out what is held: the last move ends at `end`.
bool CutterPath::flush(const Point2& end, std::vector<canonical::Line>& out, Sentence& error) {
  Curve track = last_.tool;
  track.from = last_.start;
  if (track.arc && length_of(end - track.to) > kStill_mm) {
    Curve reversed = last_.tool;
    std::swap(reversed.from, reversed.to);
    reversed.turn = -reversed.turn;
    track.sweep = std::max(0.0, track.sweep - distance_along(reversed, end) / track.radius);
  }
  track.to = end;
  if (track.arc) {
    const Point2 from = track.from - track.centre, nominal = last_.tool.from - track.centre;
    track.sweep =
        std::max(0.0, track.sweep + track.turn * std::atan2(cross(from, nominal), dot(from, nominal)));
  }
  bool first = true;
  for (canonical::Line& line : held_) {
    Pose* const target = target_of(line.command);
    if (target == nullptr) {
      out.push_back(std::move(line));
      continue;
    }
    *target = with_centre(*target, end);
    if (auto* arc = std::get_if<canonical::Arc>(&line.command); arc != nullptr && first) {
      Pose centre{};
      std::copy(arc->centre_mm.begin(), arc->centre_mm.end(), centre.begin());
      centre = with_centre(centre, track.centre);
      std::copy_n(centre.begin(), arc->centre_mm.size(), arc->centre_mm.begin());
      arc->sweep_rad = track.sweep;
      if (track.sweep * track.radius <= kStill_mm)
        line.command = canonical::Feed{arc->target, arc->frame, arc->feed_per_s, 0};
    }
    first = false;
    const Pose& to = *target_of(line.command);
    double most = std::abs(to[kExtruder] - tool_[kExtruder]);
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, std::abs(to[i] - tool_[i]));
    const bool moves = most > kStill_mm || std::holds_alternative<canonical::Arc>(line.command);
    tool_ = to;
    if (moves) out.push_back(std::move(line));
  }
  held_.clear();
  if (last_.entry || last_.traverse || !last_.level) return true;
  const bool point =
      track.arc ? track.sweep * track.radius <= kStill_mm : length_of(track.to - track.from) <= kStill_mm;
  return point || keep_track(track, false, error);
}

}  // namespace kinebus::gcode
