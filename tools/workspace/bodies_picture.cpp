#include "tools/workspace/bodies_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "tools/drawing/colour.hpp"
#include "tools/drawing/faces.hpp"

namespace kinebus::workspace {
namespace {

using bodies::BodyKind;
using bodies::Shape;
using bodies::Vec;
using Colour = std::array<double, 3>;

constexpr Colour kNear{214, 40, 48};
// Long bodies are drawn in pieces: nearer pieces of one hide farther pieces of another.
constexpr double kPiece_mm = 40;

Colour colour_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::kLeg:
      return {70, 78, 88};
    case BodyKind::kCarriage:
      return {24, 140, 166};
    case BodyKind::kRail:
      return {196, 202, 210};
    case BodyKind::kTable:
      return {112, 122, 134};
    case BodyKind::kTool:
      return {222, 176, 76};
    case BodyKind::kHolder:
      return {150, 156, 164};
    case BodyKind::kFixed:
      return {178, 140, 190};
    default:
      return {160, 170, 180};
  }
}

/// What is not drawn: the ground under all, and the room that is kept for a part.
bool hidden(BodyKind kind) {
  return kind == BodyKind::kFloor || kind == BodyKind::kPart;
}

Vec unit(const Vec& v) {
  return (1 / bodies::norm(v)) * v;
}

class Panel {
 public:
  Panel(const drawing::Box& room, const Vec& low, const Vec& high) : room_(room) {
    middle_ = 0.5 * (low + high);
    const auto seen = [&](const Vec& v) { return drawing::Point{dot(right_, v), dot(up_, v)}; };
    double across = 1, along = 1;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec half = 0.5 * (high - low);
      const Vec at{corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y,
                   corner & 4 ? half.z : -half.z};
      across = std::max(across, std::abs(seen(at).x));
      along = std::max(along, std::abs(seen(at).y));
    }
    constexpr double kMargin = 0.95;  // nothing touches the panel's edge
    scale_ = kMargin * std::min(0.5 * room.width / across, 0.5 * room.height / along);
  }

  void add(const Shape& s, const Colour& colour) {
    if (s.core == Shape::Core::kBox) return add_box(s, colour);
    const double length = 2 * bodies::norm(s.half[0]);
    const bool capsule = s.core == Shape::Core::kSegment;
    const double radius = capsule ? s.skin_mm : s.radius_mm;
    const Vec axis = length > 0 ? (2 / length) * s.half[0] : Vec{0, 0, 1};
    const Vec u = unit(cross(axis, std::abs(axis.x) < 0.7 ? Vec{1, 0, 0} : Vec{0, 1, 0})), v = cross(axis, u);
    constexpr int kSides = 24, kRings = 4;
    // The outline from one end's middle to the other's: place along the axis, and radius.
    std::vector<std::pair<double, double>> outline;
    const auto cap = [&](double side) {
      for (int k = 0; k <= kRings; ++k) {
        const double a = 0.5 * std::numbers::pi * (side < 0 ? k : kRings - k) / kRings;
        outline.push_back({side * (0.5 * length + radius * std::cos(a)), radius * std::sin(a)});
      }
    };
    // A disc in rings, for the same reason as in pieces.
    const int rings = std::max(1, static_cast<int>(std::ceil(radius / kPiece_mm)));
    const auto disc = [&](double side) {
      for (int k = 0; k < rings; ++k)
        outline.push_back({side * 0.5 * length, radius * (side < 0 ? k : rings - 1 - k) / rings});
    };
    if (capsule)
      cap(-1);
    else
      disc(-1);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length / kPiece_mm)));
    for (int k = 0; k <= pieces; ++k)
      outline.push_back({length * (static_cast<double>(k) / pieces - 0.5), radius});
    if (capsule)
      cap(1);
    else
      disc(1);
    const auto at = [&](std::size_t k, int side) {
      const double angle = 2 * std::numbers::pi * side / kSides;
      return s.centre + outline[k].first * axis +
             outline[k].second * (std::cos(angle) * u + std::sin(angle) * v);
    };
    for (std::size_t k = 0; k + 1 < outline.size(); ++k)
      for (int side = 0; side < kSides; ++side)
        add_quad(at(k, side), at(k, side + 1), at(k + 1, side + 1), at(k + 1, side), colour);
  }

  void draw(drawing::Document& document) {
    const auto clip = document.clipped(room_, 0);
    drawing::draw_faces(document, std::move(faces_), 0.4);
  }

 private:
  void add_box(const Shape& s, const Colour& colour) {
    for (std::size_t k = 0; k < 3; ++k)
      for (const double side : {-1.0, 1.0}) {
        const Vec c = s.centre + side * s.half[k], u = side * s.half[(k + 1) % 3], v = s.half[(k + 2) % 3];
        // Turned to the eye either way: a box may be given left-handed.
        add_quad(c - u - v, c + u - v, c + u + v, c - u + v, colour, s.centre);
      }
  }

  void add_quad(const Vec& a, const Vec& b, const Vec& c, const Vec& d, const Colour& colour) {
    add_face(a, b, c, colour);
    add_face(a, c, d, colour);
  }
  void add_quad(const Vec& a, const Vec& b, const Vec& c, const Vec& d, const Colour& colour,
                const Vec& inside) {
    if (dot(cross(b - a, c - a), a - inside) < 0) return add_quad(a, d, c, b, colour);
    add_quad(a, b, c, d, colour);
  }

  void add_face(const Vec& a, const Vec& b, const Vec& c, const Colour& colour) {
    const Vec n = cross(b - a, c - a);
    const double area = bodies::norm(n);
    if (!(area > 1e-9) || dot(n, towards_) <= 0) return;
    const double shade = 0.62 + 0.38 * std::max(0.0, dot(n, kLight) / area);
    drawing::Face f;
    f.corners = {place(a), place(b), place(c)};
    f.depth = dot(towards_, (1.0 / 3) * (a + b + c));
    f.colour = drawing::rgb(colour[0] * shade, colour[1] * shade, colour[2] * shade);
    faces_.push_back(std::move(f));
  }
  drawing::Point place(const Vec& v) const {
    const Vec r = v - middle_;
    return {room_.x + 0.5 * room_.width + scale_ * dot(right_, r),
            room_.y + 0.5 * room_.height - scale_ * dot(up_, r)};
  }

  static constexpr Vec kLight{0.45, -0.35, 0.82};
  drawing::Box room_;
  Vec middle_{};
  double scale_ = 1;
  // From the front right, from above.
  static constexpr double kAzimuth = -62 * kRadPerDeg, kElevation = 18 * kRadPerDeg;
  Vec towards_{std::cos(kElevation) * std::cos(kAzimuth), std::cos(kElevation) * std::sin(kAzimuth),
               std::sin(kElevation)};
  Vec right_ = unit(cross({0, 0, 1}, towards_));
  Vec up_ = cross(towards_, right_);
  std::vector<drawing::Face> faces_;
};

/// Where two bodies are nearest, of poses all over the room.
Pose nearest_pose(const bodies::CollisionModel& model, const Kinematics& kinematics, const Room& room) {
  constexpr int kHeights = 8, kTilts = 12, kRings = 6, kRays = 24;
  double least = std::numeric_limits<double>::infinity();
  Pose best{};
  for (int h = 0; h <= kHeights; ++h)
    for (int t = 0; t <= kTilts; ++t)
      for (int ring = 0; ring <= kRings; ++ring)
        for (int ray = 0; ray < (ring == 0 ? 1 : kRays); ++ray) {
          const double r = room.radius_mm * ring / kRings, angle = 2 * std::numbers::pi * ray / kRays;
          const Pose pose{r * std::cos(angle),
                          r * std::sin(angle),
                          room.z_min_mm + (room.z_max_mm - room.z_min_mm) * h / kHeights,
                          room.tilt_min_rad + (room.tilt_max_rad - room.tilt_min_rad) * t / kTilts,
                          0,
                          0};
          if (!kinematics.check(Frame::kPart, pose)) continue;
          const auto c = model.clearance(Frame::kPart, pose);
          if (!c || c->mm < model.wanted_mm() || c->mm >= least) continue;
          least = c->mm;
          best = pose;
        }
  return best;
}

Vec farther(const Vec& a, const Vec& b, double (*choose)(double, double)) {
  return {choose(a.x, b.x), choose(a.y, b.y), choose(a.z, b.z)};
}

}  // namespace

std::string draw_bodies(const bodies::CollisionModel& model, const Kinematics& kinematics, const Room& room,
                        const std::string& title) {
  const double middle_z = 0.5 * (room.z_min_mm + room.z_max_mm), low_z = std::max(0.0, room.z_min_mm);
  const std::array<std::pair<const char*, Pose>, 4> poses{{
      {"level, the tool on the table", {0, 0, low_z, 0, 0, 0}},
      {"tilted one way", {0, 0, middle_z, room.tilt_min_rad, 0, 0}},
      {"tilted the other way", {0, 0, middle_z, room.tilt_max_rad, 0, 0}},
      {"where two bodies are nearest", nearest_pose(model, kinematics, room)},
  }};
  constexpr double kPanel_mm = 320, kTop = 110;
  drawing::Document document(4 * kPanel_mm, 800);
  document.heading(40, title,
                   printed("Bodies keep %g mm apart. Red: the two that are nearest.", model.wanted_mm()));
  // One scale for all, around all that is drawn at any of the four.
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec low{kFar, kFar, kFar}, high = -low;
  std::array<bodies::Scene, 4> scenes{model.at_rest(), model.at_rest(), model.at_rest(), model.at_rest()};
  std::array<bool, 4> placed{};
  for (std::size_t k = 0; k < poses.size(); ++k) {
    placed[k] = model.place(Frame::kPart, poses[k].second, scenes[k]);
    if (!placed[k]) continue;
    for (const auto& body : model.bodies())
      for (std::size_t i = 0; i < body.shapes && !hidden(body.id.kind); ++i) {
        const Shape& s = scenes[k].shapes[body.first_shape + i];
        const auto reach = [&](const Vec& axis) { return reach_along(s, axis); };
        low = farther(low, {-reach({-1, 0, 0}), -reach({0, -1, 0}), -reach({0, 0, -1})},
                      [](double a, double b) { return std::min(a, b); });
        high = farther(high, {reach({1, 0, 0}), reach({0, 1, 0}), reach({0, 0, 1})},
                       [](double a, double b) { return std::max(a, b); });
      }
  }
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const double x = kPanel_mm * static_cast<double>(k), centre = x + 0.5 * kPanel_mm;
    const auto words = [&](double y, const std::string& line, bool bold) {
      document.text({centre, y}, line,
                    {.size = 14, .anchor = drawing::Anchor::kMiddle, .fill = drawing::kInk, .bold = bold});
    };
    const Pose& pose = poses[k].second;
    words(735, poses[k].first, true);
    words(755, printed("X %.0f Y %.0f Z %.0f A %.0f", pose[kX], pose[kY], pose[kZ], pose[kA] / kRadPerDeg),
          false);
    if (!placed[k]) {
      words(400, "out of reach", false);
      continue;
    }
    const bodies::Clearance least = model.clearance(scenes[k]);
    const std::string nearest = printed("%.1f mm: %s, %s", least.mm, model.name(least.first).c_str(),
                                        model.name(least.second).c_str());
    words(777, least.mm > 0 ? nearest : model.words(least).c_str(), false);
    Panel panel({x + 10, kTop, kPanel_mm - 20, 600}, low, high);
    for (const auto& body : model.bodies()) {
      if (hidden(body.id.kind)) continue;
      const bool near = body.id == least.first || body.id == least.second;
      for (std::size_t i = 0; i < body.shapes; ++i)
        panel.add(scenes[k].shapes[body.first_shape + i], near ? kNear : colour_of(body.id.kind));
    }
    panel.draw(document);
  }
  return document.svg();
}

}  // namespace kinebus::workspace
