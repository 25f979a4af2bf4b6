#pragma once
/// What the vertices and edges of a robot plan share: the robot and the world around it.
///
///     PARAMS_ROBOT 0 ../robots/centauro.urdf ../robots/centauro.srdf floating 1 lower_body
///     PARAMS_ROBOT 0 model centauro floating 1 lower_body
///     PARAMS_WORLD 2 map.bt obstacles.xml ground 0
///
/// Paths are relative to the graph file; `-` stands for none. A robot that comes with locograph is
/// named, so that the file can be copied anywhere.

#include <locograph/core/parameters.h>
#include <locograph/plugins/configuration/self_collision_shapes.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/robot.h>
#include <locograph/robots/tree_kernels.h>
#include <locograph/world/world_snapshot.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// PARAMS_ROBOT: urdf, srdf, or `model` and a name; then `floating` or `fixed`, number of names of
/// active joints or groups (0: all), the names; then, where they differ from RobotOptions,
/// `lenient` (lenient_srdf) and `frozen STATE` (frozen_state).
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
  std::vector<LinkPoint> sphere_points, bound_points;  ///< their centres
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

/// PARAMS_WORLD: what is in the way: OctoMap file and obstacle file, and, where the robot stands on
/// level ground, `ground` and its height [m]: voxels whose top is no higher are that ground as a
/// sensor saw it, no obstacles. The ground is that of the plan's scenario; whoever judges a plan
/// refuses another one. The files are read once, into a snapshot; distance edges read its
/// distance(). Whoever plans online binds another WorldParameter, with a newer snapshot, to his
/// workspace (core/bindings.h).
struct WorldParameter final : Parameter {
  std::shared_ptr<const WorldSnapshot> snapshot;  ///< its files are those of the line; not null
  std::optional<double> ground_z_m;

  /// Of an empty world.
  WorldParameter();
  explicit WorldParameter(std::shared_ptr<const WorldSnapshot> snapshot,
                          std::optional<double> ground_z_m = std::nullopt);
  /// Reads the files; empty paths: none. Throws Error for files that cannot be used.
  explicit WorldParameter(const WorldFiles& files, std::optional<double> ground_z_m = std::nullopt);

  std::string_view tag() const override { return "PARAMS_WORLD"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;
};

}  // namespace locograph
