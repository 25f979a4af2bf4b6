#include <locograph/plugins/plan_tracking/edge_plan_tracking.h>
#include <locograph/robots/orientation_error.h>

namespace locograph {

template class TypedEdgePool<EdgePlanTracking>;

void ReferenceConfiguration::read(FieldReader& in) {
  for (Eigen::Index i = 0; i < size(); ++i) (*this)[i] = in.number();
  if (in.peek().find_first_of("+-.0123456789") != 0) return;
  conservativeResize(size() + 1);
  (*this)[size() - 1] = in.number();
  read_quaternion(in, *this);
}

void ReferenceConfiguration::write(FieldWriter& out) const {
  for (Eigen::Index i = 0; i < size(); ++i) out.number((*this)[i]);
}

EdgePlanTracking::EdgePlanTracking(const Eigen::VectorXd& reference_,
                                   const Eigen::VectorXd& weights_) {
  reference = reference_;
  weights = weights_;
}

void EdgePlanTracking::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), q.model().tangent_size());
  require_rows("reference of EDGE_PLAN_TRACKING", reference.size(), q.q.size());
  q.model().difference(reference.data(), q.q.data(), e.data());
}

void EdgePlanTracking::jacobians(const ConfigurationState& q,
                                 JacobianRef<EdgePlanTracking, 0> j) const {
  const int base = q.model().base_tangent_size();
  if (base > 0) {
    const Eigen::Quaterniond from(reference.segment<4>(3).data());
    const Eigen::Quaterniond relative = from.conjugate() * q.base_rotation();
    const Eigen::AngleAxisd rotation(relative);
    j.topLeftCorner<3, 3>() = relative.toRotationMatrix();
    j.block<3, 3>(3, 3) = inverse_right_jacobian(rotation.angle() * rotation.axis());
  }
  for (int i = base; i < j.rows(); ++i) j(i, i) = 1.0;
}

}  // namespace locograph
