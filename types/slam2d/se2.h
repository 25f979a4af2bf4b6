#pragma once
/// A rigid motion of the plane: x, y [m] and heading θ [rad], wrapped to (−π, π].
///
///     SE2<double> world_from_b = world_from_a * a_from_b;

#include <locograph/core/fields.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace locograph {

/// Wraps an angle to [−π, π] without trigonometry, so that derivatives pass through unchanged.
template <class T>
T wrap_angle(T angle) {
  using std::floor;
  const T turns = floor((angle + T(std::numbers::pi)) / T(2.0 * std::numbers::pi));
  return angle - T(2.0 * std::numbers::pi) * turns;
}

template <class T>
class SE2 {
 public:
  SE2() : translation_(T(0), T(0)), angle_(T(0)) {}
  SE2(const T& x, const T& y, const T& angle) : translation_(x, y), angle_(angle) {}
  SE2(const Eigen::Matrix<T, 2, 1>& translation, const T& angle)
      : translation_(translation), angle_(angle) {}

  const Eigen::Matrix<T, 2, 1>& translation() const { return translation_; }
  const T& angle() const { return angle_; }

  Eigen::Matrix<T, 2, 1> rotate(const Eigen::Matrix<T, 2, 1>& v) const {
    using std::cos;
    using std::sin;
    const T c = cos(angle_), s = sin(angle_);
    return Eigen::Matrix<T, 2, 1>(c * v[0] - s * v[1], s * v[0] + c * v[1]);
  }
  Eigen::Matrix<T, 2, 1> inverse_rotate(const Eigen::Matrix<T, 2, 1>& v) const {
    using std::cos;
    using std::sin;
    const T c = cos(angle_), s = sin(angle_);
    return Eigen::Matrix<T, 2, 1>(c * v[0] + s * v[1], c * v[1] - s * v[0]);
  }
  Eigen::Matrix<T, 2, 1> operator*(const Eigen::Matrix<T, 2, 1>& point) const {
    return translation_ + rotate(point);
  }
  SE2 operator*(const SE2& other) const {
    return SE2(*this * other.translation_, wrap_angle(T(angle_ + other.angle_)));
  }
  SE2 inverse() const {
    return SE2(Eigen::Matrix<T, 2, 1>(-inverse_rotate(translation_)), T(-angle_));
  }
  template <class U>
  SE2<U> cast() const {
    return SE2<U>(U(translation_[0]), U(translation_[1]), U(angle_));
  }

  void read(FieldReader& in) requires std::is_same_v<T, double> {
    read_field(in, translation_);
    angle_ = in.number();
  }
  void write(FieldWriter& out) const requires std::is_same_v<T, double> {
    write_field(out, translation_);
    out.number(angle_);
  }

 private:
  Eigen::Matrix<T, 2, 1> translation_;
  T angle_;
};

}  // namespace locograph
