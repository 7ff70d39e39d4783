#pragma once
// The few operations on points and rotations that the scene needs beside QMatrix4x4, in double precision.

#include <array>
#include <cmath>

namespace kinebus::gui {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 operator*(double k, const Vec3& a) {
  return {k * a[0], k * a[1], k * a[2]};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline Vec3 unit(const Vec3& a) {
  const double l = length(a);
  return l > 0 ? 1 / l * a : Vec3{0, 0, 1};
}
inline Vec3 turn_x(double rad, const Vec3& v) {
  const double c = std::cos(rad), s = std::sin(rad);
  return {v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]};
}
inline Vec3 turn_z(double rad, const Vec3& v) {
  const double c = std::cos(rad), s = std::sin(rad);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}

}  // namespace kinebus::gui
