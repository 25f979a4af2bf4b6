#pragma once
/// EDGE_CONTACT: contact closure: an end effector stays at the contact it has in the world.
///
///     EDGE_CONTACT id  n contact  weights
///
///     graph.parameters().set(10, std::make_shared<const ContactParameter>(robot, 0, standing));
///     graph.add_edge(EdgeContact(*graph.parameters().get<ContactParameter>(10), 10, 1e6), q);
///
/// `contact` is a PARAMS_CONTACT. Error (n): the rows of robots/contact_closure.h, 6 for a surface,
/// 5 for one whose yaw is free, 3 for a point, 5 for a rung, 2 for a wheel, 4 for a locked one.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

struct EdgeContact : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_CONTACT";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  /// m, rad; the judge allows 1e-4 m and 1e-3 rad. Plans as they are planned are closed to a little
  /// more than 3e-5 m (segment_motion.cpp).
  static constexpr double kPositionTolerance = 4e-5, kAngleTolerance = 3e-4;
  int contact_number = 0;
  std::shared_ptr<const ContactParameter> contact;  ///< looked up by bind()
  auto fields() { return std::tie(contact_number); }
  void bind(const Parameters& parameters) {
    contact = parameters.get<ContactParameter>(contact_number);
    require_rows(kTag, dimension(), contact->closure.rows());
  }

  EdgeContact() = default;
  EdgeContact(const ContactParameter& contact, int contact_number, double weight);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeContact, 0> j) const;
  double row_tolerance(int row) const;
  RowLabel row_label(int row) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeContact::kTag, EdgeContact)
extern template class TypedEdgePool<EdgeContact>;

}  // namespace locograph
