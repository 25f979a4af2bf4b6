// What a model holds, and what it refuses to hold.
#include <locograph/common/error.h>
#include <locograph/execution/engine.h>

#include <memory>
#include <sstream>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class MujocoModel : public testing::Test {
 protected:
  Robot robot_of(const std::string& urdf) { return Robot::load(folder.write("a.urdf", urdf)); }

  static std::string refusal(const Robot& robot, const World& world = {}) {
    try {
      mujoco_model(robot, {}, world);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  const TemporaryFolder folder;
};

TEST_F(MujocoModel, NamesLinksWithoutInertia) {
  // A wrist that carries a hand: our dynamics need no mass of its own, MuJoCo does.
  const Robot robot = robot_of(R"(<robot name="a">
  <link name="base"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="wrist"/>
  <link name="hand"><inertial><mass value="1"/><origin xyz="0 0 1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <joint name="first" type="continuous"><parent link="base"/><child link="wrist"/>
    <axis xyz="1 0 0"/></joint>
  <joint name="second" type="continuous"><parent link="wrist"/><child link="hand"/>
    <axis xyz="0 1 0"/></joint>
</robot>)");
  EXPECT_NE(refusal(robot).find("links without mass or inertia: 'wrist'"), std::string::npos)
      << refusal(robot);
}

TEST_F(MujocoModel, HoldsCellsOfAMapThatAreWithinReach) {
  const Robot robot = robot_of(small_robot_urdf());
  const auto map = std::make_shared<octomap::OcTree>(0.1);
  map->updateNode(octomap::point3d(0.55F, 0.05F, 0.05F), true);
  map->updateNode(octomap::point3d(9.05F, 0.05F, 0.05F), true);
  map->updateNode(octomap::point3d(0.55F, 0.55F, 0.05F), false);  // free
  const auto cells = [&](const MujocoModelOptions& options) {
    const std::string text = mujoco_model(robot, {}, {.map = map}, options);
    int count = 0;
    for (std::size_t at = text.find("size=\"0.05"); at != std::string::npos;
         at = text.find("size=\"0.05", at + 1)) {
      ++count;
    }
    return count;
  };
  EXPECT_EQ(cells({}), 2);
  const Eigen::Vector3d one = Eigen::Vector3d::Ones();
  EXPECT_EQ(cells({.reach = {-one, one}}), 1);
  EXPECT_EQ(cells({.reach = {-0.4 * one, 0.4 * one}}), 0);
  EXPECT_NO_THROW(Engine(robot, {}, {.map = map}));
}

TEST_F(MujocoModel, CellsOfAMapThatAreSideBySideAreOneBox) {
  const Robot robot = robot_of(small_robot_urdf());
  const auto map = std::make_shared<octomap::OcTree>(0.1);
  // Three by two, one on top, and one that only shares an edge.
  for (const float x : {1.05F, 1.15F, 1.25F}) {
    for (const float y : {1.05F, 1.15F}) map->updateNode(octomap::point3d(x, y, 0.05F), true);
  }
  map->updateNode(octomap::point3d(1.05F, 1.05F, 0.15F), true);
  map->updateNode(octomap::point3d(1.35F, 1.25F, 0.05F), true);
  const std::string text = mujoco_model(robot, {}, {.map = map});
  double volume = 0.0;
  int boxes = 0;
  const std::string mark = "<geom type=\"box\" size=\"";
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    std::istringstream numbers(text.substr(at + mark.size()));
    double x = 0.0, y = 0.0, z = 0.0;
    numbers >> x >> y >> z;
    volume += 8.0 * x * y * z;
    ++boxes;
  }
  EXPECT_EQ(boxes, 3);
  EXPECT_NEAR(volume, 8e-3, 1e-9);
}

TEST_F(MujocoModel, HoldsTheWorldOnce) {
  const Robot robot = robot_of(small_robot_urdf());
  World world{.surfaces = {ground()}};
  Surface top = ground();
  top.half_x_m = top.half_y_m = 0.5;
  top.friction = 0.7;
  top.world_from_surface.translation().z() = 0.5;
  world.surfaces.push_back(top);  // of the box
  world.solids.push_back({.name = "step"});
  top.world_from_surface.translation().x() = 3.0;
  world.surfaces.push_back(top);
  world.bars.push_back({.name = "rail", .radius_m = 0.02, .friction = 0.4});
  for (const Obstacle::Shape shape :
       {Obstacle::Shape::kBox, Obstacle::Shape::kSphere, Obstacle::Shape::kCylinder}) {
    world.obstacles.emplace_back();
    world.obstacles.back().shape = shape;
    world.obstacles.back().size = Eigen::Vector3d::Constant(0.2);
  }
  const std::string text = mujoco_model(robot, {}, world);
  for (const char* there : {"surface_0\" type=\"plane", "surface_2\" type=\"box",
                            "bar_0\" type=\"capsule", "solid_0\" type=\"box", "obstacle_2\""}) {
    EXPECT_NE(text.find(there), std::string::npos) << there;
  }
  EXPECT_EQ(text.find("surface_1"), std::string::npos);
  const std::string solid = text.substr(text.find("solid_0"));
  EXPECT_NE(solid.substr(0, solid.find('\n')).find("friction=\"0.69999999999999996 "),
            std::string::npos);
  EXPECT_NO_THROW(Engine(robot, {}, world));  // MuJoCo takes it all
}

}  // namespace
}  // namespace locograph::test
