#include <locograph/plugins/com/edge_com.h>

namespace locograph {

template class TypedEdgePool<EdgeCom>;

EdgeCom::EdgeCom(const Eigen::Vector3d& target_, const Eigen::Vector3d& weights_)
    : target(target_) {
  weights = weights_;
}

/// As with require_fitting_robot(): refused here if it fits none of the robots, by the kinematics
/// if it does not fit its own.
void EdgeCom::bind(const Parameters& parameters) const {
  if (!target.allFinite())
    throw locograph::Error("EDGE_COM with a target that is not finite", "a point");
  const std::set<int> robots = parameters.numbers_of<RobotParameter>();
  for (const int number : robots) {
    if (parameters.get<RobotParameter>(number)->robot->total_mass() > 0.0) return;
  }
  if (!robots.empty()) {
    throw locograph::Error("EDGE_COM for a robot without a mass",
                           "an <inertial> with a positive mass in at least one link of the URDF");
  }
}

void EdgeCom::error(const ConfigurationState& q, Eigen::Ref<Eigen::Vector3d> e) const {
  e = q.kinematics.center_of_mass() - target;
}

void EdgeCom::jacobians(const ConfigurationState& q, JacobianRef<EdgeCom, 0> j) const {
  for (int c = 0; c < 3; ++c) {
    q.kinematics.add_center_of_mass_gradient(Eigen::Vector3d::Unit(c), 1.0, j.row(c).data());
  }
}

}  // namespace locograph
