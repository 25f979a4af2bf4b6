#pragma once
/// A ball in the way of a plan on legs, wherever it leads.
///
///     const Obstacle ball = ball_in_the_way(motion, *task.robot, 1.5);

#include <gtest/gtest.h>
#include <locograph/check/motion.h>
#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <vector>

namespace locograph::test {

/// It appears so many seconds before a link gets there: the first place that the robot, as its
/// spheres are, has been 5 cm or more away from until then, and is in the end.
inline Obstacle ball_in_the_way(const Motion& motion, const RobotParameter& robot,
                                double seconds_before) {
  constexpr std::size_t kEvery = 10;
  constexpr double kFree_m = 0.05, kFirst_s = 1.0;
  struct Seen {
    double time_s;
    std::vector<Eigen::Vector3d> centres = {}, links = {};
  };
  std::vector<Seen> all;
  RobotState state(*robot.robot);
  for (std::size_t i = 0; i < motion.configurations.size(); i += kEvery) {
    state.update(motion.configurations[i].data());
    Seen& seen = all.emplace_back(Seen{motion.time_s[i]});
    for (const CollisionSphere& sphere : robot.spheres) {
      seen.centres.push_back(state.world_from_link(sphere.link) * sphere.center);
    }
    for (const RobotParameter::LinkBound& bound : robot.bounds) {
      seen.links.push_back(state.world_from_link(bound.link) * bound.center);
    }
  }
  Obstacle ball;
  ball.name = "ball";
  ball.shape = Obstacle::Shape::kSphere;
  ball.size.x() = 0.1;
  const auto is_clear = [&](const Seen& seen) {
    for (std::size_t k = 0; k < robot.spheres.size(); ++k) {
      if (ball.distance(seen.centres[k], 0.0) - robot.spheres[k].radius < kFree_m) return false;
    }
    return true;
  };
  for (const Seen& there : all) {
    const double appears_s = there.time_s - seconds_before;
    if (appears_s < kFirst_s) continue;
    for (const Eigen::Vector3d& link : there.links) {
      ball.world_from_obstacle.translation() = link;
      const auto appears = std::ranges::find_if(
          all, [&](double t) { return t >= appears_s; }, &Seen::time_s);
      if (!is_clear(all.back()) || !std::all_of(all.begin(), appears + 1, is_clear)) continue;
      ball.appears_s = appears_s;
      return ball;
    }
  }
  ADD_FAILURE() << "no link moves far enough";
  return ball;
}

}  // namespace locograph::test
