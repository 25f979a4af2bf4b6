#pragma once
/// What a robot knows of the world by its depth cameras: configurations and images in, snapshots of
/// the world out.
///
///     Perception perception(robot, cameras_of(*robot), {.surfaces = {ground()}});
///     perception.stand(q);                          // nobody has seen what is under the robot
///     perception.configuration(0.0, q);
///     DepthImage image = camera_image(0.0);
///     use(perception.image(std::move(image)));      // what a planner is shown
///
/// Of an image, what shows the robot is taken out (self_filter.h) by the configuration at the
/// image's stamp, the window of voxels follows the robot's base, and what is left is inserted
/// (local_map.h). Voxels at surfaces, bars and solids that are known beforehand are free then:
/// others know these by their shapes. A snapshot's distance() is to the window's obstacles and to
/// those that are known beforehand; its map is none, so that solids() are what was known beforehand
/// alone: seen_near() makes those of the window for a judge.
///
/// A call that throws changes nothing: images of an unknown camera or of another size, stamps of
/// which the configuration is not known (the buffer holds the last kept_s), and stamps that are not
/// after the last one of the same camera. Stamps of different cameras may be out of order.
///
/// One thread at a time (perception_thread.h has another one for it); snapshots may be read in any.

#include <locograph/world/perception/configuration_buffer.h>
#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>
#include <locograph/world/perception/local_map.h>
#include <locograph/world/perception/self_filter.h>
#include <locograph/world/world_snapshot.h>
#include <octomap/OcTree.h>

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <vector>

namespace locograph {

/// An image that was taken in, in its two parts.
struct FilteredImage {
  const DepthCamera& camera;
  Eigen::Isometry3d world_from_optical;
  const DepthImage& kept;   ///< as it went into the map
  const DepthImage& taken;  ///< the pixels that show the robot, 0 elsewhere
};

struct PerceptionOptions {
  LocalMapOptions map;
  SelfFilterOptions filter;
  double kept_s = 5.0;    ///< configurations, before the newest
  double around_m = 0.3;  ///< what is free around the robot where it stands: see stand()
  /// Called with each image that is taken in, after newest() has it; may be empty. It throws
  /// nothing.
  std::function<void(const FilteredImage&)> on_image = {};
  /// What the window leaves is kept for map(); it does not come back into the window.
  bool keeps_map = false;

  void validate() const;
};

class Perception {
 public:
  /// known: what is known beforehand. Its map fills what of the window was never seen. Throws Error
  /// for a robot without cameras, cameras that are not valid or on no link of the robot, options
  /// out of range, and a map of other voxels than the window's.
  Perception(std::shared_ptr<const Robot> robot, std::vector<DepthCamera> cameras, World known,
             const PerceptionOptions& options = {});

  const Robot& robot() const { return *robot_; }
  const std::vector<DepthCamera>& cameras() const { return cameras_; }
  const PerceptionOptions& options() const { return options_; }

  /// The robot stands there, so there is nothing else: of the window, boxes around its shapes are
  /// free.
  void stand(const Eigen::VectorXd& q);
  /// Throws Error as ConfigurationBuffer::add() does.
  void configuration(double time_s, const Eigen::VectorXd& q);
  /// Returns newest(). Throws Error as above.
  std::shared_ptr<const WorldSnapshot> image(DepthImage image);

  /// Stamped with the newest image; before the first one what was known beforehand.
  const std::shared_ptr<const WorldSnapshot>& newest() const { return newest_; }
  /// Of the newest snapshot.
  const std::shared_ptr<const LocalField>& field() const { return field_; }

  /// For a judge: what was known beforehand, and as its map the window's obstacles in this box,
  /// with UnknownSpace::kOccupied also what was never seen.
  World seen_near(const Eigen::AlignedBox3d& box) const;

  int images() const { return images_; }  ///< taken in
  int blind() const { return blind_; }    ///< of these, without a pixel that shows anything
  /// The map that was known beforehand with what has been seen since; null if there is none. With
  /// PerceptionOptions::keeps_map there is one, and it has what the window has left, too. It takes
  /// about a second.
  std::shared_ptr<const octomap::OcTree> map() const;

 private:
  void require(const DepthImage& image) const;
  void follow_robot();
  void fill_window();
  void publish();

  std::shared_ptr<const Robot> robot_;
  std::vector<DepthCamera> cameras_;
  PerceptionOptions options_;
  World known_;                                        // without its map
  std::shared_ptr<const octomap::OcTree> beforehand_;  // null: none
  std::shared_ptr<octomap::OcTree> kept_;  // and what the window has left; null: it is not kept
  ConfigurationBuffer configurations_;
  SelfFilter filter_;
  LocalMap map_;
  std::vector<Eigen::Vector3i> shapes_;  // see voxels_of_shapes()
  RobotState state_;
  std::vector<double> last_stamp_s_;  // of each camera
  DepthImage taken_;                  // of the newest image, if anyone wants it
  std::shared_ptr<const LocalField> field_;
  std::shared_ptr<const WorldSnapshot> newest_;
  int images_ = 0, blind_ = 0;
};

}  // namespace locograph
