#include <locograph/planners/online/detour_search.h>
#include <locograph/planners/online/heading.h>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

class Search : public testing::Test {
 protected:
  /// `count` configurations of the drive from `begin` on.
  void take(int begin, int count) {
    all_ = configurations(graph_);
    window_.clear();
    times_.clear();
    for (int i = begin; i < begin + count; ++i) {
      window_.push_back(all_[i].data());
      times_.push_back(0.8 * i);
    }
  }
  std::vector<double> find(const std::vector<Obstacle>& obstacles, double offset = 0.0,
                           double slope = 0.0) {
    WorldDistance world;
    world.obstacles = obstacles;
    DetourSearch search(plan_.robot, options_);
    std::vector<double> offsets;
    for (const Detour& detour : search.find(0, window_, times_, world, {offset}, slope))
      offsets.push_back(detour.offset_m);
    return offsets;
  }
  static double farthest(const std::vector<double>& offsets) {
    double result = 0.0;
    for (const double offset : offsets) {
      if (std::abs(offset) > std::abs(result)) result = offset;
    }
    return result;
  }
  void expect_steady(const std::vector<double>& offsets, double offset, double slope) const {
    double before = offset, change_before = slope;
    for (const double o : offsets) {
      const double change = o - before;
      EXPECT_LE(std::abs(change), options_.steepest * options_.grid_m + 1e-9);
      EXPECT_LE(std::abs(change - change_before), options_.grid_m + 1e-9);
      before = o;
      change_before = change;
    }
  }

  Graph graph_ = planned_drive(centauro_drive());
  Plan plan_ = plan_of(graph_);
  std::vector<Eigen::VectorXd> all_;
  std::vector<const double*> window_;
  std::vector<double> times_;
  DetourOptions options_;
};

TEST_F(Search, StaysOnThePlanInAnEmptyWorld) {
  take(1, 20);
  EXPECT_EQ(find({}), std::vector<double>(20, 0.0));
}

TEST_F(Search, PassesOnTheSideThatIsNearer) {
  take(1, 45);
  const double right = farthest(find({box("b", {2.0, 0.3, 0.4}, {0.4, 0.8, 0.8})}));
  EXPECT_LT(right, -0.3);
  const double left = farthest(find({box("b", {2.0, -0.3, 0.4}, {0.4, 0.8, 0.8})}));
  EXPECT_GT(left, 0.3);
}

TEST_F(Search, TakesTheOtherSideWhenAWallClosesTheNearerOne) {
  take(1, 45);
  const Obstacle b = box("b", {2.0, 0.1, 0.4}, {0.4, 0.8, 0.8});
  EXPECT_LT(farthest(find({b})), -0.3);
  const Obstacle wall = box("wall", {2.0, -1.5, 0.4}, {0.2, 2.0, 0.8});
  EXPECT_GT(farthest(find({b, wall})), 0.3);
}

TEST_F(Search, DecidesASymmetricWorldAlwaysAlike) {
  take(1, 45);
  const Obstacle b = box("b", {2.0, 0.0, 0.4}, {0.4, 0.8, 0.8});
  const std::vector<double> first = find({b});
  EXPECT_GT(std::abs(farthest(first)), 0.3);
  EXPECT_EQ(find({b}), first);
}

TEST_F(Search, GoesOnFromWhereTheRobotIsAndNoSteeperThanAllowed) {
  take(10, 35);
  const std::vector<Obstacle> worlds[] = {{}, {box("b", {2.6, 0.3, 0.4}, {0.4, 0.8, 0.8})}};
  for (const std::vector<Obstacle>& world : worlds) {
    for (const double offset : {0.0, 0.2, -0.4}) {
      for (const double slope : {0.0, 0.04, -0.06}) {
        const std::vector<double> offsets = find(world, offset, slope);
        ASSERT_EQ(offsets.size(), 35u);
        expect_steady(offsets, offset, slope);
      }
    }
  }
  options_.steepest = 1;
  expect_steady(find(worlds[1]), 0.0, 0.0);
}

TEST_F(Search, ComesBackToThePlanBehindTheObstacle) {
  take(1, 49);
  const std::vector<double> offsets = find({box("b", {1.4, 0.3, 0.4}, {0.3, 0.6, 0.8})});
  EXPECT_LT(farthest(offsets), -0.2);
  EXPECT_GT(offsets.back(), 0.5 * farthest(offsets));
}

TEST_F(Search, SeesMovingObstaclesAtTheTimeOfEachConfiguration) {
  take(1, 45);
  Obstacle gone = box("cart", {2.0, 0.3, 0.4}, {0.4, 0.8, 0.8});
  KeyFrame away{1.0, Eigen::Isometry3d::Identity()};
  away.pose.translation() = Eigen::Vector3d(2.0, 9.0, 0.4);
  gone.motion = {away};
  EXPECT_EQ(find({gone}), std::vector<double>(45, 0.0));
}

/// How deep the robot's spheres are in obstacles, at most, where it is moved along the detours.
double deepest(const Plan& plan, const std::vector<const double*>& window,
               const std::vector<Detour>& detours, const WorldDistance& world) {
  RobotState state(*plan.robot->robot);
  double depth = -1.0;
  for (std::size_t k = 0; k < window.size(); ++k) {
    const Eigen::Map<const Eigen::VectorXd> planned(window[k],
                                                    plan.robot->robot->configuration_size());
    Eigen::VectorXd q = planned;
    turn_base(detours[k].yaw_rad, q.data());
    q.head<3>() += detours[k].offset_m * left_of(window[k]);
    state.update(q.data());
    for (const CollisionSphere& sphere : plan.robot->spheres) {
      const Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center;
      depth = std::max(depth, sphere.radius - world.distance(centre, 0.0));
    }
  }
  return depth;
}

TEST_F(Search, TurnsBetweenObstaclesThatItDoesNotGetBetweenHeadOn) {
  take(1, 45);
  WorldDistance world;
  world.obstacles = {box("right", {1.5, -0.9, 0.3}, {0.3, 1.0, 0.6}),
                     box("left", {2.5, 0.9, 0.3}, {0.3, 1.0, 0.6}),
                     box("right wall", {2.5, -0.85, 0.5}, {9.0, 0.1, 1.0}),
                     box("left wall", {2.5, 0.85, 0.5}, {9.0, 0.1, 1.0})};
  const auto find = [&] {
    DetourSearch search(plan_.robot, options_);
    return search.find(0, window_, times_, world, {.yaw_rad = 0.06});
  };
  const double head_on = deepest(plan_, window_, find(), world);
  options_.most_yaw = 8;
  const std::vector<Detour> slantwise = find();
  EXPECT_LT(deepest(plan_, window_, slantwise, world), head_on - 0.03);
  double before = 0.06, most = 0.0;
  for (const Detour& detour : slantwise) {
    EXPECT_LE(std::abs(detour.yaw_rad - before), options_.yaw_grid_rad + 1e-9);
    before = detour.yaw_rad;
    most = std::max(most, std::abs(before));
  }
  EXPECT_GT(most, 0.1);
  EXPECT_LE(most, options_.most_yaw * options_.yaw_grid_rad + 1e-9);
}

TEST_F(Search, KeepsItsHeadingUnlessItIsTold) {
  take(1, 45);
  WorldDistance world;
  world.obstacles = {box("b", {2.0, 0.3, 0.4}, {0.4, 0.8, 0.8})};
  DetourSearch search(plan_.robot, options_);
  for (const Detour& detour :
       search.find(0, window_, times_, world, {.offset_m = 0.1, .yaw_rad = 0.3})) {
    EXPECT_EQ(detour.yaw_rad, 0.0);
  }
}

/// Every path over the grid, costed as the header says.
class Exhaustive {
 public:
  Exhaustive(const Plan& plan, const std::vector<const double*>& window,
             const std::vector<double>& times, const WorldDistance& world,
             const DetourOptions& options)
      : options_(options),
        half_(static_cast<int>(options.largest_offset_m / options.grid_m + 0.5)) {
    RobotState state(*plan.robot->robot);
    for (std::size_t k = 0; k < window.size(); ++k) {
      state.update(window[k]);
      std::vector<double> costs;
      for (int o = -half_; o <= half_; ++o) {
        double sum = 0.0;
        for (const CollisionSphere& sphere : plan.robot->spheres) {
          const Eigen::Vector3d centre = state.world_from_link(sphere.link) * sphere.center +
                                         Eigen::Vector3d(0.0, o * options.grid_m, 0.0);
          const double short_by =
              options.margin_m + sphere.radius - world.distance(centre, times[k]);
          sum += std::pow(std::max(0.0, short_by), 2);
        }
        costs.push_back(options.obstacle_weight * sum);
      }
      // Costs between every other offset are their mean: see detour_search.cpp.
      for (int o = 1; o < 2 * half_; o += 2) costs[o] = 0.5 * (costs[o - 1] + costs[o + 1]);
      obstacle_.push_back(costs);
    }
  }
  double cost(const std::vector<int>& path, int start, int slope) const {
    double sum = 0.0;
    int before = start, change_before = slope;
    const double grid2 = options_.grid_m * options_.grid_m;
    for (std::size_t k = 0; k < path.size(); ++k) {
      const int change = path[k] - before, turn = change - change_before;
      if (std::abs(change) > options_.steepest || std::abs(turn) > 1) return kInfinity;
      sum += obstacle_[k][path[k] + half_] +
             grid2 * (options_.lateral_weight * path[k] * path[k] +
                      options_.step_weight * change * change + options_.turn_weight * turn * turn);
      before = path[k];
      change_before = change;
    }
    return sum;
  }
  double best(int start, int slope) const {
    std::vector<int> path;
    return best_from(path, start, slope);
  }

 private:
  double best_from(std::vector<int>& path, int start, int slope) const {
    if (path.size() == obstacle_.size()) return cost(path, start, slope);
    double least = kInfinity;
    for (int o = -half_; o <= half_; ++o) {
      path.push_back(o);
      least = std::min(least, best_from(path, start, slope));
      path.pop_back();
    }
    return least;
  }

  DetourOptions options_;
  int half_;
  std::vector<std::vector<double>> obstacle_;
};

TEST_F(Search, FindsWhatTryingEveryPathFinds) {
  options_.grid_m = 0.1;
  options_.largest_offset_m = 0.4;
  options_.steepest = 2;
  options_.turn_weight = 20.0;
  take(12, 5);
  double costliest = 0.0;
  for (const double y : {-0.5, 0.45, 0.8}) {
    WorldDistance world;
    world.obstacles = {box("b", {1.9, y, 0.3}, {0.4, 0.5, 0.6})};
    const Exhaustive all(plan_, window_, times_, world, options_);
    for (const auto& [start, slope] : {std::pair(0, 0), std::pair(1, 1), std::pair(-2, 0)}) {
      std::vector<int> path;
      for (const double offset : find(world.obstacles, 0.1 * start, 0.1 * slope)) {
        path.push_back(static_cast<int>(std::lround(offset / options_.grid_m)));
      }
      const double least = all.best(start, slope);
      costliest = std::max(costliest, least);
      EXPECT_NEAR(all.cost(path, start, slope), least, 1e-9 * (1.0 + least))
          << y << ' ' << start << ' ' << slope;
    }
  }
  EXPECT_GT(costliest, 1.0) << "no obstacle in the way";
}

}  // namespace
}  // namespace locograph
