#include <locograph/common/check_option.h>
#include <locograph/common/error.h>
#include <locograph/world/perception/self_filter.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>

namespace locograph {
namespace {

/// Pixels are looked at in tiles: their points are made once for all the capsules there.
constexpr int kWide = 32, kHigh = 8, kPixels = kWide * kHigh;

struct PointTile {
  alignas(64) std::uint16_t depth_mm[kPixels];
  alignas(64) float x[kPixels], y[kPixels], z[kPixels];
  alignas(64) std::int32_t inside[kPixels];  // of any of the capsules
};

/// Why a pixel is the robot's: its point is in a capsule, it flies beside the robot, or it shows
/// nothing because a capsule is too near there.
constexpr std::uint8_t kCapsule = 1, kEdge = 2, kTooNear = 4;

/// Calls f(u) for the bytes of a row that are not 0, which are few.
template <class F>
void each_set(const std::vector<std::uint8_t>& row, int begin, int end, F&& f) {
  for (int u = begin; u < end;) {
    std::uint64_t eight = 1;
    if (u + 8 <= end) std::memcpy(&eight, &row[static_cast<std::size_t>(u)], sizeof eight);
    if (eight == 0) {
      u += 8;
      continue;
    }
    for (const int last = std::min(u + 8, end); u < last; ++u) {
      if (row[static_cast<std::size_t>(u)] != 0) f(u);
    }
  }
}

bool is_padding(double value) { return value >= 0.0 && std::isfinite(value); }

}  // namespace

void SelfFilterOptions::validate() const {
  check_option(is_padding(padding_m), "padding_m", "metres, 0 or more");
  for (const auto& [link, padding] : link_padding_m) {
    check_option(is_padding(padding), "link_padding_m", "metres, 0 or more");
    const auto same = [&link = link](const auto& other) { return other.first == link; };
    check_option(std::ranges::count_if(link_padding_m, same) == 1, "link_padding_m",
                 "each link at most once");
  }
  check_option(is_padding(padding_per_m2), "padding_per_m2", "a number, 0 or more");
  check_option(edge_pixels >= 0 && edge_pixels <= 16, "edge_pixels", "0 to 16");
  check_option(edge_support >= 0 && edge_support <= 8, "edge_support", "0 to 8");
  check_option(is_padding(edge_same_m), "edge_same_m", "metres, 0 or more");
  check_option(is_padding(edge_same_per_m), "edge_same_per_m", "a number, 0 or more");
}

SelfFilter::SelfFilter(const Robot& robot, const SelfFilterOptions& options)
    : options_(options), links_(robot.links().size()) {
  options.validate();
  std::vector<double> padding(links_, options.padding_m);
  for (const auto& [link, metres] : options.link_padding_m) {
    padding[static_cast<std::size_t>(robot.link_index(link))] = metres;
  }
  capsules_ = covering_capsules(robot, options.capsules);
  for (const CollisionCapsule& capsule : capsules_) {
    padding_.push_back(padding[static_cast<std::size_t>(capsule.link)]);
  }
  placed_.reserve(capsules_.size());
  too_near_.reserve(capsules_.size());
  in_band_.reserve(capsules_.size());
  in_tile_.reserve(capsules_.size());
}

void SelfFilter::place(const RobotState& state, const DepthCamera& camera) {
  const Eigen::Isometry3d optical_from_world =
      (state.world_from_link(camera.link) * camera.link_from_optical).inverse();
  placed_.clear();
  too_near_.clear();
  for (std::size_t c = 0; c < capsules_.size(); ++c) {
    Capsule capsule = transformed(optical_from_world * state.world_from_link(capsules_[c].link),
                                  capsules_[c].capsule);
    const double far_m = std::max(capsule.from.z(), capsule.to.z()) + capsule.radius;
    const double bare_radius = capsule.radius;
    capsule.radius += padding_[c] + options_.padding_per_m2 * std::max(far_m, 0.0) * far_m;
    const ImageBounds bounds = image_bounds(camera, capsule);
    if (bounds.empty()) continue;
    Placed placed;
    const Eigen::Vector3d along = capsule.to - capsule.from;
    for (int axis = 0; axis < 3; ++axis) {
      placed.from[axis] = static_cast<float>(capsule.from[axis]);
      placed.along[axis] = static_cast<float>(along[axis]);
    }
    const double squared = along.squaredNorm();
    placed.per_squared_length = squared > 1e-12 ? static_cast<float>(1.0 / squared) : 0.0f;
    placed.squared_radius = static_cast<float>(capsule.radius * capsule.radius);
    placed.bounds = bounds;
    placed.near_mm = static_cast<int>(std::clamp(1000.0 * bounds.near_m - 1.0, 1.0, 1e6));
    placed.far_mm = static_cast<int>(std::clamp(1000.0 * bounds.far_m + 1.0, 0.0, 1e6));
    placed_.push_back(placed);
    if (options_.edge_pixels > 0 && bounds.near_m < camera.range_min_m)
      add_too_near(capsule, bare_radius, bounds);
  }
  // To whole tiles.
  x_.resize(static_cast<std::size_t>((camera.width + kWide - 1) / kWide * kWide));
  for (int u = 0; u < camera.width; ++u) {
    x_[static_cast<std::size_t>(u)] = static_cast<float>((u - camera.cx) / camera.fx);
  }
  y_.resize(static_cast<std::size_t>((camera.height + kHigh - 1) / kHigh * kHigh));
  for (int v = 0; v < camera.height; ++v) {
    y_[static_cast<std::size_t>(v)] = static_cast<float>((v - camera.cy) / camera.fy);
  }
}

namespace {

/// The pixels at `from`, `columns` of each of `rows` rows of an image so wide; the others are 0.
void load_depths(PointTile& tile, const std::uint16_t* from, int width, int columns, int rows) {
  if (columns < kWide || rows < kHigh) std::fill(tile.depth_mm, tile.depth_mm + kPixels, 0);
  for (int row = 0; row < rows; ++row) {
    const std::uint16_t* const begin = from + static_cast<std::ptrdiff_t>(row) * width;
    std::copy(begin, begin + columns, tile.depth_mm + row * kWide);
  }
}

/// Of the pixels that show something; least above most: none does.
struct DepthRange {
  int least_mm, most_mm;
};
DepthRange range_of(const PointTile& tile) {
  std::uint16_t least[kWide], most[kWide];
  for (int i = 0; i < kWide; ++i) {
    least[i] = UINT16_MAX;
    most[i] = 0;
  }
  for (int row = 0; row < kHigh; ++row) {
    for (int i = 0; i < kWide; ++i) {
      const std::uint16_t depth = tile.depth_mm[row * kWide + i];
      const std::uint16_t below = static_cast<std::uint16_t>(depth - 1);  // 0: the most there is
      least[i] = below < least[i] ? below : least[i];
      most[i] = depth > most[i] ? depth : most[i];
    }
  }
  return {*std::min_element(least, least + kWide) + 1, *std::max_element(most, most + kWide)};
}

void make_points(PointTile& tile, const float* x, const float* y) {
  for (int row = 0; row < kHigh; ++row) {
    for (int i = 0; i < kWide; ++i) {
      const float z = 0.001f * static_cast<float>(tile.depth_mm[row * kWide + i]);
      tile.z[row * kWide + i] = z;
      tile.x[row * kWide + i] = x[i] * z;
      tile.y[row * kWide + i] = y[row] * z;
    }
  }
  for (std::int32_t& inside : tile.inside) inside = 0;
}

template <class Placed>
void meet(PointTile& tile, const Placed capsule) {
  for (int i = 0; i < kPixels; ++i) {
    const float x = tile.x[i] - capsule.from[0];
    const float y = tile.y[i] - capsule.from[1];
    const float z = tile.z[i] - capsule.from[2];
    float t = (x * capsule.along[0] + y * capsule.along[1] + z * capsule.along[2]) *
              capsule.per_squared_length;
    // Clamped to [0, 1] without a branch, which SSE's loops would not survive.
    t = 0.5f * (t + std::abs(t));
    t = 0.5f * (t + 1.0f - std::abs(t - 1.0f));
    const float dx = x - t * capsule.along[0];
    const float dy = y - t * capsule.along[1];
    const float dz = z - t * capsule.along[2];
    tile.inside[i] |= dx * dx + dy * dy + dz * dz <= capsule.squared_radius;
  }
}

}  // namespace

void SelfFilter::mark_band(int v_begin, const DepthImage& image) {
  const int rows = std::min(kHigh, image.height - v_begin);
  in_band_.clear();
  for (const Placed& placed : placed_) {
    if (placed.bounds.v_begin < v_begin + rows && placed.bounds.v_end > v_begin)
      in_band_.push_back(&placed);
  }
  if (in_band_.empty()) return;
  PointTile tile;
  for (int u_begin = 0; u_begin < image.width; u_begin += kWide) {
    const int columns = std::min(kWide, image.width - u_begin);
    in_tile_.clear();
    for (const Placed* placed : in_band_) {
      if (placed->bounds.u_begin < u_begin + columns && placed->bounds.u_end > u_begin)
        in_tile_.push_back(placed);
    }
    if (in_tile_.empty()) continue;
    const std::size_t first =
        static_cast<std::size_t>(v_begin) * static_cast<std::size_t>(image.width) +
        static_cast<std::size_t>(u_begin);
    load_depths(tile, &image.depth_mm[first], image.width, columns, rows);
    const DepthRange range = range_of(tile);
    bool has_points = false;
    for (const Placed* placed : in_tile_) {
      if (placed->near_mm > range.most_mm || placed->far_mm < range.least_mm) continue;
      if (!has_points)
        make_points(tile, &x_[static_cast<std::size_t>(u_begin)],
                    &y_[static_cast<std::size_t>(v_begin)]);
      has_points = true;
      meet(tile, *placed);
    }
    if (!has_points) continue;
    for (int row = 0; row < rows; ++row) {
      std::uint8_t inside[kWide], any = 0;
      for (int i = 0; i < kWide; ++i) {
        inside[i] = static_cast<std::uint8_t>(tile.inside[row * kWide + i]) &
                    (tile.depth_mm[row * kWide + i] != 0);
      }
      for (int i = 0; i < kWide; ++i) any |= inside[i];
      if (any == 0) continue;
      row_has_robot_[static_cast<std::size_t>(v_begin + row)] = 1;
      std::copy(
          inside, inside + columns,
          &robot_[first + static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width)]);
    }
  }
}

void SelfFilter::add_too_near(const Capsule& capsule, double bare_radius,
                              const ImageBounds& bounds) {
  // Nothing is seen of a capsule around the optical centre. Where that is within the padding only,
  // there is less of it.
  const double distance = distance_to_axis(capsule, Eigen::Vector3d::Zero());
  if (distance <= bare_radius) return;
  const Eigen::Vector3d along = capsule.to - capsule.from;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(0.5 * (capsule.from + capsule.to));
  pose.rotate(Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along));
  const double radius = std::min(capsule.radius, bare_radius + 0.9 * (distance - bare_radius));
  too_near_.push_back({CapsuleEntry(pose, radius, 0.5 * along.norm()), bounds});
}

void SelfFilter::mark_too_near(const DepthCamera& camera, const DepthImage& image) {
  ImageBounds all{image.width, 0, image.height, 0};
  for (const TooNear& near : too_near_) {
    all.u_begin = std::min(all.u_begin, near.bounds.u_begin);
    all.u_end = std::max(all.u_end, near.bounds.u_end);
    all.v_begin = std::min(all.v_begin, near.bounds.v_begin);
    all.v_end = std::max(all.v_end, near.bounds.v_end);
  }
  const auto is_hidden = [&](int u, int v) {
    for (const TooNear& near : too_near_) {
      if (u >= near.bounds.u_begin && u < near.bounds.u_end && v >= near.bounds.v_begin &&
          v < near.bounds.v_end &&
          near.entry(x_[static_cast<std::size_t>(u)], y_[static_cast<std::size_t>(v)]) <
              camera.range_min_m)
        return true;
    }
    return false;
  };
  for (int v = std::max(1, all.v_begin); v < std::min(image.height - 1, all.v_end); ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width);
    const std::uint16_t* const depth = &image.depth_mm[row];
    const std::uint16_t* const above = depth - image.width;
    const std::uint16_t* const below = depth + image.width;
    // Only where an area that shows nothing ends: other pixels have no neighbours that could fly,
    // or are lost alone.
    std::uint8_t* const at_end = near_.data();
    const int u_begin = std::max(1, all.u_begin), u_end = std::min(image.width - 1, all.u_end);
    for (int u = u_begin; u < u_end; ++u) {
      const int shown =
          (above[u] != 0) + (below[u] != 0) + (depth[u - 1] != 0) + (depth[u + 1] != 0);
      at_end[u] = (depth[u] == 0) & (shown != 0) & (shown != 4);
    }
    each_set(near_, u_begin, u_end, [&](int u) {
      if (!is_hidden(u, v)) return;
      robot_[row + static_cast<std::size_t>(u)] = kTooNear;
      row_has_robot_[static_cast<std::size_t>(v)] = 1;
    });
  }
}

bool SelfFilter::is_supported(int u, int v, const DepthImage& image) const {
  const std::size_t at = static_cast<std::size_t>(v) * image.width + u;
  const int depth = image.depth_mm[at];
  if (depth == 0) return true;
  const int same = static_cast<int>(1000.0 * options_.edge_same_m +
                                    options_.edge_same_per_m * static_cast<double>(depth));
  int support = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      if (u + du < 0 || u + du >= image.width || v + dv < 0 || v + dv >= image.height) continue;
      const std::size_t other = at + static_cast<std::size_t>(dv * image.width + du);
      if (other == at || robot_[other] == kCapsule || image.depth_mm[other] == 0) continue;
      support += std::abs(static_cast<int>(image.depth_mm[other]) - depth) <= same;
    }
  }
  return support >= options_.edge_support;
}

void SelfFilter::mark_edges(const DepthImage& image) {
  const int width = image.width, height = image.height;
  const int reach = options_.edge_pixels, across = std::min(reach, width - 1);
  const auto row_of = [width](std::vector<std::uint8_t>& pixels, int v) {
    return pixels.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
  };
  beside_.resize(robot_.size());
  // Pixels within reach of the robot's: first along the rows, then along the columns.
  for (int v = 0; v < height; ++v) {
    if (row_has_robot_[static_cast<std::size_t>(v)] == 0) continue;
    const std::uint8_t* const from = row_of(robot_, v);
    std::uint8_t* const to = row_of(beside_, v);
    std::fill(to, to + width, std::uint8_t{0});
    for (int du = -across; du <= across; ++du) {
      const int end = width - std::max(0, du);
      for (int u = std::max(0, -du); u < end; ++u) to[u] |= from[u + du];
    }
  }
  rows_with_edges_.assign(row_has_robot_.size(), 0);
  for (int v = 0; v < height; ++v) {
    std::uint8_t* const near = near_.data();
    std::fill(near_.begin(), near_.end(), std::uint8_t{0});
    bool any = false;
    for (int row = std::max(0, v - reach); row <= std::min(height - 1, v + reach); ++row) {
      if (row_has_robot_[static_cast<std::size_t>(row)] == 0) continue;
      const std::uint8_t* const from = row_of(beside_, row);
      for (int u = 0; u < width; ++u) near[u] |= from[u];
      any = true;
    }
    if (!any) continue;
    rows_with_edges_[static_cast<std::size_t>(v)] = 1;
    std::uint8_t* const robot = row_of(robot_, v);
    for (int u = 0; u < width; ++u) near[u] = (near[u] != 0) & (robot[u] == 0);
    each_set(near_, 0, width, [&](int u) {
      if (!is_supported(u, v, image)) robot[u] = kEdge;
    });
  }
  row_has_robot_.swap(rows_with_edges_);
}

void SelfFilter::remove(const RobotState& state, const DepthCamera& camera, DepthImage& image,
                        DepthImage* taken) {
  camera.validate();
  if (state.robot().links().size() != links_)
    throw Error(
        "a state of a robot with " + std::to_string(state.robot().links().size()) + " links",
        "one of the filter's robot, with " + std::to_string(links_));
  if (camera.link < 0 || static_cast<std::size_t>(camera.link) >= links_)
    throw Error("camera " + camera.name + " is on link " + std::to_string(camera.link),
                "a link of the robot, below " + std::to_string(links_));
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  if (image.width != camera.width || image.height != camera.height ||
      image.depth_mm.size() != pixels)
    throw Error("an image of " + std::to_string(image.width) + " x " +
                    std::to_string(image.height) + " pixels, " +
                    std::to_string(image.depth_mm.size()) + " depths",
                "those of camera " + camera.name + ", " + std::to_string(camera.width) + " x " +
                    std::to_string(camera.height));
  place(state, camera);
  robot_.assign(pixels, 0);
  row_has_robot_.assign(static_cast<std::size_t>(camera.height), 0);
  near_.resize(static_cast<std::size_t>(camera.width));
  for (int v = 0; v < camera.height; v += kHigh) mark_band(v, image);
  if (!too_near_.empty()) mark_too_near(camera, image);
  if (options_.edge_pixels > 0) mark_edges(image);
  if (taken != nullptr) {
    taken->stamp_s = image.stamp_s;
    taken->camera = image.camera;
    taken->width = image.width;
    taken->height = image.height;
    taken->depth_mm.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
      taken->depth_mm[i] = robot_[i] != 0 ? image.depth_mm[i] : std::uint16_t{0};
    }
  }
  for (int v = 0; v < camera.height; ++v) {
    if (row_has_robot_[static_cast<std::size_t>(v)] == 0) continue;
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(camera.width);
    std::uint16_t* const depth = &image.depth_mm[row];
    const std::uint8_t* const robot = &robot_[row];
    for (int u = 0; u < camera.width; ++u) depth[u] = robot[u] != 0 ? std::uint16_t{0} : depth[u];
  }
}

}  // namespace locograph
