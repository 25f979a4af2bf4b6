#pragma once
/// Which pixels of a depth image show the robot itself.
///
///     SelfFilter filter(robot, {.padding_m = 0.02, .link_padding_m = {{"LBall", 0.03}}});
///     state.update(configuration.data());          // that of the image's stamp
///     filter.remove(state, camera, image);         // the robot's pixels are 0 now
///
/// A point is the robot's when it lies in one of the capsules that cover the robot's collision
/// shapes (robots/covering_capsules.h), each made thicker by a padding: that of its link, plus what
/// the noise of depth takes, which grows with the square of the range. The padding has to cover how
/// wrong the camera's pose, the configuration and the stamp are, too. Links without collision
/// shapes are not known: Robot::links_without_collision().
///
/// At the silhouette a sensor mixes depths: such a flying pixel is neither in a capsule nor on what
/// is beyond. Pixels close to the robot's (edge_pixels), also to those that show nothing because
/// the robot is too near there, are the robot's too, unless enough of their eight neighbours, the
/// robot's left out, are as far away as they are.
///
/// Keeps a pointer to nothing. After the first image of a size remove() does not allocate.
/// Thread-safety: one per thread.

#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>
#include <locograph/world/perception/image_bounds.h>
#include <locograph/world/perception/ray_entries.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace locograph {

struct SelfFilterOptions {
  double padding_m = 0.02;
  /// Instead of padding_m, by the names of links; each at most once.
  std::vector<std::pair<std::string, double>> link_padding_m = {};
  double padding_per_m2 = 0.01;  ///< times the square of the capsule's farthest depth [m]
  CapsuleOptions capsules = {.max_overshoot_m = 0.02};
  /// Flying pixels: how many pixels away from the robot's they are looked for; 0: not at all.
  int edge_pixels = 2;
  int edge_support = 3;           ///< neighbours as far away that a pixel there needs
  double edge_same_m = 0.01;      ///< as far away: within this much,
  double edge_same_per_m = 0.02;  ///< and this much for each metre of range

  void validate() const;
};

class SelfFilter {
 public:
  /// Throws Error for options that cannot be used, a link that the robot does not have, and for
  /// what covering_capsules() refuses.
  explicit SelfFilter(const Robot& robot, const SelfFilterOptions& options = {});

  /// Sets pixels that show the robot to 0. state: at the image's stamp. taken: if given, becomes an
  /// image of the pixels taken, 0 elsewhere. Throws Error for a camera that cannot be used, an
  /// image of another size, and for a camera or a state of another robot.
  void remove(const RobotState& state, const DepthCamera& camera, DepthImage& image,
              DepthImage* taken = nullptr);

  const std::vector<CollisionCapsule>& capsules() const { return capsules_; }  ///< not padded

 private:
  struct Placed {  // a padded capsule in the optical frame
    float from[3], along[3];
    float per_squared_length;  // 0: a sphere
    float squared_radius;
    ImageBounds bounds;
    int near_mm, far_mm;
  };

  struct TooNear {  // what the camera does not see, being nearer than its range begins
    CapsuleEntry entry;
    ImageBounds bounds;
  };

  void place(const RobotState& state, const DepthCamera& camera);
  void add_too_near(const Capsule& capsule, double bare_radius, const ImageBounds& bounds);
  void mark_band(int v_begin, const DepthImage& image);
  void mark_too_near(const DepthCamera& camera, const DepthImage& image);
  void mark_edges(const DepthImage& image);
  bool is_supported(int u, int v, const DepthImage& image) const;

  SelfFilterOptions options_;
  std::size_t links_;
  std::vector<CollisionCapsule> capsules_;
  std::vector<double> padding_;  // of each capsule
  std::vector<Placed> placed_;
  std::vector<TooNear> too_near_;
  std::vector<const Placed*> in_band_, in_tile_;
  std::vector<float> x_, y_;         // slopes of columns and rows
  std::vector<std::uint8_t> robot_;  // of each pixel: whose it is, 0: not the robot's
  std::vector<std::uint8_t> row_has_robot_, rows_with_edges_;
  std::vector<std::uint8_t> beside_, near_;  // of each pixel, of a row: within reach of the robot's
};

}  // namespace locograph
