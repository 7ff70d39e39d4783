#include "gateway/gcode/curves/turning.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace kinebus::gcode {
namespace {

using Contour = std::vector<Curve>;

// Lengths below this are rounding of text and arithmetic, mm.
constexpr double kRounding_mm = 1e-6;
// Directions that differ by less go on in one line, rad.
constexpr double kTangent = 1e-6;
constexpr std::size_t kAlong = 0, kUp = 1;

/// Into coordinates in which cuts go towards greater `along` and the tool comes from greater `up`; and back.
class Axes {
 public:
  Axes(bool facing, double along_sign, double up_sign)
      : along_(facing ? 1 : 0), along_sign_(along_sign), up_sign_(up_sign) {}
  Point2 in(const Point2& p) const { return {along_sign_ * p[along_], up_sign_ * p[1 - along_]}; }
  Point2 out(const Point2& p) const {
    Point2 given{};
    given[along_] = along_sign_ * p[kAlong];
    given[1 - along_] = up_sign_ * p[kUp];
    return given;
  }
  Curve in(Curve curve) const {
    return mapped(curve, [this](const Point2& p) { return in(p); });
  }
  Curve out(Curve curve) const {
    return mapped(curve, [this](const Point2& p) { return out(p); });
  }

 private:
  template <class Map>
  Curve mapped(Curve curve, Map map) const {
    curve.from = map(curve.from), curve.to = map(curve.to), curve.centre = map(curve.centre);
    const bool mirrored = (along_ == 1) != (along_sign_ * up_sign_ < 0);
    if (mirrored) curve.turn = -curve.turn;
    return curve;
  }
  std::size_t along_;
  double along_sign_, up_sign_;
};

Curve line(const Point2& from, const Point2& to) {
  Curve curve;
  curve.from = from, curve.to = to;
  return curve;
}

bool has_length(const Curve& curve) {
  return length_of(curve.to - curve.from) > kRounding_mm ||
         (curve.arc && curve.radius * curve.sweep > kRounding_mm);
}

/// How far along an arc a point is that rounding may have put beside its ends.
double place_on(const Curve& arc, const Point2& point) {
  const double at = distance_along(arc, point), end = arc.radius * arc.sweep;
  const double behind_the_gap = (end + 2 * std::numbers::pi * arc.radius) / 2;
  return at > behind_the_gap ? 0 : std::min(at, end);
}

/// The part of a curve between two of its points, in its order.
Curve part(const Curve& curve, const Point2& from, const Point2& to) {
  if (length_of(to - from) <= kRounding_mm) return line(from, to);
  Curve piece = curve;
  piece.from = from, piece.to = to;
  if (curve.arc) piece.sweep = std::max(0.0, place_on(curve, to) - place_on(curve, from)) / curve.radius;
  return piece;
}

/// The points of an arc that are farthest along one of the two axes, in its order.
std::vector<Point2> extremes(const Curve& curve, std::size_t axis) {
  std::vector<Point2> found;
  if (!curve.arc) return found;
  for (const double side : {1.0, -1.0}) {
    Point2 point = curve.centre;
    point[axis] += side * curve.radius;
    const double at = distance_along(curve, point), end = curve.radius * curve.sweep;
    if (at > kRounding_mm && at < end - kRounding_mm) found.push_back(point);
  }
  std::sort(found.begin(), found.end(), [&](const Point2& a, const Point2& b) {
    return distance_along(curve, a) < distance_along(curve, b);
  });
  return found;
}

/// Pieces that only rise or only fall.
Contour split(const Contour& contour) {
  Contour pieces;
  for (const Curve& curve : contour) {
    Point2 from = curve.from;
    for (const Point2& top : extremes(curve, kUp)) {
      pieces.push_back(part(curve, from, top));
      from = top;
    }
    pieces.push_back(part(curve, from, curve.to));
  }
  return pieces;
}

bool turns_back(const Contour& contour) {
  return std::any_of(contour.begin(), contour.end(), [](const Curve& curve) {
    if (curve.to[kAlong] < curve.from[kAlong] - kRounding_mm) return true;
    if (!curve.arc) return false;
    if (curve.sweep > std::numbers::pi + kTangent) return true;
    const auto tops = extremes(curve, kAlong);
    return std::any_of(tops.begin(), tops.end(), [&](const Point2& top) {
      return top[kAlong] > curve.to[kAlong] + kRounding_mm || top[kAlong] < curve.from[kAlong] - kRounding_mm;
    });
  });
}

/// Where the curves meet on both, the nearest to the end of the first.
std::optional<Point2> corner(const Curve& a, const Curve& b) {
  std::optional<Point2> best;
  const Meetings met = meetings(a, b);
  for (std::size_t i = 0; i < static_cast<std::size_t>(met.count); ++i) {
    const Point2& point = met.points[i];
    if (!lies_on(a, point) || !lies_on(b, point)) continue;
    if (!best || length_of(point - a.to) < length_of(*best - a.to)) best = point;
  }
  return best;
}

/// The contour at `left_mm` to its left: arcs around outside corners, and inside ones to where the pieces
/// meet. Nothing where a piece does not fit.
std::optional<Contour> beside(const Contour& contour, double left_mm) {
  if (std::abs(left_mm) <= kRounding_mm) return contour;
  Contour moved;
  const Curve* before = nullptr;
  for (const Curve& curve : contour) {
    Curve next = offset(curve, left_mm);
    if (next.arc && !(next.radius > kRounding_mm)) return std::nullopt;
    if (before != nullptr) {
      const double bend = cross(direction_at_end(*before), direction_at_start(curve)),
                   same_way = dot(direction_at_end(*before), direction_at_start(curve));
      const double angle = std::atan2(bend, same_way);
      if (angle * left_mm < 0 && std::abs(angle) > kTangent) {
        Curve round = line(moved.back().to, next.from);
        round.arc = true;
        round.centre = curve.from;
        round.radius = std::abs(left_mm);
        round.turn = angle < 0 ? -1 : 1;
        round.sweep = std::abs(angle);
        moved.push_back(round);
      } else if (std::abs(angle) > kTangent) {
        const auto met = corner(moved.back(), next);
        if (!met) return std::nullopt;
        moved.back() = part(moved.back(), moved.back().from, *met);
        next = part(next, *met, next.to);
      }
    }
    moved.push_back(next);
    before = &curve;
  }
  return moved;
}

/// Where a rising or falling piece is at this height; it has it.
Point2 at_height(const Curve& curve, double up) {
  if (!curve.arc) {
    const double t = (up - curve.from[kUp]) / (curve.to[kUp] - curve.from[kUp]);
    return {curve.from[kAlong] + (curve.to[kAlong] - curve.from[kAlong]) * std::clamp(t, 0.0, 1.0), up};
  }
  const double height = std::clamp(up - curve.centre[kUp], -curve.radius, curve.radius);
  const double half = std::sqrt(std::max(0.0, curve.radius * curve.radius - height * height));
  const Point2 right{curve.centre[kAlong] + half, up}, left{curve.centre[kAlong] - half, up};
  // It does not come by both. Of two that rounding has put beside its ends the nearer one.
  const auto off = [&curve](const Point2& point) {
    return lies_on(curve, point) ? 0.0 : std::min(length_of(point - curve.from), length_of(point - curve.to));
  };
  return off(right) <= off(left) ? right : left;
}

/// Bridges pockets: where the contour falls it goes straight on at the height that it has.
Contour without_pockets(const Contour& pieces) {
  Contour bridged;
  std::optional<Point2> edge;
  for (const Curve& piece : pieces) {
    const bool falls = piece.to[kUp] < piece.from[kUp] - kRounding_mm;
    if (!edge && !falls) {
      bridged.push_back(piece);
      continue;
    }
    if (!edge) edge = piece.from;
    if (piece.to[kUp] < (*edge)[kUp] - kRounding_mm) continue;
    const Point2 far = falls || piece.to[kUp] <= (*edge)[kUp] ? piece.to : at_height(piece, (*edge)[kUp]);
    bridged.push_back(line(*edge, far));
    bridged.push_back(part(piece, far, piece.to));
    edge.reset();
  }
  if (edge) bridged.push_back(line(*edge, {pieces.back().to[kAlong], (*edge)[kUp]}));
  return bridged;
}

/// Carries the cuts out, piece by piece.
class Cutter {
 public:
  Cutter(const Turning& turning, const Point2& start, std::vector<TurningMove>& moves)
      : turning_(turning), here_(start), top_(start[kUp]), moves_(moves) {}

  bool fits() const { return moves_.size() <= kMostTurningMoves; }

  void go(const Point2& to, bool traverse) {
    if (length_of(to - here_) > kRounding_mm) moves_.push_back({line(here_, to), traverse});
    here_ = to;
  }
  void follow(const Curve& curve) {
    if (has_length(curve)) moves_.push_back({curve, false});
    here_ = curve.to;
  }
  /// From `begin` on every height on this falling piece from which a cut goes out; then its end.
  void fall(const Contour& pieces, std::size_t index, bool entry) {
    const Curve& piece = index == kEntry ? entry_ : pieces[index];
    if (!entry && !falling_) top_ = turning_.what == Turning::What::kPockets ? piece.from[kUp] : top_;
    falling_ = true;
    const double deepest = piece.to[kUp] + kRounding_mm;
    const double first = std::ceil((top_ - piece.from[kUp]) / turning_.depth_mm - kRounding_mm);
    Point2 at = piece.from;
    const bool cuts = !entry || turning_.what != Turning::What::kPockets;
    for (double k = first; cuts && fits() && top_ - k * turning_.depth_mm > deepest; ++k) {
      const double height = std::min(top_ - k * turning_.depth_mm, piece.from[kUp]);
      const Point2 begin = at_height(piece, height);
      if (entry)
        go(begin, true);
      else
        follow(part(piece, at, begin));
      at = begin;
      cut(pieces, entry ? 0 : index + 1, begin, entry);
    }
    if (entry)
      go(piece.to, true);
    else
      follow(part(piece, at, piece.to));
  }
  void rest(const Curve& piece) {
    falling_ = false;
    follow(piece);
  }
  void set_entry(const Curve& entry) { entry_ = entry; }

  static constexpr std::size_t kEntry = static_cast<std::size_t>(-1);

 private:
  void cut(const Contour& pieces, std::size_t from, const Point2& begin, bool entry) {
    Point2 end{pieces.back().to[kAlong], begin[kUp]};
    for (std::size_t i = from; i < pieces.size(); ++i) {
      // A top that the cut only touches does not end it.
      if (pieces[i].to[kUp] <= begin[kUp] + kRounding_mm || pieces[i].from[kUp] > begin[kUp] + kRounding_mm)
        continue;
      end = at_height(pieces[i], begin[kUp]);
      break;
    }
    const double wide = end[kAlong] - begin[kAlong];
    if (!(wide > kRounding_mm)) return;
    const double back = std::min(turning_.retract_mm, wide / 2);
    go(end, false);
    go({end[kAlong] - back, end[kUp] + back}, true);
    go({begin[kAlong] + back, begin[kUp] + back}, true);
    go(begin, entry);
  }

  const Turning& turning_;
  Point2 here_;
  double top_;
  bool falling_ = false;
  Curve entry_;
  std::vector<TurningMove>& moves_;
};

double sign(double value, double otherwise) {
  return std::abs(value) > kRounding_mm ? std::copysign(1.0, value) : otherwise;
}

Sentence no_room() {
  return say("the allowance D does not fit into this profile: an inside corner or arc is too narrow for it");
}

Result<std::vector<TurningMove>, Sentence> rough(const std::vector<Curve>& profile, const Point2& start,
                                                 const Turning& turning) {
  const std::size_t along = turning.facing ? 1 : 0, up = 1 - along;
  const Point2 &first = profile.front().to, &last = profile.back().to;
  const Axes axes(turning.facing, sign(last[along] - first[along], sign(first[along] - start[along], 1)),
                  sign(start[up] - first[up], sign(last[up] - first[up], 1)));
  const Point2 from = axes.in(start);
  Contour contour;
  // A way to the profile that does not go down is a cut of its own.
  const bool comes_down = axes.in(first)[kUp] < from[kUp] - kRounding_mm;
  for (std::size_t i = comes_down ? 1 : 0; i < profile.size(); ++i)
    if (has_length(profile[i])) contour.push_back(axes.in(profile[i]));
  if (contour.empty()) return Error<Sentence>(say("the profile has no move behind the one that goes to it"));
  if (turns_back(contour))
    return Error<Sentence>(turning.facing ? say("the profile turns back along X: G72 cannot cut it")
                                          : say("the profile turns back along Z: G71 cannot cut it"));
  auto moved = beside(contour, turning.allowance_mm);
  if (!moved) return Error<Sentence>(no_room());
  // A profile that falls from its beginning on is come round to: beside it the tool would stand in the stock.
  if (comes_down && moved->front().from[kAlong] > contour.front().from[kAlong] + kRounding_mm) {
    const Point2 corner = contour.front().from;
    Curve round = line({corner[kAlong], corner[kUp] + turning.allowance_mm}, moved->front().from);
    round.arc = true;
    round.turn = -1;
    round.centre = corner;
    round.radius = turning.allowance_mm;
    round.sweep =
        -std::atan2(direction_at_start(contour.front())[kUp], direction_at_start(contour.front())[kAlong]);
    moved->insert(moved->begin(), round);
  }
  Contour pieces = split(*moved);
  if (turning.what == Turning::What::kOutside) pieces = split(without_pockets(pieces));
  if (pieces.back().to[kUp] < from[kUp] - kRounding_mm)
    pieces.push_back(line(pieces.back().to, {pieces.back().to[kAlong], from[kUp]}));

  std::vector<TurningMove> moves;
  Cutter cutter(turning, from, moves);
  // Not from behind the profile: the tool would come through it.
  const Point2 above{std::min(from[kAlong], axes.in(first)[kAlong]), from[kUp]};
  const Point2 begin = pieces.front().from;
  if (comes_down) {
    if ((from[kUp] - begin[kUp]) / turning.depth_mm > static_cast<double>(kMostTurningMoves))
      return Error<Sentence>(say("the depth of a cut I is far too small for this profile"));
    cutter.go(above, true);
    cutter.set_entry(line(above, begin));
    cutter.fall(pieces, Cutter::kEntry, true);
  } else {
    cutter.go(begin, true);
  }
  for (std::size_t i = 0; i < pieces.size() && cutter.fits(); ++i) {
    if (pieces[i].to[kUp] < pieces[i].from[kUp] - kRounding_mm)
      cutter.fall(pieces, i, false);
    else
      cutter.rest(pieces[i]);
  }
  if (!cutter.fits()) return Error<Sentence>(say("the depth of a cut I is far too small for this profile"));
  for (TurningMove& move : moves) move.curve = axes.out(move.curve);
  return moves;
}

Result<std::vector<TurningMove>, Sentence> finish(const std::vector<Curve>& profile, const Point2& start,
                                                  const Turning& turning) {
  Contour contour;
  for (std::size_t i = 1; i < profile.size(); ++i)
    if (has_length(profile[i])) contour.push_back(profile[i]);
  if (contour.empty()) return Error<Sentence>(say("the profile has no move behind the one that goes to it"));
  const Point2 &first = profile.front().to, &last = profile.back().to;
  const Point2 way = direction_at_start(contour.front());
  const double side = cross(way, start - first) < 0 ? -1 : 1;
  // From behind the profile's beginning the tool first goes along u, where that keeps it on its side.
  const Point2 beside_first{first[0], start[1]};
  const bool behind = (start[0] - first[0]) * (last[0] - first[0]) > 0;
  const bool goes_along = behind && cross(way, beside_first - first) * side > 0;
  std::vector<TurningMove> moves;
  Cutter cutter(turning, start, moves);
  for (int pass = 1; pass <= turning.passes; ++pass) {
    const double left =
        turning.allowance_mm - pass * (turning.allowance_mm - turning.last_mm) / turning.passes;
    const auto moved = beside(contour, side * left);
    if (!moved) return Error<Sentence>(no_room());
    cutter.go(start, true);
    if (goes_along) cutter.go(beside_first, true);
    cutter.go(moved->front().from, true);
    for (const Curve& curve : *moved) cutter.follow(curve);
    if (!cutter.fits()) return Error<Sentence>(say("G70 has too many passes P for this profile"));
  }
  return moves;
}

}  // namespace

Result<std::vector<TurningMove>, Sentence> turn(const std::vector<Curve>& profile, const Point2& start,
                                                const Turning& turning) {
  if (profile.empty()) return Error<Sentence>(say("the profile has no move behind the one that goes to it"));
  return turning.what == Turning::What::kFinish ? finish(profile, start, turning)
                                                : rough(profile, start, turning);
}

}  // namespace kinebus::gcode
