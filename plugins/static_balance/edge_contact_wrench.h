#pragma once
/// EDGE_CONTACT_WRENCH: every contact wrench is one that its contact can bear.
///
///     EDGE_CONTACT_WRENCH wrenches  n  weights
///
/// Error (n, the rows of all contacts one after the other): max(0, g) of each limit g ≤ 0, f and m
/// being force and moment along the contact's axes (contact_parameter.h), X and Y the half sizes:
///
///   surface, point,   −fz,   fz − f_max                                             [N]
///   wheel             √(fx² + fy²) − μ fz,  or K sides: nₖ·(fx, fy) − μ_K fz         [N]
///   surface           ±my − X fz,  ±mx − Y fz      centre of pressure in the rectangle [N m]
///                     |Y fx − μ' mx| + |X fy − μ' my| − μ'(X + Y) fz − mz            [N m]
///                     |Y fx + μ' mx| + |X fy + μ' my| − μ'(X + Y) fz + mz            [N m]
///   rung              |fx| − f_max,  |fy| − f_max,  |fz| − f_max                     [N]
///                     |mx| − m_max,  |mz| − m_max                                    [N m]
///
/// The yaw limits, four rows each for the signs of their |·|, are Caron, Pham & Nakamura 2015,
/// "Stability of surface contacts for humanoid robots: closed-form formulae of the contact wrench
/// cone", with the rows above and four sides, the sixteen rows of that cone. It is the
/// cone of four corner forces in pyramids: μ' = μ/√2 keeps these inside Coulomb's (for `outer`
/// pyramids μ' = μ). μ_K = μ cos(π/K) for inner pyramids, μ for outer ones.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/static_balance/vertex_wrenches.h>

namespace locograph {

struct EdgeContactWrench : WeightedEdge<Eigen::Dynamic, VertexWrenches> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_CONTACT_WRENCH";
  static constexpr double kTolerance = 1e-3;  ///< N, N m

  EdgeContactWrench() = default;
  EdgeContactWrench(const ContactList& contacts, double weight);

  /// Throws Error for other rows than the contacts of the vertex have.
  void check(const Graph& graph) const;
  void error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const WrenchesState& wrenches, JacobianRef<EdgeContactWrench, 0> j) const;
  RowLabel row_label(int row, const VertexWrenches& wrenches) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeContactWrench::kTag, EdgeContactWrench)
extern template class TypedEdgePool<EdgeContactWrench>;

}  // namespace locograph
