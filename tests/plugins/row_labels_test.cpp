#include <locograph/core/violations.h>
#include <locograph/plugins/com/edge_com.h>
#include <locograph/plugins/time_step/edge_duration.h>

#include <set>

#include "plugins/plugin_test_support.h"
#include "plugins/small_robot.h"

namespace locograph::test {
namespace {

constexpr const char* kPlan =
    "PARAMS_ROBOT 0 cart.urdf cart.srdf floating 0\n"
    "PARAMS_PLAN 1 3\n"
    "PARAMS_WORLD 2 - -\n"
    "PARAMS_FRAME 3 0 arm 0 0 0.1 0 0 0 1\n"
    "PARAMS_CONTACT 4 0 \"\" arm surface 0.1 0.1 0.5 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0\n"
    "PARAMS_CONTACT 5 0 lift lift point 0 0.5 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free inner 4\n"
    "PARAMS_CONTACT 6 0 grip wheel rung 100 5 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 1 0 0\n"
    "PARAMS_CONTACT 7 0 wheel wheel wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
    "PARAMS_CONTACT 8 0 sole arm surface 0.1 0.1 0.5 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free\n"
    "PARAMS_CONTACT 9 0 wheel wheel wheel 0.1 0.8 100 0 0 0 0 0 1 1 0 0 at 0 0 0 0 0 1 free "
    "locked\n"
    "PARAMS_STANCE 10 1 7\n"
    "PARAMS_STANCE 11 1 9\n"
    // The arm 0.25 rad beyond its upper limit, the lift 0.125 m below its lower one.
    "VERTEX_CONFIGURATION 0 0 0 - 0 0 0 0 0 0 1 2.25 -0.125 0.3\n"
    "VERTEX_CONFIGURATION 1 0 1 - 0 0 0 0 0 0 1 0.1 0.3 0.3\n"
    "VERTEX_CONFIGURATION 2 0 3 - 0 0 0 0 0 0 1 0.1 0.2 0.3\n"
    "VERTEX_TIME_STEP 10 0.5\n"
    "VERTEX_TIME_STEP 11 0.25\n"
    "VERTEX_WRENCHES 20 3 4 5 6  1 2 3 4 5 6  1 2 3  1 2 3 4 5\n";

class RowLabels : public testing::Test {
 protected:
  void SetUp() override {
    folder.write("cart.urdf", kCartUrdf);
    folder.write("cart.srdf", kCartSrdf);
  }
  Graph read(const std::string& edges) const {
    return read_graph(folder.write("plan.g2o", kPlan + edges), robot_types());
  }
  /// "name [unit]" of every row of one edge, by its line.
  std::vector<std::string> labels(const std::string& edge) const {
    Graph graph = read(edge + "\n");
    Problem problem;
    problem.compile(graph);
    const EdgePool& pool = *graph.edge_pools()[0];
    std::vector<std::string> all;
    for (int row = 0; row < pool.dimension(0); ++row) {
      const RowLabel label = pool.row_label(problem.edges()[0], 0, row);
      all.push_back(label.name + " [" + label.unit + "]");
    }
    return all;
  }
  using Labels = std::vector<std::string>;
  TemporaryFolder folder;
};

TEST_F(RowLabels, OfLimitsNameJointsInTheirOwnUnit) {
  EXPECT_EQ(labels("EDGE_JOINT_LIMITS 0 3 0.1 scalar 1"),
            Labels({"arm_joint upper limit [rad]", "lift_joint lower limit [m]",
                    "wheel_joint lower limit [rad]"}));
  const Labels steps = {"arm_joint step [rad]", "lift_joint step [m]", "wheel_joint step [rad]",
                        "base linear step [m]", "base angular step [rad]"};
  EXPECT_EQ(labels("EDGE_VELOCITY_LIMITS 0 1 5 1 0.5 0.5 scalar 1"), steps);
  for (const char* kind : {"", "_SIGNED"}) {
    EXPECT_EQ(
        labels(std::string("EDGE_VELOCITY_LIMITS_TIMED") + kind + " 0 1 10 5 1 0.5 0.5 scalar 1"),
        steps);
  }
  const Labels accelerations = {
      "arm_joint acceleration [rad/s^2]", "lift_joint acceleration [m/s^2]",
      "wheel_joint acceleration [rad/s^2]", "base linear acceleration [m/s^2]",
      "base angular acceleration [rad/s^2]"};
  EXPECT_EQ(labels("EDGE_ACCELERATION_LIMITS 0 1 2 5 1 1 1 1 1 scalar 1"), accelerations);
  for (const char* kind : {"", "_SIGNED"}) {
    EXPECT_EQ(labels(std::string("EDGE_ACCELERATION_LIMITS_TIMED") + kind +
                     " 0 1 2 10 11 5 1 1 1 1 1 scalar 1"),
              accelerations);
    EXPECT_EQ(labels(std::string("EDGE_REST_ACCELERATION_LIMITS_TIMED") + kind +
                     " 0 1 10 5 1 1 1 1 1 scalar 1"),
              accelerations);
    EXPECT_EQ(labels(std::string("EDGE_TIME_STEP_LIMITS") + kind + " 10 0.1 1 scalar 1"),
              Labels({"time step below its minimum [s]", "time step above its maximum [s]"}));
  }
  EXPECT_EQ(labels("EDGE_DURATION 10 1"), Labels({" [s^0.5]"}));
  EXPECT_EQ(
      labels("EDGE_TORQUE_LIMITS 0 20 3 1 scalar 1"),
      Labels({"arm_joint torque [N m]", "lift_joint torque [N]", "wheel_joint torque [N m]"}));
}

TEST_F(RowLabels, OfDistancesNameLinks) {
  EXPECT_EQ(labels("EDGE_OBSTACLE_DISTANCE 0 3 2 0.1 scalar 1"),
            Labels({"base near an obstacle [m]", "arm near an obstacle [m]",
                    "wheel near an obstacle [m]"}));
  EXPECT_EQ(labels("EDGE_SWEPT_OBSTACLE_DISTANCE 0 1 3 2 0.1 2 scalar 1"),
            Labels({"base near an obstacle on its way [m]", "arm near an obstacle on its way [m]",
                    "wheel near an obstacle on its way [m]"}));
  const Labels pairs = labels("EDGE_SELF_COLLISION 0 3 0.1 scalar 1");
  EXPECT_EQ(std::set<std::string>(pairs.begin(), pairs.end()).size(), 3u);
  for (const std::string& pair : pairs) {
    EXPECT_NE(pair.find(" near "), std::string::npos) << pair;
    EXPECT_TRUE(pair.ends_with(" [m]")) << pair;
  }
}

TEST_F(RowLabels, OfContactsAndTasksNameFramesWheelsAndCoordinates) {
  EXPECT_EQ(labels("EDGE_CONTACT 0 6 4 scalar 1"),
            Labels({"arm x [m]", "arm y [m]", "arm z [m]", "arm about x [rad]", "arm about y [rad]",
                    "arm about z [rad]"}));
  EXPECT_EQ(labels("EDGE_CONTACT 0 5 8 scalar 1")[4], "sole about y [rad]");
  EXPECT_EQ(labels("EDGE_CONTACT 0 5 6 scalar 1"),
            Labels({"grip x [m]", "grip y [m]", "grip z [m]", "grip about x [rad]",
                    "grip about z [rad]"}));
  EXPECT_EQ(labels("EDGE_FRAME_POSE 0 3 0 0 0 0 0 0 1 scalar 1")[5], "arm about z [rad]");
  EXPECT_EQ(EdgeCom().row_label(2).name, "z");
  EXPECT_EQ(EdgeCom().row_label(2).unit, "m");
  EXPECT_EQ(labels("EDGE_CONTACT 0 2 7 scalar 1"),
            Labels({"wheel height [m]", "wheel axle tilt []"}));
  EXPECT_EQ(labels("EDGE_CONTACT 0 4 9 scalar 1"),
            Labels({"wheel x [m]", "wheel y [m]", "wheel height [m]", "wheel axle tilt []"}));
  EXPECT_EQ(labels("EDGE_ROLLING 0 1 2 10 scalar 1"),
            Labels({"wheel lateral [m]", "wheel longitudinal [m]"}));
  EXPECT_EQ(labels("EDGE_ROLLING 0 1 3 11 scalar 1"),
            Labels({"wheel lateral [m]", "wheel longitudinal [m]", "wheel turned [m]"}));
  EXPECT_EQ(labels("EDGE_STEERING_SLIP 0 1 1 10 0.002 scalar 1"), Labels({"wheel half-way [m]"}));
  const Labels tangent = {"base x [m]",         "base y [m]",         "base z [m]",
                          "base about x [rad]", "base about y [rad]", "base about z [rad]",
                          "arm_joint [rad]",    "lift_joint [m]",     "wheel_joint [rad]"};
  EXPECT_EQ(labels("EDGE_PLAN_TRACKING 0 9 0 0 0 0 0 0 1 0 0 0 scalar 1"), tangent);
  EXPECT_EQ(labels("EDGE_VELOCITY_TRACKING 0 1 9 1 2 3 4 5 6 7 8 9 scalar 1"), tangent);
}

TEST_F(RowLabels, OfWrenchesTellForcesFromMoments) {
  EXPECT_EQ(labels("EDGE_BALANCE 0 20 scalar 1"),
            Labels({"x [N]", "y [N]", "z [N]", "about x [N m]", "about y [N m]", "about z [N m]"}));
  const Labels norm = labels("EDGE_WRENCH_NORM 20 14 scalar 1");
  ASSERT_EQ(norm.size(), 14u);
  EXPECT_EQ(norm[0], "arm wrench x [N]");
  EXPECT_EQ(norm[5], "arm wrench about z [N m]");
  EXPECT_EQ(norm[8], "lift wrench z [N]");
  EXPECT_EQ(norm[12], "grip wrench about x [N m]");
  EXPECT_EQ(norm[13], "grip wrench about z [N m]") << "a rung bears no moment about y";
  EXPECT_EQ(labels("EDGE_WRENCH_TRACKING 20 14 1 2 3 4 5 6 7 8 9 10 11 12 13 14 scalar 1"), norm);
  const Labels limits = labels("EDGE_CONTACT_WRENCH 20 26 scalar 1");
  ASSERT_EQ(limits.size(), 26u);
  EXPECT_EQ(limits[0], "arm pull [N]");
  EXPECT_EQ(limits[1], "arm normal force [N]");
  EXPECT_EQ(limits[2], "arm friction [N]");
  for (int row = 3; row < 7; ++row) EXPECT_EQ(limits[row], "arm centre of pressure [N m]");
  for (int row = 7; row < 15; ++row) EXPECT_EQ(limits[row], "arm yaw moment [N m]");
  EXPECT_EQ(limits[15], "lift pull [N]");
  EXPECT_EQ(limits[16], "lift normal force [N]");
  for (int row = 17; row < 21; ++row) EXPECT_EQ(limits[row], "lift friction [N]");
  for (int row = 21; row < 24; ++row) EXPECT_EQ(limits[row], "grip force [N]");
  for (int row = 24; row < 26; ++row) EXPECT_EQ(limits[row], "grip moment [N m]");
}

TEST_F(RowLabels, TellWhichLimitIsViolatedByHowMuch) {
  Graph graph = read(
      "EDGE_JOINT_LIMITS 0 3 0 scalar 1\n"
      "EDGE_JOINT_LIMITS 1 3 0 scalar 1\n"
      "EDGE_VELOCITY_LIMITS 0 1 5 1 0 0 scalar 1\n");
  const int line = 1 + static_cast<int>(std::ranges::count(std::string(kPlan), '\n'));
  const std::vector<ConstraintViolation> found = violations(graph);
  ASSERT_EQ(found.size(), 4u);
  // Over 1 s the arm moves by 2.15 rad of 1, the lift by 0.425 m of 0.2.
  EXPECT_EQ(found[0].text(), "EDGE_VELOCITY_LIMITS 0 1 (line " + std::to_string(line + 2) +
                                 "), row 0: arm_joint step exceeded by 1.15 rad");
  EXPECT_EQ(found[1].text(), "EDGE_JOINT_LIMITS 0 (line " + std::to_string(line) +
                                 "), row 0: arm_joint upper limit exceeded by 0.25 rad");
  EXPECT_EQ(found[2].label.name, "lift_joint step");
  EXPECT_EQ(found[2].label.unit, "m");
  EXPECT_NEAR(found[2].amount, 0.225, 1e-12);
  EXPECT_EQ(found[3].label.name, "lift_joint lower limit");
  EXPECT_EQ(found[3].amount, 0.125);
}

}  // namespace
}  // namespace locograph::test
