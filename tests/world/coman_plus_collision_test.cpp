// The shipped COMAN+ model against itself: exact distances between its collision shapes.
#include <gtest/gtest.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <limits>

#include "robots/coman_plus_postures.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class ComanPlusCollision : public testing::Test {
 protected:
  ComanPlusCollision()
      : robot(
            Robot::load(model("coman_plus/coman_plus.urdf"), model("coman_plus/coman_plus.srdf"))),
        state(robot),
        home(robot.named_configuration("home")) {
    state.update(home.data());
    for (const Link& link : robot.links()) {
      solids.emplace_back();
      for (const CollisionShape& shape : link.collision) {
        solids.back().push_back(link_solid(robot, shape));
      }
    }
  }

  double link_distance(const std::pair<int, int>& pair) const {
    double least = std::numeric_limits<double>::infinity();
    const auto first = static_cast<std::size_t>(pair.first);
    const auto second = static_cast<std::size_t>(pair.second);
    for (std::size_t a = 0; a < solids[first].size(); ++a) {
      for (std::size_t b = 0; b < solids[second].size(); ++b) {
        const Eigen::Isometry3d world_from_a =
            state.world_from_link(pair.first) * robot.links()[first].collision[a].link_from_shape;
        const Eigen::Isometry3d world_from_b =
            state.world_from_link(pair.second) * robot.links()[second].collision[b].link_from_shape;
        least = std::min(
            least, shape_distance(solids[first][a], world_from_a, solids[second][b], world_from_b)
                       .distance);
      }
    }
    return least;
  }
  std::string names(const std::pair<int, int>& pair) const {
    return robot.links()[static_cast<std::size_t>(pair.first)].name + " and " +
           robot.links()[static_cast<std::size_t>(pair.second)].name;
  }

  Robot robot;
  RobotState state;
  Eigen::VectorXd home;
  std::vector<std::vector<ConvexShape>> solids;
};

TEST_F(ComanPlusCollision, CollidesWithItselfNowhereAtHomeAndInThePublishedPostures) {
  EXPECT_EQ(robot.self_collision_pairs().size(), 364u);
  const auto least = [&](const Eigen::VectorXd& q) {
    state.update(q.data());
    double distance = std::numeric_limits<double>::infinity();
    for (const std::pair<int, int>& pair : robot.self_collision_pairs()) {
      const double d = link_distance(pair);
      EXPECT_GT(d, 0.008) << names(pair);
      distance = std::min(distance, d);
    }
    return distance;
  };
  EXPECT_NEAR(least(home), 0.0164, 1e-3);
  for (const ComanPosture& posture : coman_postures()) {
    SCOPED_TRACE(posture.name);
    least(posture.configuration());
  }
}

TEST_F(ComanPlusCollision, ExcludesFromCollisionChecksOnlyWhatTouchesAtHomeOrIsOutOfReach) {
  const Robot unaware = Robot::load(robot.urdf_file());
  const auto& checked = robot.self_collision_pairs();
  std::vector<std::pair<int, int>> apart, adjacent;
  for (const std::pair<int, int>& pair : unaware.self_collision_pairs()) {
    if (std::find(checked.begin(), checked.end(), pair) != checked.end()) continue;
    (link_distance(pair) > 0.0 ? apart : adjacent).push_back(pair);
  }
  EXPECT_EQ(adjacent.size(), 43u);
  EXPECT_EQ(apart.size(), 117u);
  std::mt19937 random(28);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int sample = 0; sample < 300; ++sample) {
    Eigen::VectorXd q = random_configuration(robot, random);
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      const double die = unit(random);
      if (die < 0.2) q[7 + i] = robot.active_joint(i).lower;
      if (die > 0.8) q[7 + i] = robot.active_joint(i).upper;
    }
    state.update(q.data());
    for (const std::pair<int, int>& pair : apart)
      EXPECT_GT(link_distance(pair), 0.0) << names(pair);
  }
}

}  // namespace
}  // namespace locograph::test
