#include "gateway/gcode/words/rotation.hpp"

#include <cmath>

namespace kinebus::gcode {

Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector3 operator*(const Matrix3& m, const Vector3& v) {
  Vector3 result{};
  for (std::size_t row = 0; row < 3; ++row)
    result[row] = m[row][0] * v[0] + m[row][1] * v[1] + m[row][2] * v[2];
  return result;
}

Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  Matrix3 result{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      for (std::size_t k = 0; k < 3; ++k) result[row][column] += a[row][k] * b[k][column];
  return result;
}

Matrix3 transposed(const Matrix3& m) {
  Matrix3 result{};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column) result[row][column] = m[column][row];
  return result;
}

double norm(const Vector3& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Matrix3 rotation_x(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
}

Matrix3 rotation_z(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
}

Pose in_frame(const Pose& pose, Frame from, Frame to) {
  if (from == to) return pose;
  const Matrix3 to_machine = rotation_x(pose[kAxisA]) * rotation_z(pose[kAxisC]);
  Pose result = pose;
  set_xyz(result, (to == Frame::kMachine ? to_machine : transposed(to_machine)) * xyz(pose));
  return result;
}

Matrix3 euler_zxz(double i_rad, double j_rad, double k_rad) {
  return rotation_z(i_rad) * rotation_x(j_rad) * rotation_z(k_rad);
}

}  // namespace kinebus::gcode
