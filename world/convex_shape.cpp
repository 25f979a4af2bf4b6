#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <locograph/common/error.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/gjk.h>
#include <locograph/world/require_metres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

namespace locograph {

struct ConvexShape::Fcl {
  std::unique_ptr<fcl::CollisionGeometryd> geometry;
};

namespace {

constexpr double kCertified = 1e-5;

Eigen::Vector3d along_z(double z) { return Eigen::Vector3d(0.0, 0.0, z); }

Eigen::Vector3d longest_axis(const Eigen::Vector3d& half) {
  int axis = 0;
  half.maxCoeff(&axis);
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  out[axis] = half[axis];
  return out;
}

// Minimises a convex function on [0, 1].
template <class F>
double minimise_convex(const F& f) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 80; ++i) {
    const double left = low + (high - low) / 3.0, right = high - (high - low) / 3.0;
    if (f(left) < f(right))
      high = right;
    else
      low = left;
  }
  return 0.5 * (low + high);
}

// Where on the segment the squared distance to the box is least: its derivative is piecewise linear
// and does not decrease, so the root is found between two neighbouring kinks.
double nearest_parameter(const Eigen::Vector3d& from, const Eigen::Vector3d& step,
                         const Eigen::Vector3d& half) {
  const auto slope = [&](double t) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double p = from[axis] + t * step[axis];
      sum += step[axis] * (p - std::clamp(p, -half[axis], half[axis]));
    }
    return sum;
  };
  double low = 0.0, high = 1.0, slope_low = slope(0.0), slope_high = slope(1.0);
  if (slope_low >= 0.0) return 0.0;
  if (slope_high <= 0.0) return 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    if (step[axis] == 0.0) continue;
    for (const double face : {-half[axis], half[axis]}) {
      const double t = (face - from[axis]) / step[axis];
      if (t <= low || t >= high) continue;
      const double value = slope(t);
      if (value <= 0.0) {
        low = t;
        slope_low = value;
      } else {
        high = t;
        slope_high = value;
      }
    }
  }
  return low + (high - low) * slope_low / (slope_low - slope_high);
}

double point_box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  const Eigen::Vector3d excess = p.cwiseAbs() - half;
  const double outside = excess.cwiseMax(0.0).norm();
  return outside > 0.0 ? outside : excess.maxCoeff();
}

Eigen::Vector3d nearest_on_box_surface(const Eigen::Vector3d& p, const Eigen::Vector3d& half) {
  Eigen::Vector3d q = p.cwiseMax(-half).cwiseMin(half);
  const Eigen::Vector3d depth = half - p.cwiseAbs();
  if (depth.minCoeff() <= 0.0) return q;
  int axis = 0;
  depth.minCoeff(&axis);
  q[axis] = p[axis] < 0.0 ? -half[axis] : half[axis];
  return q;
}

// box_from_swept: into axes centred on the box. The points come out in these axes.
ShapeDistance swept_sphere_box(const ConvexShape& swept, const Eigen::Isometry3d& box_from_swept,
                               const Eigen::Vector3d& half) {
  const Eigen::Vector3d from = box_from_swept * along_z(-swept.half_length());
  const Eigen::Vector3d to = box_from_swept * along_z(swept.half_length());
  const SegmentBox segment = segment_box_distance(from, to, half);
  ShapeDistance result;
  result.distance = segment.distance - swept.radius();
  result.on_first = from + segment.parameter * (to - from);
  result.on_second = nearest_on_box_surface(result.on_first, half);
  Eigen::Vector3d outward = result.on_first - result.on_second;
  if (segment.distance < 0.0) outward = -outward;
  const double norm = outward.norm();
  if (norm > 0.0) result.on_first -= outward * (swept.radius() / norm);
  return result;
}

struct NearestOnSegments {
  Eigen::Vector3d on_first, on_second;
};

// Segments p + [0, 1] u and q + [0, 1] v: C. Ericson, "Real-Time Collision Detection", 2005, 5.1.9.
NearestOnSegments nearest_on_segments(const Eigen::Vector3d& p, const Eigen::Vector3d& u,
                                      const Eigen::Vector3d& q, const Eigen::Vector3d& v) {
  const Eigen::Vector3d r = p - q;
  const double a = u.squaredNorm(), e = v.squaredNorm(), b = u.dot(v), c = u.dot(r), f = v.dot(r);
  double s = 0.0, t = 0.0;
  if (a > 0.0 && e > 0.0) {
    const double determinant = a * e - b * b;
    if (determinant > 1e-14 * a * e) s = std::clamp((b * f - c * e) / determinant, 0.0, 1.0);
    t = (b * s + f) / e;
    if (t < 0.0 || t > 1.0) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((b * t - c) / a, 0.0, 1.0);
    }
  } else if (a > 0.0) {
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (e > 0.0) {
    t = std::clamp(f / e, 0.0, 1.0);
  }
  return {p + s * u, q + t * v};
}

ShapeDistance swept_spheres(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                            const ConvexShape& second, const Eigen::Isometry3d& world_from_second) {
  const auto [on_u, on_v] =
      nearest_on_segments(world_from_first * along_z(-first.half_length()),
                          world_from_first.linear().col(2) * (2.0 * first.half_length()),
                          world_from_second * along_z(-second.half_length()),
                          world_from_second.linear().col(2) * (2.0 * second.half_length()));
  const Eigen::Vector3d between = on_u - on_v;
  const double norm = between.norm();
  const Eigen::Vector3d direction =
      norm > 0.0 ? Eigen::Vector3d(between / norm) : Eigen::Vector3d::UnitZ();
  return {norm - first.radius() - second.radius(), on_u - first.radius() * direction,
          on_v + second.radius() * direction};
}

Eigen::Vector3d world_support(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape,
                              const Eigen::Vector3d& direction) {
  return world_from_shape * shape.support(world_from_shape.linear().transpose() * direction);
}

/// The least way out of one shape for another that has been found so far.
class WayOut {
 public:
  WayOut(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
         const ConvexShape& second, const Eigen::Isometry3d& world_from_second)
      : first_(first),
        second_(second),
        world_from_first_(world_from_first),
        world_from_second_(world_from_second) {}

  /// How far the first has to be moved along a direction of length 1 to come free of the second.
  double along(const Eigen::Vector3d& n) const {
    return n.dot(world_support(second_, world_from_second_, n) -
                 world_support(first_, world_from_first_, -n));
  }
  void consider(const Eigen::Vector3d& n) {
    const double depth = along(n);
    if (depth >= depth_) return;
    depth_ = depth;
    direction_ = n;
  }
  /// The directions that the shape's form suggests.
  void consider(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape) {
    const Eigen::Matrix3d axes = world_from_shape.linear();
    const bool box = shape.type() == ConvexShape::Type::kBox;
    if (!box && shape.type() != ConvexShape::Type::kCylinder) return;
    for (int axis = box ? 0 : 2; axis < 3; ++axis) {
      consider(axes.col(axis));
      consider(-axes.col(axis));
    }
    if (!box) consider_across(axes);
  }
  ShapeDistance distance() const {
    const Eigen::Vector3d on_first = world_support(first_, world_from_first_, -direction_);
    return {-std::max(0.0, depth_), on_first, on_first + depth_ * direction_};
  }

 private:
  /// Directions across z: the best of some, and between its neighbours.
  void consider_across(const Eigen::Matrix3d& axes) {
    constexpr int kDirections = 24;
    constexpr double kApart = 2.0 * std::numbers::pi / kDirections;
    const auto across = [&](double angle) -> Eigen::Vector3d {
      return std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1);
    };
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kDirections; ++i) {
      const double depth = along(across(kApart * i));
      if (depth >= least) continue;
      least = depth;
      best = i;
    }
    const double from = kApart * (best - 1), wide = 2.0 * kApart;
    const double where = minimise_convex([&](double s) { return along(across(from + s * wide)); });
    consider(across(kApart * best));
    consider(across(from + where * wide));
  }

  const ConvexShape &first_, &second_;
  const Eigen::Isometry3d &world_from_first_, &world_from_second_;
  double depth_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d direction_ = Eigen::Vector3d::UnitZ();
};

/// Of FCL's answer only the direction counts: along a thin bar its depth is the length of the bar,
/// and sometimes there is none.
ShapeDistance penetration(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                          const ConvexShape& second, const Eigen::Isometry3d& world_from_second) {
  fcl::CollisionRequestd request;
  request.enable_contact = true;
  request.num_max_contacts = 4;
  fcl::CollisionResultd result;
  fcl::collide(first.fcl().geometry.get(), world_from_first, second.fcl().geometry.get(),
               world_from_second, request, result);
  WayOut way(first, world_from_first, second, world_from_second);
  for (std::size_t i = 0; i < result.numContacts(); ++i) {
    const Eigen::Vector3d& normal = result.getContact(i).normal;
    if (!(normal.norm() > 0.5)) continue;
    way.consider(-normal.normalized());
    way.consider(normal.normalized());
  }
  way.consider(first, world_from_first);
  way.consider(second, world_from_second);
  const Eigen::Vector3d between =
      world_from_first * first.center() - world_from_second * second.center();
  way.consider(between.norm() > 1e-9 ? Eigen::Vector3d(between.normalized())
                                     : Eigen::Vector3d::UnitZ());
  return way.distance();
}

ShapeDistance by_fcl(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                     const ConvexShape& second, const Eigen::Isometry3d& world_from_second) {
  fcl::DistanceRequestd request;
  request.enable_nearest_points = true;
  fcl::DistanceResultd nearest;
  const double distance =
      fcl::distance(first.fcl().geometry.get(), world_from_first, second.fcl().geometry.get(),
                    world_from_second, request, nearest);
  if (distance > 0.0) {
    const Eigen::Vector3d normal =
        (nearest.nearest_points[0] - nearest.nearest_points[1]).normalized();
    const double bound = normal.dot(world_support(first, world_from_first, -normal) -
                                    world_support(second, world_from_second, normal));
    if (distance - bound <= kCertified)
      return {distance, nearest.nearest_points[0], nearest.nearest_points[1]};
  }
  Eigen::Vector3d start = world_from_first * first.center() - world_from_second * second.center();
  if (start.norm() < 1e-9) start = Eigen::Vector3d::UnitX();
  const GjkResult gjk = gjk_distance(
      [&](const Eigen::Vector3d& n) { return world_support(first, world_from_first, n); },
      [&](const Eigen::Vector3d& n) { return world_support(second, world_from_second, n); }, start);
  if (gjk.distance > 0.0) return {gjk.distance, gjk.on_first, gjk.on_second};
  return penetration(first, world_from_first, second, world_from_second);
}

}  // namespace

ConvexShape::ConvexShape(Type type, double radius, const Eigen::Vector3d& half)
    : type_(type), radius_(radius), half_(half) {}

ConvexShape ConvexShape::sphere(double radius) {
  ConvexShape shape(Type::kSphere, require_metres(radius, "radius of a shape"),
                    Eigen::Vector3d::Zero());
  shape.bounding_radius_ = shape.bounding_capsule_radius_ = radius;
  shape.fcl_ = std::make_shared<Fcl>(Fcl{std::make_unique<fcl::Sphered>(radius)});
  return shape;
}

ConvexShape ConvexShape::capsule(double radius, double length) {
  if (length == 0.0) return sphere(radius);
  ConvexShape shape(Type::kCapsule, require_metres(radius, "radius of a shape"),
                    along_z(0.5 * require_metres(length, "length of a shape")));
  shape.bounding_radius_ = radius + 0.5 * length;
  shape.bounding_axis_ = shape.half_;
  shape.bounding_capsule_radius_ = radius;
  shape.fcl_ = std::make_shared<Fcl>(Fcl{std::make_unique<fcl::Capsuled>(radius, length)});
  return shape;
}

ConvexShape ConvexShape::cylinder(double radius, double height) {
  ConvexShape shape(Type::kCylinder, require_metres(radius, "radius of a shape"),
                    along_z(0.5 * require_metres(height, "height of a shape")));
  shape.bounding_radius_ = std::hypot(radius, 0.5 * height);
  shape.bounding_axis_ = shape.half_;
  shape.bounding_capsule_radius_ = radius;
  shape.fcl_ = std::make_shared<Fcl>(Fcl{std::make_unique<fcl::Cylinderd>(radius, height)});
  return shape;
}

ConvexShape ConvexShape::box(const Eigen::Vector3d& size) {
  for (int axis = 0; axis < 3; ++axis) require_metres(size[axis], "extent of a shape");
  ConvexShape shape(Type::kBox, 0.0, 0.5 * size);
  shape.bounding_radius_ = shape.half_.norm();
  shape.bounding_axis_ = longest_axis(shape.half_);
  shape.bounding_capsule_radius_ = Eigen::Vector3d(shape.half_ - shape.bounding_axis_).norm();
  shape.fcl_ = std::make_shared<Fcl>(Fcl{std::make_unique<fcl::Boxd>(size)});
  return shape;
}

ConvexShape ConvexShape::hull(std::vector<Eigen::Vector3d> points) {
  if (points.size() < 4)
    throw Error("a hull of " + std::to_string(points.size()) + " points", "at least four");
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& point : points) {
    if (!point.allFinite()) throw Error("a point of a hull is not finite", "finite coordinates");
    bounds.extend(point);
  }
  ConvexShape shape(Type::kHull, 0.0, 0.5 * bounds.sizes());
  shape.center_ = bounds.center();
  shape.bounding_axis_ = longest_axis(shape.half_);
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d offset = point - shape.center_;
    const Eigen::Vector3d off_axis =
        offset - offset.cwiseMax(-shape.bounding_axis_).cwiseMin(shape.bounding_axis_);
    shape.bounding_radius_ = std::max(shape.bounding_radius_, offset.norm());
    shape.bounding_capsule_radius_ = std::max(shape.bounding_capsule_radius_, off_axis.norm());
  }
  shape.points_ = std::make_shared<const std::vector<Eigen::Vector3d>>(std::move(points));
  // Without faces FCL searches all points instead of walking along edges, which would need a mesh
  // that really is convex.
  shape.fcl_ = std::make_shared<Fcl>(Fcl{std::make_unique<fcl::Convexd>(
      shape.points_, 0, std::make_shared<const std::vector<int>>(), false)});
  return shape;
}

Eigen::Vector3d ConvexShape::support(const Eigen::Vector3d& direction) const {
  const double up = direction.z() < 0.0 ? -half_.z() : half_.z();
  switch (type_) {
    case Type::kSphere:
    case Type::kCapsule:
      return along_z(up) + direction.normalized() * radius_;
    case Type::kCylinder: {
      const double across = std::hypot(direction.x(), direction.y());
      if (across == 0.0) return along_z(up);
      return Eigen::Vector3d(direction.x() * radius_ / across, direction.y() * radius_ / across,
                             up);
    }
    case Type::kBox:
      return Eigen::Vector3d(direction.x() < 0.0 ? -half_.x() : half_.x(),
                             direction.y() < 0.0 ? -half_.y() : half_.y(), up);
    case Type::kHull:
      break;
  }
  const Eigen::Vector3d* farthest = &points_->front();
  double most = direction.dot(*farthest);
  for (const Eigen::Vector3d& point : *points_) {
    const double reach = direction.dot(point);
    if (reach <= most) continue;
    most = reach;
    farthest = &point;
  }
  return *farthest;
}

SegmentBox segment_box_distance(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                const Eigen::Vector3d& half_extents) {
  const Eigen::Vector3d step = to - from;
  SegmentBox result;
  result.parameter = nearest_parameter(from, step, half_extents);
  result.distance = point_box_distance(from + result.parameter * step, half_extents);
  if (result.distance > 0.0 || step.isZero(0.0)) return result;
  // The depth of a convex set is concave along a line.
  result.parameter =
      minimise_convex([&](double t) { return point_box_distance(from + t * step, half_extents); });
  result.distance = point_box_distance(from + result.parameter * step, half_extents);
  return result;
}

double segment_box_clearance(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             const Eigen::Vector3d& half_extents) {
  const Eigen::Vector3d step = to - from;
  const double t = nearest_parameter(from, step, half_extents);
  const Eigen::Vector3d nearest = from + t * step;
  return (nearest.cwiseAbs() - half_extents).cwiseMax(0.0).norm();
}

double capsule_distance(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                        const ConvexShape& second, const Eigen::Isometry3d& world_from_second) {
  const Eigen::Vector3d u = world_from_first.linear() * first.bounding_axis();
  const Eigen::Vector3d v = world_from_second.linear() * second.bounding_axis();
  const auto [on_u, on_v] = nearest_on_segments(world_from_first * first.center() - u, 2.0 * u,
                                                world_from_second * second.center() - v, 2.0 * v);
  return (on_u - on_v).norm() - first.bounding_capsule_radius() - second.bounding_capsule_radius();
}

ShapeDistance shape_distance(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                             const ConvexShape& second,
                             const Eigen::Isometry3d& world_from_second) {
  if (first.is_swept_sphere() && second.is_swept_sphere())
    return swept_spheres(first, world_from_first, second, world_from_second);
  const bool first_box = first.type() == ConvexShape::Type::kBox;
  const bool second_box = second.type() == ConvexShape::Type::kBox;
  if ((first.is_swept_sphere() && second_box) || (first_box && second.is_swept_sphere())) {
    const Eigen::Isometry3d& world_from_box = first_box ? world_from_first : world_from_second;
    const Eigen::Isometry3d& world_from_swept = first_box ? world_from_second : world_from_first;
    const Eigen::Isometry3d box_from_swept = world_from_box.inverse() * world_from_swept;
    ShapeDistance result = swept_sphere_box(first_box ? second : first, box_from_swept,
                                            (first_box ? first : second).half_extents());
    result.on_first = world_from_box * result.on_first;
    result.on_second = world_from_box * result.on_second;
    if (first_box) std::swap(result.on_first, result.on_second);
    return result;
  }
  return by_fcl(first, world_from_first, second, world_from_second);
}

ShapeDistance shape_distance(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape,
                             const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d centre = box.center();
  if (shape.is_swept_sphere()) {
    Eigen::Isometry3d box_from_shape = world_from_shape;
    box_from_shape.translation() -= centre;
    ShapeDistance result = swept_sphere_box(shape, box_from_shape, 0.5 * box.sizes());
    result.on_first += centre;
    result.on_second += centre;
    return result;
  }
  Eigen::Isometry3d world_from_box = Eigen::Isometry3d::Identity();
  world_from_box.translation() = centre;
  return by_fcl(shape, world_from_shape, ConvexShape::box(box.sizes()), world_from_box);
}

}  // namespace locograph
