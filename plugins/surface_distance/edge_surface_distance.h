#pragma once
/// EDGE_SURFACE_DISTANCE: what may be touched is in the way of everything that does not touch it.
///
///     EDGE_SURFACE_DISTANCE id  n places before after margin  k near…  weights
///
///     graph.parameters().set(30, std::make_shared<const PlacesParameter>(robot, 0, world));
///     EdgeSurfaceDistance edge(*robot, 30, 20, 20, 0.008, 1e4);
///     edge.bind(graph.parameters());  // once for all configurations of the stance
///     graph.add_edge(edge, q);
///
/// places: a PARAMS_PLACES. before, after: the PARAMS_STANCEs that are held up to the configuration
/// and from it on, the same one within a stance. Of two stances the contacts of both are closed;
/// the links of a contact that only one of them has may be at what they touch, not in it. near: k
/// PARAMS_CONTACTs that are not closed here, but whose links are near what they touch, as they have
/// just left it or are about to come down: they are kept out of it, without the margin.
///
/// Error (links with spheres, RobotParameter::bounds) [m]: of the places that the link is nearest
/// to violating, max(0, margin − d) where it keeps away, d the signed distance of the spheres that
/// cover it; max(0, depth − allowed) where it touches, by its exact shapes. The rows are those of
/// the stance planner (place_rows.h).
///
/// Links fixed to the contact's plane have no error there: EDGE_CONTACT holds them. Links without
/// weight cost nothing. d has kinks where another sphere or place becomes the nearest.

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/configuration/row_labels.h>
#include <locograph/plugins/configuration/stance_parameter.h>
#include <locograph/plugins/surface_distance/place_rows.h>
#include <locograph/plugins/surface_distance/places_parameter.h>

#include <memory>
#include <optional>
#include <vector>

namespace locograph {

/// Numbers of parameters in the line of an edge, after how many there are.
struct ParameterNumbers {
  std::vector<int> all;

  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};

struct EdgeSurfaceDistance : WeightedEdge<Eigen::Dynamic, VertexConfiguration> {
  static constexpr bool kOneSided = true;
  static constexpr std::string_view kTag = "EDGE_SURFACE_DISTANCE";
  int places_number = 0, before_number = 0, after_number = 0;
  double margin_m = 0.008;
  ParameterNumbers near_numbers;
  /// Looked up by bind(); relations are made anew for other ones only.
  std::shared_ptr<const PlacesParameter> places;
  std::shared_ptr<const StanceParameter> before, after;
  ContactList near;
  std::shared_ptr<const PlaceRelations> relations;
  auto fields() {
    return std::tie(places_number, before_number, after_number, margin_m, near_numbers);
  }
  /// Throws Error for a negative margin, for stances and contacts of another robot, for two stances
  /// that have no contact in common, and for a near contact of an end effector that has a closed
  /// one.
  void bind(const Parameters& parameters);

  EdgeSurfaceDistance() = default;
  EdgeSurfaceDistance(const RobotParameter& robot, int places_number, int before_number,
                      int after_number, double margin_m, double weight,
                      std::vector<int> near_numbers = {});

  void error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const;
  void jacobians(const ConfigurationState& q, JacobianRef<EdgeSurfaceDistance, 0> j) const;
  double row_tolerance(int row) const;
  RowLabel row_label(int row) const;

 private:
  /// Of the rows of a link, the one that is violated most.
  std::optional<PlaceRow> worst_row(const ConfigurationState& q, std::size_t bound) const;
};
LOCOGRAPH_REGISTER_EDGE(EdgeSurfaceDistance::kTag, EdgeSurfaceDistance)
extern template class TypedEdgePool<EdgeSurfaceDistance>;

}  // namespace locograph
