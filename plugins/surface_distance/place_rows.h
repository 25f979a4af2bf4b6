#pragma once
/// What a link lacks to a surface, bar or solid box: one row for each link and place.
///
///     const PlaceBands bands{.margin_m = 0.008, .apart_m = 0.1, .touching_m = 0.03};
///     const std::vector<int>& near = relations.near(reach_of(q, bands.margin_m + bands.apart_m));
///     for (std::size_t i = 0; i < near.size(); ++i)
///       if (const std::optional<PlaceRow> row = place_row(q, relations, near[i], i, bound, bands))
///         q.kinematics.add_point_gradient(link, row->point, row->gradient, 1.0, gradient.data());
///
/// A link that keeps away has the distance of the nearest of the spheres that cover it, less the
/// margin. A link that touches has the depth of its exact shapes, added to how deep it may be. At
/// least 0 where it holds.

#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/surface_distance/place_relations.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>

namespace locograph {

struct PlaceBands {
  double margin_m = 0.0;  ///< of links that keep away
  /// Rows whose value is this or more are left out: of links that keep away, of those that touch.
  double apart_m = 0.0, touching_m = 0.0;
};

struct PlaceRow {
  double value;                     ///< m
  Eigen::Vector3d point, gradient;  ///< of the value by the point, which is fixed to the link
};

/// Around all spheres of a robot, and so far beyond them.
Eigen::AlignedBox3d reach_of(const ConfigurationState& q, double reach_m);

/// Of a bound and a place, which is the i-th of the relations. Nothing where the two have nothing
/// to do with each other, or are too far apart. Deterministic and thread-safe.
std::optional<PlaceRow> place_row(const ConfigurationState& q, const PlaceRelations& relations,
                                  int place, std::size_t i, std::size_t bound,
                                  const PlaceBands& bands);

}  // namespace locograph
