#include <locograph/common/error.h>
#include <locograph/planners/plan/clearance_search.h>

#include <cmath>

namespace locograph {

ClearanceSearch::ClearanceSearch(const Robot& robot, const CollisionWorld& world,
                                 const Motion& motion, MovingShapes& shapes,
                                 const CheckOptions& options)
    : robot_(robot),
      world_(world),
      motion_(motion),
      shapes_(shapes),
      options_(options),
      sampler_(robot, motion),
      obstacle_path_(options.obstacles ? std::span<const Obstacle>(*options.obstacles)
                                       : std::span<const Obstacle>()) {}

ClearanceSearch::Sample ClearanceSearch::sample(int vertex, double fraction,
                                                ViolationTally& tally) {
  Sample sample;
  sample.fraction = fraction;
  sampler_.link_poses(vertex, fraction, sample.world_from_link);
  const double time_s = sampler_.time_s(vertex, fraction);
  const CollisionWorld::Closest closest =
      kind_ == Kind::kObstacles ? world_.environment_distance(sample.world_from_link, time_s)
                                : world_.self_distance(sample.world_from_link);
  ++samples_;
  sample.distance = closest.distance_m;
  if (closest.link < 0 && closest.distance_m < tally.limit())
    throw Error("a required clearance of " + std::to_string(tally.limit()) + " m",
                "one below the " + std::to_string(closest.distance_m) +
                    " m up to which the CollisionWorld computes distances");
  tally.add(closest.distance_m, vertex, time_s, closest.point, [&] {
    if (closest.link < 0) return std::string("nothing within reach of the distance query");
    return robot_.links()[std::size_t(closest.link)].name + " and " + closest.what;
  });
  return sample;
}

double ClearanceSearch::path_bound(int step, const Sample& from, const Sample& to) const {
  const double fraction = to.fraction - from.fraction;
  if (kind_ == Kind::kSelf)
    return shapes_.relative_path_bound(from.world_from_link, to.world_from_link, fraction);
  const double begin_s = sampler_.time_s(step, from.fraction);
  const double end_s = sampler_.time_s(step, to.fraction);
  const double obstacles = options_.obstacles
                               ? obstacle_path_.bound(begin_s, end_s)
                               : options_.max_obstacle_speed_m_s * std::abs(end_s - begin_s);
  return obstacles + shapes_.path_bound(from.world_from_link, to.world_from_link, fraction);
}

void ClearanceSearch::refine(int step, const Sample& from, const Sample& to,
                             ViolationTally& tally) {
  const double bound = 0.5 * (from.distance + to.distance - path_bound(step, from, to));
  const double resolution = options_.clearance_resolution_m;
  const bool new_minimum = bound < tally.worst() - resolution;
  const bool new_violation = !tally.violated_at(step) && bound < tally.limit() - resolution;
  if (!new_minimum && !new_violation) return;
  const double middle = 0.5 * (from.fraction + to.fraction);
  if (middle <= from.fraction || middle >= to.fraction) return;
  const Sample between = sample(step, middle, tally);
  refine(step, from, between, tally);
  refine(step, between, to, tally);
}

void ClearanceSearch::run(Kind kind, const UsableParts& usable, ViolationTally& tally) {
  kind_ = kind;
  const std::size_t vertices = motion_.configurations.size();
  std::vector<double> distances(vertices, 0.0);
  for (std::size_t i = 0; i < vertices; ++i)
    if (usable.vertices[i]) distances[i] = sample(int(i), 0.0, tally).distance;
  for (std::size_t i = 0; i + 1 < vertices; ++i) {
    if (!usable.steps[i]) continue;
    shapes_.set_step(
        configuration_step(robot_, motion_.configurations[i], motion_.configurations[i + 1]));
    Sample from, to;
    to.fraction = 1.0;
    from.distance = distances[i];
    to.distance = distances[i + 1];
    sampler_.link_poses(int(i), 0.0, from.world_from_link);
    sampler_.link_poses(int(i), 1.0, to.world_from_link);
    refine(int(i), from, to, tally);
  }
}

}  // namespace locograph
