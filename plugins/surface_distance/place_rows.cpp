#include <locograph/plugins/surface_distance/place_rows.h>

namespace locograph {
namespace {

std::optional<PlaceRow> row_apart(const ConfigurationState& q, const TouchablePlaces& places,
                                  int place, std::size_t b, const PlaceBands& bands) {
  const RobotParameter::LinkBound& bound = q.robot->bounds[b];
  const double limit = bands.margin_m + bands.apart_m;
  if (places.is_far(place, q.bound_centre(b), bound.radius, limit)) return std::nullopt;
  TouchablePlaces::Distance worst{limit, Eigen::Vector3d::Zero()};
  int nearest = -1;
  for (int i = bound.begin; i < bound.end; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const TouchablePlaces::Distance found =
        places.distance(place, q.sphere_centre(k), q.robot->spheres[k].radius);
    if (found.value >= worst.value) continue;
    worst = found;
    nearest = i;
  }
  if (nearest < 0) return std::nullopt;
  return PlaceRow{worst.value - bands.margin_m, q.sphere_centre(nearest), worst.gradient};
}

std::optional<PlaceRow> row_touching(const ConfigurationState& q, const TouchablePlaces& places,
                                     int place, std::size_t b, double deepest_m,
                                     const PlaceBands& bands) {
  const Eigen::Isometry3d& pose = q.kinematics.world_from_link(q.robot->bounds[b].link);
  const double limit = bands.touching_m - deepest_m;
  const std::optional<TouchablePlaces::Depth> depth =
      places.depth(place, static_cast<int>(b), pose, limit);
  if (!depth) return std::nullopt;
  return PlaceRow{depth->value + deepest_m, depth->point, depth->out};
}

}  // namespace

Eigen::AlignedBox3d reach_of(const ConfigurationState& q, double reach_m) {
  Eigen::AlignedBox3d around;
  for (std::size_t b = 0; b < q.robot->bounds.size(); ++b) {
    around.extend(box_around(q.bound_centre(b), q.robot->bounds[b].radius + reach_m));
  }
  return around;
}

std::optional<PlaceRow> place_row(const ConfigurationState& q, const PlaceRelations& relations,
                                  int place, std::size_t i, std::size_t bound,
                                  const PlaceBands& bands) {
  switch (relations.relation(i, bound)) {
    case PlaceRelations::Relation::kApart:
      return row_apart(q, relations.places(), place, bound, bands);
    case PlaceRelations::Relation::kTouches:
      return row_touching(q, relations.places(), place, bound, relations.deepest_m(i, bound),
                          bands);
    case PlaceRelations::Relation::kNone:
      break;
  }
  return std::nullopt;
}

}  // namespace locograph
