#pragma once
/// EDGE_BALL_ROLLING: between two configurations a ball that is held rolls on what it touches.
///
///     EDGE_BALL_ROLLING id id  n contact  weights
///
///     graph.add_edge(EdgeBallRolling(11, 1e5), before, after);   // of PARAMS_CONTACT 11
///
/// Error (3) [m]: the slip along both directions of the plane or bar that the contact is on, as if
/// the ball turned the shortest way; the height above that, of the second configuration
/// (robots/rolling_ball.h). EDGE_CONTACT holds the ball where it touches down.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/contact_parameter.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/robots/rolling_ball.h>

#include <memory>
#include <optional>

namespace locograph {

struct EdgeBallRolling : WeightedEdge<3, VertexConfiguration, VertexConfiguration> {
  static constexpr std::string_view kTag = "EDGE_BALL_ROLLING";
  static constexpr ConstraintKind kConstraint = ConstraintKind::kEquality;
  /// m; the judge allows 1 mm of slip while the ball is held, and 1e-4 m of height.
  static constexpr double kSlipTolerance = 1e-4, kHeightTolerance = 4e-5;
  int contact_number = 0;
  std::shared_ptr<const ContactParameter> contact;  ///< looked up by bind()
  std::optional<BallTrack> track;                   ///< likewise
  auto fields() { return std::tie(contact_number); }
  /// Throws Error for a contact that is not of a ball.
  void bind(const Parameters& parameters);

  EdgeBallRolling() = default;
  EdgeBallRolling(int contact_number, double weight);

  void error(const ConfigurationState& a, const ConfigurationState& b,
             Eigen::Ref<Eigen::Vector3d> e) const;
  void jacobians(const ConfigurationState& a, const ConfigurationState& b,
                 JacobianRef<EdgeBallRolling, 0> ja, JacobianRef<EdgeBallRolling, 1> jb) const;
  double row_tolerance(int row) const { return row < 2 ? kSlipTolerance : kHeightTolerance; }
  RowLabel row_label(int row) const;

 private:
  BallPose pose(const ConfigurationState& q) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeBallRolling::kTag, EdgeBallRolling)
extern template class TypedEdgePool<EdgeBallRolling>;

}  // namespace locograph
