#pragma once
/// A robot that comes with locograph, and how far points are from its exact shapes.
///
///     const Robot robot = shipped("centauro");
///     PosedRobot posed(robot);
///     Eigen::VectorXd q = robot.named_configuration("home");
///     posed.stand(q, 0.0);                                    // q's base is lifted or lowered
///     const double away_m = posed.distance({1.0, 0.2, 0.5});

#include <locograph/robots/robot.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace locograph {

inline Robot shipped(const std::string& name) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/" + name + "/" + name;
  return Robot::load(stem + ".urdf", stem + ".srdf");
}

/// Keeps a pointer to the robot.
class PosedRobot {
 public:
  explicit PosedRobot(const Robot& robot) : state_(robot) {
    for (std::size_t l = 0; l < robot.links().size(); ++l) {
      for (const CollisionShape& shape : robot.links()[l].collision)
        solids_.push_back({static_cast<int>(l), shape.link_from_shape, link_solid(robot, shape)});
    }
  }

  const RobotState& state() const { return state_; }
  void update(const Eigen::VectorXd& configuration) { state_.update(configuration.data()); }

  /// With the lowest point of its shapes at this height, which the base goes up or down for.
  void stand(Eigen::VectorXd& configuration, double floor_m) {
    update(configuration);
    double lowest = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids_) {
      const Eigen::Isometry3d pose = pose_of(solid);
      const Eigen::Vector3d down = -pose.linear().row(2).transpose();
      lowest = std::min(lowest, (pose * solid.shape.support(down)).z());
    }
    configuration[2] += floor_m - lowest;
    update(configuration);
  }

  double distance(const Eigen::Vector3d& point, int* nearest_link = nullptr) const {
    constexpr double kPoint_m = 1e-4;
    static const ConvexShape ball = ConvexShape::sphere(kPoint_m);
    const Eigen::Isometry3d at(Eigen::Translation3d(point.x(), point.y(), point.z()));
    double least = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids_) {
      const Eigen::Isometry3d pose = pose_of(solid);
      if ((pose * solid.shape.center() - point).norm() - solid.shape.bounding_radius() >= least)
        continue;
      const double its = shape_distance(ball, at, solid.shape, pose).distance + kPoint_m;
      if (its >= least) continue;
      least = its;
      if (nearest_link != nullptr) *nearest_link = solid.link;
    }
    return least;
  }

 private:
  struct Solid {
    int link;
    Eigen::Isometry3d link_from_shape;
    ConvexShape shape;
  };

  Eigen::Isometry3d pose_of(const Solid& solid) const {
    return state_.world_from_link(solid.link) * solid.link_from_shape;
  }

  RobotState state_;
  std::vector<Solid> solids_;
};

}  // namespace locograph
