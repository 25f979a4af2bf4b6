#pragma once
/// Where rays enter solids: one small function object for each kind of solid, for loops over rays
/// that the compiler turns into vector instructions.
///
///     const CapsuleEntry entry(optical_from_shape, 0.05, 0.15);   // radius, half of its length
///     double depth_m = entry(0.1, -0.2);          // along (0.1, -0.2, 1); infinite: passes by
///
/// Rays start at the origin along (x, y, 1): what they return is the depth along z. The origin must
/// not lie in the solid. Axes of capsules and cylinders are the local z, origins the middle; a
/// sphere is a capsule without length.
///
/// |t d - c| = r has t = (d.c -+ sqrt((d.c)^2 - d.d (c.c - r^2))) / d.d; of a cylinder both vectors
/// lose their part along the axis first. A solid between pairs of planes is entered through the
/// last of the near ones, if none of the far ones comes before (T. Kay and J. Kajiya, "Ray tracing
/// complex scenes", SIGGRAPH 1986).

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace locograph {

inline constexpr double kNoEntry = std::numeric_limits<double>::infinity();

namespace ray_entries_detail {

/// Of rays along an axis, whose side is then very far away.
inline constexpr double kParallel = 1e-13;

/// b where one of them is no number.
inline double larger(double a, double b) { return a > b ? a : b; }
inline double smaller(double a, double b) { return a < b ? a : b; }

struct Vector {
  double x, y, z;
  explicit Vector(const Eigen::Vector3d& v) : x(v.x()), y(v.y()), z(v.z()) {}
  double along(double ray_x, double ray_y) const { return x * ray_x + y * ray_y + z; }
};

/// A cylinder without ends, as quadratic in the depth t: a t^2 - 2 b t + c = 0.
class EndlessCylinder {
 public:
  EndlessCylinder(const Eigen::Isometry3d& optical_from_shape, double radius)
      : axis(optical_from_shape.linear().col(2)),
        middle(optical_from_shape.translation()),
        middle_along(optical_from_shape.linear().col(2).dot(optical_from_shape.translation())),
        c(optical_from_shape.translation().squaredNorm() - middle_along * middle_along -
          radius * radius) {}

  Vector axis, middle;
  double middle_along, c;
};

}  // namespace ray_entries_detail

class CapsuleEntry {
 public:
  CapsuleEntry(const Eigen::Isometry3d& optical_from_shape, double radius, double half_length)
      : side_(optical_from_shape, radius),
        lower_(optical_from_shape * Eigen::Vector3d(0.0, 0.0, -half_length)),
        upper_(optical_from_shape * Eigen::Vector3d(0.0, 0.0, half_length)),
        lower_c_(lower_.x * lower_.x + lower_.y * lower_.y + lower_.z * lower_.z - radius * radius),
        upper_c_(upper_.x * upper_.x + upper_.y * upper_.y + upper_.z * upper_.z - radius * radius),
        half_(half_length) {}

  double operator()(double x, double y) const {
    using namespace ray_entries_detail;
    const double squared = x * x + y * y + 1.0;
    const double slope = side_.axis.along(x, y);
    const double a = larger(squared - slope * slope, kParallel);
    const double b = side_.middle.along(x, y) - side_.middle_along * slope;
    const double side_root = b * b - a * side_.c;
    const double on_side = (b - std::sqrt(larger(side_root, 0.0))) / a;
    // Where it would enter an endless cylinder tells which part of the capsule it may enter.
    const double along = on_side * slope - side_.middle_along;
    const bool is_upper = along > 0.0;
    const double lower = lower_.along(x, y), upper = upper_.along(x, y);
    const double end = is_upper ? upper : lower;
    const double end_root = end * end - squared * (is_upper ? upper_c_ : lower_c_);
    const double on_end = (end - std::sqrt(larger(end_root, 0.0))) / squared;
    const bool is_side = std::abs(along) <= half_;
    const double root = is_side ? side_root : end_root;
    const double depth = is_side ? on_side : on_end;
    const double met = root >= 0.0 ? depth : kNoEntry;
    return met > 0.0 ? met : kNoEntry;
  }

 private:
  ray_entries_detail::EndlessCylinder side_;
  ray_entries_detail::Vector lower_, upper_;
  double lower_c_, upper_c_, half_;
};

class CylinderEntry {
 public:
  CylinderEntry(const Eigen::Isometry3d& optical_from_shape, double radius, double half_length)
      : side_(optical_from_shape, radius), half_(half_length) {}

  double operator()(double x, double y) const {
    using namespace ray_entries_detail;
    const double slope = side_.axis.along(x, y);
    const double a = larger(x * x + y * y + 1.0 - slope * slope, kParallel);
    const double b = side_.middle.along(x, y) - side_.middle_along * slope;
    const double root = b * b - a * side_.c;
    const double wide = std::sqrt(larger(root, 0.0));
    const double half = std::copysign(half_, slope);
    const double in = larger((side_.middle_along - half) / slope, (b - wide) / a);
    const double out = smaller((side_.middle_along + half) / slope, (b + wide) / a);
    const double met = root >= 0.0 ? in : kNoEntry;
    const double entered = met <= out ? met : kNoEntry;
    return entered > 0.0 ? entered : kNoEntry;
  }

 private:
  ray_entries_detail::EndlessCylinder side_;
  double half_;
};

class BoxEntry {
 public:
  BoxEntry(const Eigen::Isometry3d& optical_from_box, const Eigen::Vector3d& half_extents)
      : x_(optical_from_box.linear().col(0)),
        y_(optical_from_box.linear().col(1)),
        z_(optical_from_box.linear().col(2)),
        middle_(optical_from_box.linear().transpose() * optical_from_box.translation()),
        half_(half_extents) {}

  double operator()(double x, double y) const {
    using namespace ray_entries_detail;
    double in = -kNoEntry, out = kNoEntry;
    slab(x_.along(x, y), middle_.x, half_.x, in, out);
    slab(y_.along(x, y), middle_.y, half_.y, in, out);
    slab(z_.along(x, y), middle_.z, half_.z, in, out);
    const double entered = in <= out ? in : kNoEntry;
    return entered > 0.0 ? entered : kNoEntry;
  }

 private:
  static void slab(double slope, double middle, double half, double& in, double& out) {
    using namespace ray_entries_detail;
    const double inverse = 1.0 / slope, signed_half = std::copysign(half, slope);
    in = larger((middle - signed_half) * inverse, in);
    out = smaller((middle + signed_half) * inverse, out);
  }

  ray_entries_detail::Vector x_, y_, z_, middle_, half_;
};

/// Of all points with normal . p <= offset, entered from the other side.
class HalfSpaceEntry {
 public:
  HalfSpaceEntry(const Eigen::Vector3d& normal, double offset) : normal_(normal), offset_(offset) {}

  double operator()(double x, double y) const {
    const double depth = offset_ / normal_.along(x, y);
    const double ahead = depth > 0.0 ? depth : kNoEntry;
    return offset_ < 0.0 ? ahead : kNoEntry;
  }

 private:
  ray_entries_detail::Vector normal_;
  double offset_;
};

}  // namespace locograph
