// Collision shapes as loaded, and spheres that cover them.
#include <locograph/common/error.h>
#include <locograph/robots/collision_model.h>
#include <locograph/robots/urdf_reader.h>

#include <cmath>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

CollisionShape shape(ShapeType type, double radius, double length, const Eigen::Vector3d& size) {
  CollisionShape result;
  result.type = type;
  result.link = 0;
  result.radius = radius;
  result.length = length;
  result.size = size;
  result.link_from_shape.translation() << 0.1, -0.2, 0.3;
  result.link_from_shape.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, -2, 3).normalized()));
  return result;
}

/// Points of the surface, edges and corners included, in the link frame.
std::vector<Eigen::Vector3d> surface(const CollisionShape& shape, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 4000; ++i) {
    Eigen::Vector3d point;
    if (shape.type == ShapeType::kBox) {
      point << unit(random), unit(random), unit(random);
      for (int k = 0; k <= i % 3; ++k) {  // on a face, an edge, a corner
        const int axis = (i / 3 + k) % 3;
        point[axis] = point[axis] < 0.0 ? -1.0 : 1.0;
      }
      point = 0.5 * point.cwiseProduct(shape.size);
    } else {
      const double z = 0.5 * shape.length * unit(random);
      const double angle = EIGEN_PI * unit(random);
      const Eigen::Vector3d around(shape.radius * std::cos(angle), shape.radius * std::sin(angle),
                                   0.0);
      const double end = (i % 2 == 0 ? 0.5 : -0.5) * shape.length;
      const Eigen::Vector3d on_ball =
          shape.radius *
          Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
      if (shape.type == ShapeType::kSphere) {
        point = on_ball;
      } else if (i % 3 == 0) {
        point = around + Eigen::Vector3d(0, 0, z);
      } else if (shape.type == ShapeType::kCapsule) {
        point = on_ball;
        point.z() = std::copysign(point.z(), end) + end;
      } else {
        const double reach = i % 3 == 1 ? 1.0 : std::abs(unit(random));
        point = reach * around + Eigen::Vector3d(0, 0, end);
      }
    }
    points.push_back(shape.link_from_shape * point);
  }
  return points;
}

double distance_outside(const std::vector<CollisionSphere>& spheres, const Eigen::Vector3d& point) {
  double least = std::numeric_limits<double>::infinity();
  for (const CollisionSphere& sphere : spheres) {
    least = std::min(least, (point - sphere.center).norm() - sphere.radius);
  }
  return least;
}

/// Signed distance of a point in the link frame to the shape, at least where it is positive.
double distance_to(const CollisionShape& shape, const Eigen::Vector3d& point_in_link) {
  const Eigen::Vector3d p = shape.link_from_shape.inverse() * point_in_link;
  if (shape.type == ShapeType::kBox) return (p.cwiseAbs() - 0.5 * shape.size).cwiseMax(0.0).norm();
  if (shape.type == ShapeType::kSphere) return p.norm() - shape.radius;
  const double beyond = std::max(0.0, std::abs(p.z()) - 0.5 * shape.length);
  const double radial = p.head<2>().norm();
  if (shape.type == ShapeType::kCapsule) return std::hypot(radial, beyond) - shape.radius;
  return std::hypot(std::max(0.0, radial - shape.radius), beyond);
}

const std::vector<CollisionShape> kShapes = {
    shape(ShapeType::kSphere, 0.1, 0.0, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCapsule, 0.08, 0.3, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCapsule, 0.2132, 0.3859, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCapsule, 0.07, 0.0001, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCylinder, 0.078, 0.11, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCylinder, 0.02, 0.5, Eigen::Vector3d::Ones()),
    shape(ShapeType::kCylinder, 0.2, 0.01, Eigen::Vector3d::Ones()),
    shape(ShapeType::kBox, 0.0, 0.0, Eigen::Vector3d(0.025, 0.09, 0.025)),
    shape(ShapeType::kBox, 0.0, 0.0, Eigen::Vector3d(0.3, 0.2, 0.05))};

TEST(CoveringSpheres, CoverTheSurfaceOfEveryShape) {
  std::mt19937 random(12);
  for (std::size_t s = 0; s < kShapes.size(); ++s) {
    for (const double overshoot : {0.003, 0.01, 0.05}) {
      for (const int limit : {1, 5, 64}) {
        const std::vector<CollisionSphere> spheres = covering_spheres(kShapes[s], overshoot, limit);
        ASSERT_FALSE(spheres.empty());
        EXPECT_LE(static_cast<int>(spheres.size()), limit);
        double worst = -1.0;
        for (const Eigen::Vector3d& point : surface(kShapes[s], random)) {
          worst = std::max(worst, distance_outside(spheres, point));
        }
        EXPECT_LE(worst, 0.0) << "shape " << s << ", overshoot " << overshoot;
      }
    }
  }
}

TEST(CoveringSpheres, CoverTheInsideToo) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> depth(0.0, 1.0);
  for (const CollisionShape& shape : kShapes) {
    const std::vector<CollisionSphere> spheres = covering_spheres(shape, 0.01, 200);
    const Eigen::Vector3d centre = shape.link_from_shape.translation();
    for (const Eigen::Vector3d& point : surface(shape, random)) {
      const Eigen::Vector3d inside = centre + depth(random) * (point - centre);
      ASSERT_LE(distance_outside(spheres, inside), 0.0);
    }
  }
}

TEST(CoveringSpheres, StickOutNoFurtherThanAskedIfTheyMayBeMany) {
  std::mt19937 random(14);
  std::normal_distribution<double> normal;
  for (std::size_t s = 0; s < kShapes.size(); ++s) {
    for (const double overshoot : {0.01, 0.03}) {
      double worst = 0.0;
      for (const CollisionSphere& sphere : covering_spheres(kShapes[s], overshoot, 2000)) {
        for (int i = 0; i < 500; ++i) {
          const Eigen::Vector3d direction =
              Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
          worst =
              std::max(worst, distance_to(kShapes[s], sphere.center + sphere.radius * direction));
        }
      }
      EXPECT_LE(worst, overshoot + 1e-6) << "shape " << s;
    }
  }
}

TEST(CoveringSpheres, OfARobotNameTheirLinkAndShape) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"));
  const std::vector<CollisionSphere> spheres = covering_spheres(robot, 0.02);
  std::vector<std::vector<std::vector<CollisionSphere>>> sorted(robot.links().size());
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    sorted[l].resize(robot.links()[l].collision.size());
  }
  for (const CollisionSphere& sphere : spheres) {
    sorted[static_cast<std::size_t>(sphere.link)][static_cast<std::size_t>(sphere.shape)].push_back(
        sphere);
  }
  std::mt19937 random(15);
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    for (std::size_t s = 0; s < sorted[l].size(); ++s) {
      for (const Eigen::Vector3d& point : surface(robot.links()[l].collision[s], random)) {
        ASSERT_LE(distance_outside(sorted[l][s], point), 0.0) << robot.links()[l].name;
      }
    }
  }
}

TEST(CoveringSpheres, RefuseArgumentsThatAreNotPositive) {
  EXPECT_THROW(covering_spheres(kShapes[1], 0.0, 10), Error);
  EXPECT_THROW(covering_spheres(kShapes[1], std::nan(""), 10), Error);
  EXPECT_THROW(covering_spheres(kShapes[1], 0.01, 0), Error);
}

TEST(Capsules, AreMergedFromACylinderAndTwoSpheres) {
  CollisionShape cylinder = kShapes[4];
  CollisionShape top = shape(ShapeType::kSphere, 0.078, 0, Eigen::Vector3d::Ones()), bottom = top;
  top.link_from_shape.translation() = cylinder.link_from_shape * Eigen::Vector3d(0, 0, 0.055);
  bottom.link_from_shape.translation() = cylinder.link_from_shape * Eigen::Vector3d(0, 0, -0.055);
  const CollisionShape other = kShapes[0];

  const std::vector<CollisionShape> merged = merge_capsules({other, top, cylinder, bottom});
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].type, ShapeType::kSphere);
  EXPECT_EQ(merged[0].radius, other.radius);
  EXPECT_EQ(merged[1].type, ShapeType::kCapsule);
  EXPECT_EQ(merged[1].radius, 0.078);
  EXPECT_EQ(merged[1].length, 0.11);

  EXPECT_EQ(merge_capsules({top, cylinder}).size(), 2u);
  CollisionShape thin = bottom;
  thin.radius = 0.07;
  EXPECT_EQ(merge_capsules({top, cylinder, thin}).size(), 3u);
  CollisionShape far = bottom;
  far.link_from_shape.translation().x() += 0.001;
  EXPECT_EQ(merge_capsules({top, cylinder, far}).size(), 3u);
  EXPECT_EQ(merge_capsules({top, cylinder, top}).size(), 3u);
}

TEST(Capsules, OfThePublicCapsuleModelAreAllFound) {
  if (!std::filesystem::exists(public_robot("centauro_capsule.urdf"))) {
    GTEST_SKIP() << public_robot("centauro_capsule.urdf") << " is not on this machine";
  }
  const Robot robot = Robot::load(public_robot("centauro_capsule.urdf"));
  int capsules = 0, boxes = 0, others = 0;
  for (const Link& link : robot.links()) {
    for (const CollisionShape& shape : link.collision) {
      ++(shape.type == ShapeType::kCapsule ? capsules
         : shape.type == ShapeType::kBox   ? boxes
                                           : others);
    }
  }
  EXPECT_EQ(capsules, 47);
  EXPECT_EQ(boxes, 2);
  EXPECT_EQ(others, 0);
}

TEST(Meshes, AreFoundBesideTheUrdfScaledAndCovered) {
  const TemporaryFolder folder;
  folder.write("robots/meshes/part.stl",
               "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 100 0 0\n"
               "vertex 0 200 50\nendloop\nendfacet\nendsolid part\n");
  const std::filesystem::path urdf = folder.write(
      "robots/urdf/deep/r.urdf",
      "<robot name='r'><link name='a'><collision><origin xyz='1 0 0'/><geometry><mesh "
      "filename='package://elsewhere/meshes/part.stl' scale='0.001 0.001 -0.001'/></geometry>"
      "</collision></link></robot>");
  const Robot robot = Robot::load(urdf);
  const CollisionShape& mesh = robot.links()[0].collision[0];
  ASSERT_TRUE(mesh.mesh_found);
  EXPECT_EQ(mesh.mesh_file, folder.path() / "robots/meshes/part.stl");
  const std::vector<CollisionSphere> spheres = covering_spheres(robot, 0.01);
  for (const Eigen::Vector3d& corner :
       {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(1.1, 0.0, 0.0),
        Eigen::Vector3d(1.0, 0.2, -0.05)}) {
    EXPECT_LE(distance_outside(spheres, corner), 0.0);
  }
  for (const CollisionSphere& sphere : spheres) {
    EXPECT_LE(sphere.center.x() + sphere.radius, 1.1 + 0.0101);
    EXPECT_GE(sphere.center.z() - sphere.radius, -0.05 - 0.0101);
  }
}

TEST(Meshes, AreReadAsTextOrBinaryStl) {
  const TemporaryFolder folder;
  std::string binary(80, 'x');
  const std::uint32_t count = 1;
  const float numbers[12] = {0, 0, 1, -1, 2, 3, 4, -5, 6, 0, 0, 9};
  const std::uint16_t attributes = 0;
  binary.append(reinterpret_cast<const char*>(&count), 4);
  binary.append(reinterpret_cast<const char*>(numbers), 48);
  binary.append(reinterpret_cast<const char*>(&attributes), 2);
  const Eigen::AlignedBox3d box = mesh_bounds(folder.write("b.stl", binary));
  EXPECT_EQ(box.min(), Eigen::Vector3d(-1, -5, 3));
  EXPECT_EQ(box.max(), Eigen::Vector3d(4, 2, 9));

  EXPECT_THROW(mesh_bounds(folder.path() / "none.stl"), Error);
  EXPECT_THROW(mesh_bounds(folder.write("c.stl", "solid of nothing\nendsolid")), Error);
  EXPECT_THROW(mesh_bounds(folder.write("d.stl", binary.substr(0, 100))), Error);
  const std::string text = "solid a\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendsolid a\n";
  EXPECT_EQ(mesh_bounds(folder.write("e.stl", text)).max(), Eigen::Vector3d(1, 1, 0));
  EXPECT_THROW(mesh_bounds(folder.write("f.stl", text.substr(0, text.find("ends")))), Error);
  try {
    mesh_bounds(folder.write("g.stl", "solid a\nvertex 0 0 0\nvertex 1 zero 0\nendsolid a\n"));
    ADD_FAILURE() << "an unreadable vertex was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 3);
  }
}

TEST(Meshes, OfThePublicGo2AreFoundAndCovered) {
  if (!std::filesystem::exists(public_robot("go2.urdf"))) {
    GTEST_SKIP() << public_robot("go2.urdf") << " is not on this machine";
  }
  const Robot robot = Robot::load(public_robot("go2.urdf"));
  const std::vector<CollisionSphere> spheres = covering_spheres(robot, 0.05, 8);
  for (const Link& link : robot.links()) {
    for (const CollisionShape& shape : link.collision) {
      EXPECT_TRUE(shape.type != ShapeType::kMesh || shape.mesh_found) << link.name;
    }
  }
  EXPECT_FALSE(spheres.empty());
}

}  // namespace
}  // namespace locograph::test
