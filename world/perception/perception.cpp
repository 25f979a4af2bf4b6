#include <locograph/common/error.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/world/perception/known_shapes.h>
#include <locograph/world/perception/perception.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace locograph {
namespace {

std::vector<DepthCamera> usable(std::vector<DepthCamera> cameras, const Robot& robot) {
  if (cameras.empty()) {
    throw Error("the robot " + robot.name() + " has no depth camera",
                "a link *_depth_optical_frame, or a <camera> in the scenario");
  }
  for (const DepthCamera& camera : cameras) {
    camera.validate();
    if (camera.link < 0 || camera.link >= static_cast<int>(robot.links().size())) {
      throw Error("camera " + camera.name + " is on link " + std::to_string(camera.link),
                  "a link of the robot");
    }
    if (camera.width < 2 || camera.height < 2) {
      throw Error("camera " + camera.name + " has one row or column of pixels",
                  "at least 2 x 2 pixels");
    }
  }
  return cameras;
}

PerceptionOptions usable(const PerceptionOptions& options) {
  options.validate();
  return options;
}

std::shared_ptr<const octomap::OcTree> known_map(const World& known,
                                                 const PerceptionOptions& options) {
  if (!known.map) return nullptr;
  const double voxel_m = options.map.resolution_m;
  const double theirs_m = known.map->getResolution();
  if (std::abs(theirs_m - voxel_m) > 1e-9 * voxel_m) {
    throw Error("the map that is known beforehand has voxels of " + std::to_string(theirs_m) + " m",
                "those of the window, " + std::to_string(voxel_m) + " m");
  }
  return known.map;
}

/// Null: an empty one.
std::shared_ptr<octomap::OcTree> copy_of(const std::shared_ptr<const octomap::OcTree>& map,
                                         double voxel_m) {
  return map ? std::make_shared<octomap::OcTree>(*map) : std::make_shared<octomap::OcTree>(voxel_m);
}

constexpr int kKeyOffset = 1 << 15;  // OctoMap: key = index + 2^15

octomap::OcTreeKey key_of(const Eigen::Vector3i& index) {
  const auto key = [](int i) { return static_cast<octomap::key_type>(i + kKeyOffset); };
  return {key(index.x()), key(index.y()), key(index.z())};
}

}  // namespace

void PerceptionOptions::validate() const {
  map.validate();
  filter.validate();
  if (!(kept_s > 0.0)) throw Error("kept_s is " + std::to_string(kept_s), "above 0 s");
  if (!(around_m >= 0.0 && std::isfinite(around_m)))
    throw Error("around_m is " + std::to_string(around_m), "0 m or more");
}

Perception::Perception(std::shared_ptr<const Robot> robot, std::vector<DepthCamera> cameras,
                       World known, const PerceptionOptions& options)
    : robot_(std::move(robot)),
      cameras_(usable(std::move(cameras), *robot_)),
      options_(usable(options)),
      known_(std::move(known)),
      beforehand_(known_map(known_, options_)),
      configurations_(*robot_, options_.kept_s),
      filter_(*robot_, options_.filter),
      map_(options_.map),
      state_(*robot_),
      last_stamp_s_(cameras_.size(), -std::numeric_limits<double>::infinity()) {
  known_.map = nullptr;
  fill_window();
  if (options_.keeps_map) kept_ = copy_of(beforehand_, options_.map.resolution_m);
  publish();
}

void Perception::stand(const Eigen::VectorXd& q) {
  if (q.size() != robot_->configuration_size()) {
    throw Error("a configuration of " + std::to_string(q.size()) + " numbers",
                std::to_string(robot_->configuration_size()));
  }
  if (!q.allFinite()) throw Error("a configuration that is not finite", "finite numbers");
  state_.update(q.data());
  follow_robot();
  octomap::OcTree here(options_.map.resolution_m);
  for (const CollisionCapsule& one : filter_.capsules()) {
    const Capsule capsule = transformed(state_.world_from_link(one.link), one.capsule);
    Eigen::AlignedBox3d box(capsule.from);
    box.extend(capsule.to);
    const double around_m = capsule.radius + options_.around_m;
    map_.window().each_in({box.min().array() - around_m, box.max().array() + around_m},
                          [&](const Eigen::Vector3i& index) {
                            here.setNodeValue(key_of(index), here.getClampingThresMinLog(), true);
                          });
  }
  here.updateInnerOccupancy();
  map_.load(here);
  publish();
}

void Perception::configuration(double time_s, const Eigen::VectorXd& q) {
  configurations_.add(time_s, q);
}

void Perception::require(const DepthImage& image) const {
  if (image.camera < 0 || image.camera >= static_cast<int>(cameras_.size())) {
    throw Error("an image of camera " + std::to_string(image.camera),
                "0 to " + std::to_string(cameras_.size() - 1));
  }
  const auto index = static_cast<std::size_t>(image.camera);
  const DepthCamera& camera = cameras_[index];
  const auto size_text = [](int width, int height) {
    return std::to_string(width) + " x " + std::to_string(height) + " pixels";
  };
  if (image.width != camera.width || image.height != camera.height) {
    throw Error("an image of camera " + camera.name + " of " + size_text(image.width, image.height),
                size_text(camera.width, camera.height));
  }
  const std::size_t pixels =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (image.depth_mm.size() != pixels) {
    throw Error("an image of camera " + camera.name + " with " +
                    std::to_string(image.depth_mm.size()) + " depths",
                std::to_string(pixels));
  }
  if (!(image.stamp_s > last_stamp_s_[index])) {
    throw Error("an image of camera " + camera.name + " at " + std::to_string(image.stamp_s) + " s",
                "a time after its last one, " + std::to_string(last_stamp_s_[index]) + " s");
  }
}

std::shared_ptr<const WorldSnapshot> Perception::image(DepthImage image) {
  require(image);
  const Eigen::VectorXd q = configurations_.at(image.stamp_s);
  state_.update(q.data());
  follow_robot();
  // From here on nothing is wrong with it.
  const auto index = static_cast<std::size_t>(image.camera);
  const DepthCamera& camera = cameras_[index];
  last_stamp_s_[index] = image.stamp_s;
  ++images_;
  if (pixels_seen(image) == 0) ++blind_;
  filter_.remove(state_, camera, image, options_.on_image ? &taken_ : nullptr);
  const Eigen::Isometry3d world_from_optical =
      state_.world_from_link(camera.link) * camera.link_from_optical;
  map_.insert(camera, world_from_optical, image);
  map_.clear(shapes_);
  publish();
  if (options_.on_image) options_.on_image({camera, world_from_optical, image, taken_});
  return newest_;
}

void Perception::follow_robot() {
  const Eigen::Vector3i before = map_.window().first;
  map_.move_to(state_.world_from_link(robot_->root_link()).translation());
  if (map_.window().first == before) return;
  if (kept_ && field_) field_->merge_into(*kept_);
  fill_window();
}

/// What is known beforehand of a window that is new.
void Perception::fill_window() {
  if (beforehand_) map_.load(*beforehand_);
  shapes_ = voxels_of_shapes(known_, map_.window(), options_.map.floor_band_m);
  map_.clear(shapes_);
}

void Perception::publish() {
  field_ = map_.field();
  WorldDistance seen;
  seen.source = field_;
  seen.obstacles = known_.obstacles;
  newest_ = std::make_shared<const WorldSnapshot>(known_, std::move(seen), field_->stamp_s());
}

World Perception::seen_near(const Eigen::AlignedBox3d& box) const {
  auto voxels = std::make_shared<octomap::OcTree>(options_.map.resolution_m);
  const bool unknown_counts = options_.map.unknown == UnknownSpace::kOccupied;
  field_->window().each_in(box, [&](const Eigen::Vector3i& index) {
    if (!field_->is_occupied(index) && !(unknown_counts && !field_->is_known(index))) return;
    voxels->setNodeValue(key_of(index), voxels->getClampingThresMaxLog(), true);
  });
  voxels->updateInnerOccupancy();
  World seen = known_;
  seen.map = std::move(voxels);
  return seen;
}

std::shared_ptr<const octomap::OcTree> Perception::map() const {
  if (!kept_ && !beforehand_) return nullptr;
  const auto map = copy_of(kept_ ? kept_ : beforehand_, options_.map.resolution_m);
  map_.merge_into(*map);
  return map;
}

}  // namespace locograph
