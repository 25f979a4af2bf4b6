#include <locograph/common/stably_sorted.h>
#include <locograph/world/planar_patches.h>
#include <locograph/world/point_grid.h>
#include <locograph/world/rectangles.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace locograph {
namespace {

struct Plane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::UnitZ();
  double distance(const Eigen::Vector3d& p) const { return normal.dot(p - point); }
};

struct Region {
  Plane plane;
  Moments moments;
  double tolerance_m = 0.0;
  std::vector<int> voxels;
  std::vector<std::uint32_t> points;
};

double area(const Surface& surface) { return surface.half_x_m * surface.half_y_m; }

bool larger(const Surface& a, const Surface& b) { return area(a) > area(b); }

class RegionGrowing {
 public:
  RegionGrowing(std::span<const Eigen::Vector3d> points, const PatchOptions& options)
      : points_(points), options_(options), grid_(points, options.voxel_m) {}

  std::vector<Region> regions() {
    find_normals();
    std::vector<int> seeds;
    for (int voxel = 0; voxel < grid_.size(); ++voxel) {
      if (flatness_[index(voxel)] < kNotFlat) seeds.push_back(voxel);
    }
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](int a, int b) { return flatness_[index(a)] < flatness_[index(b)]; });
    region_of_.assign(index(grid_.size()), -1);
    for (const int seed : seeds) {
      if (region_of_[index(seed)] >= 0) continue;
      options_.deadline.require();
      grow(seed);
    }
    collect_points();
    for (Region& region : regions_) settle(region.points, region.plane);
    return std::move(regions_);
  }

  const PointGrid& grid() const { return grid_; }

 private:
  static constexpr double kNotFlat = 1.0;
  /// Of the variance that a flat neighbourhood has across it.
  static constexpr double kMostThickness = 0.06;
  static constexpr int kOften = 1000;  ///< voxels, between looks at the clock

  static std::size_t index(int voxel) { return static_cast<std::size_t>(voxel); }

  void find_normals() {
    normals_.resize(index(grid_.size()));
    flatness_.assign(index(grid_.size()), kNotFlat);
    // Two rows of voxels have a variance of v^2 / 3 across them.
    const double least_width = 0.22 * options_.voxel_m * options_.voxel_m;
    for (int voxel = 0; voxel < grid_.size(); ++voxel) {
      if (voxel % kOften == 0) options_.deadline.require();
      Moments around;
      grid_.around(voxel, 1, [&](int other) { around.add(grid_.moments(other)); });
      if (around.weight < 3.0) continue;
      const Principal axes = principal(around);
      const double thickness = axes.variances[0] / axes.variances.sum();
      if (axes.variances[1] < least_width || !(thickness < kMostThickness)) continue;
      normals_[index(voxel)] = axes.directions.col(0);
      flatness_[index(voxel)] = thickness;
    }
  }

  void fit(Region& region) const {
    region.plane = {region.moments.mean, principal(region.moments).directions.col(0)};
  }

  void grow(int seed) {
    const int id = static_cast<int>(regions_.size());
    const double least_cosine = std::cos(options_.angle_rad);
    Region region;
    region.plane = {grid_.moments(seed).mean, normals_[index(seed)]};
    // The neighbours' plane: that of the seed's own points is worse.
    Moments around;
    grid_.around(seed, 1, [&](int other) { around.add(grid_.moments(other)); });
    region.plane.point = around.mean;
    double fit_at = 9.0;
    const auto take = [&](int voxel) {
      if (region_of_[index(voxel)] >= 0 || flatness_[index(voxel)] >= kNotFlat) return;
      if (std::abs(normals_[index(voxel)].dot(region.plane.normal)) < least_cosine) return;
      const Moments& moments = grid_.moments(voxel);
      if (std::abs(region.plane.distance(moments.mean)) > options_.plane_distance_m) return;
      region_of_[index(voxel)] = id;
      region.voxels.push_back(voxel);
      region.moments.add(moments);
    };
    take(seed);
    for (std::size_t i = 0; i < region.voxels.size(); ++i) {
      grid_.around(region.voxels[i], 1, take);
      if (region.moments.weight < fit_at) continue;
      fit_at = 1.3 * region.moments.weight;
      fit(region);
    }
    // No rectangle comes out of less, and its voxels may be of a neighbour that is noisier.
    const double cells =
        options_.least_length_m * options_.least_width_m / (options_.voxel_m * options_.voxel_m);
    if (region.moments.weight < std::max(3.0, 0.5 * cells)) {
      for (const int voxel : region.voxels) region_of_[index(voxel)] = -1;
      return;
    }
    fit(region);
    std::vector<std::uint32_t> own;
    for (const int voxel : region.voxels) {
      const auto points = grid_.points_of(voxel);
      own.insert(own.end(), points.begin(), points.end());
    }
    const double deviation = settle(own, region.plane);
    region.tolerance_m =
        std::clamp(5.0 * deviation, options_.plane_distance_m, 2.0 * options_.plane_distance_m);
    regions_.push_back(std::move(region));
  }

  /// The plane of most of the points, without those of neighbours in voxels at the edges. Returns
  /// their standard deviation from it.
  double settle(const std::vector<std::uint32_t>& points, Plane& plane) const {
    double deviation = 0.0;
    std::vector<double> distances;
    for (int iteration = 0; iteration < 4; ++iteration) {
      distances.clear();
      for (const std::uint32_t p : points)
        distances.push_back(std::abs(plane.distance(points_[p])));
      // Of a normal distribution half is within 0.67 standard deviations.
      const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
      std::nth_element(distances.begin(), middle, distances.end());
      const double far = 2.5 / 0.67 * *middle + 1e-6;
      Moments near;
      for (const std::uint32_t p : points) {
        if (std::abs(plane.distance(points_[p])) <= far) near.add(points_[p]);
      }
      if (near.weight < 3.0) break;
      const Principal axes = principal(near);
      plane = {near.mean, axes.directions.col(0)};
      deviation = std::sqrt(axes.variances[0]);
    }
    return deviation;
  }

  /// All points close to a region's plane in its voxels and up to two beside them: edges blur the
  /// normals of the voxels next to them.
  void collect_points() {
    std::vector<int> near;
    for (int voxel = 0; voxel < grid_.size(); ++voxel) {
      near.clear();
      grid_.around(voxel, region_of_[index(voxel)] < 0 ? 2 : 1, [&](int other) {
        const int id = region_of_[index(other)];
        if (id >= 0 && std::find(near.begin(), near.end(), id) == near.end()) near.push_back(id);
      });
      for (const int id : near) {
        Region& region = regions_[index(id)];
        for (const std::uint32_t p : grid_.points_of(voxel)) {
          if (std::abs(region.plane.distance(points_[p])) <= region.tolerance_m) {
            region.points.push_back(p);
          }
        }
      }
    }
  }

  std::span<const Eigen::Vector3d> points_;
  PatchOptions options_;
  PointGrid grid_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<double> flatness_;  ///< kNotFlat or the part of the variance across the plane
  std::vector<int> region_of_;
  std::vector<Region> regions_;
};

/// The regions with most points first, without those most of whose points are of a larger one of
/// the same direction: voxels at the edges of that one, grown together by themselves.
std::vector<Region> without_repetitions(std::vector<Region> regions, std::size_t points,
                                        const PatchOptions& options) {
  regions = stably_sorted(std::move(regions), [](const Region& a, const Region& b) {
    return a.points.size() > b.points.size();
  });
  std::vector<Region> kept;
  std::vector<int> region_of(points, -1);
  for (Region& region : regions) {
    std::size_t repeated = 0;
    for (const std::uint32_t p : region.points) {
      const int other = region_of[p];
      if (other < 0) continue;
      const Plane& plane = kept[static_cast<std::size_t>(other)].plane;
      if (std::abs(plane.normal.dot(region.plane.normal)) > std::cos(options.angle_rad)) ++repeated;
    }
    if (2 * repeated > region.points.size()) continue;
    for (const std::uint32_t p : region.points) {
      if (region_of[p] < 0) region_of[p] = static_cast<int>(kept.size());
    }
    kept.push_back(std::move(region));
  }
  return kept;
}

/// As PatchOptions::viewpoint says.
Eigen::Vector3d outward(const Region& region, const PointGrid& grid, const PatchOptions& options) {
  const Plane& plane = region.plane;
  if (options.viewpoint) {
    return plane.distance(*options.viewpoint) >= 0.0 ? plane.normal
                                                     : Eigen::Vector3d(-plane.normal);
  }
  const auto turned = [&](double side) -> Eigen::Vector3d { return side * plane.normal; };
  if (std::abs(plane.normal.z()) > 0.5) return turned(plane.normal.z() > 0.0 ? 1.0 : -1.0);
  constexpr int kBeside = 3;
  int below = 0, above = 0;
  for (const int voxel : region.voxels) {
    const bool low = grid.moments(voxel).mean.z() < plane.point.z();
    grid.around(voxel, kBeside, [&](int other) {
      const double distance = plane.distance(grid.moments(other).mean);
      const bool other_low = grid.moments(other).mean.z() < plane.point.z();
      if (other_low == low && std::abs(distance) > std::max(options.voxel_m, region.tolerance_m)) {
        (low ? below : above) += distance > 0.0 ? 1 : -1;
      }
    });
  }
  if (below != 0) return turned(below > 0 ? 1.0 : -1.0);
  if (above != 0) return turned(above > 0 ? -1.0 : 1.0);
  int in_front = 0;
  for (int voxel = 0; voxel < grid.size(); ++voxel) {
    const double distance = plane.distance(grid.moments(voxel).mean);
    if (std::abs(distance) > region.tolerance_m) in_front += distance > 0.0 ? 1 : -1;
  }
  return turned(in_front >= 0 ? 1.0 : -1.0);
}

/// Where the points of one cell are.
struct Extent {
  double lower_x = std::numeric_limits<double>::infinity(), lower_y = lower_x;
  double upper_x = -lower_x, upper_y = -lower_x;
};

/// The points of a region in cells of its plane.
class CellsOfPoints {
 public:
  CellsOfPoints(std::vector<PlanePoint> points, double voxel_m) : frame_(smallest_frame(points)) {
    const double width = frame_.upper_x - frame_.lower_x, height = frame_.upper_y - frame_.lower_y;
    size_x_ = width / std::max(1.0, std::round(width / voxel_m));
    size_y_ = height / std::max(1.0, std::round(height / voxel_m));
    if (!(size_x_ > 0.0) || !(size_y_ > 0.0)) return;
    const int last_x = static_cast<int>(std::lround(width / size_x_)) - 1;
    const int last_y = static_cast<int>(std::lround(height / size_y_)) - 1;
    const double c = std::cos(frame_.angle_rad), s = std::sin(frame_.angle_rad);
    std::vector<std::pair<Cell, PlanePoint>> sorted;
    sorted.reserve(points.size());
    for (const PlanePoint& point : points) {
      const PlanePoint turned{c * point.x + s * point.y, c * point.y - s * point.x};
      sorted.emplace_back(
          Cell{std::min(static_cast<int>((turned.x - frame_.lower_x) / size_x_), last_x),
               std::min(static_cast<int>((turned.y - frame_.lower_y) / size_y_), last_y)},
          turned);
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const auto& a, const auto& b) { return before(a.first, b.first); });
    for (const auto& [cell, point] : sorted) {
      if (cells_.empty() || cells_.back() != cell) {
        cells_.push_back(cell);
        extents_.emplace_back();
      }
      Extent& extent = extents_.back();
      extent.lower_x = std::min(extent.lower_x, point.x);
      extent.lower_y = std::min(extent.lower_y, point.y);
      extent.upper_x = std::max(extent.upper_x, point.x);
      extent.upper_y = std::max(extent.upper_y, point.y);
    }
  }

  double angle() const { return frame_.angle_rad; }

  std::vector<Extent> rectangles(const PatchOptions& options) const {
    std::vector<Extent> found;
    const CellSizes sizes{size_x_, size_y_, options.least_length_m, options.least_width_m};
    for (const CellRectangle& cells : cell_rectangles(cells_, sizes, options.deadline)) {
      const Extent extent = covered(cells);
      const double x = extent.upper_x - extent.lower_x, y = extent.upper_y - extent.lower_y;
      if (std::max(x, y) >= options.least_length_m && std::min(x, y) >= options.least_width_m) {
        found.push_back(extent);
      }
    }
    return found;
  }

 private:
  static bool before(const Cell& a, const Cell& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

  const Extent* extent(const Cell& cell) const {
    const auto found = std::lower_bound(cells_.begin(), cells_.end(), cell, before);
    if (found == cells_.end() || *found != cell) return nullptr;
    return &extents_[static_cast<std::size_t>(found - cells_.begin())];
  }

  /// Sides go to the cells' borders where other cells follow, else no further than points.
  Extent covered(const CellRectangle& r) const {
    Extent side{frame_.lower_x + r.from.x * size_x_, frame_.lower_y + r.from.y * size_y_,
                frame_.lower_x + (r.to.x + 1) * size_x_, frame_.lower_y + (r.to.y + 1) * size_y_};
    for (int y = r.from.y; y <= r.to.y; ++y) {
      if (extent({r.from.x - 1, y}) == nullptr)
        side.lower_x = std::max(side.lower_x, extent({r.from.x, y})->lower_x);
      if (extent({r.to.x + 1, y}) == nullptr)
        side.upper_x = std::min(side.upper_x, extent({r.to.x, y})->upper_x);
    }
    for (int x = r.from.x; x <= r.to.x; ++x) {
      if (extent({x, r.from.y - 1}) == nullptr)
        side.lower_y = std::max(side.lower_y, extent({x, r.from.y})->lower_y);
      if (extent({x, r.to.y + 1}) == nullptr)
        side.upper_y = std::min(side.upper_y, extent({x, r.to.y})->upper_y);
    }
    return side;
  }

  PlaneFrame frame_;
  double size_x_ = 0.0, size_y_ = 0.0;
  std::vector<Cell> cells_;  ///< sorted
  std::vector<Extent> extents_;
};

std::vector<Surface> surfaces_of(const Region& region, const Eigen::Vector3d& normal,
                                 std::span<const Eigen::Vector3d> points,
                                 const PatchOptions& options) {
  // World x laid into the plane, world z where the normal is along x.
  const Eigen::Vector3d along =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d x = (along - along.dot(normal) * normal).normalized();
  const Eigen::Vector3d y = normal.cross(x);
  std::vector<PlanePoint> in_plane;
  in_plane.reserve(region.points.size());
  for (const std::uint32_t p : region.points) {
    const Eigen::Vector3d from = points[p] - region.plane.point;
    in_plane.push_back({x.dot(from), y.dot(from)});
  }
  const CellsOfPoints cells(std::move(in_plane), options.voxel_m);
  Eigen::Isometry3d world_from_cells = Eigen::Isometry3d::Identity();
  world_from_cells.linear() << x, y, normal;
  world_from_cells.translation() = region.plane.point;
  world_from_cells.rotate(Eigen::AngleAxisd(cells.angle(), Eigen::Vector3d::UnitZ()));
  std::vector<Surface> surfaces;
  for (const Extent& extent : cells.rectangles(options)) {
    Surface& surface = surfaces.emplace_back();
    surface.world_from_surface = world_from_cells;
    surface.world_from_surface.translate(Eigen::Vector3d(
        0.5 * (extent.lower_x + extent.upper_x), 0.5 * (extent.lower_y + extent.upper_y), 0.0));
    surface.half_x_m = 0.5 * (extent.upper_x - extent.lower_x);
    surface.half_y_m = 0.5 * (extent.upper_y - extent.lower_y);
  }
  return surfaces;
}

}  // namespace

std::vector<PlanarRegion> planar_regions(std::span<const Eigen::Vector3d> points,
                                         const PatchOptions& options) {
  RegionGrowing growing(points, options);
  std::vector<PlanarRegion> found;
  for (Region& region : without_repetitions(growing.regions(), points.size(), options)) {
    options.deadline.require();
    const Eigen::Vector3d normal = outward(region, growing.grid(), options);
    std::vector<Surface> surfaces = surfaces_of(region, normal, points, options);
    if (surfaces.empty()) continue;
    found.push_back({region.tolerance_m, std::move(region.points), std::move(surfaces)});
  }
  return found;
}

std::vector<Surface> planar_patches(std::span<const Eigen::Vector3d> points,
                                    const PatchOptions& options) {
  std::vector<Surface> surfaces;
  for (const PlanarRegion& region : planar_regions(points, options)) {
    surfaces.insert(surfaces.end(), region.surfaces.begin(), region.surfaces.end());
  }
  return stably_sorted(std::move(surfaces), larger);
}

}  // namespace locograph
