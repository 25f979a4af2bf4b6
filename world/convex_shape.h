#pragma once
/// A convex solid (sphere, capsule, cylinder, box, hull of points) and exact distances between two.
///
///     locograph::ConvexShape arm = locograph::ConvexShape::capsule(0.05, 0.3);
///     locograph::ConvexShape table = locograph::ConvexShape::box(Eigen::Vector3d(1, 2, 0.1));
///     double d = locograph::shape_distance(arm, world_from_arm, table, world_from_table).distance;
///
/// Axes of capsules and cylinders are the local z, origins the middle; metres. Spheres and capsules
/// against each other and against boxes have closed forms here: FCL 0.7 answers some capsule-box
/// pairs wrong by centimetres. The other pairs go to FCL, whose answer counts if its own nearest
/// points certify it to 1e-5 m (the plane between them supports both shapes); otherwise the GJK
/// distance of gjk.h is used. Immutable and thread-safe; copies share what FCL needs.

#include <Eigen/Geometry>
#include <memory>
#include <vector>

namespace locograph {

class ConvexShape {
 public:
  enum class Type { kSphere, kCapsule, kCylinder, kBox, kHull };

  /// length: between the centres of the capsule's end spheres. Sizes that are not positive and
  /// finite (a capsule's length may be 0), and fewer than four points, throw Error.
  static ConvexShape sphere(double radius);
  static ConvexShape capsule(double radius, double length);
  static ConvexShape cylinder(double radius, double height);
  static ConvexShape box(const Eigen::Vector3d& size);
  static ConvexShape hull(std::vector<Eigen::Vector3d> points);

  Type type() const { return type_; }
  /// Sphere and capsule: a segment along z swept by a sphere.
  bool is_swept_sphere() const { return type_ == Type::kSphere || type_ == Type::kCapsule; }
  double radius() const { return radius_; }
  double half_length() const { return half_.z(); }
  const Eigen::Vector3d& half_extents() const { return half_; }  ///< of a box
  const Eigen::Vector3d& center() const { return center_; }      ///< of the bounding sphere
  double bounding_radius() const { return bounding_radius_; }

  /// A capsule around the shape: its end spheres' centres are center() +- bounding_axis(). For a
  /// sphere or a capsule it is the shape itself.
  const Eigen::Vector3d& bounding_axis() const { return bounding_axis_; }
  double bounding_capsule_radius() const { return bounding_capsule_radius_; }

  /// A point of the shape that is farthest along a local direction, which is not zero.
  Eigen::Vector3d support(const Eigen::Vector3d& direction) const;

  struct Fcl;
  const Fcl& fcl() const { return *fcl_; }

 private:
  ConvexShape(Type type, double radius, const Eigen::Vector3d& half);

  Type type_;
  double radius_;
  Eigen::Vector3d half_;  // capsule, cylinder: (0, 0, half length)
  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double bounding_radius_ = 0.0;
  Eigen::Vector3d bounding_axis_ = Eigen::Vector3d::Zero();
  double bounding_capsule_radius_ = 0.0;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> points_;
  std::shared_ptr<const Fcl> fcl_;
};

/// Between the bounding capsules: where it is positive, the shapes are at least as far apart. Far
/// cheaper than their distance.
double capsule_distance(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                        const ConvexShape& second, const Eigen::Isometry3d& world_from_second);

struct ShapeDistance {
  /// Negative on penetration: a depth. For spheres and capsules against a box it is that of the
  /// deepest sphere, otherwise how far the shapes have to be moved apart: along the normals of a
  /// box, along and across a cylinder, or along FCL's normals, whichever is least. Never less than
  /// the least way apart.
  double distance = 0.0;
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();
};

/// Points are in the world frame.
ShapeDistance shape_distance(const ConvexShape& first, const Eigen::Isometry3d& world_from_first,
                             const ConvexShape& second, const Eigen::Isometry3d& world_from_second);

/// The same for an axis-aligned box in the world.
ShapeDistance shape_distance(const ConvexShape& shape, const Eigen::Isometry3d& world_from_shape,
                             const Eigen::AlignedBox3d& box);

/// Signed distance between the points of a segment and an axis-aligned box about the origin: the
/// distance if they are apart, else minus the depth of the segment's deepest point. parameter in
/// [0, 1] tells where on the segment.
struct SegmentBox {
  double distance = 0.0, parameter = 0.0;
};
SegmentBox segment_box_distance(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                const Eigen::Vector3d& half_extents);

/// Its positive part alone, which is cheaper: 0 if the segment touches the box.
double segment_box_clearance(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                             const Eigen::Vector3d& half_extents);

}  // namespace locograph
