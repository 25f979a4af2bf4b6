#include <locograph/common/error.h>
#include <locograph/common/ranges.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/world/leftover_map.h>
#include <locograph/world/rectangles.h>
#include <locograph/world/surfaces_of.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace locograph {
namespace {

constexpr double kWeld_m = 1e-5, kSamePlane_m = 1e-3;
constexpr double kSameNormal = 1.0 - 3.8e-5;  // the cosine of half a degree
constexpr double kMostCells = 4e6, kMostSamples = 5e6;

struct Triangle {
  std::array<Eigen::Vector3d, 3> corners;
  std::array<int, 3> ids{};  ///< of the corners, the same for those at one place
  Eigen::Vector3d normal;
  double area_m2 = 0.0;
};

/// Directed edges of counter-clockwise triangles: neighbours have them the other way around.
using Edge = std::pair<int, int>;

std::vector<Triangle> triangles_of(const std::filesystem::path& file,
                                   const Eigen::Isometry3d& world_from_mesh, double scale) {
  const std::vector<Eigen::Vector3d> corners = mesh_triangles(file);
  std::map<std::array<long long, 3>, int> places;
  std::vector<Triangle> triangles;
  for (std::size_t first = 0; first + 2 < corners.size(); first += 3) {
    Triangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d corner = world_from_mesh * (scale * corners[first + c]);
      if (!(corner.cwiseAbs().maxCoeff() <= ranges::kCoordinate_m)) {
        throw Error(file.string(), 0, "a corner of the mesh is far off",
                    "coordinates within 1000000 m");
      }
      triangle.corners[c] = corner;
      std::array<long long, 3> place{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = std::llround(corner[static_cast<int>(axis)] / kWeld_m);
      }
      triangle.ids[c] = places.emplace(place, static_cast<int>(places.size())).first->second;
    }
    const Eigen::Vector3d cross = (triangle.corners[1] - triangle.corners[0])
                                      .cross(triangle.corners[2] - triangle.corners[0]);
    triangle.area_m2 = 0.5 * cross.norm();
    if (!(triangle.area_m2 > 1e-12)) continue;  // has no inside
    triangle.normal = cross.normalized();
    triangles.push_back(triangle);
  }
  if (triangles.empty()) {
    throw Error(file.string(), 0, "all triangles of the mesh are degenerate", "an area");
  }
  return triangles;
}

/// Sets of triangles in one plane that hang together, grown from the largest on.
std::vector<std::vector<int>> faces_of(const std::vector<Triangle>& triangles) {
  std::multimap<Edge, int> of_edge;
  std::vector<int> by_area;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const Triangle& triangle = triangles[static_cast<std::size_t>(t)];
    by_area.push_back(t);
    for (std::size_t c = 0; c < 3; ++c) {
      of_edge.emplace(Edge(triangle.ids[c], triangle.ids[(c + 1) % 3]), t);
    }
  }
  const auto at = [&](int t) -> const Triangle& { return triangles[static_cast<std::size_t>(t)]; };
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](int a, int b) { return at(a).area_m2 > at(b).area_m2; });
  std::vector<char> taken(triangles.size(), 0);
  std::vector<std::vector<int>> faces;
  for (const int seed : by_area) {
    if (taken[static_cast<std::size_t>(seed)] != 0) continue;
    std::vector<int>& face = faces.emplace_back();
    const Triangle& plane = at(seed);
    const auto take = [&](int t) {
      if (taken[static_cast<std::size_t>(t)] != 0) return;
      if (at(t).normal.dot(plane.normal) < kSameNormal) return;
      for (const Eigen::Vector3d& corner : at(t).corners) {
        if (std::abs(plane.normal.dot(corner - plane.corners[0])) > kSamePlane_m) return;
      }
      taken[static_cast<std::size_t>(t)] = 1;
      face.push_back(t);
    };
    take(seed);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Triangle& triangle = at(face[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        const auto [first, last] =
            of_edge.equal_range(Edge(triangle.ids[(c + 1) % 3], triangle.ids[c]));
        for (auto other = first; other != last; ++other) take(other->second);
      }
    }
  }
  return faces;
}

/// Of a face's plane, in units of cells.
using InCells = Eigen::Vector2d;

/// Cells whose middle is in the triangle.
void fill(const std::array<InCells, 3>& corners, std::vector<Cell>& cells) {
  const auto [lowest, highest] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  for (int y = static_cast<int>(std::ceil(lowest - 0.5)); y + 0.5 <= highest; ++y) {
    double from = 1e300, to = -1e300;
    for (std::size_t c = 0; c < 3; ++c) {
      const InCells &a = corners[c], &b = corners[(c + 1) % 3];
      if (std::min(a.y(), b.y()) > y + 0.5 || std::max(a.y(), b.y()) < y + 0.5) continue;
      const double part = a.y() == b.y() ? 0.0 : (y + 0.5 - a.y()) / (b.y() - a.y());
      const double x = a.x() + part * (b.x() - a.x());
      from = std::min(from, x), to = std::max(to, x);
      if (a.y() == b.y()) from = std::min(from, b.x()), to = std::max(to, b.x());
    }
    for (int x = static_cast<int>(std::ceil(from - 0.5)); x + 0.5 <= to; ++x) {
      cells.push_back({x, y});
    }
  }
}

/// Cells that a line goes through, more than at their border.
void cross(const InCells& a, const InCells& b, std::vector<Cell>& cells) {
  constexpr double kBorder = 1e-4;
  const double lowest = std::min(a.y(), b.y()), highest = std::max(a.y(), b.y());
  const auto x_at = [&](double y) {
    return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
  };
  for (int y = static_cast<int>(std::floor(lowest)); y <= highest; ++y) {
    // The part of the line inside this row.
    const double low = std::max(lowest, y + kBorder), high = std::min(highest, y + 1.0 - kBorder);
    if (low > high) continue;
    const bool level = highest - lowest < kBorder;
    const double x1 = level ? a.x() : x_at(low), x2 = level ? b.x() : x_at(high);
    const double from = std::min(x1, x2), to = std::max(x1, x2);
    for (int x = static_cast<int>(std::floor(from)); x <= to; ++x) {
      if (std::max(from, x + kBorder) <= std::min(to, x + 1.0 - kBorder)) cells.push_back({x, y});
    }
  }
}

bool before(const Cell& a, const Cell& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

std::vector<Surface> rectangles_on(const std::vector<Triangle>& triangles,
                                   const std::vector<int>& face, const MeshOptions& options) {
  const auto at = [&](int t) -> const Triangle& { return triangles[static_cast<std::size_t>(t)]; };
  double face_area = 0.0;
  for (const int t : face) face_area += at(t).area_m2;
  if (face_area < options.least_length_m * options.least_width_m) return {};
  const Eigen::Vector3d normal = at(face[0]).normal, origin = at(face[0]).corners[0];
  const Eigen::Vector3d along =
      std::abs(normal.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
  Eigen::Isometry3d world_from_face = Eigen::Isometry3d::Identity();
  world_from_face.linear().col(0) = (along - along.dot(normal) * normal).normalized();
  world_from_face.linear().col(1) = normal.cross(world_from_face.linear().col(0));
  world_from_face.linear().col(2) = normal;
  world_from_face.translation() = origin;

  const Eigen::Isometry3d face_from_world = world_from_face.inverse();
  std::vector<PlanePoint> corners;
  for (const int t : face)
    for (const Eigen::Vector3d& corner : at(t).corners) {
      const Eigen::Vector3d p = face_from_world * corner;
      corners.push_back({p.x(), p.y()});
    }
  const PlaneFrame frame = smallest_frame(corners);
  world_from_face.rotate(Eigen::AngleAxisd(frame.angle_rad, Eigen::Vector3d::UnitZ()));
  world_from_face.translate(Eigen::Vector3d(frame.lower_x, frame.lower_y, 0.0));
  const double width = frame.upper_x - frame.lower_x, height = frame.upper_y - frame.lower_y;
  const double cell = std::max(options.cell_m, std::sqrt(width * height / kMostCells));
  const Eigen::Vector2d sizes(width / std::max(1.0, std::round(width / cell)),
                              height / std::max(1.0, std::round(height / cell)));
  const Eigen::Isometry3d cells_from_world = world_from_face.inverse();
  const auto in_cells = [&](const Eigen::Vector3d& corner) -> InCells {
    const Eigen::Vector3d p = cells_from_world * corner;
    return InCells(p.x(), p.y()).cwiseQuotient(sizes);
  };

  std::set<Edge> edges;
  for (const int t : face)
    for (std::size_t c = 0; c < 3; ++c) edges.emplace(at(t).ids[c], at(t).ids[(c + 1) % 3]);
  std::vector<Cell> inside, crossed;
  for (const int t : face) {
    std::array<InCells, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) triangle[c] = in_cells(at(t).corners[c]);
    fill(triangle, inside);
    for (std::size_t c = 0; c < 3; ++c) {
      if (edges.contains({at(t).ids[(c + 1) % 3], at(t).ids[c]})) continue;
      cross(triangle[c], triangle[(c + 1) % 3], crossed);
    }
  }
  std::sort(inside.begin(), inside.end(), before);
  std::sort(crossed.begin(), crossed.end(), before);
  std::vector<Cell> whole;
  std::set_difference(inside.begin(), inside.end(), crossed.begin(), crossed.end(),
                      std::back_inserter(whole), before);
  std::vector<Surface> surfaces;
  for (const CellRectangle& r : cell_rectangles(
           std::move(whole), {sizes.x(), sizes.y(), options.least_length_m, options.least_width_m},
           options.deadline)) {
    Surface& surface = surfaces.emplace_back();
    surface.half_x_m = 0.5 * (r.to.x - r.from.x + 1) * sizes.x();
    surface.half_y_m = 0.5 * (r.to.y - r.from.y + 1) * sizes.y();
    surface.world_from_surface = world_from_face;
    surface.world_from_surface.translate(Eigen::Vector3d(
        r.from.x * sizes.x() + surface.half_x_m, r.from.y * sizes.y() + surface.half_y_m, 0.0));
  }
  return surfaces;
}

/// Points on a triangle no further apart than a step, its borders included.
void sample(const Triangle& triangle, double step_m, std::vector<Eigen::Vector3d>& samples) {
  // Rows along the longest side.
  std::size_t longest = 0;
  const auto side = [&](std::size_t c) -> Eigen::Vector3d {
    return triangle.corners[(c + 1) % 3] - triangle.corners[c % 3];
  };
  for (std::size_t c = 1; c < 3; ++c) {
    if (side(c).norm() > side(longest).norm()) longest = c;
  }
  const Eigen::Vector3d base = triangle.corners[longest], along = side(longest);
  const Eigen::Vector3d top = triangle.corners[(longest + 2) % 3];
  const int rows = static_cast<int>(std::ceil(2.0 * triangle.area_m2 / along.norm() / step_m)) + 1;
  for (int row = 0; row <= rows; ++row) {
    const double up = static_cast<double>(row) / rows;
    const Eigen::Vector3d from = base + up * (top - base), width = (1.0 - up) * along;
    const int steps = static_cast<int>(std::ceil(width.norm() / step_m)) + 1;
    for (int i = 0; i <= steps; ++i) {
      samples.push_back(from + static_cast<double>(i) / steps * width);
    }
  }
}

}  // namespace

void add_mesh(World& world, const std::string& name, const std::filesystem::path& stl_file,
              const Eigen::Isometry3d& world_from_mesh, double scale, double friction,
              const MeshOptions& options) {
  if (!(scale > 0.0) || !std::isfinite(scale) || !world_from_mesh.matrix().allFinite()) {
    throw Error("scale or pose of the mesh '" + name + "' cannot be used",
                "a positive scale and a finite pose");
  }
  if (!(options.cell_m >= ranges::kLeastVoxel_m) || !(options.voxel_m >= ranges::kLeastVoxel_m)) {
    throw Error("cells or voxels of the mesh '" + name + "' are too small", "0.0001 m or more");
  }
  const std::vector<Triangle> triangles = triangles_of(stl_file, world_from_mesh, scale);
  std::vector<Surface> surfaces;
  std::vector<Plate> plates;
  for (const std::vector<int>& face : faces_of(triangles)) {
    options.deadline.require();
    for (Surface& surface : rectangles_on(triangles, face, options)) {
      plates.emplace_back(surface, kSamePlane_m);
      surfaces.push_back(std::move(surface));
    }
  }
  double area_m2 = 0.0, length_m = 0.0;
  for (const Triangle& triangle : triangles) {
    area_m2 += triangle.area_m2;
    for (std::size_t c = 0; c < 3; ++c) {
      length_m += (triangle.corners[(c + 1) % 3] - triangle.corners[c]).norm();
    }
  }
  const double voxel_m = std::max(
      {options.voxel_m, 2.0 * std::sqrt(area_m2 / kMostSamples), 2.0 * length_m / kMostSamples});
  std::vector<Eigen::Vector3d> samples;
  for (const Triangle& triangle : triangles) sample(triangle, 0.5 * voxel_m, samples);
  world.map = with_leftovers(world.map, samples, plates, {}, 0.0, voxel_m, options.deadline);
  append_surfaces(world, name, friction, std::move(surfaces));
}

}  // namespace locograph
