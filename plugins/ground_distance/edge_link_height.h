#pragma once
/// EDGE_LINK_HEIGHT: keeps the exact collision shapes of one link a margin above the ground, z = 0.
///
///     EDGE_LINK_HEIGHT id  robot link margin  weights
///
///     const auto solids = std::make_shared<const LinkSolids>(model, model.link_index("l_sole"));
///     graph.add_edge(EdgeLinkHeight(kRobotNumber, "l_sole", 2e-5, 1e6, solids), configuration);
///
/// For links that touch something near the ground, where spheres that cover them
/// (EDGE_GROUND_DISTANCE) would ask for centimetres too much. Error (1) [m]: max(0, margin - z) of
/// the lowest point of the link's shapes, meshes as their convex hulls. A link without shapes has
/// no error.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/world/convex_shape.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// The exact shapes of a link. Immutable.
class LinkSolids {
 public:
  /// Throws Error for a mesh that was not found or cannot be read.
  LinkSolids(const Robot& robot, int link);

  int link() const { return link_; }
  bool empty() const { return solids_.empty(); }
  /// In the world; not of an empty one.
  Eigen::Vector3d lowest_point(const Eigen::Isometry3d& world_from_link) const;
  /// No point of the shapes is farther than this from a point of the link [m].
  double reach_from(const Eigen::Vector3d& point) const;

 private:
  struct Solid {
    ConvexShape shape;
    Eigen::Isometry3d link_from_shape;
  };
  int link_;
  std::vector<Solid> solids_;
};

struct EdgeLinkHeight : WeightedEdge<1, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_LINK_HEIGHT";
  int robot_number = 0;
  std::string link_name;
  double margin_m = 0.0;
  std::shared_ptr<const LinkSolids> solids;     ///< made by bind() where they are not given
  std::shared_ptr<const RobotParameter> robot;  ///< whose link it is, looked up by bind()
  auto fields() { return std::tie(robot_number, link_name, margin_m); }
  void bind(const Parameters& parameters);

  EdgeLinkHeight() = default;
  EdgeLinkHeight(int robot_number, std::string link_name, double margin_m, double weight,
                 std::shared_ptr<const LinkSolids> solids = nullptr);

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeLinkHeight, 0> j) const;
  RowLabel row_label(int) const { return {link_name + " near the ground", "m"}; }
};
LOCOGRAPH_REGISTER_EDGE(EdgeLinkHeight::kTag, EdgeLinkHeight)
extern template class TypedEdgePool<EdgeLinkHeight>;

}  // namespace locograph
