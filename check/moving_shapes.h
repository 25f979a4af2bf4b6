#pragma once
/// The collision shapes of a robot in motion: how far they can travel between two samples of a
/// step.
///
///     locograph::MovingShapes shapes(robot);
///     shapes.set_step(curve.step(3).bounds());
///     double at_most = shapes.path_bound(poses_at_0_25, poses_at_0_50, 0.25);  // of the step
///
/// Bound. Joints and base turn at rates of at most w during a step, which change at a rate of at
/// most v. A point x then has |x''| <= M = sum of v_b r_b, and over pairs (a above b, or a = b) of
/// w_a w_b r_b, each unequal pair counted twice, because
/// d2x/dq_a dq_b = axis_a x (axis_b x (x - origin_b)); r_b is the
/// largest distance of the shape from joint b in any configuration. Over an interval, scaled to
/// length 1, the variance of x' is (1/2) int int |x'(s) - x'(t)|^2 ds dt <= M^2 / 12 and its mean
/// is the chord, so the path is at most (int |x'|^2)^(1/2) <= (|chord|^2 + M^2 / 12)^(1/2). It also
/// is at most |p'| + sum w_b r_b. All of it is about shapes as sets: a wheel that spins about its
/// own axis does not move, a sphere's radius does not count.
///
/// A prismatic joint's reach uses its limits. Meshes count as their convex hull.
/// Not thread-safe: set_step keeps numbers of the step.

#include <locograph/check/motion_curve.h>
#include <locograph/robots/robot.h>
#include <locograph/world/convex_shape.h>

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace locograph {

class MovingShapes {
 public:
  explicit MovingShapes(const Robot& robot);

  int size() const { return int(shapes_.size()); }
  /// The link whose <collision> the shape is.
  int link(int shape) const { return shapes_[std::size_t(shape)].link; }

  /// False: turning this active joint moves no shape, as for the joint of a round wheel.
  bool joint_moves_shapes(int active) const { return moves_shapes_[std::size_t(active)]; }

  void set_step(const StepBounds& step);
  /// No point of any shape travels further than this during the step [m].
  double step_length_bound() const;
  /// No point of any shape is further than this from the chord between two places of its way that
  /// are `fraction` of the step apart [m]: M / 8.
  double bend(double fraction) const;
  /// The same for all shapes, as seen from the base.
  double step_length_bound_in_base() const;
  /// How much longer than their chords the paths of shapes as seen from the base can be, between
  /// two samples that are `fraction` of the step apart [m].
  double bend_in_base(double fraction) const;

  /// Largest path of a shape between two samples that are `fraction` of the step apart [m]. Of all
  /// links, or of some: one bool for each.
  double path_bound(std::span<const Eigen::Isometry3d> from, std::span<const Eigen::Isometry3d> to,
                    double fraction, const std::vector<bool>* links = nullptr) const;
  /// The same for two shapes relative to each other, over the shapes of self-collision pairs.
  double relative_path_bound(std::span<const Eigen::Isometry3d> from,
                             std::span<const Eigen::Isometry3d> to, double fraction) const;

 private:
  /// An axis of the robot: how fast it moves by an active joint, how far the shape is from it.
  struct Mover {
    int active;
    double rate;
    bool prismatic;
    double reach;
  };
  struct Shape {
    int link = -1;     // as in the URDF
    int carrier = -1;  // link it moves with, up to its own spin
    Eigen::Isometry3d carrier_from_shape;
    ConvexShape geometry;
    Eigen::Vector3d end_1, end_2;  // of its bounding capsule, carrier frame
    double loose_radius = 0.0;     // of that capsule; 0 if it is the shape
    bool in_self_pair = false;
    double base_reach = 0.0;
    std::vector<Mover> movers;  // above the carrier, root first
  };
  struct Bound {
    double length = 0.0, second_derivative = 0.0;  // of the whole step
  };

  void add(const Robot& robot, const CollisionShape& shape);
  static Bound bound(const Shape& shape, const StepBounds& step, bool in_world);
  static double path(const Shape& shape, const Bound& bound, const Eigen::Isometry3d& from,
                     const Eigen::Isometry3d& to, double fraction);

  std::vector<Shape> shapes_;
  std::vector<bool> moves_shapes_;
  std::vector<Bound> in_world_, in_base_;
};

}  // namespace locograph
