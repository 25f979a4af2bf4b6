#pragma once
/// The kinematics of one configuration: link poses, Jacobians, centre of mass.
///
///     locograph::RobotState state(robot);
///     state.update(robot.named_configuration("home").data());
///     Eigen::Vector3d wheel = state.world_from_link(robot.link_index("wheel_1")).translation();
///     Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, robot.tangent_size());
///     state.frame_jacobian(robot.link_index("wheel_1"), Eigen::Isometry3d::Identity(), jacobian);
///
/// Everything is in the world frame [m, rad] unless said; columns follow the tangent convention of
/// robot.h. All memory is allocated by the constructor; no other function allocates.
/// Keeps a pointer to the robot, which must outlive it. Thread-safety: one per thread to update,
/// const functions freely shared.
///
/// Before the first update() the state is that of neutral_configuration().

#include <locograph/robots/robot.h>

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace locograph {

class RobotState;
struct LinkPoint;
struct StateUpdate;
struct TreeKernels;

class RobotState {
 public:
  explicit RobotState(const Robot& robot);

  const Robot& robot() const { return *robot_; }

  /// q: robot().configuration_size() numbers; the quaternion must have norm 1.
  void update(const double* q);

  const Eigen::Isometry3d& world_from_link(int link) const {
    return world_from_link_[static_cast<std::size_t>(link)];
  }
  /// A point on an axis of the robot (index into Robot::axes()), and the direction of the axis.
  const Eigen::Vector3d& joint_origin(int axis) const {
    return joint_origin_[static_cast<std::size_t>(axis)];
  }
  const Eigen::Vector3d& joint_axis(int axis) const {
    return joint_axis_[static_cast<std::size_t>(axis)];
  }

  /// Geometric Jacobian, 6 x tangent_size, of a frame fixed to `link`: rows 0-2 velocity of its
  /// origin, rows 3-5 angular velocity, both along the world axes. Overwrites all columns.
  void frame_jacobian(int link, const Eigen::Isometry3d& link_from_frame,
                      Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> jacobian) const;

  /// The linear rows of frame_jacobian(), 3 x tangent_size, for a point fixed to `link` that is now
  /// at point_world. Writes the columns of the base and of support(link) only: the others are zero
  /// in every configuration and left to the caller.
  void point_jacobian(int link, const Eigen::Vector3d& point_world,
                      Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> jacobian) const;

  /// row[k * stride] += scale * direction . d(point)/d(tangent_k) for a point fixed to `link` that
  /// is now at point_world. Touches the columns of the base and of support(link) only.
  void add_point_gradient(int link, const Eigen::Vector3d& point_world,
                          const Eigen::Vector3d& direction_world, double scale, double* row,
                          int stride = 1) const;

  /// row[k * stride] += scale * direction . d(rotation)/d(tangent_k): what turns `link` about the
  /// world direction. Touches the same columns.
  void add_rotation_gradient(int link, const Eigen::Vector3d& direction_world, double scale,
                             double* row, int stride = 1) const;

  /// row[k * stride] += force . d(point)/d(tangent_k) + moment . d(rotation)/d(tangent_k): the two
  /// above in one pass, for what a wrench at point_world does to the tangent.
  void add_wrench_gradient(int link, const Eigen::Vector3d& point_world,
                           const Eigen::Vector3d& force_world, const Eigen::Vector3d& moment_world,
                           double* row, int stride = 1) const;

  /// row[k * stride] += scale * direction . d(axis)/d(tangent_k) for a unit vector fixed to `link`
  /// that now points along axis_world. Touches the same columns.
  void add_axis_gradient(int link, const Eigen::Vector3d& axis_world,
                         const Eigen::Vector3d& direction_world, double scale, double* row,
                         int stride = 1) const;

  /// Throws Error if no link has a mass.
  void require_mass() const;
  /// Mass * centre of mass [kg m] and mass [kg] of one body of robot().tree() and all bodies behind
  /// it. Body 0 stands for the whole robot, body i + 1 for what axis i moves.
  const Eigen::Vector4d& subtree_moment(int body) const {
    return subtree_moment_[static_cast<std::size_t>(body)];
  }
  /// How the mass moment of everything behind an axis moves with it [kg m].
  Eigen::Vector3d moment_column(int axis) const;
  /// Throws Error if no link has a mass.
  Eigen::Vector3d center_of_mass() const;
  /// 3 x tangent_size, overwrites all columns. Throws Error if no link has a mass.
  void center_of_mass_jacobian(Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>> jacobian) const;
  /// row[k * stride] += scale * direction . d(center_of_mass)/d(tangent_k), all columns.
  /// Throws Error if no link has a mass.
  void add_center_of_mass_gradient(const Eigen::Vector3d& direction_world, double scale,
                                   double* row, int stride = 1) const;

 private:
  friend void update_together(std::span<const StateUpdate> updates,
                              std::span<const LinkPoint> first, std::span<const LinkPoint> second,
                              const TreeKernels& kernels);
  const Eigen::Isometry3d& world_from_base() const { return world_from_link_[0]; }
  /// The columns of the base in the gradient of what moves with it.
  void add_base_gradient(const Eigen::Vector3d& point_world, const Eigen::Vector3d& force_world,
                         const Eigen::Vector3d& moment_world, double* row, int stride) const;

  const Robot* robot_;
  const KinematicTree* tree_;
  std::vector<Eigen::Isometry3d> world_from_link_;
  std::vector<Eigen::Vector3d> joint_origin_, joint_axis_;
  std::vector<Eigen::Vector4d> subtree_moment_;  // sum of mass * com of all bodies below, [kg m]
  std::vector<double> coefficients_;
};

}  // namespace locograph
