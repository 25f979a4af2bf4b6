#pragma once
/// Depth images one after the other, in the order of their stamps: taken by simulated cameras, or
/// recorded in a folder.
///
///     SimulatedImages images(robot, world, cameras_of(*robot), {.rate_hz = 30.0});
///     while (images.next_stamp_s() <= 1.0) {
///       state.update(q.data());                 // where the robot is then
///       use(images.take(state));
///     }

#include <locograph/robots/robot_state.h>
#include <locograph/world/perception/clouds_folder.h>
#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>
#include <locograph/world/perception/simulated_camera.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace locograph {

class ImageSource {
 public:
  virtual ~ImageSource() = default;

  /// Of the image that take() gives next; infinite: there is none. Stamps do not descend.
  virtual double next_stamp_s() const = 0;
  /// state: of the robot at that stamp.
  virtual DepthImage take(const RobotState& state) = 0;
};

struct SimulatedImagesOptions {
  double rate_hz = 30.0;   ///< of each camera
  double begin_s = 0.0;    ///< stamp of the first images
  std::uint64_t seed = 0;  ///< of the noise
  CameraNoise noise = {};

  void validate() const;
};

/// One image of each camera at a time.
class SimulatedImages final : public ImageSource {
 public:
  /// Keeps a copy of the truth. Throws Error for cameras and options that cannot be used.
  SimulatedImages(std::shared_ptr<const Robot> robot, World truth, std::vector<DepthCamera> cameras,
                  const SimulatedImagesOptions& options = {});

  double next_stamp_s() const override;
  DepthImage take(const RobotState& state) override;

 private:
  std::shared_ptr<const Robot> robot_;
  World truth_;
  std::vector<DepthCamera> cameras_;
  SimulatedImagesOptions options_;
  SimulatedCamera simulated_;
  std::int64_t taken_ = 0;
};

class RecordedImages final : public ImageSource {
 public:
  explicit RecordedImages(CloudsFolder folder) : folder_(std::move(folder)) {}

  double next_stamp_s() const override;
  /// Throws Error for a file that cannot be used. The state does not matter.
  DepthImage take(const RobotState& state) override;

 private:
  CloudsFolder folder_;
  int taken_ = 0;
};

}  // namespace locograph
