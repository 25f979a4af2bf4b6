#include <locograph/common/error.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/mesh_fit.h>
#include <locograph/robots/shape_covers.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace locograph {
namespace {

/// Spheres in the frame of a shape.
using Spheres = std::vector<std::pair<Eigen::Vector3d, double>>;

/// n spheres of radius R along the axis of a capsule cover it if the outer two stand at most R - r
/// inside the ends of the segment and neighbours at most 2 sqrt(R^2 - r^2) apart.
Spheres cover_capsule(double r, double length, double overshoot, int limit) {
  for (int n = 1; n <= limit; ++n) {
    const auto reach = [&](double radius) {
      return 2.0 * (radius - r) + 2.0 * (n - 1) * std::sqrt(radius * radius - r * r);
    };
    if (reach(r + overshoot) < length) continue;
    double low = r, high = r + overshoot;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (reach(middle) < length ? low : high) = middle;
    }
    Spheres spheres;
    const double first = -0.5 * length + (high - r);
    const double step = n > 1 ? -2.0 * first / (n - 1) : 0.0;
    for (int i = 0; i < n; ++i) {
      spheres.emplace_back(Eigen::Vector3d(0.0, 0.0, n > 1 ? first + i * step : 0.0), high);
    }
    return spheres;
  }
  return {};
}

/// A grid of cells, each inside the sphere through its corners, which sticks out of the faces by
/// R - half the cell's smallest edge.
Spheres cover_box(const Eigen::Vector3d& size, double overshoot, int limit) {
  Eigen::Vector3i best = Eigen::Vector3i::Zero();
  int fewest = limit + 1;
  for (int x = 1; x < fewest; ++x) {
    for (int y = 1; x * y < fewest; ++y) {
      for (int z = 1; x * y * z < fewest; ++z) {
        const Eigen::Vector3d cell = size.cwiseQuotient(Eigen::Vector3d(x, y, z));
        if (0.5 * (cell.norm() - cell.minCoeff()) > overshoot) continue;
        best << x, y, z;
        fewest = x * y * z;
      }
    }
  }
  Spheres spheres;
  if (fewest > limit) return spheres;
  const Eigen::Vector3d cell = size.cwiseQuotient(best.cast<double>());
  for (int x = 0; x < best.x(); ++x) {
    for (int y = 0; y < best.y(); ++y) {
      for (int z = 0; z < best.z(); ++z) {
        const Eigen::Vector3d centre =
            (Eigen::Vector3d(x, y, z).array() + 0.5).matrix().cwiseProduct(cell) - 0.5 * size;
        spheres.emplace_back(centre, 0.5 * cell.norm());
      }
    }
  }
  return spheres;
}

/// One ring of equal spheres that covers an annulus of a disc.
struct Ring {
  int count = 0;
  double centre = 0.0;  // distance of the centres from the axis
  double reach = 0.0;   // radius of the discs that cover the annulus
  double inner = 0.0;   // where the annulus ends
};

/// The ring of `count` spheres that covers the widest annulus inside radius `outer`, with discs of
/// at most `most` and no sphere beyond `limit` from the axis; count 0 if there is none. A disc
/// covers a sector of half angle pi / count, whose corners are its farthest points: the corner at
/// radius x has the distance sqrt(x^2 + centre^2 - 2 x centre cos) from the disc's centre.
Ring widest_ring(double outer, int count, double most, double h, double limit) {
  constexpr int kSteps = 100;
  const double cosine = std::cos(std::numbers::pi / count);
  const auto corner = [&](double x, double centre) {
    return std::sqrt(x * x + centre * centre - 2.0 * x * centre * cosine);
  };
  Ring best;
  best.inner = outer;
  for (int i = 1; i < kSteps; ++i) {
    const double centre = outer * i / kSteps;
    const double room = limit - centre;
    if (room <= h) break;
    const double reach = std::min(most, std::sqrt(room * room - h * h));
    if (corner(outer, centre) > reach) continue;
    const double sine = centre * std::sqrt(1.0 - cosine * cosine);
    const double root = std::sqrt(std::max(0.0, reach * reach - sine * sine));
    const double inner = reach >= centre ? 0.0 : std::max(0.0, centre * cosine - root);
    if (inner < best.inner) {
      best = {count, centre, std::max(corner(outer, centre), corner(inner, centre)), inner};
    }
  }
  return best;
}

/// Rings from the rim inwards for one layer of half height h, greedily by area per sphere. Empty if
/// it takes more than `limit` spheres.
std::vector<Ring> cover_disc(double r, double h, double overshoot, int limit) {
  constexpr int kMostPerRing = 64;
  const double most = std::sqrt(overshoot * (overshoot + 2.0 * h));  // sqrt(c^2 + h^2) - h
  std::vector<Ring> rings;
  double outer = r;
  int total = 0;
  while (outer > most || std::hypot(outer, h) > r + overshoot) {
    Ring best;
    double best_value = 0.0;
    for (int count = 3; count <= std::min(limit - total, kMostPerRing); ++count) {
      const Ring ring = widest_ring(outer, count, most, h, r + overshoot);
      const double value = (outer * outer - ring.inner * ring.inner) / count;
      if (ring.count > 0 && value > best_value) {
        best_value = value;
        best = ring;
      }
    }
    if (best.count == 0) return {};
    total += best.count;
    rings.push_back(best);
    outer = best.inner;
    if (outer == 0.0) return rings;
  }
  if (total + 1 > limit) return {};
  rings.push_back({1, 0.0, outer, 0.0});
  return rings;
}

Spheres cover_cylinder(double r, double length, double overshoot, int limit) {
  std::vector<Ring> best;
  int fewest = limit + 1, layers = 0;
  for (int n = 1; n < fewest; ++n) {
    const std::vector<Ring> rings = cover_disc(r, 0.5 * length / n, overshoot, (fewest - 1) / n);
    int count = 0;
    for (const Ring& ring : rings) count += n * ring.count;
    if (count == 0 || count >= fewest) continue;
    fewest = count;
    layers = n;
    best = rings;
  }
  Spheres spheres;
  for (int layer = 0; layer < layers; ++layer) {
    const double z = ((layer + 0.5) / layers - 0.5) * length;
    for (const Ring& ring : best) {
      for (int i = 0; i < ring.count; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / ring.count;
        spheres.emplace_back(
            Eigen::Vector3d(ring.centre * std::cos(angle), ring.centre * std::sin(angle), z),
            std::hypot(ring.reach, 0.5 * length / layers));
      }
    }
  }
  return spheres;
}

/// Empty if it takes more than `limit` spheres.
Spheres cover(const CollisionShape& shape, double overshoot, int limit) {
  switch (shape.type) {
    case ShapeType::kSphere:
      return {{Eigen::Vector3d::Zero(), shape.radius}};
    case ShapeType::kCapsule:
      return cover_capsule(shape.radius, shape.length, overshoot, limit);
    case ShapeType::kCylinder:
      return cover_cylinder(shape.radius, shape.length, overshoot, limit);
    case ShapeType::kBox:
      return cover_box(shape.size, overshoot, limit);
    case ShapeType::kMesh:
      break;
  }
  Spheres spheres;
  for (const Capsule& sphere : fit_capsules(collision_mesh(shape), {overshoot, limit, true})) {
    spheres.emplace_back(sphere.from, sphere.radius);
  }
  return spheres;
}

}  // namespace

std::vector<CollisionSphere> covering_spheres(const CollisionShape& shape, double max_overshoot_m,
                                              int max_spheres_per_shape) {
  if (!(max_overshoot_m > 0.0) || max_spheres_per_shape < 1) {
    throw Error("covering spheres with overshoot " + std::to_string(max_overshoot_m) + " m and " +
                    std::to_string(max_spheres_per_shape) + " spheres per shape",
                "positive numbers");
  }
  Spheres spheres;
  for (double overshoot = max_overshoot_m; spheres.empty(); overshoot *= 1.1) {
    spheres = cover(shape, overshoot, max_spheres_per_shape);
  }
  std::vector<CollisionSphere> result;
  for (const auto& [centre, radius] : spheres) {
    const Eigen::Vector3d in_link = shape.link_from_shape * centre;
    result.push_back({shape.link, in_link, radius * kInflation, -1});
  }
  return result;
}

std::vector<CollisionSphere> covering_spheres(const Robot& robot, double max_overshoot_m,
                                              int max_spheres_per_shape) {
  std::vector<CollisionSphere> result;
  ShapeCovers<std::vector<CollisionSphere>> covers([&](const CollisionShape& shape) {
    return covering_spheres(shape, max_overshoot_m, max_spheres_per_shape);
  });
  for (const Link& link : robot.links()) {
    for (std::size_t s = 0; s < link.collision.size(); ++s) {
      const CollisionShape& shape = link.collision[s];
      for (const CollisionSphere& sphere : covers.of(robot, shape)) {
        result.push_back({shape.link, shape.link_from_shape * sphere.center, sphere.radius,
                          static_cast<int>(s)});
      }
    }
  }
  return result;
}

}  // namespace locograph
