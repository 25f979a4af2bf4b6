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

std::optional<double> ChangingObstacles::free_after(const Motion& motion, double begin_s) {
  constexpr double kStep_s = 0.25, kApart_m = 0.02, kStillApart_m = 5e-3;
  std::vector<std::vector<Eigen::Vector3d>> all;
  for (const Eigen::VectorXd& q : motion.configurations) all.push_back(centres(q));
  // Where something is there for less than a step, too.
  std::vector<double> changes_s;
  for (const Obstacle* obstacle : obstacles_) {
    for (const double time_s : {obstacle->appears_s, obstacle->vanishes_s}) {
      if (std::isfinite(time_s)) changes_s.push_back(time_s);
    }
  }
  const auto is_free = [&](double after_s) {
    const auto at_s = [&](std::size_t i) { return begin_s + after_s + motion.time_s[i]; };
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!keep_away(all[i], at_s(i), kApart_m)) return false;
    }
    for (std::size_t i = 1; i < all.size(); ++i) {
      for (const double time_s : changes_s) {
        const bool in_step = at_s(i - 1) < time_s && time_s < at_s(i);
        if (in_step &&
            !(keep_away(all[i - 1], time_s, kApart_m) && keep_away(all[i], time_s, kApart_m))) {
          return false;
        }
      }
    }
    return true;
  };
  for (double after_s = 0.0; after_s <= kWaits_s; after_s += kStep_s) {
    if (is_free(after_s)) return after_s;
    waits_ = keep_away(all.front(), begin_s + after_s, kStillApart_m);
    if (!waits_) break;
  }
  return {};
}

std::string ChangingObstacles::refusal() const {
  if (!waits_) return "something meets the robot where it would wait";
  return "the way is not free within " + std::to_string(static_cast<int>(kWaits_s)) + " s";
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
