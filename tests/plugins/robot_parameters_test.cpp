#include "plugins/plugin_test_support.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

class RobotParameters : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("cart.urdf", kCartUrdf);
    folder.write("cart.srdf", kCartSrdf);
  }
  Graph read(const std::string& lines) const {
    return read_graph_text(lines, "plan.g2o", folder.path(), robot_types());
  }
  TemporaryFolder folder;
};

TEST_F(RobotParameters, KnowTheRobotItsBaseAndItsActiveJoints) {
  const Graph graph = read(
      "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n"
      "PARAMS_ROBOT 1 cart.urdf cart.srdf fixed 1 limb\n"
      "PARAMS_ROBOT 2 cart.urdf - fixed 2 lift_joint wheel_joint\n");
  EXPECT_EQ(graph.parameters().get<RobotParameter>(0)->robot->configuration_size(), 10);
  EXPECT_EQ(graph.parameters().get<RobotParameter>(1)->robot->configuration_size(), 1);
  EXPECT_EQ(graph.parameters().get<RobotParameter>(2)->robot->configuration_size(), 2);
  EXPECT_EQ(graph.parameters().get<RobotParameter>(0)->spheres.size(), 3u);
}

TEST_F(RobotParameters, KeepHowTheSrdfWasReadAndWhereFrozenJointsStand) {
  folder.write("strange.srdf",
               "<robot name=\"cart\"><group_state name=\"raised\" group=\"limb\">"
               "<joint name=\"arm_joint\" value=\"1.5\"/></group_state>"
               "<group name=\"limb\"><joint name=\"arm_joint\"/></group>"
               "<disable_collisions link1=\"base\" link2=\"nowhere\" reason=\"Never\"/></robot>");
  const std::string line = "PARAMS_ROBOT 0 cart.urdf strange.srdf floating 1 wheel_joint";
  EXPECT_THROW(read(line), Error);
  const Graph graph = read(line + " lenient frozen raised");
  const auto robot = graph.parameters().get<RobotParameter>(0);
  EXPECT_TRUE(robot->options.lenient_srdf);
  EXPECT_EQ(robot->robot->joints()[robot->robot->joint_index("arm_joint")].frozen_position, 1.5);
  EXPECT_EQ(write_graph_text(graph, folder.path()), line + " lenient frozen raised\n");
}

TEST_F(RobotParameters, NameARobotThatComesAlong) {
  const std::string line = "PARAMS_ROBOT 0 model centauro floating 1 lower_body";
  const Graph graph = read(line);
  EXPECT_EQ(graph.parameters().get<RobotParameter>(0)->robot->name(), "centauro");
  EXPECT_EQ(write_graph_text(graph, folder.path()), line + '\n');
  // By its path it is the same robot.
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  const Graph by_path =
      read("PARAMS_ROBOT 0 " + stem + ".urdf " + stem + ".srdf floating 1 lower_body");
  EXPECT_EQ(write_graph_text(by_path, folder.path()), line + '\n');
}

TEST_F(RobotParameters, KeepThePathsOfARobotThatDoesNotComeAlongAsItIs) {
  const std::string stem = LOCOGRAPH_SOURCE_DIR "/robots/models/centauro/centauro";
  std::filesystem::copy(stem + ".urdf", folder.file("centauro.urdf"));
  std::filesystem::copy(stem + ".srdf", folder.file("centauro.srdf"));
  const std::string copied = "PARAMS_ROBOT 0 centauro.urdf centauro.srdf floating 1 lower_body\n";
  EXPECT_EQ(write_graph_text(read(copied), folder.path()), copied);
  const Graph other_srdf =
      read("PARAMS_ROBOT 0 " + stem + ".urdf centauro.srdf floating 1 lower_body");
  const std::string text = write_graph_text(other_srdf, folder.path());
  EXPECT_NE(text.find("centauro.urdf centauro.srdf floating"), std::string::npos) << text;
}

TEST_F(RobotParameters, HaveAbsolutePathsWhereTheGraphHasNoPlaceOfItsOwn) {
  const Graph graph = read("PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n");
  const std::string own = std::filesystem::canonical(folder.path()).string();
  EXPECT_EQ(write_graph_text(graph),
            "PARAMS_ROBOT 0 " + own + "/cart.urdf " + own + "/cart.srdf floating 0\n");
}

TEST_F(RobotParameters, LeaveAFrozenWheelItsPlaceButNoJoint) {
  const Graph graph = read(
      "PARAMS_ROBOT 0 cart.urdf - floating 1 arm_joint\n"
      "PARAMS_CONTACT 1 0 wheel wheel wheel 0.1 0.8 9 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
      "PARAMS_STANCE 2 1 1\n");
  EXPECT_EQ(graph.parameters().get<StanceParameter>(2)->wheels[0].wheel.joint, -1);
}

TEST_F(RobotParameters, KnowTheAxleAndTheCarrierOfEveryWheel) {
  const RobotCase centauro = centauro_lower_body();
  const Robot& robot = centauro.model();
  RobotState state(robot);
  state.update(home(centauro).data());
  for (const Contact& contact : centauro.wheels) {
    const Wheel wheel = wheel_of(robot, contact.effector);
    const Eigen::Isometry3d& carrier = state.world_from_link(wheel.carrier);
    EXPECT_TRUE((carrier.linear() * wheel.axle_in_carrier).isApprox(state.joint_axis(wheel.joint)));
    EXPECT_TRUE((carrier * wheel.centre_in_carrier)
                    .isApprox(state.world_from_link(wheel.link).translation()));
    EXPECT_NEAR(wheel.upright_in_carrier.norm(), 1.0, 1e-12);
    EXPECT_NEAR(wheel.upright_in_carrier.dot(wheel.axle_in_carrier), 0.0, 1e-12);
    EXPECT_EQ(robot.links()[wheel.carrier].name.substr(0, 7), "ankle2_");
  }
}

TEST_F(RobotParameters, GiveEveryConfigurationItsKinematicsSpheresAndTime) {
  const RobotCase centauro = centauro_lower_body();
  VertexConfiguration vertex(kRobot, centauro.robot, 3.5, home(centauro));
  ConfigurationState derived = vertex.make_derived();
  vertex.derive(vertex.state.data(), derived);
  EXPECT_EQ(derived.time_s, 3.5);
  EXPECT_EQ(vertex.dimension(), 30);
  EXPECT_EQ(vertex.state_size(), 31);
  RobotState state(centauro.model());
  state.update(vertex.state.data());
  for (std::size_t i = 0; i < centauro.robot->spheres.size(); ++i) {
    const CollisionSphere& sphere = centauro.robot->spheres[i];
    EXPECT_TRUE(derived.sphere_centre(static_cast<Eigen::Index>(i))
                    .isApprox(state.world_from_link(sphere.link) * sphere.center));
  }
}

TEST_F(RobotParameters, AreAllRegisteredUnderTheirTags) {
  const std::vector<std::string> tags = robot_types().tags();
  for (const char* tag : {"PARAMS_ROBOT",
                          "PARAMS_WORLD",
                          "PARAMS_PLAN",
                          "PARAMS_SCENARIO",
                          "PARAMS_CONTACTS",
                          "PARAMS_CONTACT",
                          "PARAMS_STANCE",
                          "VERTEX_CONFIGURATION",
                          "PARAMS_FRAME",
                          "EDGE_ACCELERATION_LIMITS",
                          "EDGE_BALL_ROLLING",
                          "EDGE_COM",
                          "EDGE_CONTACT",
                          "EDGE_FRAME_POSE",
                          "EDGE_JOINT_LIMITS",
                          "EDGE_VELOCITY_LIMITS",
                          "EDGE_OBSTACLE_DISTANCE",
                          "EDGE_ROLLING",
                          "EDGE_PLAN_TRACKING",
                          "EDGE_STEERING_SLIP",
                          "EDGE_VELOCITY_TRACKING"}) {
    EXPECT_NE(std::find(tags.begin(), tags.end(), tag), tags.end()) << tag;
  }
  for (const char* tag : {"PARAMS_WHEELS", "EDGE_WHEEL_CONTACT"}) {
    EXPECT_EQ(std::find(tags.begin(), tags.end(), tag), tags.end()) << tag;
    EXPECT_NE(robot_types().retired(tag), nullptr) << tag;
  }
}

}  // namespace
}  // namespace locograph::test
