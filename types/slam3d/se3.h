#pragma once
/// A rigid motion of space: translation [m] and unit quaternion, in files `x y z qx qy qz qw`.
///
///     SE3<double> world_from_b = world_from_a * a_from_b;

#include <locograph/core/fields.h>

#include <Eigen/Geometry>
#include <cmath>

namespace locograph {

template <class T>
class SE3 {
 public:
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Quaternion = Eigen::Quaternion<T>;

  SE3() : translation_(T(0), T(0), T(0)), rotation_(T(1), T(0), T(0), T(0)) {}
  SE3(const Vector& translation, const Quaternion& rotation)
      : translation_(translation), rotation_(rotation) {}
  /// From seven numbers x y z qx qy qz qw.
  explicit SE3(const T* s) : translation_(s[0], s[1], s[2]), rotation_(s[6], s[3], s[4], s[5]) {}

  const Vector& translation() const { return translation_; }
  const Quaternion& rotation() const { return rotation_; }

  Vector operator*(const Vector& point) const { return translation_ + rotation_ * point; }
  SE3 operator*(const SE3& other) const {
    return SE3(Vector(*this * other.translation_), Quaternion(rotation_ * other.rotation_));
  }
  SE3 inverse() const {
    const Quaternion back = rotation_.conjugate();
    return SE3(Vector(-(back * translation_)), back);
  }
  template <class U>
  SE3<U> cast() const {
    return SE3<U>(translation_.template cast<U>(), rotation_.template cast<U>());
  }
  void store(T* s) const {
    for (int i = 0; i < 3; ++i) s[i] = translation_[i];
    s[3] = rotation_.x();
    s[4] = rotation_.y();
    s[5] = rotation_.z();
    s[6] = rotation_.w();
  }

  /// Normalises the quaternion, unless it is normalised already: reading what was written gives the
  /// same bits.
  void read(FieldReader& in) requires std::is_same_v<T, double> {
    read_field(in, translation_);
    for (int i = 0; i < 4; ++i) rotation_.coeffs()[i] = in.number();
    const double squared = rotation_.squaredNorm();
    if (squared < 1e-12) in.fail("quaternion of length zero", "a unit quaternion qx qy qz qw");
    if (std::abs(squared - 1.0) > 1e-14) rotation_.coeffs() /= std::sqrt(squared);
  }
  void write(FieldWriter& out) const requires std::is_same_v<T, double> {
    write_field(out, translation_);
    for (int i = 0; i < 4; ++i) out.number(rotation_.coeffs()[i]);
  }

 private:
  Vector translation_;
  Quaternion rotation_;
};

/// Unit quaternion of a rotation vector (axis times angle [rad]): exp: so(3) → S³. The series near
/// zero keeps dual numbers differentiable there.
template <class T>
Eigen::Quaternion<T> quaternion_exp(const Eigen::Matrix<T, 3, 1>& v) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T squared = v.squaredNorm();
  if (squared < T(1e-12)) {
    const T half = T(0.5) - squared / T(48.0);
    return Eigen::Quaternion<T>(T(1) - squared / T(8.0), half * v[0], half * v[1], half * v[2]);
  }
  const T angle = sqrt(squared);
  const T factor = sin(angle * T(0.5)) / angle;
  return Eigen::Quaternion<T>(cos(angle * T(0.5)), factor * v[0], factor * v[1], factor * v[2]);
}

/// Rotation vector of a unit quaternion, of length at most π; the inverse of quaternion_exp().
inline Eigen::Vector3d quaternion_log(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and −q are the same rotation
  const double sine = q.vec().norm(), cosine = sign * q.w();
  const double factor = sine < 1e-9 ? 2.0 / cosine : 2.0 * std::atan2(sine, cosine) / sine;
  return sign * factor * q.vec();
}

}  // namespace locograph
