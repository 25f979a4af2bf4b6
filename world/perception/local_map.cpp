#include <locograph/common/error.h>
#include <locograph/common/simd_level.h>
#include <locograph/world/node_distances.h>
#include <locograph/world/perception/local_map.h>
#include <locograph/world/perception/window_octree.h>
#include <locograph/world/require_metres.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace locograph {
namespace {

constexpr int kStep = 8;  // voxels that the window moves by
constexpr double kMostWindowVoxels = 1 << 25;
constexpr int kMostCap = 100;               // its square, twice, fits into 16 bits
constexpr double kFarthestIndex = 1 << 15;  // as OctoMap's
constexpr double kTicks = 8.0;              // of the clock of forgetting, within its time
constexpr double kNearest_m = 0.15;         // voxels nearer than this are not looked at
constexpr int kFields = 3;                  // one is read, one is the newest, one is written

void require(bool holds, const char* what, const char* expected) {
  if (!holds) throw Error(what, expected);
}

Eigen::Vector3i size_in_voxels(const LocalMapOptions& options) {
  constexpr double kRounding = 1e-9;
  Eigen::Vector3i size =
      ((options.size_m / options.resolution_m).array() - kRounding).ceil().cast<int>();
  size[0] = (size[0] + kVoxelBlock - 1) / kVoxelBlock * kVoxelBlock;
  return size.cwiseMax(2);
}

VoxelWindow window_of(const LocalMapOptions& options) {
  options.validate();
  VoxelWindow window{.resolution_m = options.resolution_m, .size = size_in_voxels(options)};
  window.place((-window.size / (2 * kStep)) * kStep);
  return window;
}

ObstacleRange obstacles_of(const LocalMapOptions& options) {
  const auto first = static_cast<std::uint8_t>(options.log_odds.occupied_from);
  // kNeverSeen is 128 among the unsigned.
  const int last = options.unknown == UnknownSpace::kOccupied ? 128 : 127;
  return {first, static_cast<std::uint8_t>(last - first)};
}

}  // namespace

int LocalMapOptions::cap() const {
  return static_cast<int>(std::ceil(max_distance_m / resolution_m + kNodeOffset));
}

void LocalMapOptions::validate() const {
  require_metres(resolution_m, "resolution_m");
  require_metres(max_distance_m, "max_distance_m");
  require_metres(range_m, "range_m");
  for (int axis = 0; axis < 3; ++axis) require_metres(size_m[axis], "size_m");
  const Eigen::Array3d voxels = (size_m / resolution_m).array();
  if (voxels.maxCoeff() > kFarthestIndex || voxels.prod() > kMostWindowVoxels ||
      static_cast<double>(size_in_voxels(*this).cast<double>().prod()) > kMostWindowVoxels) {
    std::ostringstream size;
    size << std::setprecision(10) << "a window of " << std::ceil(voxels[0]) << " x "
         << std::ceil(voxels[1]) << " x " << std::ceil(voxels[2]) << " voxels";
    throw Error(size.str(), "at most 2^25; a smaller one, or larger voxels");
  }
  require(max_distance_m / resolution_m + kNodeOffset <= kMostCap,
          "max_distance_m is more than 98 voxels", "less, or larger voxels");
  const LogOdds& odds = log_odds;
  require(odds.hit >= 1 && odds.hit <= 100 && odds.miss >= 1 && odds.miss <= 100,
          "log-odds of a hit or a miss are out of range", "1 to 100");
  require(odds.least >= -100 && odds.least < 0 && odds.most <= 100 && odds.occupied_from >= 1 &&
              odds.occupied_from < odds.most,
          "log-odds are out of order", "-100 <= least < 0 < occupied_from < most <= 100");
  require(least_pixels >= 1 && least_pixels <= kMostHits, "least_pixels is out of range",
          "1 to 127");
  require(least_share >= 0.0 && least_share <= 1.0, "least_share is out of range", "0 to 1");
  require(footprint >= 0.0 && footprint <= 4.0, "footprint is out of range", "0 to 4");
  require(std::isfinite(free_margin_m) && free_margin_m >= 0.0, "free_margin_m is out of range",
          "0 m or more");
  require(forget_after_s > 0.0, "forget_after_s is out of range", "a positive number of seconds");
  require(!std::isnan(floor_z_m) && floor_z_m < std::numeric_limits<double>::infinity(),
          "floor_z_m is not a height", "metres, or minus infinity");
  require(std::isfinite(floor_band_m) && floor_band_m >= 0.0, "floor_band_m is out of range",
          "0 m or more");
}

LocalMap::LocalMap(const LocalMapOptions& options, const std::string& level)
    : options_(options),
      kernels_(window_kernels_at(level.empty() ? simd_level() : level)),
      window_(window_of(options)),
      obstacle_(obstacles_of(options)),
      stamp_s_(-std::numeric_limits<double>::infinity()),
      transform_(window_, options.cap(), obstacle_, options.unknown == UnknownSpace::kOccupied,
                 kernels_),
      buffers_(blank_field(), kFields) {
  log_odds_.assign(window_.count(), kNeverSeen);
  hits_.assign(window_.count(), 0);
  if (std::isfinite(options.forget_after_s)) age_.assign(window_.count(), 0);
  from_.resize(static_cast<std::size_t>(window_.size[1]));
  to_.resize(from_.size());
  free_.assign(static_cast<std::size_t>(window_.size[0]), 0);
}

LocalField LocalMap::blank_field() const {
  LocalField blank;
  blank.window_ = window_;
  blank.scale_ = options_.log_odds;
  blank.unknown_ = options_.unknown;
  blank.max_distance_m_ = options_.max_distance_m;
  blank.inverse_resolution_ = 1.0 / options_.resolution_m;
  blank.log_odds_.resize(window_.count());
  blank.squared_.resize(window_.count());
  const int farthest = options_.cap() * options_.cap() + 1;
  for (int squared = 0; squared <= farthest; ++squared) {
    const double value =
        (std::sqrt(static_cast<double>(squared)) - kNodeOffset) * options_.resolution_m;
    blank.value_of_squared_.push_back(static_cast<float>(std::min(value, options_.max_distance_m)));
  }
  return blank;
}

void LocalMap::set_log_odds(std::size_t stored, std::int8_t value) {
  std::int8_t& odds = log_odds_[stored];
  if (obstacle_.holds(odds) != obstacle_.holds(value)) {
    const auto nx = static_cast<std::size_t>(window_.size[0]),
               ny = static_cast<std::size_t>(window_.size[1]);
    const std::size_t x = stored % nx, y = stored / nx % ny;
    transform_.changed()[y * (nx / kVoxelBlock) + x / kVoxelBlock] = 1;
  }
  odds = value;
  if (!age_.empty()) age_[stored] = 0;
}

void LocalMap::move_to(const Eigen::Vector3d& centre) {
  require(centre.allFinite(), "the centre of the local map is not finite", "a point");
  const Eigen::Vector3d at = centre / options_.resolution_m;
  require(at.cwiseAbs().maxCoeff() + window_.size.maxCoeff() <= kFarthestIndex,
          "the local map would leave the range of OctoMap's keys", "a centre within 2^15 voxels");
  Eigen::Vector3i lowest = window_.first;
  for (int axis = 0; axis < 3; ++axis) {
    const double wanted = at[axis] - 0.5 * window_.size[axis];
    if (std::abs(wanted - lowest[axis]) > kStep)
      lowest[axis] = static_cast<int>(std::floor(wanted / kStep + 0.5)) * kStep;
  }
  if (lowest == window_.first) return;
  forget_all_but(lowest);
  window_.place(lowest);
  transform_.change_everything();
  stale_ = true;
}

// What is not in the window at its new place, as it is stored: along each axis some layers.
void LocalMap::forget_all_but(const Eigen::Vector3i& lowest) {
  const Eigen::Vector3i& size = window_.size;
  const auto forget = [&](std::size_t begin, int count) {
    std::fill_n(log_odds_.begin() + static_cast<std::ptrdiff_t>(begin), count, kNeverSeen);
    if (!age_.empty())
      std::fill_n(age_.begin() + static_cast<std::ptrdiff_t>(begin), count, std::uint8_t{0});
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int way = lowest[axis] - window_.first[axis], count = std::min(std::abs(way), size[axis]);
    const int first = way > 0 ? window_.first[axis] + size[axis] : lowest[axis];
    for (int i = 0; i < count; ++i) {
      const int rest = (first + i) % size[axis], layer = rest < 0 ? rest + size[axis] : rest;
      const std::size_t nx = static_cast<std::size_t>(size[0]), plane = nx * size[1];
      if (axis == 2) forget(layer * plane, size[0] * size[1]);
      for (int z = 0; axis < 2 && z < size[2]; ++z) {
        if (axis == 1) forget(z * plane + layer * nx, size[0]);
        for (int y = 0; axis == 0 && y < size[1]; ++y) forget(z * plane + y * nx + layer, 1);
      }
    }
  }
}

void LocalMap::fit_image(const DepthCamera& camera) {
  pooled_.width = camera.width;
  pooled_.height = camera.height;
  pooled_.levels = 0;
  int offset = 0;
  while (pooled_.levels < PooledImage::kMostLevels) {
    const int width = camera.width >> (pooled_.levels + 1),
              height = camera.height >> (pooled_.levels + 1);
    if (width == 0 || height == 0) break;
    pooled_.level_width[pooled_.levels] = width;
    pooled_.level_height[pooled_.levels] = height;
    pooled_.offset[pooled_.levels++] = offset;
    offset += width * height;
  }
  const auto grow = [](auto& buffer, std::size_t size) {
    if (buffer.size() < size) buffer.resize(size);
  };
  const auto width = static_cast<std::size_t>(camera.width);
  grow(block_, static_cast<std::size_t>(offset));
  grow(nearest_, static_cast<std::size_t>(offset));
  grow(row_, 2 * (width + 4));
  grow(code_, width + 1);
  grow(run_, width + 1);
  grow(column_, width);
  grow(touched_, std::min(width * static_cast<std::size_t>(camera.height), window_.count()));
  pooled_.block = block_.data();
  pooled_.row = row_.data();
  pooled_.nearest = nearest_.data();
}

void LocalMap::forget_until(double stamp_s) {
  if (stamp_s <= stamp_s_) return;
  if (!age_.empty() && std::isfinite(stamp_s_)) {
    const double tick = options_.forget_after_s / kTicks;
    const double ticks = std::floor(stamp_s / tick) - std::floor(stamp_s_ / tick);
    const Ageing ageing{.window = window_.rings(),
                        .most = static_cast<std::uint8_t>(kTicks),
                        .obstacle = obstacle_,
                        .log_odds = log_odds_.data(),
                        .age = age_.data(),
                        .changed = transform_.changed().data()};
    for (int i = 0; i < std::min(ticks, kTicks + 1.0); ++i) kernels_.age(ageing);
  }
  stamp_s_ = stamp_s;
}

void LocalMap::insert(const DepthCamera& camera, const Eigen::Isometry3d& world_from_optical,
                      const DepthImage& image) {
  // DepthCamera::validate() tells more, but is not for every image.
  const double numbers[] = {camera.fx, camera.fy,          camera.cx,
                            camera.cy, camera.range_min_m, camera.range_max_m};
  require(std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }) &&
              camera.fx > 0.0 && camera.fy > 0.0 && camera.range_min_m < camera.range_max_m,
          "the camera's focal lengths, centre or range are none", "a valid DepthCamera");
  require(camera.width >= 2 && camera.height >= 2, "a camera of one row or column",
          "at least 2 x 2 pixels");
  if (image.width != camera.width || image.height != camera.height ||
      image.depth_mm.size() != static_cast<std::size_t>(image.width) * image.height) {
    throw Error(
        "an image of " + std::to_string(image.width) + " x " + std::to_string(image.height) +
            " pixels with " + std::to_string(image.depth_mm.size()) + " depths",
        "the camera's " + std::to_string(camera.width) + " x " + std::to_string(camera.height));
  }
  require(std::isfinite(image.stamp_s), "the image's stamp is not finite", "seconds");
  const Eigen::Matrix3d rotation = world_from_optical.linear();
  const Eigen::Vector3d position = world_from_optical.translation();
  constexpr double kRotation = 1e-6;
  require(rotation.allFinite() && position.allFinite() &&
              (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < kRotation,
          "the camera's pose is not finite or no rotation", "a pose in the world");

  fit_image(camera);
  forget_until(image.stamp_s);
  stale_ = true;

  const double h = options_.resolution_m;
  const double range_m = std::min(options_.range_m, camera.range_max_m);
  pooled_.depth_mm = image.depth_mm.data();
  kernels_.pool(pooled_);

  HitMarking hits{
      .window = window_.rings(),
      .depth_mm = image.depth_mm.data(),
      .width = camera.width,
      .height = camera.height,
      .column = column_.data(),
      .cy = static_cast<float>(camera.cy),
      .inverse_fy = static_cast<float>(1.0 / camera.fy),
      .rotation = {},
      .origin = {},
      .nearest_mm = static_cast<int>(std::clamp(std::ceil(camera.range_min_m * 1e3), 1.0, 65535.0)),
      .farthest_mm = static_cast<int>(std::min(range_m * 1e3, 65535.0)),
      .floor = static_cast<float>(options_.floor_top_m() / h - window_.first[2]),
      .code = code_.data(),
      .run = run_.data(),
      .hits = hits_.data(),
      .touched = touched_.data()};
  for (int u = 0; u < camera.width; ++u)
    column_[static_cast<std::size_t>(u)] = static_cast<float>((u - camera.cx) / camera.fx);
  MissMarking misses{
      .window = window_.rings(),
      .image = &pooled_,
      .fx = static_cast<float>(camera.fx),
      .fy = static_cast<float>(camera.fy),
      .cx = static_cast<float>(camera.cx),
      .cy = static_cast<float>(camera.cy),
      .first = {},
      .step = {},
      .nearest_m = static_cast<float>(kNearest_m),
      .farthest_m = static_cast<float>(range_m),
      .footprint_px_m = static_cast<float>(options_.footprint * std::max(camera.fx, camera.fy) * h),
      .margin_mm = static_cast<float>(options_.free_margin_m * 1e3),
      .miss = static_cast<std::int8_t>(options_.log_odds.miss),
      .least = static_cast<std::int8_t>(options_.log_odds.least),
      .obstacle = obstacle_,
      .hits = hits_.data(),
      .log_odds = log_odds_.data(),
      .age = age_.empty() ? nullptr : age_.data(),
      .changed = transform_.changed().data(),
      .from = from_.data(),
      .to = to_.data(),
      .free = free_.data()};
  const Eigen::Vector3d first_centre =
      (window_.first.cast<double>() + Eigen::Vector3d::Constant(0.5)) * h - position;
  for (int i = 0; i < 3; ++i) {
    hits.origin[i] = static_cast<float>(position[i] / h - window_.first[i]);
    misses.first[i] = static_cast<float>(rotation.col(i).dot(first_centre));
    for (int k = 0; k < 3; ++k) {
      hits.rotation[3 * i + k] = static_cast<float>(rotation(i, k) * 1e-3 / h);
      misses.step[k][i] = static_cast<float>(rotation(k, i) * h);
    }
  }
  const int touched = kernels_.mark_hits(hits);
  kernels_.mark_misses(misses);
  add_hits(camera, touched);
}

void LocalMap::add_hits(const DepthCamera& camera, int touched) {
  const LogOdds& odds = options_.log_odds;
  const double h_mm = options_.resolution_m * 1e3;
  const double wall = options_.least_share * camera.fx * camera.fy * h_mm * h_mm;  // [pixels mm^2]
  for (int i = 0; i < touched; ++i) {
    const TouchedVoxel& voxel = touched_[static_cast<std::size_t>(i)];
    const auto stored = static_cast<std::size_t>(voxel.voxel);
    const int pixels = hits_[stored] & kMostHits;
    hits_[stored] = 0;
    const int before = log_odds_[stored] == kNeverSeen ? 0 : log_odds_[stored];
    if (pixels == 0) {  // floor alone
      set_log_odds(stored, static_cast<std::int8_t>(std::max(before - odds.miss, odds.least)));
      continue;
    }
    const double depth = voxel.depth_mm;
    if (pixels < options_.least_pixels || (pixels < kMostHits && pixels * depth * depth < wall))
      continue;
    set_log_odds(stored, static_cast<std::int8_t>(std::min(before + odds.hit, odds.most)));
  }
}

void LocalMap::clear(const Eigen::AlignedBox3d& box) {
  require(box.min().allFinite() && box.max().allFinite(), "the box to clear is not finite",
          "two corners");
  const Eigen::AlignedBox3d inside = box.intersection(window_.bounds());
  if (inside.isEmpty()) return;
  const auto first_centre_from = [&](const Eigen::Vector3d& corner) -> Eigen::Vector3i {
    return (corner.array() / options_.resolution_m - 0.5).ceil().cast<int>();
  };
  const Eigen::Vector3i low = first_centre_from(inside.min()),
                        beyond = first_centre_from(inside.max());
  for (int z = low[2]; z < beyond[2]; ++z)
    for (int y = low[1]; y < beyond[1]; ++y)
      for (int x = low[0]; x < beyond[0]; ++x)
        set_log_odds(window_.stored({x, y, z}), static_cast<std::int8_t>(options_.log_odds.least));
  stale_ = true;
}

void LocalMap::clear(std::span<const Eigen::Vector3i> voxels) {
  for (const Eigen::Vector3i& index : voxels) {
    if (!window_.contains(index)) continue;
    const std::size_t stored = window_.stored(index);
    if (!obstacle_.holds(log_odds_[stored]) || log_odds_[stored] == kNeverSeen) continue;
    set_log_odds(stored, static_cast<std::int8_t>(options_.log_odds.least));
    stale_ = true;
  }
}

std::shared_ptr<const LocalField> LocalMap::field() {
  if (!stale_) return field_;
  transform_.update(window_, log_odds_);
  field_.reset();
  LocalField& next = buffers_.free_one();
  next.window_ = window_;
  next.stamp_s_ = stamp_s_;
  const Eigen::AlignedBox3d bounds = window_.bounds();
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5 * options_.resolution_m);
  next.lowest_node_ = bounds.min() + half;
  next.highest_node_ = bounds.max() - half;
  std::copy_n(log_odds_.data(), window_.count(), next.log_odds_.data());
  std::copy_n(transform_.squared().data(), window_.count(), next.squared_.data());
  field_ = buffers_.share(next);
  stale_ = false;
  return field_;
}

void LocalMap::load(const octomap::OcTree& tree) {
  for (std::size_t i = 0; i < age_.size(); ++i) {
    if (log_odds_[i] == kNeverSeen) age_[i] = 0;
  }
  fill_unseen(tree, window_, options_.log_odds, options_.floor_top_m(), log_odds_);
  transform_.change_everything();
  stale_ = true;
}

void LocalMap::merge_into(octomap::OcTree& tree) const {
  merge_window(window_, options_.log_odds, log_odds_, tree);
}

std::size_t LocalMap::memory_bytes() const {
  const auto bytes = [](const auto&... buffers) {
    return (... + (buffers.size() * sizeof(buffers[0])));
  };
  const std::size_t voxels = window_.count();
  return bytes(log_odds_, hits_, age_, block_, row_, nearest_, code_, run_, free_, column_, from_,
               to_, touched_) +
         transform_.memory_bytes() +
         static_cast<std::size_t>(buffers_.count()) * voxels *
             (sizeof(std::int8_t) + sizeof(std::int16_t));
}

}  // namespace locograph
