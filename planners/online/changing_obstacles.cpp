#include <locograph/planners/online/changing_obstacles.h>

#include <algorithm>
#include <cmath>

namespace locograph {

ChangingObstacles::ChangingObstacles(const RobotParameter& robot, const World& world)
    : robot_(robot), state_(*robot.robot) {
  for (const Obstacle& obstacle : world.obstacles) {
    const bool changes = !obstacle.motion.empty() || std::isfinite(obstacle.appears_s) ||
                         std::isfinite(obstacle.vanishes_s);
    if (changes) obstacles_.push_back(&obstacle);
  }
}

std::vector<Eigen::Vector3d> ChangingObstacles::centres(const Eigen::VectorXd& configuration) {
  state_.update(configuration.data());
  std::vector<Eigen::Vector3d> centres;
  for (const CollisionSphere& sphere : robot_.spheres) {
    centres.push_back(state_.world_from_link(sphere.link) * sphere.center);
  }
  return centres;
}

bool ChangingObstacles::keep_away(const std::vector<Eigen::Vector3d>& centres, double time_s,
                                  double apart_m) const {
  return std::ranges::all_of(obstacles_, [&](const Obstacle* obstacle) {
    for (std::size_t k = 0; k < centres.size(); ++k) {
      if (obstacle->distance(centres[k], time_s) <= robot_.spheres[k].radius + apart_m) {
        return false;
      }
    }
    return true;
  });
}

}  // namespace locograph
