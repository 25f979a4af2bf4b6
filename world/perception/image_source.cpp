#include <locograph/common/error.h>
#include <locograph/world/perception/image_source.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace locograph {
namespace {

SimulatedImagesOptions checked(const SimulatedImagesOptions& options) {
  options.validate();
  return options;
}

}  // namespace

void SimulatedImagesOptions::validate() const {
  constexpr double kMost_hz = 1000.0;
  if (!(rate_hz > 0.0 && rate_hz <= kMost_hz))
    throw Error("a camera rate of " + std::to_string(rate_hz) + " Hz", "above 0 to 1000 Hz");
  if (!std::isfinite(begin_s)) throw Error("begin_s is not finite", "seconds");
}

SimulatedImages::SimulatedImages(std::shared_ptr<const Robot> robot, World truth,
                                 std::vector<DepthCamera> cameras,
                                 const SimulatedImagesOptions& options)
    : robot_(std::move(robot)),
      truth_(std::move(truth)),
      cameras_(std::move(cameras)),
      options_(checked(options)),
      simulated_(*robot_, truth_, options_.noise) {
  if (cameras_.empty()) throw Error("no cameras to simulate", "one or more");
  for (const DepthCamera& camera : cameras_) camera.validate();
}

double SimulatedImages::next_stamp_s() const {
  const auto round = taken_ / static_cast<std::int64_t>(cameras_.size());
  return options_.begin_s + static_cast<double>(round) / options_.rate_hz;
}

DepthImage SimulatedImages::take(const RobotState& state) {
  const double stamp_s = next_stamp_s();
  const auto camera = static_cast<std::size_t>(taken_ % static_cast<std::int64_t>(cameras_.size()));
  ++taken_;
  DepthImage image =
      simulated_.take(cameras_[camera], static_cast<int>(camera), state, stamp_s, options_.seed);
  image.stamp_s = stamp_s;
  return image;
}

double RecordedImages::next_stamp_s() const {
  return taken_ < folder_.size() ? folder_.stamp_s(taken_)
                                 : std::numeric_limits<double>::infinity();
}

DepthImage RecordedImages::take(const RobotState&) { return folder_.load(taken_++); }

}  // namespace locograph
