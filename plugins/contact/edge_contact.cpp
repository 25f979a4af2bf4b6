#include <locograph/plugins/contact/edge_contact.h>

namespace locograph {

template class TypedEdgePool<EdgeContact>;

EdgeContact::EdgeContact(const ContactParameter& placed, int number, double weight)
    : contact_number(number) {
  weights.setConstant(placed.closure.rows(), weight);
}

void EdgeContact::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_same_robot(kTag, q.robot, contact->robot);
  contact->closure.error(q.kinematics, e.data());
}

void EdgeContact::jacobians(const ConfigurationState& q, JacobianRef<EdgeContact, 0> j) const {
  contact->closure.add_jacobian(q.kinematics, j.data(), j.outerStride());
}

double EdgeContact::row_tolerance(int row) const {
  const bool angle = contact->closure.held()[static_cast<std::size_t>(row)] >= 3;
  return angle ? kAngleTolerance : kPositionTolerance;
}

RowLabel EdgeContact::row_label(int row) const {
  const std::string& name = contact->contact.name();
  if (const std::optional<ContactRowLabel> label = contact->closure.label(row)) {
    return {name + " " + label->name, label->unit};
  }
  RowLabel label = pose_row(contact->closure.held()[static_cast<std::size_t>(row)]);
  label.name = name + " " + label.name;
  return label;
}

}  // namespace locograph
