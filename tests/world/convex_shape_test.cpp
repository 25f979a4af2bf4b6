#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/world/convex_shape.h>
#include <locograph/world/gjk.h>
#include <locograph/world/mesh_vertices.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/sanitized.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::kSanitized, test::TemporaryFolder;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Eigen::Isometry3d pose(double reach) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    const Eigen::Vector4d q((*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1));
    out.linear() = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    out.translation() =
        Eigen::Vector3d((*this)(-reach, reach), (*this)(-reach, reach), (*this)(-reach, reach));
    return out;
  }
  ConvexShape shape(int kind) {
    switch (kind) {
      case 0:
        return ConvexShape::sphere((*this)(0.03, 0.2));
      case 1:
        return ConvexShape::capsule((*this)(0.03, 0.15), (*this)(0.05, 0.5));
      case 2:
        return ConvexShape::cylinder((*this)(0.03, 0.15), (*this)(0.05, 0.5));
      case 3:
        return ConvexShape::box(
            Eigen::Vector3d((*this)(0.03, 0.3), (*this)(0.03, 0.3), (*this)(0.03, 0.3)));
      default: {
        std::vector<Eigen::Vector3d> points;
        for (int i = 0; i < 20; ++i)
          points.emplace_back((*this)(-0.1, 0.2), (*this)(-0.2, 0.1), (*this)(-0.1, 0.1));
        return ConvexShape::hull(points);
      }
    }
  }

 private:
  std::mt19937 engine_;
};

// A lower bound of the distance: the gap between the shapes along a direction.
double gap(const ConvexShape& a, const Eigen::Isometry3d& world_from_a, const ConvexShape& b,
           const Eigen::Isometry3d& world_from_b, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d n = direction.normalized();
  const Eigen::Vector3d on_a = world_from_a * a.support(world_from_a.linear().transpose() * -n);
  const Eigen::Vector3d on_b = world_from_b * b.support(world_from_b.linear().transpose() * n);
  return n.dot(on_a - on_b);
}

bool contains(const ConvexShape& shape, const Eigen::Vector3d& p, double slack) {
  switch (shape.type()) {
    case ConvexShape::Type::kSphere:
    case ConvexShape::Type::kCapsule: {
      const double z = std::clamp(p.z(), -shape.half_length(), shape.half_length());
      return (p - Eigen::Vector3d(0, 0, z)).norm() <= shape.radius() + slack;
    }
    case ConvexShape::Type::kCylinder:
      return std::hypot(p.x(), p.y()) <= shape.radius() + slack &&
             std::abs(p.z()) <= shape.half_length() + slack;
    case ConvexShape::Type::kBox:
      return (p.cwiseAbs().array() <= shape.half_extents().array() + slack).all();
    case ConvexShape::Type::kHull:
      break;
  }
  // By 400 supporting half-spaces.
  Random random(99);
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(random(-1, 1), random(-1, 1), random(-1, 1)).normalized();
    if (n.dot(p) > n.dot(shape.support(n)) + slack) return false;
  }
  return true;
}

TEST(ConvexShape, DistancesOfAllPairsAreCertifiedFromBothSides) {
  // Points on the shapes bound the distance from above, the gap along their line from below.
  Random random(1);
  constexpr int kRuns = kSanitized ? 5000 : 50000;
  int apart[5][5] = {};
  for (int i = 0; i < kRuns; ++i) {
    const int one = i % 5, two = i / 5 % 5;
    const ConvexShape a = random.shape(one), b = random.shape(two);
    const Eigen::Isometry3d world_from_a = random.pose(0.4), world_from_b = random.pose(0.4);
    const ShapeDistance found = shape_distance(a, world_from_a, b, world_from_b);
    if (found.distance <= 0.0) continue;
    ++apart[one][two];
    const Eigen::Vector3d between = found.on_first - found.on_second;
    EXPECT_NEAR(between.norm(), found.distance, 1e-6) << one << ' ' << two;
    EXPECT_GE(gap(a, world_from_a, b, world_from_b, between), found.distance - 2e-5)
        << one << ' ' << two << " run " << i;
    EXPECT_TRUE(contains(a, world_from_a.inverse() * found.on_first, 1e-5)) << one << ' ' << two;
    EXPECT_TRUE(contains(b, world_from_b.inverse() * found.on_second, 1e-5)) << one << ' ' << two;
  }
  for (const auto& row : apart)
    for (int count : row) EXPECT_GT(count, kRuns / 100);
}

TEST(ConvexShape, PairsCalledTouchingHaveNoGapInAnyDirection) {
  Random random(2);
  int touching = 0;
  for (int i = 0; i < 5000; ++i) {
    const ConvexShape a = random.shape(i % 5), b = random.shape(i / 5 % 5);
    const Eigen::Isometry3d world_from_a = random.pose(0.15), world_from_b = random.pose(0.15);
    const ShapeDistance found = shape_distance(a, world_from_a, b, world_from_b);
    if (found.distance > 0.0) continue;
    ++touching;
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d n(random(-1, 1), random(-1, 1), random(-1, 1));
      EXPECT_LE(gap(a, world_from_a, b, world_from_b, n), 1e-9);
    }
  }
  EXPECT_GT(touching, 1000);
}

TEST(ConvexShape, PenetrationDepthsOfSimplePairsAreTheKnownOnes) {
  const Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  const auto at = [](double x, double y, double z) {
    return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
  };
  const ConvexShape ball = ConvexShape::sphere(0.1);
  const ConvexShape rod = ConvexShape::capsule(0.05, 0.4);
  const ConvexShape box = ConvexShape::box(Eigen::Vector3d(0.2, 0.4, 0.6));
  const ConvexShape can = ConvexShape::cylinder(0.1, 0.2);
  EXPECT_NEAR(shape_distance(ball, at(0.15, 0, 0), ball, origin).distance, -0.05, 1e-12);
  EXPECT_NEAR(shape_distance(ball, at(0.15, 0, 0), box, origin).distance, -0.05, 1e-12);
  EXPECT_NEAR(shape_distance(ball, at(0.08, 0, 0), box, origin).distance, -0.12, 1e-12);
  EXPECT_NEAR(shape_distance(box, origin, rod, at(0.13, 0, 0.1)).distance, -0.02, 1e-12);
  EXPECT_NEAR(shape_distance(rod, at(0.08, 0, 0), rod, origin).distance, -0.02, 1e-12);
  EXPECT_NEAR(shape_distance(box, at(0.19, 0.01, 0.02), box, origin).distance, -0.01, 1e-6);
  EXPECT_NEAR(shape_distance(can, at(0.01, 0.02, 0.38), box, origin).distance, -0.02, 1e-3);
}

TEST(ConvexShape, TheDepthInALongThinBarIsTheWayOutAcrossIt) {
  constexpr double kBar_m = 0.02, kBall_m = 0.03;
  const ConvexShape bar = ConvexShape::cylinder(kBar_m, 2.0);
  const ConvexShape ball = ConvexShape::sphere(kBall_m);
  const ConvexShape arm = ConvexShape::capsule(kBall_m, 0.4);
  const ConvexShape can = ConvexShape::cylinder(kBall_m, 0.4);
  const ConvexShape block = ConvexShape::box({0.06, 0.1, 0.2});
  Random random(8);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Isometry3d world_from_bar = random.pose(1.0);
    const double off = random(0.0, 0.045), angle = random(0.0, 6.28), along = random(-0.7, 0.7);
    Eigen::Isometry3d bar_from_shape = Eigen::Isometry3d::Identity();
    bar_from_shape.translation() << off * std::cos(angle), off * std::sin(angle), along;
    const auto distance = [&](const ConvexShape& shape, const Eigen::Isometry3d& bar_from) {
      const double forth =
          shape_distance(shape, world_from_bar * bar_from, bar, world_from_bar).distance;
      EXPECT_NEAR(shape_distance(bar, world_from_bar, shape, world_from_bar * bar_from).distance,
                  forth, 1e-6);
      return forth;
    };
    const double expected = off - kBar_m - kBall_m;
    EXPECT_NEAR(distance(ball, bar_from_shape), expected, 1e-6);
    // Across the bar, along what is tangential to it there.
    const Eigen::Vector3d out(std::cos(angle), std::sin(angle), 0.0);
    const Eigen::Vector3d tangent = Eigen::Vector3d::UnitZ().cross(out);
    bar_from_shape.linear() << out, out.cross(-tangent), tangent;
    bar_from_shape.linear().col(1) = tangent.cross(out);
    EXPECT_NEAR(distance(arm, bar_from_shape), expected, 1e-6);
    EXPECT_NEAR(distance(can, bar_from_shape), expected, 1e-6);
    // A block of 0.06 m towards the bar.
    EXPECT_NEAR(distance(block, bar_from_shape), off - kBar_m - 0.03, 1e-6);
  }
}

TEST(ConvexShape, ContainedShapesAreInCollision) {
  const Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  const ConvexShape big = ConvexShape::box(Eigen::Vector3d(2, 2, 2));
  Random random(3);
  for (int kind = 0; kind < 5; ++kind)
    EXPECT_LT(shape_distance(random.shape(kind), random.pose(0.3), big, origin).distance, -0.3);
}

TEST(ConvexShape, SegmentToBoxDistanceAgreesWithDenseSampling) {
  Random random(4);
  const auto point = [&] { return Eigen::Vector3d(random(-1, 1), random(-1, 1), random(-1, 1)); };
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d half = 0.4 * point().cwiseAbs() + Eigen::Vector3d::Constant(0.02);
    Eigen::Vector3d from = point(), to = point();
    if (i % 5 == 0) to.head<2>() = from.head<2>();  // parallel to an axis
    if (i % 50 == 0) to = from;
    double nearest = 1e9;
    const int samples = 2000;
    for (int k = 0; k <= samples; ++k) {
      const Eigen::Vector3d p = from + (to - from) * k / samples;
      const Eigen::Vector3d excess = p.cwiseAbs() - half;
      const double outside = excess.cwiseMax(0.0).norm();
      nearest = std::min(nearest, outside > 0.0 ? outside : excess.maxCoeff());
    }
    const double found = segment_box_distance(from, to, half).distance;
    EXPECT_LE(found, nearest + 1e-12);
    EXPECT_GE(found, nearest - (to - from).norm() / samples);
    EXPECT_NEAR(segment_box_clearance(from, to, half), std::max(0.0, found), 1e-9);
  }
}

TEST(ConvexShape, GjkAloneFindsTheDistanceToo) {
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    const ConvexShape a = random.shape(3), b = random.shape(i % 2 ? 3 : 0);
    const Eigen::Isometry3d world_from_a = random.pose(0.4), world_from_b = random.pose(0.4);
    const auto support = [](const ConvexShape& s, const Eigen::Isometry3d& pose) {
      return [&s, &pose](const Eigen::Vector3d& n) -> Eigen::Vector3d {
        return pose * s.support(pose.linear().transpose() * n);
      };
    };
    const GjkResult found = gjk_distance(support(a, world_from_a), support(b, world_from_b),
                                         Eigen::Vector3d(1, 0.1, 0.2));
    EXPECT_LE(found.error, 1e-6);
    const double reference = shape_distance(a, world_from_a, b, world_from_b).distance;
    EXPECT_NEAR(found.distance, std::max(0.0, reference), 2e-5);
  }
}

TEST(ConvexShape, BoundingCapsulesContainTheShapes) {
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const ConvexShape shape = random.shape(i % 5);
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d p =
          shape.support(Eigen::Vector3d(random(-1, 1), random(-1, 1), random(-1, 1)));
      const Eigen::Vector3d offset = p - shape.center();
      EXPECT_LE(offset.norm(), shape.bounding_radius() + 1e-12);
      const Eigen::Vector3d& axis = shape.bounding_axis();
      const double t =
          axis.isZero() ? 0.0 : std::clamp(offset.dot(axis) / axis.squaredNorm(), -1.0, 1.0);
      EXPECT_LE((offset - t * axis).norm(), shape.bounding_capsule_radius() + 1e-12);
    }
  }
}

TEST(ConvexShape, BoundingCapsulesAreNoFartherApartThanTheShapes) {
  Random random(7);
  int apart = 0;
  for (int i = 0; i < 1000; ++i) {
    const ConvexShape a = random.shape(i % 5), b = random.shape(i / 5 % 5);
    const Eigen::Isometry3d world_from_a = random.pose(1.0), world_from_b = random.pose(1.0);
    const double capsules = capsule_distance(a, world_from_a, b, world_from_b);
    if (capsules <= 0.0) continue;
    ++apart;
    const double distance = shape_distance(a, world_from_a, b, world_from_b).distance;
    EXPECT_LE(capsules, distance + 1e-5);
    if (a.is_swept_sphere() && b.is_swept_sphere()) {
      EXPECT_NEAR(capsules, distance, 1e-12);
    }
  }
  EXPECT_GT(apart, 100);
}

TEST(ConvexShape, RefusesSizesThatAreNone) {
  EXPECT_THROW(ConvexShape::sphere(0.0), Error);
  EXPECT_THROW(ConvexShape::capsule(0.1, -1.0), Error);
  EXPECT_THROW(ConvexShape::cylinder(0.1, 0.0), Error);
  EXPECT_THROW(ConvexShape::box(Eigen::Vector3d(1, 1, std::nan(""))), Error);
  EXPECT_THROW(ConvexShape::hull({}), Error);
}

TEST(StlVertices, ReadsTextAndBinaryAndRefusesTheRest) {
  const TemporaryFolder folder;
  const std::string text =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 "
      "1 2.5e-1\nendloop\nendfacet\nendsolid a\n";
  const std::vector<Eigen::Vector3d> vertices = mesh_vertices(folder.write("a.stl", text));
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices.back(), Eigen::Vector3d(1, 1, 0.25));
  EXPECT_THROW(mesh_vertices(folder.write("b.stl", text.substr(0, text.size() - 12))), Error);
  EXPECT_THROW(mesh_vertices(folder.write("c.stl", "hello")), Error);
  EXPECT_THROW(mesh_vertices(folder.file("none.stl")), Error);

  const std::filesystem::path foot = std::filesystem::path(LOCOGRAPH_SHARED_DATA) /
                                     "robots/go2_description/collisions/foot_convex.stl";
  if (!std::filesystem::exists(foot)) GTEST_SKIP() << foot << " is missing";
  // A closed triangle mesh of the sphere's topology: V = F / 2 + 2.
  EXPECT_EQ(mesh_vertices(foot).size(), 654u / 2 + 2);
  const std::string content = read_file(foot);
  EXPECT_THROW(mesh_vertices(folder.write("cut.stl", content.substr(0, content.size() - 1))),
               Error);
}

}  // namespace
}  // namespace locograph
