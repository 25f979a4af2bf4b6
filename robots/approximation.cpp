#include <locograph/common/error.h>
#include <locograph/robots/approximation.h>
#include <locograph/robots/capsule_surface.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/shape_covers.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace locograph {
namespace {

constexpr int kDirections = 600;   // on each capsule
constexpr int kAcross = 100;       // points of a surface along its greatest extent
constexpr double kInside = 1e-12;  // m; what lies on two capsules lies inside neither

/// The point of a primitive nearest to p, in its frame.
Eigen::Vector3d nearest_point(const CollisionShape& shape, const Eigen::Vector3d& p) {
  const double half = 0.5 * shape.length;
  switch (shape.type) {
    case ShapeType::kBox:
      return p.cwiseMax(-0.5 * shape.size).cwiseMin(0.5 * shape.size);
    case ShapeType::kCylinder: {
      const double radial = p.head<2>().norm();
      const double scale = radial > shape.radius ? shape.radius / radial : 1.0;
      return {scale * p.x(), scale * p.y(), std::clamp(p.z(), -half, half)};
    }
    case ShapeType::kSphere:
    case ShapeType::kCapsule:
    case ShapeType::kMesh:
      break;
  }
  const double z = shape.type == ShapeType::kCapsule ? std::clamp(p.z(), -half, half) : 0.0;
  const Eigen::Vector3d middle(0.0, 0.0, z), arm = p - middle;
  return arm.norm() > shape.radius ? Eigen::Vector3d(middle + shape.radius * arm.normalized()) : p;
}

/// The surface of a primitive: what is nearest to the faces of a larger box.
template <class Look>
void visit_primitive(const CollisionShape& shape, const Look& look) {
  Eigen::Vector3d reach = Eigen::Vector3d::Constant(shape.radius);
  if (shape.type == ShapeType::kBox) reach = 0.5 * shape.size;
  if (shape.type == ShapeType::kCylinder) reach.z() = 0.5 * shape.length;
  if (shape.type == ShapeType::kCapsule) reach.z() += 0.5 * shape.length;
  reach.array() += 0.1 * reach.maxCoeff();
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i <= kAcross; ++i) {
      for (int j = 0; j <= kAcross; ++j) {
        for (const double side : {-1.0, 1.0}) {
          Eigen::Vector3d outside;
          outside[axis] = side * reach[axis];
          outside[u] = reach[u] * (2.0 * i / kAcross - 1.0);
          outside[v] = reach[v] * (2.0 * j / kAcross - 1.0);
          look(nearest_point(shape, outside));
        }
      }
    }
  }
}

/// A lattice on every triangle, its corners included.
template <class Look>
void visit_triangles(const TriangleTree& mesh, const Look& look) {
  const double spacing = std::max(mesh.bounds().sizes().maxCoeff() / kAcross, 1e-9);
  for (std::size_t t = 0; t + 2 < mesh.corners().size(); t += 3) {
    const Eigen::Vector3d& a = mesh.corners()[t];
    const Eigen::Vector3d b = mesh.corners()[t + 1] - a, c = mesh.corners()[t + 2] - a;
    const double longest = std::max({b.norm(), c.norm(), (c - b).norm()});
    const int steps = 1 + static_cast<int>(longest / spacing);
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        look(Eigen::Vector3d(a + static_cast<double>(i) / steps * b +
                             static_cast<double>(j) / steps * c));
      }
    }
  }
}

/// Distance to the union; only its sign means something inside.
double outside_of(std::span<const Capsule> cover, const Eigen::Vector3d& point, int skipped = -1) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(cover.size()); ++i) {
    if (i == skipped) continue;
    least = std::min(least, signed_distance(cover[static_cast<std::size_t>(i)], point));
  }
  return least;
}

void worsen(Approximation& all, const Approximation& one) {
  all.count += one.count;
  all.worst_over_m = std::max(all.worst_over_m, one.worst_over_m);
  all.worst_under_m = std::max(all.worst_under_m, one.worst_under_m);
}

}  // namespace

Approximation measured(const CollisionShape& shape, std::span<const Capsule> cover) {
  Approximation result;
  result.count = static_cast<int>(cover.size());
  std::vector<Capsule> own;  // in the frame of the shape
  const Eigen::Isometry3d shape_from_link = shape.link_from_shape.inverse();
  for (const Capsule& capsule : cover) own.push_back(transformed(shape_from_link, capsule));

  std::optional<TriangleTree> mesh;
  if (shape.type == ShapeType::kMesh) mesh.emplace(collision_mesh(shape));
  const auto look_under = [&](const Eigen::Vector3d& point) {
    result.worst_under_m = std::max(result.worst_under_m, outside_of(own, point));
  };
  if (mesh) {
    visit_triangles(*mesh, look_under);
  } else {
    visit_primitive(shape, look_under);
  }
  for (int i = 0; i < result.count; ++i) {
    visit_surface<kDirections>(own[static_cast<std::size_t>(i)], [&](const Eigen::Vector3d& point) {
      if (outside_of(own, point, i) < -kInside) return;
      const double over =
          mesh ? mesh->distance(point) : (point - nearest_point(shape, point)).norm();
      if (over <= result.worst_over_m) return;
      if (mesh && std::abs(mesh->winding_number(point)) > 0.5) return;
      result.worst_over_m = over;
    });
  }
  return result;
}

std::vector<LinkApproximation> approximations(const Robot& robot, double sphere_overshoot_m,
                                              const CapsuleOptions& options) {
  using Both = std::pair<Approximation, Approximation>;
  ShapeCovers<Both> covers([&](const CollisionShape& shape) {
    std::vector<Capsule> spheres;
    for (const CollisionSphere& sphere :
         covering_spheres(shape, sphere_overshoot_m, options.max_spheres_per_shape)) {
      spheres.push_back({sphere.center, sphere.center, sphere.radius});
    }
    return Both(measured(shape, spheres), measured(shape, covering_capsules(shape, options)));
  });
  std::vector<LinkApproximation> result;
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    const Link& link = robot.links()[l];
    if (link.collision.empty()) continue;
    LinkApproximation of_link;
    of_link.link = static_cast<int>(l);
    of_link.shapes = static_cast<int>(link.collision.size());
    try {
      for (const CollisionShape& shape : link.collision) {
        const auto& [spheres, capsules] = covers.of(robot, shape);
        worsen(of_link.spheres, spheres);
        worsen(of_link.capsules, capsules);
      }
    } catch (const Error& error) {
      of_link.spheres = of_link.capsules = {};
      of_link.unusable = error.what();
    }
    result.push_back(of_link);
  }
  return result;
}

}  // namespace locograph
