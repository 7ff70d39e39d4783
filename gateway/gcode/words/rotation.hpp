#pragma once
// The two frames of a pose, and the rotations between them. The convention is that of
// gateway/kinematics/kinematics.hpp: m = R_X(A) R_Z(C) q, with q in the part's frame and m along the
// machine's axes.

#include <array>

#include "gateway/gcode/words/state.hpp"

namespace kinebus::gcode {

using Vector3 = std::array<double, 3>;

Vector3 operator+(const Vector3& a, const Vector3& b);
Vector3 operator-(const Vector3& a, const Vector3& b);
Vector3 operator*(const Matrix3& m, const Vector3& v);
Matrix3 operator*(const Matrix3& a, const Matrix3& b);
Matrix3 transposed(const Matrix3& m);
double norm(const Vector3& v);

Matrix3 rotation_x(double angle_rad);
Matrix3 rotation_z(double angle_rad);

inline Vector3 xyz(const Pose& pose) {
  return {pose[kAxisX], pose[kAxisY], pose[kAxisZ]};
}
inline void set_xyz(Pose& pose, const Vector3& v) {
  pose[kAxisX] = v[0], pose[kAxisY] = v[1], pose[kAxisZ] = v[2];
}

/// The same physical pose, written in the other frame.
Pose in_frame(const Pose& pose, Frame from, Frame to);

/// G68.2 I J K: the plane's axes after turning about Z by I, then about the new X by J, then about the new Z
/// by K.
Matrix3 euler_zxz(double i_rad, double j_rad, double k_rad);

}  // namespace kinebus::gcode
