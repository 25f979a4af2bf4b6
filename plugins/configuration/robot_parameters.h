#pragma once
/// What the vertices and edges of a robot plan share: the robot, its wheels, the world around it.
///
///     PARAMS_ROBOT 0 ../robots/centauro.urdf ../robots/centauro.srdf floating 1 lower_body
///     PARAMS_WHEELS 1 0 4 wheel_1 0.078 wheel_2 0.078 wheel_3 0.078 wheel_4 0.078
///     PARAMS_WORLD 2 map.bt obstacles.xml
///
/// Paths are relative to the graph file; `-` stands for none.

#include <locograph/core/parameters.h>
#include <locograph/plugins/configuration/self_collision_shapes.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/robot.h>
#include <locograph/world/distance_field.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace locograph {

/// The ground is the plane z = 0. Voxels of a map whose top is no higher are the ground as a sensor
/// saw it, not an obstacle.
inline constexpr double kGroundVoxelTop_m = 1e-6;

/// PARAMS_ROBOT: urdf, srdf, `floating` or `fixed`, number of names of active joints or groups
/// (0: all), the names; then, where they differ from RobotOptions, `lenient` (lenient_srdf) and
/// `frozen STATE` (frozen_state).
struct RobotParameter final : Parameter {
  std::filesystem::path urdf, srdf;
  RobotOptions options;
  std::shared_ptr<const Robot> robot;
  std::vector<CollisionSphere> spheres;  ///< cover every collision shape, ordered by link
  /// One sphere around all spheres of a link: what is far from it is far from all of them.
  struct LinkBound {
    int link;
    Eigen::Vector3d center;  ///< link frame
    double radius;
    int begin, end;  ///< its spheres
  };
  std::vector<LinkBound> bounds;
  SelfCollisionShapes self_collision;

  RobotParameter() = default;
  /// Loads the robot. Throws Error for unusable files.
  RobotParameter(std::filesystem::path urdf, std::filesystem::path srdf, RobotOptions options);

  std::string_view tag() const override { return "PARAMS_ROBOT"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;

 private:
  void load();
};

/// A wheel: the link that turns, and the one that carries it (what steering moves).
struct Wheel {
  std::string link_name;
  double radius_m = 0.0;
  int link = -1;
  int carrier = -1;
  int joint = -1;                   ///< active joint, -1 when it cannot turn
  Eigen::Vector3d axle_in_carrier;  ///< unit; a positive joint velocity turns about it
  Eigen::Vector3d centre_in_carrier;
  Eigen::Vector3d
      upright_in_carrier;  ///< unit, normal to the axle: its angle is the carrier's pitch
};

/// PARAMS_WHEELS: number of the robot, number of wheels, link and radius [m] of each.
struct WheelsParameter final : Parameter {
  int robot_number = 0;
  std::vector<Wheel> wheels;

  WheelsParameter() = default;
  /// Throws Error for an unknown link, one that no joint turns, or a radius that is not positive.
  WheelsParameter(const Robot& robot, int robot_number, std::vector<Wheel> named);

  std::string_view tag() const override { return "PARAMS_WHEELS"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

/// PARAMS_WORLD: OctoMap file and obstacle file. `now` is what the distance edges read: whoever
/// plans online replaces it when the world shows something new, and with set_files() what the plan
/// will be saved with; the files are not read again.
struct WorldParameter final : Parameter {
  mutable std::filesystem::path map, obstacles;  ///< empty: none
  mutable WorldDistance now;

  WorldParameter() = default;
  WorldParameter(std::filesystem::path map, std::filesystem::path obstacles);
  void set_files(std::filesystem::path map_file, std::filesystem::path obstacle_file) const {
    map = std::move(map_file);
    obstacles = std::move(obstacle_file);
  }

  std::string_view tag() const override { return "PARAMS_WORLD"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;

 private:
  void load();
};

/// PARAMS_SCENARIO: name or file of the scenario a plan was made for.
struct ScenarioParameter final : Parameter {
  std::string scenario;
  std::string_view tag() const override { return "PARAMS_SCENARIO"; }
  void read(FieldReader& in) override { scenario = in.word(); }
  void write(FieldWriter& out) const override { out.word(scenario); }
};

}  // namespace locograph
