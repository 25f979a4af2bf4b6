#include <locograph/plugins/wheel_contact/edge_wheel_contact.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeWheelContact>;

void EdgeWheelContact::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, q.robot, robot);
  for (std::size_t w = 0; w < wheels->wheels.size(); ++w) {
    const Wheel& wheel = wheels->wheels[w];
    const Eigen::Isometry3d& carrier = q.kinematics.world_from_link(wheel.carrier);
    const double height = (carrier * wheel.centre_in_carrier).z();
    const double tilt = carrier.linear().row(2).dot(wheel.axle_in_carrier);
    e[2 * w] = height - wheel.radius_m * std::sqrt(std::max(0.0, 1.0 - tilt * tilt));
    e[2 * w + 1] = tilt;
  }
}

void EdgeWheelContact::jacobians(const ConfigurationState& q,
                                 JacobianRef<EdgeWheelContact, 0> j) const {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (std::size_t w = 0; w < wheels->wheels.size(); ++w) {
    const Wheel& wheel = wheels->wheels[w];
    const Eigen::Isometry3d& carrier = q.kinematics.world_from_link(wheel.carrier);
    const Eigen::Vector3d centre = carrier * wheel.centre_in_carrier;
    const Eigen::Vector3d axle = carrier.linear() * wheel.axle_in_carrier;
    const double upright = std::sqrt(std::max(1e-12, 1.0 - axle.z() * axle.z()));
    double* height_row = j.row(2 * w).data();
    q.kinematics.add_point_gradient(wheel.carrier, centre, up, 1.0, height_row);
    q.kinematics.add_axis_gradient(wheel.carrier, axle, up, wheel.radius_m * axle.z() / upright,
                                   height_row);
    q.kinematics.add_axis_gradient(wheel.carrier, axle, up, 1.0, j.row(2 * w + 1).data());
  }
}

}  // namespace locograph
