#include "gateway/bodies/shape.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::bodies {

Shape Shape::capsule(const Vec& from, const Vec& to, double radius_mm) {
  Shape s;
  s.skin_mm = radius_mm;
  s.span(from, to);
  return s;
}

Shape Shape::box(const Vec& centre, const Vec& half_u, const Vec& half_v, const Vec& half_w) {
  Shape s;
  s.core = Core::kBox;
  s.centre = centre;
  s.half = {half_u, half_v, half_w};
  s.core_reach_mm = std::sqrt(dot(half_u, half_u) + dot(half_v, half_v) + dot(half_w, half_w));
  return s;
}

Shape Shape::cylinder(const Vec& from, const Vec& to, double radius_mm) {
  Shape s;
  s.core = Core::kCylinder;
  s.radius_mm = radius_mm;
  s.centre = 0.5 * (from + to);
  s.half[0] = 0.5 * (to - from);
  const double half = norm(s.half[0]);
  s.axis = (1 / half) * s.half[0];
  s.core_reach_mm = std::hypot(half, radius_mm);
  return s;
}

namespace {

/// Point of the core that lies farthest in direction `d`.
Vec farthest(const Shape& s, const Vec& d) {
  const auto towards = [&d](const Vec& v) { return dot(v, d) < 0 ? -v : v; };
  switch (s.core) {
    case Shape::Core::kSegment:
      return s.centre + towards(s.half[0]);
    case Shape::Core::kBox:
      return s.centre + towards(s.half[0]) + towards(s.half[1]) + towards(s.half[2]);
    case Shape::Core::kCylinder:
      break;
  }
  const Vec end = s.centre + towards(s.half[0]);
  const Vec across = d - dot(d, s.axis) * s.axis;
  const double length = norm(across);
  // Straight along the axis every point of the end is as far: its centre is one of them.
  if (!(length > 1e-12 * norm(d))) return end;
  return end + (s.radius_mm / length) * across;
}

/// Between two segments (closest points by clamping, one parameter after the other).
Vec between_segments(const Shape& a, const Shape& b) {
  const Vec u = 2 * a.half[0], v = 2 * b.half[0];
  const Vec r = (a.centre - a.half[0]) - (b.centre - b.half[0]);
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const auto clamp01 = [](double x) { return std::clamp(x, 0.0, 1.0); };
  double s = 0, t = 0;
  constexpr double kPoint = 1e-18;  // mm^2: a segment without length
  if (uu <= kPoint && vv <= kPoint) return r;
  if (uu <= kPoint) {
    t = clamp01(vr / vv);
  } else if (vv <= kPoint) {
    s = clamp01(-ur / uu);
  } else {
    const double det = uu * vv - uv * uv;
    // Parallel: any s will do, the clamping of t finds the rest.
    if (det > 1e-12 * uu * vv) s = clamp01((uv * vr - ur * vv) / det);
    t = (uv * s + vr) / vv;
    if (t < 0) {
      t = 0;
      s = clamp01(-ur / uu);
    } else if (t > 1) {
      t = 1;
      s = clamp01((uv - ur) / uu);
    }
  }
  return r + s * u - t * v;
}

/// Up to four points of the difference of both cores, the smallest set that holds the point next to the
/// origin.
struct Simplex {
  std::array<Vec, 4> point;
  int count = 0;
};

/// Next to the origin on the segment p q; keeps in `out` what is needed of it.
Vec nearest(const Vec& p, const Vec& q, Simplex& out) {
  const Vec pq = q - p;
  const double t = -dot(p, pq), length2 = dot(pq, pq);
  if (t <= 0 || !(length2 > 0)) {
    out = {{p}, 1};
    return p;
  }
  if (t >= length2) {
    out = {{q}, 1};
    return q;
  }
  out = {{p, q}, 2};
  return p + (t / length2) * pq;
}

/// The same on a triangle: of its corners, edges and face the one whose region the origin is in.
Vec nearest(const Vec& p, const Vec& q, const Vec& r, Simplex& out) {
  const Vec pq = q - p, pr = r - p;
  const double d1 = -dot(pq, p), d2 = -dot(pr, p), d3 = -dot(pq, q), d4 = -dot(pr, q), d5 = -dot(pq, r),
               d6 = -dot(pr, r);
  const double wr = d1 * d4 - d3 * d2, wq = d5 * d2 - d1 * d6, wp = d3 * d6 - d5 * d4;
  const Vec n = cross(pq, pr);
  // A flat triangle has no face to be next to.
  const bool flat = !(dot(n, n) > 1e-20 * dot(pq, pq) * dot(pr, pr));
  if (!flat && wp > 0 && wq > 0 && wr > 0) {
    out = {{p, q, r}, 3};
    return (dot(p, n) / dot(n, n)) * n;
  }
  Simplex edge;
  Vec best = nearest(p, q, out);
  for (const auto& [a, b] : {std::pair{p, r}, std::pair{q, r}}) {
    const Vec v = nearest(a, b, edge);
    if (dot(v, v) < dot(best, best)) {
      best = v;
      out = edge;
    }
  }
  return best;
}

/// The same on whatever the simplex is. The origin inside a tetrahedron: 0.
Vec nearest(Simplex& s) {
  const Simplex all = s;
  const auto& p = all.point;
  if (all.count == 1) return p[0];
  if (all.count == 2) return nearest(p[0], p[1], s);
  if (all.count == 3) return nearest(p[0], p[1], p[2], s);
  constexpr std::size_t kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  bool inside = true;
  Vec best{};
  double least = HUGE_VAL;
  for (const auto& f : kFaces) {
    const Vec n = cross(p[f[1]] - p[f[0]], p[f[2]] - p[f[0]]);
    const double origin = -dot(p[f[0]], n), opposite = dot(p[f[3]] - p[f[0]], n);
    if (origin * opposite > 0) continue;
    inside = false;
    Simplex face;
    const Vec v = nearest(p[f[0]], p[f[1]], p[f[2]], face);
    if (dot(v, v) < least) {
      least = dot(v, v);
      best = v;
      s = face;
    }
  }
  return inside ? Vec{} : best;
}

/// Gilbert, Johnson and Keerthi: walks over the difference of both cores towards the origin. What it returns
/// is the distance of a plane that parts the two, so never more than the truth. Ends as soon as it is
/// `enough_mm`.
Parting part_cores(const Shape& a, const Shape& b, double enough_mm) {
  constexpr double kGood_mm = 1e-3;
  constexpr int kMost = 64;
  Vec v = a.centre - b.centre;
  if (!(dot(v, v) > 0)) return {};
  Simplex simplex;
  Parting best;
  for (int i = 0; i < kMost; ++i) {
    const double length = norm(v);
    if (length < kGood_mm) return {};
    const Vec w = farthest(a, -v) - farthest(b, v);
    const double parted = dot(v, w) / length;
    if (parted > best.mm) best = {parted, (1 / length) * v};
    if ((simplex.count > 0 && length - best.mm <= kGood_mm) || best.mm >= enough_mm) break;
    simplex.point[static_cast<std::size_t>(simplex.count++)] = w;
    v = nearest(simplex);
    if (simplex.count == 4) return {};
  }
  return best;
}

}  // namespace

Parting part(const Shape& a, const Shape& b, double enough_mm) {
  Parting cores;
  if (a.core == Shape::Core::kSegment && b.core == Shape::Core::kSegment) {
    const Vec between = between_segments(a, b);
    cores.mm = norm(between);
    if (cores.mm > 0) cores.axis = (1 / cores.mm) * between;
  } else {
    cores = part_cores(a, b, enough_mm + a.skin_mm + b.skin_mm);
  }
  cores.mm -= a.skin_mm + b.skin_mm;
  return cores;
}

double distance_mm(const Shape& s, const Vec& point) {
  const Vec off = point - s.centre;
  // Beyond the half along its direction, whose length is not 0.
  const auto beyond = [&off](const Vec& half) {
    const double length = norm(half);
    return std::max(0.0, std::abs(dot(off, half)) / length - length);
  };
  switch (s.core) {
    case Shape::Core::kSegment: {
      const double length2 = dot(s.half[0], s.half[0]);
      const double t = length2 > 0 ? std::clamp(dot(off, s.half[0]) / length2, -1.0, 1.0) : 0;
      return norm(off - t * s.half[0]) - s.skin_mm;
    }
    case Shape::Core::kBox:
      return norm({beyond(s.half[0]), beyond(s.half[1]), beyond(s.half[2])}) - s.skin_mm;
    case Shape::Core::kCylinder:
      break;
  }
  const double along = dot(off, s.axis), across = std::sqrt(std::max(0.0, dot(off, off) - along * along));
  return std::hypot(beyond(s.half[0]), std::max(0.0, across - s.radius_mm)) - s.skin_mm;
}

double reach_along(const Shape& s, const Vec& axis) {
  double reach = dot(s.centre, axis) + std::abs(dot(s.half[0], axis)) + s.skin_mm;
  if (s.core == Shape::Core::kBox) reach += std::abs(dot(s.half[1], axis)) + std::abs(dot(s.half[2], axis));
  if (s.core == Shape::Core::kCylinder) {
    const double along = dot(s.axis, axis);
    reach += s.radius_mm * std::sqrt(std::max(0.0, 1 - along * along));
  }
  return reach;
}

}  // namespace kinebus::bodies
