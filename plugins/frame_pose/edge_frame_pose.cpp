#include <locograph/plugins/frame_pose/edge_frame_pose.h>
#include <locograph/robots/orientation_error.h>

namespace locograph {

template class TypedEdgePool<EdgeFramePose>;

EdgeFramePose::EdgeFramePose(int number, const Eigen::Isometry3d& world_from_target,
                             const Eigen::Matrix<double, 6, 1>& weights_)
    : frame_number(number), target(world_from_target) {
  weights = weights_;
}

void EdgeFramePose::error(const ConfigurationState& q,
                          Eigen::Ref<Eigen::Matrix<double, 6, 1>> e) const {
  require_same_robot(kTag, q.robot, robot);
  const Eigen::Matrix3d axes = target.rotation.toRotationMatrix();
  const Eigen::Isometry3d now = frame->world_from_frame(q.kinematics);
  e.head<3>() = axes.transpose() * (now.translation() - target.position);
  e.tail<3>() = OrientationError(axes, now.linear()).vector;
}

void EdgeFramePose::jacobians(const ConfigurationState& q, JacobianRef<EdgeFramePose, 0> j) const {
  const Eigen::Matrix3d axes = target.rotation.toRotationMatrix();
  const Eigen::Isometry3d now = frame->world_from_frame(q.kinematics);
  const Eigen::Matrix3d turning = OrientationError(axes, now.linear()).derivative();
  for (int c = 0; c < 3; ++c) {
    q.kinematics.add_point_gradient(frame->link, now.translation(), axes.col(c), 1.0,
                                    j.row(c).data());
    q.kinematics.add_rotation_gradient(frame->link, turning.row(c).transpose(), 1.0,
                                       j.row(3 + c).data());
  }
}

}  // namespace locograph
