#pragma once
/// The scene that a viewer page shows, out of a plan, a pose graph or a robot: doc/scene_format.md.
///
///     SceneOptions options;
///     options.map = "hall.bt";
///     Json scene = make_scene("plan.g2o", options);
///     write_file_atomically("plan.html", scene_page(scene));
///
/// Errors: locograph::Error for unusable files, and for a graph with neither configurations nor
/// poses.

#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/refine_perception.h>
#include <locograph/core/graph.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace locograph {

struct SceneOptions {
  std::string map, obstacles;        ///< instead of the plan's own world
  std::string tree;                  ///< plans: what the search for stances tried; "": not shown
  bool check = true;                 ///< judge the plan and show what is wrong with it
  int executed = -1;                 ///< show the plan as when the robot is here; -1: as a whole
  int window = 20;                   ///< configurations that are being refined then
  bool optimize = false;             ///< pose graphs: show them before and after
  std::vector<std::string> plugins;  ///< as graph_types()
  bool lenient = false;              ///< as ReadOptions::lenient
  std::string srdf;                  ///< robots: instead of the file beside the URDF
  std::string state;                 ///< robots: group_state to stand in; "": home or another one
  bool capsules = false;             ///< robots: draw what links are kept apart by, nothing else
  PerceptionChoice perception;       ///< plans: what cameras show on the way
  bool live = false;                 ///< what they show comes with the messages of a run
  /// Files to be written: they must not be among the clouds that are read.
  std::vector<std::filesystem::path> outputs = {};
  std::function<void(double)> on_progress = {};  ///< of the way that cameras go; may be empty
};

/// file: a graph (.g2o) or a robot (.urdf).
Json make_scene(const std::string& file, const SceneOptions& options);

/// Parts of it. ------------------------------------------------------------------------------

/// `robot`: links with visual and collision shapes, joints, meshes, missing.
Json robot_scene(const Robot& robot);
/// `plan`, `stances`: times, configurations, reference, contacts. judging says what the contacts
/// lie on; null: not known.
void add_plan_scene(const PlanFile& file, const Judging* judging, const SceneOptions& options,
                    Json& scene);
/// `check`
Json check_scene(const PlanFile& file, const CheckReport& report);
/// `map`, `obstacles`, `surfaces` that end, `bars`; voxels nearest to `near` when there are too
/// many for a page.
void add_world_scene(const World& world, const Eigen::AlignedBox3d& near, Json& scene);
/// The same with the robot's covering capsules as its collision shapes, and without visual ones.
/// Throws Error for a mesh that cannot be read.
Json capsule_scene(const Robot& robot);
/// A whole scene of kind pose_graph.
Json pose_graph_scene(Graph graph, const std::string& file, const SceneOptions& options);
/// A whole scene with one configuration: the robot on the ground.
Json standing_scene(const std::string& urdf, const SceneOptions& options);

/// [x, y, z, qx, qy, qz, qw], rounded to a micrometre.
Json pose_json(const Eigen::Isometry3d& pose);
Json vector_json(const Eigen::Vector3d& v);
double rounded(double value);

/// The viewer's page with a scene inside. Throws Error when the viewer is not built or installed.
std::string scene_page(const Json& scene);

}  // namespace locograph
