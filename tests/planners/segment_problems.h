#pragma once
/// Segments that need a search: no way leads straight from one end to the other.
///
///     for (const std::string& name : segment_problem_names()) {
///       const std::unique_ptr<SegmentProblem> problem = segment_problem(name);
///       SegmentSpace space(problem->robot, problem->world);
///       space.set_segment(problem->segment);
///       …
///     }
///
/// COMAN+ stands on both feet, and its left hand goes from one place to another:
///
///   board          round a board that stands out in front of it
///   windows        out of one window of a wall and in at another
///   windows_held   the same while the right hand leans on a wall beside it
///
/// Shared by a benchmark and a test.

#include <locograph/planners/offline/motion/segment_space.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "planners/stance_tasks.h"

namespace locograph::test {

struct SegmentProblem {
  std::shared_ptr<const RobotParameter> robot;
  World world;
  BalanceRegion region;
  Segment segment;  ///< keeps a pointer to the region
};

inline const std::vector<std::string>& segment_problem_names() {
  static const std::vector<std::string> names = {"board", "windows", "windows_held"};
  return names;
}

/// A box between two corners [m, world].
inline SolidBox box_between(const std::string& name, const Eigen::Vector3d& low,
                            const Eigen::Vector3d& high) {
  SolidBox box{.name = name, .size_m = high - low};
  box.world_from_box.translation() = 0.5 * (low + high);
  return box;
}

/// A wall across x with two windows, beside each other along y.
inline std::vector<SolidBox> wall_with_windows(double x_m, double middle_y_m, double between_m,
                                               double width_m, double low_m, double high_m) {
  const double near = x_m - 0.015, far = x_m + 0.015, half = 0.5 * between_m;
  const double outer = half + width_m;
  const auto part = [&](const std::string& name, double y0, double y1, double z0, double z1) {
    return box_between(name, {near, middle_y_m + y0, z0}, {far, middle_y_m + y1, z1});
  };
  return {part("sill", -outer - 0.3, outer + 0.3, low_m - 0.3, low_m),
          part("lintel", -outer - 0.3, outer + 0.3, high_m, high_m + 0.3),
          part("mullion", -half, half, low_m, high_m),
          part("right_jamb", -outer - 0.3, -outer, low_m, high_m),
          part("left_jamb", outer, outer + 0.3, low_m, high_m)};
}

/// Throws std::invalid_argument for an unknown name and std::runtime_error where no posture is
/// found for an end.
inline std::unique_ptr<SegmentProblem> segment_problem(const std::string& name) {
  Task task = stance_task("slanted_wall");
  auto problem = std::make_unique<SegmentProblem>();
  problem->robot = task.robot;
  problem->world.surfaces = {ground()};
  std::vector<Contact> held = task.start.contacts;
  Eigen::Vector3d from, to;
  if (name == "board") {
    problem->world.solids = {box_between("board", {0.25, 0.235, 0.6}, {0.9, 0.265, 1.5})};
    from = {0.45, 0.45, 0.95};
    to = {0.45, 0.08, 0.95};
  } else if (name == "windows" || name == "windows_held") {
    problem->world.solids = wall_with_windows(0.42, 0.25, 0.1, 0.22, 0.8, 1.02);
    from = {0.5, 0.41, 0.91};
    to = {0.5, 0.09, 0.91};
  } else {
    throw std::invalid_argument("no segment problem " + name);
  }
  const auto effector = [&](const std::string& wanted) {
    for (const EndEffector& one : task.end_effectors()) {
      if (one.name == wanted) return one;
    }
    throw std::invalid_argument("no end effector " + wanted);
  };
  if (name == "windows_held") {
    Surface side = ground();
    side.name = "side_wall";
    side.world_from_surface.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;  // its normal is +y
    side.world_from_surface.translation() = Eigen::Vector3d(0.0, -0.6, 0.0);
    problem->world.surfaces.push_back(side);
    held.push_back({.effector = effector("right_hand"),
                    .position = {0.2, -0.6, 0.95},
                    .normal = Eigen::Vector3d::UnitY()});
  }
  std::vector<BearingContact> bearing;
  for (const Contact& contact : task.start.contacts) bearing.push_back({contact});
  problem->region = balance_region(task.robot->robot->total_mass(), bearing, 0.1);
  problem->segment.held = held;
  problem->segment.balance = &problem->region;

  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(problem->segment);
  const auto reach = [&](const Eigen::Vector3d& place, Eigen::VectorXd& q) {
    Contact hand{.effector = effector("left_hand"), .position = place};
    hand.effector.radius_m = 0.0;
    if (!space.solve(task.start_configuration, std::vector<Contact>{hand}, q)) {
      throw std::runtime_error(name + ": " + space.why_not());
    }
  };
  reach(from, problem->segment.from);
  space.set_segment(problem->segment);  // what is held rolls from there
  reach(to, problem->segment.to);
  return problem;
}

/// COMAN+ on its left foot; the right one steps forward.
inline std::unique_ptr<SegmentProblem> step_forward_problem(double step_m = 0.12) {
  Task task = stance_task("slanted_wall");
  auto problem = std::make_unique<SegmentProblem>();
  problem->robot = task.robot;
  problem->world.surfaces = {ground()};
  const Contact left = contact_of(task.start, "left_foot");
  const Contact before = contact_of(task.start, "right_foot");
  Contact after = before;
  after.position.x() += step_m;
  const std::vector<BearingContact> bearing = {{left}};
  problem->region = balance_region(task.robot->robot->total_mass(), bearing, 0.1);
  Segment& segment = problem->segment;
  segment.held = {left};
  segment.balance = &problem->region;
  segment.left = {before};
  segment.reached = {after};
  segment.from = segment.to = task.start_configuration;
  SegmentSpace space(problem->robot, problem->world);
  space.set_segment(segment);
  const auto stand = [&](const Contact& contact, Eigen::VectorXd& q) {
    if (!space.solve(task.start_configuration, std::vector<Contact>{contact}, q)) {
      throw std::runtime_error(space.why_not());
    }
  };
  Eigen::VectorXd from, to;
  stand(before, from);
  stand(after, to);
  segment.from = from;
  segment.to = to;
  return problem;
}

}  // namespace locograph::test
