#include <locograph/world/planar_patches.h>
#include <locograph/world/point_grid.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace locograph {
namespace {

struct Cylinder {
  Eigen::Vector3d point = Eigen::Vector3d::Zero(), direction = Eigen::Vector3d::UnitX();
  double radius_m = 0.0;

  double along(const Eigen::Vector3d& p) const { return direction.dot(p - point); }
  Eigen::Vector3d off_axis(const Eigen::Vector3d& p) const {
    return p - point - along(p) * direction;
  }
  double distance(const Eigen::Vector3d& p) const { return off_axis(p).norm() - radius_m; }
};

struct Across {
  Eigen::Vector3d x, y;
  explicit Across(const Eigen::Vector3d& direction)
      : x(direction.unitOrthogonal()), y(direction.cross(x)) {}
};

/// Centre and radius of the circle through points seen along the axis (Kåsa: linear in both).
bool circle_across(const std::vector<Eigen::Vector3d>& points, Cylinder& cylinder) {
  const Across across(cylinder.direction);
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sums = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d from = point - cylinder.point;
    const Eigen::Vector3d row(2.0 * across.x.dot(from), 2.0 * across.y.dot(from), 1.0);
    squares += row * row.transpose();
    sums += row * 0.25 * (row[0] * row[0] + row[1] * row[1]);
  }
  const Eigen::Vector3d solution = squares.ldlt().solve(sums);
  const double radius_2 = solution[2] + solution.head<2>().squaredNorm();
  if (!solution.allFinite() || !(radius_2 > 0.0)) return false;
  cylinder.point += solution[0] * across.x + solution[1] * across.y;
  cylinder.radius_m = std::sqrt(radius_2);
  return true;
}

/// Gauss-Newton in the distances from the cylinder's side, those of the far points left out.
bool refine(const std::vector<Eigen::Vector3d>& points, double far_m, Cylinder& cylinder) {
  using Vector5 = Eigen::Matrix<double, 5, 1>;
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  for (int iteration = 0; iteration < 15; ++iteration) {
    const Across across(cylinder.direction);
    Matrix5 hessian = Matrix5::Zero();
    Vector5 gradient = Vector5::Zero();
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d off = cylinder.off_axis(point);
      const double from_axis = off.norm(), along = cylinder.along(point);
      const double residual = from_axis - cylinder.radius_m;
      if (from_axis < 1e-9 || std::abs(residual) > far_m) continue;
      const double x = across.x.dot(off) / from_axis, y = across.y.dot(off) / from_axis;
      Vector5 row;
      row << -x, -y, -along * x, -along * y, -1.0;
      hessian += row * row.transpose();
      gradient += row * residual;
    }
    hessian.diagonal() *= 1.0 + 1e-9;
    const Vector5 step = -hessian.ldlt().solve(gradient);
    if (!step.allFinite() || step.norm() > 1.0) return false;
    cylinder.point += step[0] * across.x + step[1] * across.y;
    cylinder.direction =
        (cylinder.direction + step[2] * across.x + step[3] * across.y).normalized();
    cylinder.radius_m += step[4];
    if (step.norm() < 1e-7) break;
  }
  return cylinder.radius_m > 0.0;
}

class BarSearch {
 public:
  BarSearch(std::span<const Eigen::Vector3d> points, const BarOptions& options)
      : points_(points), options_(options), grid_(points, options.voxel_m) {}

  std::vector<Bar> bars() {
    find_lines();
    std::vector<int> seeds;
    for (int voxel = 0; voxel < grid_.size(); ++voxel) {
      if (thickness_[index(voxel)] < 1.0) seeds.push_back(voxel);
    }
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](int a, int b) { return thickness_[index(a)] < thickness_[index(b)]; });
    taken_.assign(index(grid_.size()), 0);
    visited_.assign(index(grid_.size()), -1);
    std::vector<Bar> bars;
    for (const int seed : seeds) {
      if (taken_[index(seed)] != 0) continue;
      options_.deadline.require();
      Bar bar;
      if (bar_from(seed, bar)) bars.push_back(bar);
    }
    const auto length = [](const Bar& bar) { return (bar.to - bar.from).norm(); };
    std::stable_sort(bars.begin(), bars.end(),
                     [&](const Bar& a, const Bar& b) { return length(a) > length(b); });
    return bars;
  }

 private:
  static constexpr int kOften = 1000;  ///< voxels, between looks at the clock

  static std::size_t index(int voxel) { return static_cast<std::size_t>(voxel); }

  /// Voxels whose surroundings are much longer than they are thick.
  void find_lines() {
    directions_.resize(index(grid_.size()));
    thickness_.assign(index(grid_.size()), 1.0);
    const double least_length = options_.voxel_m * options_.voxel_m;
    const double most_width = std::pow(options_.most_radius_m, 2);
    for (int voxel = 0; voxel < grid_.size(); ++voxel) {
      if (voxel % kOften == 0) options_.deadline.require();
      Moments around;
      grid_.around(voxel, 2, [&](int other) { around.add(grid_.moments(other)); });
      if (around.weight < 3.0) continue;
      const Principal axes = principal(around);
      if (axes.variances[2] < least_length || axes.variances[1] > most_width ||
          axes.variances[1] > 0.25 * axes.variances[2]) {
        continue;
      }
      directions_[index(voxel)] = axes.directions.col(2);
      thickness_[index(voxel)] = axes.variances[1] / axes.variances[2];
    }
  }

  /// Voxels along the seed's line, which is fitted again as it grows. Those where bars cross have
  /// no direction and may belong to several.
  Moments row_from(int seed, std::vector<int>& row) {
    Moments line;
    grid_.around(seed, 1, [&](int other) { line.add(grid_.moments(other)); });
    Cylinder axis{line.mean, directions_[index(seed)], 0.0};
    const double most_off = std::max(0.8 * options_.voxel_m, 0.7 * options_.most_radius_m);
    line = Moments();
    const auto take = [&](int voxel) {
      if (visited_[index(voxel)] == seed) return;
      const Moments& moments = grid_.moments(voxel);
      if (axis.off_axis(moments.mean).norm() > most_off) return;
      if (thickness_[index(voxel)] < 1.0 &&
          std::abs(directions_[index(voxel)].dot(axis.direction)) < 0.9) {
        return;
      }
      visited_[index(voxel)] = seed;
      row.push_back(voxel);
      line.add(moments);
    };
    take(seed);
    for (std::size_t i = 0; i < row.size(); ++i) {
      grid_.around(row[i], 1, take);
      if (line.weight < 6.0) continue;
      axis.point = line.mean;
      axis.direction = principal(line).directions.col(2);
    }
    return line;
  }

  bool bar_from(int seed, Bar& bar) {
    std::vector<int> row;
    const Moments line = row_from(seed, row);
    for (const int voxel : row) taken_[index(voxel)] = 1;
    if (line.weight < 3.0) return false;
    Cylinder fitted{line.mean, principal(line).directions.col(2), 0.0};
    const double reach = options_.most_radius_m + 2.0 * options_.distance_m;
    std::vector<Eigen::Vector3d> near;
    for (const int voxel : row) {
      for (const std::uint32_t p : grid_.points_of(voxel)) {
        if (fitted.off_axis(points_[p]).norm() <= reach) near.push_back(points_[p]);
      }
    }
    if (near.size() < 12) return false;
    std::vector<Eigen::Vector3d> some;
    const std::size_t stride = near.size() / 4000 + 1;
    for (std::size_t i = 0; i < near.size(); i += stride) some.push_back(near[i]);
    if (!circle_across(some, fitted) || fitted.radius_m > 2.0 * options_.most_radius_m) {
      return false;
    }
    if (!refine(some, 4.0 * options_.distance_m, fitted) ||
        !refine(some, 2.0 * options_.distance_m, fitted) ||
        fitted.radius_m > options_.most_radius_m || fitted.radius_m < options_.least_radius_m) {
      return false;
    }
    if (!seen_around(near, fitted) || !stands_alone(row, fitted) || !ends_of(near, fitted, bar)) {
      return false;
    }
    take_beside(row, fitted);
    return true;
  }

  bool on_side(const Eigen::Vector3d& point, const Cylinder& cylinder) const {
    return std::abs(cylinder.distance(point)) <= 2.0 * options_.distance_m;
  }

  /// Most points close to the side, from four twelfths of it at least.
  bool seen_around(const std::vector<Eigen::Vector3d>& points, const Cylinder& cylinder) const {
    const Across across(cylinder.direction);
    std::array<std::size_t, 12> sectors{};
    std::size_t on = 0;
    double squares = 0.0;
    for (const Eigen::Vector3d& point : points) {
      if (!on_side(point, cylinder)) continue;
      ++on;
      squares += std::pow(cylinder.distance(point), 2);
      const Eigen::Vector3d off = cylinder.off_axis(point);
      const double turn =
          std::atan2(across.y.dot(off), across.x.dot(off)) / (2.0 * std::numbers::pi) + 0.5;
      ++sectors[std::min<std::size_t>(static_cast<std::size_t>(turn * 12.0), 11)];
    }
    const auto seen = std::count_if(sectors.begin(), sectors.end(),
                                    [&](std::size_t count) { return 50 * count > on; });
    const double most_deviation =
        std::min(options_.distance_m, std::max(0.5 * options_.distance_m, 0.3 * cylinder.radius_m));
    return seen >= 4 && 10 * on >= 7 * points.size() &&
           squares <= std::pow(most_deviation, 2) * static_cast<double>(on);
  }

  /// Unlike a strip of a larger surface: along most of it there are few points around that are off
  /// its side. Other bars that meet it are so at few places.
  bool stands_alone(const std::vector<int>& row, const Cylinder& cylinder) const {
    std::vector<int> voxels;
    for (const int voxel : row) {
      grid_.around(voxel, 2, [&](int other) { voxels.push_back(other); });
    }
    std::sort(voxels.begin(), voxels.end());
    voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
    struct Piece {
      int on = 0, off = 0;
    };
    std::map<int, Piece> pieces;  // of a voxel's length
    for (const int voxel : voxels) {
      for (const std::uint32_t p : grid_.points_of(voxel)) {
        const double along = std::floor(cylinder.along(points_[p]) / options_.voxel_m);
        Piece& piece = pieces[static_cast<int>(along)];
        ++(std::abs(cylinder.distance(points_[p])) <= options_.distance_m ? piece.on : piece.off);
      }
    }
    int alone = 0, crowded = 0;
    for (const auto& [along, piece] : pieces) {
      if (piece.on > 0) ++(2 * piece.off <= piece.on ? alone : crowded);
    }
    return alone > crowded;
  }

  /// The longest stretch without a gap of more than two voxels.
  bool ends_of(const std::vector<Eigen::Vector3d>& points, const Cylinder& cylinder,
               Bar& bar) const {
    std::vector<double> along;
    for (const Eigen::Vector3d& point : points) {
      if (on_side(point, cylinder)) along.push_back(cylinder.along(point));
    }
    std::sort(along.begin(), along.end());
    double from = 0.0, to = 0.0;
    for (std::size_t first = 0, i = 0; i < along.size(); ++i) {
      if (i > 0 && along[i] - along[i - 1] > 2.0 * options_.voxel_m) first = i;
      if (along[i] - along[first] > to - from) from = along[first], to = along[i];
    }
    if (to - from < std::max(options_.least_length_m, 4.0 * cylinder.radius_m)) return false;
    bar.from = cylinder.point + from * cylinder.direction;
    bar.to = cylinder.point + to * cylinder.direction;
    bar.radius_m = cylinder.radius_m;
    return true;
  }

  /// No other bar starts from voxels beside the row that are of the same bar.
  void take_beside(const std::vector<int>& row, const Cylinder& cylinder) {
    for (const int voxel : row) {
      grid_.around(voxel, 1, [&](int other) {
        if (cylinder.distance(grid_.moments(other).mean) <= 0.5 * options_.voxel_m) {
          taken_[index(other)] = 1;
        }
      });
    }
  }

  std::span<const Eigen::Vector3d> points_;
  BarOptions options_;
  PointGrid grid_;
  std::vector<Eigen::Vector3d> directions_;
  std::vector<double> thickness_;  ///< 1: no line
  std::vector<char> taken_;
  std::vector<int> visited_;  ///< by the row from this seed
};

}  // namespace

std::vector<Bar> bars_in(std::span<const Eigen::Vector3d> points, const BarOptions& options) {
  return BarSearch(points, options).bars();
}

}  // namespace locograph
