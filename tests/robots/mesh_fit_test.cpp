// Capsules and spheres fitted to meshes, and how far they are from them.
#include <locograph/common/error.h>
#include <locograph/robots/approximation.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/mesh_fit.h>
#include <locograph/robots/stl_file.h>

#include <cmath>
#include <numbers>

#include "common/sanitized.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

using Corners = std::vector<Eigen::Vector3d>;

void add_quad(Corners& corners, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
              const Eigen::Vector3d& c, const Eigen::Vector3d& d) {
  corners.insert(corners.end(), {a, b, c, a, c, d});
}

/// What lies between a polygon in the plane z = low, counter-clockwise, and the same at `high`.
/// The ends are fans around the first corner.
Corners prism(const std::vector<Eigen::Vector2d>& polygon, double low, double high) {
  const auto at = [&](std::size_t i, double z) {
    const Eigen::Vector2d& p = polygon[i % polygon.size()];
    return Eigen::Vector3d(p.x(), p.y(), z);
  };
  Corners corners;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    add_quad(corners, at(i, low), at(i + 1, low), at(i + 1, high), at(i, high));
  }
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    corners.insert(corners.end(), {at(0, low), at(i, low), at(i - 1, low)});
    corners.insert(corners.end(), {at(0, high), at(i - 1, high), at(i, high)});
  }
  return corners;
}

Corners box(double x, double y, double z) {
  return prism({{-x / 2, -y / 2}, {x / 2, -y / 2}, {x / 2, y / 2}, {-x / 2, y / 2}}, -z / 2, z / 2);
}

Corners cylinder(double radius, double length, int sides) {
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return prism(polygon, -0.5 * length, 0.5 * length);
}

/// Two legs, 0.3 m and 0.2 m long, 0.05 m thick. The first corner is the inner one, so that the
/// fans of its ends lie inside it.
Corners l_shape() {
  return prism({{0.05, 0.05}, {0.05, 0.3}, {0.0, 0.3}, {0.0, 0.0}, {0.2, 0.0}, {0.2, 0.05}}, 0.0,
               0.05);
}

Corners turned(Corners corners) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 0.4, -0.3, 0.2;
  pose.rotate(Eigen::AngleAxisd(0.9, Eigen::Vector3d(2, -1, 1).normalized()));
  for (Eigen::Vector3d& corner : corners) corner = pose * corner;
  return corners;
}

/// Random points of the triangles, none of them where the fit or its measurement looked.
Corners random_points(const Corners& corners, int each) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Corners points;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    for (int i = 0; i < each; ++i) {
      double a = unit(random), b = unit(random);
      if (a + b > 1.0) {
        a = 1.0 - a;
        b = 1.0 - b;
      }
      points.push_back(corners[t] + a * (corners[t + 1] - corners[t]) +
                       b * (corners[t + 2] - corners[t]));
    }
  }
  return points;
}

double worst_outside(const std::vector<Capsule>& capsules, const Corners& points) {
  double worst = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : points) {
    double least = std::numeric_limits<double>::infinity();
    for (const Capsule& c : capsules) least = std::min(least, signed_distance(c, point));
    worst = std::max(worst, least);
  }
  return worst;
}

/// How far random points of the capsules' union stick out of the mesh.
double worst_overshoot(const std::vector<Capsule>& capsules, const TriangleTree& mesh) {
  std::mt19937 random(42);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (const Capsule& capsule : capsules) {
    for (int i = 0; i < 1500; ++i) {
      const Eigen::Vector3d direction =
          Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
      const Eigen::Vector3d middle = capsule.from + unit(random) * (capsule.to - capsule.from);
      const Eigen::Vector3d point = middle + capsule.radius * direction;
      worst = std::max(worst, mesh.distance_outside(point));  // 0 where it is inside the mesh
    }
  }
  return worst;
}

/// As text, all digits.
std::string stl(const Corners& corners) {
  std::ostringstream text;
  text.precision(17);
  text << "solid m\n";
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i % 3 == 0) text << "facet normal 0 0 0\nouter loop\n";
    text << "vertex " << corners[i].x() << ' ' << corners[i].y() << ' ' << corners[i].z() << '\n';
    if (i % 3 == 2) text << "endloop\nendfacet\n";
  }
  text << "endsolid m\n";
  return text.str();
}

CollisionShape mesh_shape(const std::filesystem::path& file) {
  CollisionShape shape;
  shape.type = ShapeType::kMesh;
  shape.link = 0;
  shape.mesh_file = file;
  shape.mesh_found = true;
  return shape;
}

TEST(TriangleTree, FindsTheDistanceThatTryingAllTrianglesFinds) {
  const Corners corners = turned(cylinder(0.1, 0.3, 40));
  const TriangleTree tree(corners);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-0.5, 0.5);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d point(0.4 + unit(random), -0.3 + unit(random), 0.2 + unit(random));
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      const TriangleTree one({corners[t], corners[t + 1], corners[t + 2]});
      least = std::min(least, one.distance(point));
    }
    EXPECT_DOUBLE_EQ(tree.distance(point), least);
  }
}

TEST(TriangleTree, KnowsTheDistancesOfABox) {
  const TriangleTree tree(box(2.0, 4.0, 6.0));
  EXPECT_DOUBLE_EQ(tree.distance({0, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(tree.distance({3, 1, 1}), 2.0);
  EXPECT_DOUBLE_EQ(tree.distance({1 + 3, 2 + 4, 0}), 5.0);      // an edge
  EXPECT_DOUBLE_EQ(tree.distance({1 + 2, 2 + 3, 3 + 6}), 7.0);  // a corner
  EXPECT_DOUBLE_EQ(tree.distance({3, 1, 1}, 0.5), 0.5);
  EXPECT_NEAR(tree.winding_number({0.9, 1.9, 2.9}), 1.0, 1e-12);
  EXPECT_NEAR(tree.winding_number({1.1, 0, 0}), 0.0, 1e-12);
  EXPECT_NEAR(tree.winding_number({50, 0, 0}), 0.0, 1e-3);
  EXPECT_EQ(tree.distance_outside({0.5, 0.5, 0.5}), 0.0);
}

TEST(MeshFit, PutsTheSphereAroundACube) {
  const TriangleTree mesh(box(0.2, 0.2, 0.2));
  const std::vector<Capsule> spheres = fit_capsules(mesh, {0.01, 1, true});
  ASSERT_EQ(spheres.size(), 1u);
  EXPECT_EQ(spheres[0].from, spheres[0].to);
  EXPECT_NEAR(spheres[0].radius, 0.1 * std::sqrt(3.0), 0.002);
  EXPECT_GE(spheres[0].radius, 0.1 * std::sqrt(3.0));
}

// A capsule of radius R around a cylinder of radius r sticks out by R - r at its side and by
// R - sqrt(R^2 - r^2) at its ends: least where both are the same, R = sqrt(2) r.
TEST(MeshFit, PutsTheBestCapsuleAroundACylinder) {
  const double radius = 0.05;
  const TriangleTree mesh(turned(cylinder(radius, 0.4, 64)));
  const std::vector<Capsule> capsules = fit_capsules(mesh, {0.001, 1, false});
  ASSERT_EQ(capsules.size(), 1u);
  const double best = (std::sqrt(2.0) - 1.0) * radius;
  const double over = worst_overshoot(capsules, mesh);
  EXPECT_GT(over, 0.95 * best);
  EXPECT_LT(over, 1.15 * best);
}

TEST(MeshFit, FindsACapsuleAgain) {
  const Capsule capsule{{0.1, 0.0, -0.1}, {0.2, 0.1, 0.3}, 0.06};
  const Eigen::Vector3d axis = (capsule.to - capsule.from).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  constexpr int kAround = 32, kAlong = 17;  // rings, from one tip to the other
  const auto at = [&](int i, int k) -> Eigen::Vector3d {
    const double angle = 2.0 * std::numbers::pi * k / kAround;
    const double up =
        std::numbers::pi * (i <= kAlong / 2 ? i : i - 1) / (kAlong - 1) - 0.5 * std::numbers::pi;
    return (i <= kAlong / 2 ? capsule.from : capsule.to) +
           capsule.radius *
               (std::sin(up) * axis + std::cos(up) * (std::cos(angle) * u + std::sin(angle) * v));
  };
  Corners corners;
  for (int i = 0; i < kAlong; ++i) {
    for (int k = 0; k < kAround; ++k) {
      add_quad(corners, at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k));
    }
  }
  const std::vector<Capsule> found = fit_capsules(TriangleTree(corners), {0.004, 12, false});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].radius, capsule.radius, 0.003);
  EXPECT_LE(worst_outside(found, random_points(corners, 5)), 0.0);
}

TEST(MeshFit, CutsAnLInTwo) {
  const Corners corners = l_shape();
  const TriangleTree mesh(corners);
  const std::vector<Capsule> one = fit_capsules(mesh, {0.02, 1, false});
  const std::vector<Capsule> several = fit_capsules(mesh, {0.02, 6, false});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_GE(several.size(), 2u);
  EXPECT_GT(worst_overshoot(one, mesh), 0.07);
  EXPECT_LT(worst_overshoot(several, mesh), 0.021);
  const Eigen::Vector3d notch(0.12, 0.15, 0.025);
  EXPECT_LT(worst_outside(one, {notch}), 0.0);
  EXPECT_GT(worst_outside(several, {notch}), 0.03);
  EXPECT_LE(worst_outside(several, random_points(corners, 500)), 0.0);
}

TEST(MeshFit, TurnsWithTheMesh) {
  const TriangleTree mesh(l_shape()), turned_mesh(turned(l_shape()));
  const MeshFitOptions options{0.02, 6, false};
  EXPECT_LT(worst_overshoot(fit_capsules(turned_mesh, options), turned_mesh), 0.021);
}

TEST(MeshFit, CoversTheInsideToo) {
  const TriangleTree mesh(box(0.4, 0.3, 0.2));
  for (const bool only_spheres : {false, true}) {
    const std::vector<Capsule> capsules = fit_capsules(mesh, {0.02, 30, only_spheres});
    EXPECT_GT(capsules.size(), 4u);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-0.5, 0.5);
    Corners inside;
    for (int i = 0; i < 5000; ++i) {
      inside.emplace_back(0.4 * unit(random), 0.3 * unit(random), 0.2 * unit(random));
    }
    EXPECT_LT(worst_outside(capsules, inside), 0.005);
  }
}

TEST(MeshFit, KeepsItsBoundsAndGetsBetterWithMore) {
  const TriangleTree mesh(turned(box(0.4, 0.2, 0.1)));
  double last = std::numeric_limits<double>::infinity();
  for (const int most : {1, 8, 64}) {
    const std::vector<Capsule> spheres = fit_capsules(mesh, {0.015, most, true});
    EXPECT_LE(static_cast<int>(spheres.size()), most);
    const double over = worst_overshoot(spheres, mesh);
    EXPECT_LT(over, last);
    last = over;
  }
  EXPECT_LT(last, 1.2 * 0.0183);  // cubes of 0.05 m: half their diagonal less half their side
}

TEST(MeshFit, RemembersNoOtherMeshAndNoOtherOptions) {
  const TriangleTree one(box(0.1, 0.1, 0.1)), two(box(0.1, 0.1, 0.2));
  const MeshFitOptions options{0.05, 4, true};
  const std::vector<Capsule> fit = fit_capsules(one, options), longer = fit_capsules(two, options);
  EXPECT_EQ(fit_capsules(one, options)[0].radius, fit[0].radius);
  EXPECT_NE(longer[0].to, fit[0].to);
  EXPECT_LT(fit_capsules(one, {0.02, 64, true})[0].radius, fit[0].radius);
}

TEST(MeshFit, GivesTheSameBitsAgain) {
  const TriangleTree mesh(turned(l_shape()));
  // Other options, lest the second is remembered; neither bounds the number.
  const std::vector<Capsule> first = fit_capsules(mesh, {0.02, 20, false});
  const std::vector<Capsule> second = fit_capsules(mesh, {0.02, 21, false});
  ASSERT_LT(first.size(), 20u);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].from, second[i].from);
    EXPECT_EQ(first[i].to, second[i].to);
    EXPECT_EQ(first[i].radius, second[i].radius);
  }
}

TEST(MeshFit, CoversBrokenMeshes) {
  const Corners whole = turned(cylinder(0.05, 0.3, 24));
  std::vector<Corners> broken(4);
  for (std::size_t t = 0; t < whole.size(); t += 3) {
    const Corners triangle(whole.begin() + static_cast<long>(t),
                           whole.begin() + static_cast<long>(t) + 3);
    const auto add = [&](Corners& to) { to.insert(to.end(), triangle.begin(), triangle.end()); };
    if (t % 5 != 0) add(broken[0]);  // holes
    add(broken[1]);
    if (t % 2 == 0) add(broken[1]);                                              // twice
    broken[2].insert(broken[2].end(), {triangle[0], triangle[2], triangle[1]});  // inside out
    add(broken[3]);
    broken[3].insert(broken[3].end(), {triangle[0], triangle[0], triangle[1]});  // no area
  }
  for (const Corners& corners : broken) {
    const TriangleTree mesh(corners);
    const std::vector<Capsule> capsules = fit_capsules(mesh, {0.025, 8, false});
    EXPECT_LE(worst_outside(capsules, corners), 0.0);
    EXPECT_LE(worst_outside(capsules, random_points(corners, 50)), 0.0);
    EXPECT_LT(worst_overshoot(capsules, mesh), 0.03);
  }
}

TEST(MeshFit, CoversWhatHasNoVolume) {
  const Eigen::Vector3d a(0.1, 0.2, 0.3), b(0.4, 0.2, 0.3), c(0.1, 0.4, 0.3);
  for (const Corners& corners : {Corners{a, b, c}, Corners{a, b, b}, Corners{a, a, a}}) {
    for (const bool only_spheres : {false, true}) {
      const std::vector<Capsule> capsules =
          fit_capsules(TriangleTree(corners), {0.01, 8, only_spheres});
      ASSERT_FALSE(capsules.empty());
      for (const Capsule& capsule : capsules) {
        EXPECT_TRUE(capsule.from.allFinite() && capsule.to.allFinite());
        EXPECT_TRUE(std::isfinite(capsule.radius));
        EXPECT_LT(capsule.radius, 0.3);
      }
      EXPECT_LE(worst_outside(capsules, random_points(corners, 500)), 1e-12);
    }
  }
}

TEST(Approximation, MeasuresWhatIsKnown) {
  CollisionShape ball;
  ball.type = ShapeType::kSphere;
  ball.radius = 0.1;
  ball.link_from_shape.translation() << 1.0, 2.0, 3.0;
  const Eigen::Vector3d middle = ball.link_from_shape.translation();
  const Approximation larger = measured(ball, std::vector<Capsule>{{middle, middle, 0.13}});
  EXPECT_NEAR(larger.worst_over_m, 0.03, 1e-12);
  EXPECT_EQ(larger.worst_under_m, 0.0);
  const Approximation smaller = measured(ball, std::vector<Capsule>{{middle, middle, 0.08}});
  EXPECT_EQ(smaller.worst_over_m, 0.0);
  EXPECT_NEAR(smaller.worst_under_m, 0.02, 1e-12);

  CollisionShape cube;
  cube.type = ShapeType::kBox;
  cube.size = Eigen::Vector3d::Constant(0.2);
  const Approximation around =
      measured(cube, std::vector<Capsule>{
                         {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.1 * std::sqrt(3.0)}});
  EXPECT_NEAR(around.worst_over_m, 0.1 * (std::sqrt(3.0) - 1.0), 1e-3);
  EXPECT_NEAR(around.worst_under_m, 0.0, 1e-15);

  CollisionShape rod;
  rod.type = ShapeType::kCylinder;
  rod.radius = 0.05;
  rod.length = 0.4;
  const Approximation inscribed =
      measured(rod, std::vector<Capsule>{{{0.0, 0.0, -0.15}, {0.0, 0.0, 0.15}, 0.05}});
  EXPECT_NEAR(inscribed.worst_over_m, 0.0, 1e-12);
  EXPECT_NEAR(inscribed.worst_under_m, 0.05 * (std::sqrt(2.0) - 1.0), 1e-4);
}

TEST(Approximation, OfAMeshIsThatOfTheBoxItIs) {
  const TemporaryFolder folder;
  CollisionShape mesh = mesh_shape(folder.write("box.stl", stl(box(300.0, 100.0, 50.0))));
  mesh.size = Eigen::Vector3d::Constant(0.001);
  CollisionShape box = mesh;
  box.type = ShapeType::kBox;
  box.size << 0.3, 0.1, 0.05;
  const std::vector<Capsule> capsules = covering_capsules(mesh);
  const Approximation of_mesh = measured(mesh, capsules), of_box = measured(box, capsules);
  EXPECT_NEAR(of_mesh.worst_over_m, of_box.worst_over_m, 1e-12);
  EXPECT_EQ(of_mesh.worst_under_m, 0.0);
  EXPECT_EQ(of_box.worst_under_m, 0.0);
  EXPECT_LT(of_mesh.worst_over_m, 0.03);
}

TEST(Approximation, OfMirroredAndScaledMeshesIsInTheLinksFrame) {
  const TemporaryFolder folder;
  folder.write("l.stl", stl(l_shape()));
  const std::filesystem::path urdf = folder.write(
      "r.urdf",
      "<robot name='r'><link name='a'><collision><origin xyz='1 0 0' rpy='0 0 1'/><geometry><mesh "
      "filename='l.stl' scale='2 2 -2'/></geometry></collision></link></robot>");
  const Robot robot = Robot::load(urdf);
  const CollisionShape& shape = robot.links()[0].collision[0];
  std::vector<Capsule> capsules;
  for (const CollisionCapsule& c : covering_capsules(robot, {.max_overshoot_m = 0.04})) {
    capsules.push_back(c.capsule);
  }
  Corners points = random_points(l_shape(), 100);
  for (Eigen::Vector3d& point : points) {
    point =
        shape.link_from_shape * Eigen::Vector3d(2.0 * point.x(), 2.0 * point.y(), -2.0 * point.z());
  }
  EXPECT_LE(worst_outside(capsules, points), 0.0);
  const std::vector<LinkApproximation> links =
      approximations(robot, 0.04, {.max_overshoot_m = 0.04});
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].capsules.count, static_cast<int>(capsules.size()));
  EXPECT_EQ(links[0].capsules.worst_under_m, 0.0);
  EXPECT_LT(links[0].capsules.worst_over_m, 0.042);
  EXPECT_LT(links[0].spheres.worst_over_m, 0.042);
}

TEST(Approximation, NamesTheFileOfAnUnusableMesh) {
  const TemporaryFolder folder;
  folder.write("bad.stl", "solid bad\nvertex 0 0\n");
  const std::filesystem::path urdf = folder.write(
      "r.urdf",
      "<robot name='r'><link name='a'><collision><geometry><mesh filename='bad.stl'/></geometry>"
      "</collision></link></robot>");
  const Robot robot = Robot::load(urdf);
  const std::vector<LinkApproximation> links = approximations(robot, 0.02, {});
  ASSERT_EQ(links.size(), 1u);
  EXPECT_NE(links[0].unusable.find("bad.stl:2:"), std::string::npos) << links[0].unusable;
  EXPECT_THROW(covering_capsules(robot), Error);
  EXPECT_THROW(covering_spheres(robot), Error);
  EXPECT_THROW(covering_capsules(mesh_shape(folder.write("empty.stl", "solid e\nendsolid e\n"))),
               Error);
  EXPECT_THROW(covering_capsules(robot.links()[0].collision[0], {.max_overshoot_m = 0.0}), Error);
}

TEST(Approximation, OfThePublicGo2CoversEveryMesh) {
  if (kSanitized) GTEST_SKIP() << "half a minute, like Meshes.OfThePublicGo2AreFoundAndCovered";
  if (!std::filesystem::exists(public_robot("go2.urdf"))) {
    GTEST_SKIP() << public_robot("go2.urdf") << " is not on this machine";
  }
  const Robot robot = Robot::load(public_robot("go2.urdf"));
  const std::vector<CollisionCapsule> capsules = covering_capsules(robot);
  const std::vector<CollisionSphere> spheres = covering_spheres(robot, 0.025);
  std::map<std::string, double> worst_over;
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    const Link& link = robot.links()[l];
    for (std::size_t s = 0; s < link.collision.size(); ++s) {
      const CollisionShape& shape = link.collision[s];
      if (shape.type != ShapeType::kMesh) continue;
      std::vector<Capsule> own, own_spheres;
      for (const CollisionCapsule& c : capsules) {
        if (c.link == static_cast<int>(l) && c.shape == static_cast<int>(s))
          own.push_back(c.capsule);
      }
      for (const CollisionSphere& c : spheres) {
        if (c.link != static_cast<int>(l) || c.shape != static_cast<int>(s)) continue;
        own_spheres.push_back({c.center, c.center, c.radius});
      }
      Corners corners = stl_triangles(shape.mesh_file);
      for (Eigen::Vector3d& corner : corners) corner = shape.link_from_shape * corner;
      const Corners points = random_points(corners, 10);
      EXPECT_LE(worst_outside(own, points), 0.0) << link.name;
      EXPECT_LE(worst_outside(own_spheres, points), 0.0) << link.name;
      if (worst_over.contains(shape.mesh_file.filename().string())) continue;
      double& reported = worst_over[shape.mesh_file.filename().string()];
      const Approximation approximation = measured(shape, own);
      reported = approximation.worst_over_m;
      EXPECT_EQ(approximation.worst_under_m, 0.0) << link.name;
      EXPECT_LE(worst_overshoot(own, TriangleTree(corners)), reported + 0.001) << link.name;
      EXPECT_LT(measured(shape, own_spheres).worst_over_m, 0.0255) << link.name;
    }
  }
  ASSERT_EQ(worst_over.size(), 9u);
  EXPECT_LT(worst_over["base_convex.stl"], 0.03);
  EXPECT_LT(worst_over["thigh_convex.stl"], 0.015);
  EXPECT_LT(worst_over["calf_upper_convex.stl"], 0.0105);
}

}  // namespace
}  // namespace locograph::test
