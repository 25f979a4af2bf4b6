#pragma once
/// What the tests of the planners share: the shipped drive as a plan, changed at will, and a check.
///
///     Graph graph = plan_wheeled_drive(centauro_drive(4.0, 0.3));
///     EXPECT_EQ(violated(check_plan(graph, {box("b", {2, 0, 0.25}, {0.5, 0.5, 0.5})})), …);

#include <gtest/gtest.h>
#include <locograph/planners/offline/wheeled_drive.h>
#include <locograph/planners/plan/feasibility_checker.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/scenario.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/temporary_folder.h"
#include "planners/centauro_on_wheels.h"

namespace locograph {

using test::TemporaryFolder;

/// Robots and scenarios as an installation holds them.
class DataFolder : public TemporaryFolder {
 public:
  DataFolder() {
    const std::filesystem::path source = LOCOGRAPH_SOURCE_DIR;
    std::filesystem::create_directory_symlink(source / "robots", path() / "robots");
    std::filesystem::create_directory_symlink(source / "planners/scenarios", path() / "scenarios");
  }
};

inline Scenario centauro_drive(double distance_m = 4.0, double curvature_1_m = 0.0,
                               int configurations = 50) {
  Scenario scenario = load_scenario("centauro_drive", DataFolder().path());
  scenario.drive->distance_m = distance_m;
  scenario.drive->curvature_1_m = curvature_1_m;
  scenario.drive->configurations = configurations;
  return scenario;
}

/// A motion of CENTAURO on its wheels, among obstacles.
inline CheckReport check_drive(const Robot& robot, const Motion& motion,
                               const std::vector<Obstacle>& obstacles = {},
                               std::shared_ptr<const octomap::OcTree> map = nullptr) {
  CollisionWorldOptions collision;
  for (const RollingWheel& wheel : motion.wheels) {
    collision.ignore_floor_links.push_back(wheel.link);
    const int joint = robot.links()[wheel.link].parent_joint;
    collision.ignore_floor_links.push_back(robot.joints()[joint].parent_link);
  }
  const CollisionWorld world(robot, std::move(map), obstacles, collision);
  CheckOptions options;
  options.obstacles = obstacles;
  return check_motion(robot, world, motion, options);
}

inline CheckReport check_plan(const Graph& graph, const std::vector<Obstacle>& obstacles = {},
                              std::shared_ptr<const octomap::OcTree> map = nullptr) {
  const Plan plan = plan_of(graph);
  return check_drive(*plan.robot->robot, motion_of(graph, plan), obstacles, std::move(map));
}

inline void expect_feasible(const CheckReport& report) {
  for (const Violation& v : report.violations) {
    EXPECT_FALSE(v.violated) << v.constraint << ' ' << v.worst << ' ' << v.unit << ", limit "
                             << v.limit << ", at vertex " << v.at_vertex << " and " << v.count - 1
                             << " more: " << v.what;
  }
  EXPECT_TRUE(report.feasible);
}

inline std::vector<Eigen::VectorXd> configurations(const Graph& graph) {
  return motion_of(graph, plan_of(graph)).configurations;
}

}  // namespace locograph
