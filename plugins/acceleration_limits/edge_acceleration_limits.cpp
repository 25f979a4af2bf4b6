#include <locograph/plugins/acceleration_limits/acceleration_rows.h>
#include <locograph/plugins/acceleration_limits/edge_acceleration_limits.h>

namespace locograph {

template class TypedEdgePool<EdgeAccelerationLimits>;

namespace {

AccelerationRows rows_of(const EdgeAccelerationLimits& edge, const ConfigurationState& a,
                         const ConfigurationState& b, const ConfigurationState& c) {
  return {edge.kTag, edge.limits, {a, b, c, {b.time_s - a.time_s, c.time_s - b.time_s}}};
}

}  // namespace

EdgeAccelerationLimits::EdgeAccelerationLimits(const Eigen::VectorXd& limits_, double weight)
    : limits(limits_) {
  weights.setConstant(limits.size(), weight);
}

EdgeAccelerationLimits::EdgeAccelerationLimits(const Robot& robot, double joint, double base_linear,
                                               double base_angular, double weight) {
  resize(robot.active_joint_count() + 2);
  limits.setConstant(joint);
  limits.tail<2>() << base_linear, base_angular;
  weights.setConstant(weight);
}

void EdgeAccelerationLimits::bind(const Parameters& parameters) const {
  AccelerationRows::check(kTag, limits, dimension(), parameters);
}

void EdgeAccelerationLimits::error(const ConfigurationState& a, const ConfigurationState& b,
                                   const ConfigurationState& c,
                                   Eigen::Ref<Eigen::VectorXd> e) const {
  rows_of(*this, a, b, c).error(LimitKind::kHinged, e);
}

void EdgeAccelerationLimits::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                       const ConfigurationState& c,
                                       JacobianRef<EdgeAccelerationLimits, 0> ja,
                                       JacobianRef<EdgeAccelerationLimits, 1> jb,
                                       JacobianRef<EdgeAccelerationLimits, 2> jc) const {
  rows_of(*this, a, b, c).by_configurations(LimitKind::kHinged, &ja, jb, jc);
}

}  // namespace locograph
