#include <locograph/common/error.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/stl_file.h>
#include <locograph/robots/visual_model.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

const char kTriangle[] =
    "solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 -3\n"
    "endloop\nendfacet\nendsolid t\n";

std::string visual(const std::string& geometry, const std::string& rest = "") {
  return "<visual>" + rest + "<geometry>" + geometry + "</geometry></visual>";
}

Robot robot_of(const TemporaryFolder& folder, const std::string& links_and_more) {
  return Robot::load(
      folder.write("r.urdf", "<robot name=\"r\">\n" + links_and_more + "\n</robot>\n"));
}

TEST(VisualModel, ReadsPrimitivesWhereTheUrdfHasThem) {
  const TemporaryFolder folder;
  const Robot robot = robot_of(
      folder, "<link name=\"a\">" + visual("<sphere radius=\"0.1\"/>", "<origin xyz=\"1 2 3\"/>") +
                  visual("<cylinder radius=\"0.2\" length=\"0.5\"/>",
                         "<origin rpy=\"1.5707963267948966 0 1.5707963267948966\"/>") +
                  visual("<box size=\"1 2 3\"/>") + "</link>");
  const std::vector<VisualShape> shapes = load_visuals(robot);
  ASSERT_EQ(shapes.size(), 3u);
  EXPECT_EQ(shapes[0].type, ShapeType::kSphere);
  EXPECT_EQ(shapes[0].radius, 0.1);
  EXPECT_EQ(shapes[0].link_from_shape.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(shapes[1].type, ShapeType::kCylinder);
  EXPECT_EQ(shapes[1].length, 0.5);
  // Rz(90°) Rx(90°) takes z to −y, then to x.
  EXPECT_TRUE((shapes[1].link_from_shape.linear() * Eigen::Vector3d::UnitZ())
                  .isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_EQ(shapes[2].size, Eigen::Vector3d(1, 2, 3));
}

TEST(VisualModel, ColoursComeFromNamedAndInlineMaterials) {
  const TemporaryFolder folder;
  const std::string ball = "<sphere radius=\"0.1\"/>";
  const Robot robot = robot_of(
      folder, "<link name=\"a\">" + visual(ball, "<material name=\"red\"/>") +
                  visual(ball, "<material name=\"own\"><color rgba=\"0 1 0 0.5\"/></material>") +
                  visual(ball, "<material name=\"own\"/>") + visual(ball) +
                  "</link><material name=\"red\"><color rgba=\"1 0 0 1\"/></material>");
  const std::vector<VisualShape> shapes = load_visuals(robot);
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_EQ(shapes[0].color, Eigen::Vector4d(1, 0, 0, 1));
  EXPECT_EQ(shapes[1].color, Eigen::Vector4d(0, 1, 0, 0.5));
  EXPECT_EQ(shapes[2].color, shapes[1].color);
  EXPECT_GT(shapes[3].color[0], 0.5);
}

TEST(VisualModel, RefusesAColourThatIsNoneWithItsLine) {
  const TemporaryFolder folder;
  const Robot robot = robot_of(folder,
                               "<link name=\"a\"/>\n<material name=\"red\">\n"
                               "<color rgba=\"2 0 0 1\"/></material>");
  try {
    load_visuals(robot);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 4);
  }
}

TEST(VisualModel, FindsStlMeshesAndTheirScale) {
  const TemporaryFolder folder;
  folder.write("meshes/t.STL", kTriangle);
  const Robot robot =
      robot_of(folder, "<link name=\"a\">" +
                           visual("<mesh filename=\"package://r/meshes/t.STL\" scale=\"1 2 3\"/>") +
                           "</link>");
  const std::vector<VisualShape> shapes = load_visuals(robot);
  ASSERT_EQ(shapes.size(), 1u);
  EXPECT_TRUE(shapes[0].mesh_found);
  EXPECT_EQ(shapes[0].size, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(missing_meshes(shapes).empty());
  EXPECT_EQ(stl_triangles(shapes[0].mesh_file).size(), 3u);
  EXPECT_DOUBLE_EQ(lowest_point(shapes[0], Eigen::Isometry3d::Identity()), -9.0);
}

TEST(VisualModel, DrawsCollisionShapesInPlaceOfMissingMeshes) {
  const TemporaryFolder folder;
  folder.write("there.dae", "<COLLADA/>");
  const Robot robot = robot_of(
      folder, "<link name=\"a\">" +
                  visual("<mesh filename=\"package://r/none.stl\"/>",
                         "<material name=\"c\"><color rgba=\"0 0 1 1\"/></material>") +
                  "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>"
                  "<link name=\"b\">" +
                  visual("<mesh filename=\"package://r/there.dae\"/>") +
                  "</link><link name=\"c\"/>"
                  "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"
                  "<joint name=\"k\" type=\"fixed\"><parent link=\"b\"/><child link=\"c\"/>"
                  "<origin xyz=\"0 0.4 0\"/></joint>");
  const std::vector<VisualShape> shapes = load_visuals(robot);
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_FALSE(shapes[0].drawable());
  EXPECT_EQ(shapes[1].type, ShapeType::kBox);
  EXPECT_EQ(shapes[1].color, Eigen::Vector4d(0, 0, 1, 1));
  EXPECT_FALSE(shapes[2].drawable()) << "only STL files are read";
  EXPECT_EQ(shapes[3].type, ShapeType::kCapsule) << "nothing but the way to the next joint";
  EXPECT_DOUBLE_EQ(shapes[3].length, 0.4);
  EXPECT_TRUE((shapes[3].link_from_shape * Eigen::Vector3d(0, 0, 0.2))
                  .isApprox(Eigen::Vector3d(0, 0.4, 0)));
  EXPECT_EQ(missing_meshes(shapes),
            (std::vector<std::string>{"package://r/none.stl", "package://r/there.dae"}));
}

TEST(VisualModel, LowestPointsOfPrimitivesAreExact) {
  Eigen::Isometry3d tilted = Eigen::Isometry3d::Identity();
  tilted.linear() = Eigen::AngleAxisd(M_PI / 6, Eigen::Vector3d::UnitX()).toRotationMatrix();
  VisualShape shape;
  shape.radius = 0.1;
  shape.length = 1.0;
  shape.type = ShapeType::kSphere;
  EXPECT_NEAR(lowest_point(shape, tilted), -0.1, 1e-12);
  shape.type = ShapeType::kCapsule;
  EXPECT_NEAR(lowest_point(shape, tilted), -0.5 * std::cos(M_PI / 6) - 0.1, 1e-12);
  shape.type = ShapeType::kCylinder;
  EXPECT_NEAR(lowest_point(shape, tilted), -0.5 * std::cos(M_PI / 6) - 0.1 * std::sin(M_PI / 6),
              1e-12);
  shape.type = ShapeType::kBox;
  shape.size << 3.0, 1.0, 2.0;
  EXPECT_NEAR(lowest_point(shape, tilted), -0.5 * std::sin(M_PI / 6) - std::cos(M_PI / 6), 1e-12);
}

TEST(VisualModel, PoseBetweenPutsTheAxisOnBothEnds) {
  const Eigen::Vector3d from(0.3, -0.2, 0.5);
  for (const Eigen::Vector3d& along :
       {Eigen::Vector3d(0.0, 0.0, 2.0), Eigen::Vector3d(0.0, 0.0, -2.0),
        Eigen::Vector3d(0.01, 0.0, -2.0), Eigen::Vector3d(1.0, -2.0, 0.5),
        Eigen::Vector3d(-3.0, 0.1, -0.7)}) {
    const Eigen::Isometry3d pose = pose_between(from, from + along);
    const Eigen::Vector3d half = 0.5 * along.norm() * Eigen::Vector3d::UnitZ();
    EXPECT_LT((pose * half - from - along).norm(), 1e-12) << along.transpose();
    EXPECT_LT((pose * -half - from).norm(), 1e-12) << along.transpose();
    EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-12) << along.transpose();
  }
  EXPECT_TRUE(pose_between(from, from).linear().isIdentity());
}

TEST(VisualModel, CentauroIsCompleteAndStandsOnItsWheels) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
  const std::vector<VisualShape> shapes = load_visuals(robot);
  EXPECT_GT(shapes.size(), 60u);
  EXPECT_TRUE(missing_meshes(shapes).empty());
  // The forks' capsules reach a little lower than the wheels, whose lowest point is at −0.7188.
  const double lowest = lowest_point(robot, robot.named_configuration("home"));
  EXPECT_LE(lowest, -0.7188 + 1e-4);
  EXPECT_GE(lowest, -0.7288 - 1e-4);
}

TEST(VisualModel, PublicRobotsCanBeSeen) {
  if (!std::filesystem::is_directory(LOCOGRAPH_SHARED_DATA)) GTEST_SKIP() << "no shared data";
  for (const std::string& name : public_robots()) {
    RobotOptions options;
    options.lenient_srdf = true;
    const Robot robot = Robot::load(public_robot(name + ".urdf"), {}, options);
    int drawable = 0;
    for (const VisualShape& shape : load_visuals(robot)) drawable += shape.drawable() ? 1 : 0;
    EXPECT_GE(drawable, 1) << name;
    EXPECT_TRUE(std::isfinite(lowest_point(robot, robot.neutral_configuration()))) << name;
  }
}

}  // namespace
}  // namespace locograph::test
