#include <locograph/robots/robot_state.h>

#include "planners/scenario_texts.h"

namespace locograph {
namespace {

const std::string kStones =
    "<scenario version=\"1\" name=\"stones\">\n"     // line 1
    "<robot urdf=\"r.urdf\" effort_scale=\"2\"/>\n"  // 2
    "<end_effectors>\n"                              // 3
    "<end_effector name=\"foot\" link=\"sole\" kind=\"surface\" half_x=\"0.08\""
    " half_y=\"0.035\" max_force=\"1000\"/>\n"  // 4
    "<end_effector name=\"grip\" link=\"hand\" kind=\"rung\" max_force=\"400\""
    " max_moment=\"5\"/>\n"                                                             // 5
    "</end_effectors>\n"                                                                // 6
    "<environment friction=\"0.8\">\n"                                                  // 7
    "<plane name=\"floor\" center=\"1 2 0\" normal=\"0 0 2\" size=\"4 2\"/>\n"          // 8
    "<box name=\"stone\" center=\"1 0 0.1\" size=\"0.4 0.3 0.2\" friction=\"0.6\"/>\n"  // 9
    "<rung name=\"bar\" from=\"1 -0.5 1\" to=\"1 0.5 1\" radius=\"0.02\"/>\n"           // 10
    "</environment>\n"                                                                  // 11
    "<start base=\"0 0 0.9 0 0 0 1.0005\">\n"                                           // 12
    "<joint name=\"knee\" position=\"0.7\"/>\n"                                         // 13
    "<contact end_effector=\"foot\" position=\"0 0 0\" normal=\"0 0 1\" forward=\"1 0 0\"/>\n"
    "</start>\n"                                                                // 15
    "<goal>\n"                                                                  // 16
    "<contact end_effector=\"foot\" position=\"1 0 0.2\" normal=\"0 0 1\"/>\n"  // 17
    "</goal>\n"                                                                 // 18
    "<goal>\n"                                                                  // 19
    "<contact end_effector=\"grip\" position=\"1 0 1\" normal=\"0 0 1\" forward=\"1 0 0\"/>\n"
    "</goal>\n"                              // 21
    "<planner torque_limits=\"report\"/>\n"  // 22
    "</scenario>\n";

TEST(ContactTask, AContactTaskHasAStartWithItsPostureAndGoalsInTheirOrder) {
  const Scenario scenario = scenario_of(kStones);
  EXPECT_FALSE(scenario.drive.has_value());
  EXPECT_FALSE(scenario.enforce_torque_limits);
  EXPECT_EQ(scenario.effort_scale, 2.0);
  ASSERT_TRUE(scenario.contacts.has_value());
  const ContactTask& task = *scenario.contacts;
  ASSERT_TRUE(task.base.has_value());
  EXPECT_EQ((*task.base)[2], 0.9);
  EXPECT_DOUBLE_EQ((*task.base)[6], 1.0) << "normalised";
  ASSERT_EQ(task.joints.size(), 1u);
  EXPECT_EQ(task.joints[0].name, "knee");
  EXPECT_EQ(task.joints[0].position, 0.7);
  EXPECT_EQ(task.start_line, 12);
  EXPECT_EQ(task.goal_lines, (std::vector<int>{16, 19}));

  ASSERT_EQ(task.start.contacts.size(), 1u);
  const Contact& foot = task.start.contacts[0];
  EXPECT_EQ(foot.effector.link, "sole");
  EXPECT_EQ(foot.effector.half_x_m, 0.08);
  EXPECT_EQ(foot.effector.friction, 0.8);
  EXPECT_EQ(foot.forward, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(foot.bears_load);
  ASSERT_EQ(task.goals.size(), 2u);
  ASSERT_EQ(task.goals[0].contacts.size(), 1u);
  EXPECT_EQ(task.goals[0].contacts[0].position, Eigen::Vector3d(1.0, 0.0, 0.2));
  EXPECT_FALSE(task.goals[0].contacts[0].forward.has_value()) << "its yaw is free";
  EXPECT_EQ(task.goals[1].contacts[0].effector.kind, ContactKind::kGrasp);
}

TEST(ContactTask, AStartMayLeaveThePostureToTheRobotsState) {
  const Scenario scenario = scenario_of(with(with(kStones, " base=\"0 0 0.9 0 0 0 1.0005\"", ""),
                                             "<joint name=\"knee\" position=\"0.7\"/>", ""));
  EXPECT_FALSE(scenario.contacts->base.has_value());
  EXPECT_TRUE(scenario.contacts->joints.empty());
}

TEST(ContactTask, ItsWorldHoldsThePlanesTheFacesOfTheBoxesAndTheBars) {
  const World world = world_of(scenario_of(kStones));
  ASSERT_EQ(world.surfaces.size(), 7u) << "and not the ground";
  const Surface& floor = world.surfaces[0];
  EXPECT_EQ(floor.name, "floor");
  EXPECT_EQ(floor.half_x_m, 2.0);
  EXPECT_EQ(floor.half_y_m, 1.0);
  EXPECT_EQ(floor.friction, 0.0) << "what the end effector says";
  EXPECT_EQ(floor.world_from_surface.translation(), Eigen::Vector3d(1.0, 2.0, 0.0));
  EXPECT_EQ(floor.world_from_surface.linear(), Eigen::Matrix3d::Identity());
  ASSERT_EQ(world.bars.size(), 1u);
  EXPECT_EQ(world.bars[0].name, "bar");
  EXPECT_EQ(world.bars[0].to, Eigen::Vector3d(1.0, 0.5, 1.0));
  EXPECT_EQ(world.bars[0].radius_m, 0.02);
}

TEST(ContactTask, TheFacesOfATurnedBoxEncloseItAndLookOutwards) {
  const World world = world_of(scenario_of(
      with(kStones, "size=\"0.4 0.3 0.2\"", "size=\"0.4 0.3 0.2\" rpy=\"0.3 -0.2 1.1\"")));
  const Eigen::Vector3d center(1.0, 0.0, 0.1), half(0.2, 0.15, 0.1);
  const Eigen::Matrix3d axes = (Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const struct {
    const char* name;
    int axis;
    double sign;
  } faces[] = {{"stone top", 2, 1.0},   {"stone bottom", 2, -1.0}, {"stone front", 0, 1.0},
               {"stone back", 0, -1.0}, {"stone left", 1, 1.0},    {"stone right", 1, -1.0}};
  ASSERT_EQ(world.solids.size(), 1u);
  EXPECT_EQ(world.solids[0].name, "stone");
  for (std::size_t i = 0; i < 6; ++i) {
    const Surface& face = world.surfaces[1 + i];
    EXPECT_EQ(face.name, faces[i].name);
    EXPECT_EQ(face.friction, 0.6);
    const Eigen::Vector3d out = faces[i].sign * axes.col(faces[i].axis);
    const Eigen::Isometry3d& pose = face.world_from_surface;
    EXPECT_LT((pose.linear().col(2) - out).norm(), 1e-12);
    EXPECT_NEAR(pose.linear().determinant(), 1.0, 1e-12);
    EXPECT_LT((pose.translation() - (center + half[faces[i].axis] * out)).norm(), 1e-12);
    for (const double x : {-face.half_x_m, face.half_x_m}) {
      for (const double y : {-face.half_y_m, face.half_y_m}) {
        const Eigen::Vector3d corner =
            axes.transpose() * (pose * Eigen::Vector3d(x, y, 0.0) - center);
        EXPECT_LT((corner.cwiseAbs() - half).norm(), 1e-12) << face.name;
      }
    }
    EXPECT_TRUE(is_part_of(world.solids.at(0), face)) << face.name;
  }
}

TEST(ContactTask, APlaneWithoutForwardHasXLaidIntoItAndZWhereItsNormalIsAlongX) {
  const auto axes = [](const std::string& normal) {
    const Scenario scenario = scenario_of(with(kStones, "normal=\"0 0 2\"", normal));
    return Eigen::Matrix3d(scenario.surfaces[0].world_from_surface.linear());
  };
  const double slope = std::sqrt(0.5);
  EXPECT_LT((axes("normal=\"-1 0 1\"").col(0) - Eigen::Vector3d(slope, 0, slope)).norm(), 1e-12);
  EXPECT_LT((axes("normal=\"0 -1 0\"").col(0) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((axes("normal=\"-3 0 0\"").col(0) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((axes("normal=\"0 -1 0\" forward=\"0 1 1\"").col(0) - Eigen::Vector3d::UnitZ()).norm(),
            1e-12)
      << "forward is laid into the plane";
}

TEST(ContactTask, WithoutFrictionOfTheEnvironmentEndEffectorsHaveTheLargestOfAllThatIsInIt) {
  std::string text = with(kStones, "<environment friction=\"0.8\">", "<environment>");
  text = with(text, "size=\"4 2\"", "size=\"4 2\" friction=\"0.5\"");
  text = with(text, "radius=\"0.02\"", "radius=\"0.02\" friction=\"0.7\"");
  const Scenario scenario = scenario_of(text);
  EXPECT_EQ(scenario.end_effectors[0].friction, 0.7);
  EXPECT_EQ(scenario.contacts->start.contacts[0].effector.friction, 0.7);
  EXPECT_EQ(scenario.surfaces[0].friction, 0.5);
  EXPECT_EQ(scenario.bars[0].friction, 0.7);
}

class PublishedTask : public testing::TestWithParam<const char*> {};

TEST_P(PublishedTask, StartsInThePublishedPostureOnItsContacts) {
  const Scenario scenario = load_scenario(GetParam(), DataFolder().path());
  EXPECT_EQ(scenario.name, GetParam());
  EXPECT_TRUE(scenario.enforce_torque_limits);
  EXPECT_EQ(scenario.end_effectors.size(), 4u);
  const Robot robot = Robot::load(scenario.urdf, scenario.srdf);
  ASSERT_TRUE(scenario.contacts.has_value());
  const ContactTask& task = *scenario.contacts;
  require_sound_stance(robot, task.start);
  for (const Stance& goal : task.goals) {
    require_sound_stance(robot, goal);
    EXPECT_EQ(goal.contacts.size(), 4u);
  }
  ASSERT_TRUE(task.base.has_value());
  ASSERT_EQ(static_cast<int>(task.joints.size()), robot.active_joint_count());
  Eigen::VectorXd q(robot.configuration_size());
  q.head<7>() = *task.base;
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const auto& [name, position, line] = task.joints[static_cast<std::size_t>(i)];
    EXPECT_EQ(name, robot.active_joint(i).name);
    q[7 + i] = position;
  }
  RobotState state(robot);
  state.update(q.data());
  for (const Contact& contact : task.start.contacts) {
    const EndEffector& effector = contact.effector;
    const Eigen::Isometry3d& pose = state.world_from_link(robot.link_index(effector.link));
    const Eigen::Vector3d place = contact.position + effector.radius_m * contact.normal;
    const bool sole = effector.kind == ContactKind::kSurface;
    // The published hands touch with a tip that is 0.0115 m inside the ball.
    EXPECT_LT((pose * effector.point - place).norm(), sole ? 1e-4 : 0.012) << contact.name();
    if (!sole) continue;
    EXPECT_LT((pose.linear() - axes_in_world(contact)).norm(), 3e-4) << contact.name();
  }
}

INSTANTIATE_TEST_SUITE_P(ContactTask, PublishedTask,
                         testing::Values("ladder_climbing", "parallel_walls", "quadrupedal_walking",
                                         "standing_up", "walk_then_stand"),
                         [](const testing::TestParamInfo<const char*>& info) {
                           return std::string(info.param);
                         });

class BadContactTask : public testing::TestWithParam<Mistake> {};

TEST_P(BadContactTask, IsRefusedWithFileAndLine) { expect_refused(kStones, GetParam()); }

const char kStart[] =
    "<start base=\"0 0 0.9 0 0 0 1.0005\">\n"
    "<joint name=\"knee\" position=\"0.7\"/>\n"
    "<contact end_effector=\"foot\" position=\"0 0 0\" normal=\"0 0 1\" forward=\"1 0 0\"/>\n"
    "</start>\n";
const char kGoals[] =
    "<goal>\n"
    "<contact end_effector=\"foot\" position=\"1 0 0.2\" normal=\"0 0 1\"/>\n"
    "</goal>\n"
    "<goal>\n"
    "<contact end_effector=\"grip\" position=\"1 0 1\" normal=\"0 0 1\" forward=\"1 0 0\"/>\n"
    "</goal>\n";
const char kThings[] =
    "<plane name=\"floor\" center=\"1 2 0\" normal=\"0 0 2\" size=\"4 2\"/>\n"
    "<box name=\"stone\" center=\"1 0 0.1\" size=\"0.4 0.3 0.2\" friction=\"0.6\"/>\n"
    "<rung name=\"bar\" from=\"1 -0.5 1\" to=\"1 0.5 1\" radius=\"0.02\"/>\n";
const char kFootAtStart[] = "position=\"0 0 0\" normal=\"0 0 1\" forward=\"1 0 0\"";

INSTANTIATE_TEST_SUITE_P(
    ContactTask, BadContactTask,
    testing::Values(
        Mistake{"NoGoal", kGoals, "", 12, "a <start> without a <goal>"},
        Mistake{"NoStart", kStart, "", 12, "a <goal> without a <start>"},
        Mistake{"SecondStart", "</scenario>", "<start/></scenario>", 23, "a second <start>"},
        Mistake{"NothingToStandOn", kThings, "", 7, "nothing to stand on"},
        Mistake{"UnknownAttributeOfTheStart", "<start base", "<start pose=\"1\" base", 12,
                "unknown attribute 'pose'"},
        Mistake{"UnknownElementOfTheGoal", "<goal>\n", "<goal>\n<joint/>", 17,
                "unknown element <joint>"},
        Mistake{"AGoalWithoutContacts", "</scenario>", "<goal/></scenario>", 23,
                "a <goal> without contacts"},
        Mistake{"AStartWithoutContacts",
                "<contact end_effector=\"foot\" position=\"0 0 0\" "
                "normal=\"0 0 1\" forward=\"1 0 0\"/>",
                "", 12, "a <start> without contacts"},
        Mistake{"ABaseWithoutAQuaternion", "0 0 0.9 0 0 0 1.0005", "0 0 0.9", 12,
                "expected 7 finite numbers"},
        Mistake{"AQuaternionThatIsNone", "0 0 0.9 0 0 0 1.0005", "0 0 0.9 0 0 0 1.1", 12,
                "the quaternion of length 1"},
        Mistake{"AQuaternionBeyondAllNumbers", "0 0 0.9 0 0 0 1.0005", "0 0 0 1e300 0 0 0", 12,
                "the quaternion of length 1"},
        Mistake{"ABaseBeyondAllPlaces", "0 0 0.9 0 0 0 1.0005", "0 0 1e7 0 0 0 1", 12,
                "coordinates up to 1e+06"},
        Mistake{"TheSameJointTwice", "</start>", "<joint name=\"knee\" position=\"0\"/></start>",
                15, "a second position of joint 'knee'"},
        Mistake{"AJointBeyondAllAngles", "position=\"0.7\"", "position=\"1e7\"", 13,
                "position=\"1e7\""},
        Mistake{"AJointWithoutAPosition", " position=\"0.7\"", "", 13, "without position"},
        Mistake{"AnEndEffectorThatIsNotThere", "end_effector=\"foot\"", "end_effector=\"fot\"", 14,
                "unknown end effector 'fot', expected one of foot, grip; did you mean 'foot'?"},
        Mistake{"TheSameEndEffectorTwice", "</start>",
                "<contact end_effector=\"foot\" position=\"1 0 0\" normal=\"0 0 1\"/></start>", 15,
                "a second contact of 'foot'"},
        Mistake{"ANormalOfZero", kFootAtStart, "position=\"0 0 0\" normal=\"0 0 0\"", 14,
                "contact of foot has a normal of length zero"},
        Mistake{"ForwardAlongTheNormal", kFootAtStart,
                "position=\"0 0 0\" normal=\"0 0 1\" forward=\"0 0 -2\"", 14,
                "a forward direction along its normal"},
        Mistake{"AContactWithoutAPlace", kFootAtStart, "normal=\"0 0 1\"", 14, "without position"},
        Mistake{"AContactWithoutANormal", kFootAtStart, "position=\"0 0 0\"", 14, "without normal"},
        Mistake{"AContactThatSaysWhatItBears", kFootAtStart,
                "position=\"0 0 0\" normal=\"0 0 1\" max_force=\"9\"", 14,
                "unknown attribute 'max_force'"},
        Mistake{"AGraspWithoutForward", "position=\"1 0 1\" normal=\"0 0 1\" forward=\"1 0 0\"",
                "position=\"1 0 1\" normal=\"0 0 1\"", 20, "contact of grip without forward"},
        Mistake{"NoEffort", "effort_scale=\"2\"", "effort_scale=\"0\"", 2, "effort_scale is 0"},
        Mistake{"EffortBeyondAllMotors", "effort_scale=\"2\"", "effort_scale=\"1001\"", 2,
                "a number > 0 to 1000"},
        Mistake{"APlaneWithoutAName", "name=\"floor\" ", "", 8, "<plane> without name"},
        Mistake{"APlaneWithoutSize", "size=\"4 2\"", "", 8, "<plane> without size"},
        Mistake{"APlaneOfNoSize", "size=\"4 2\"", "size=\"4 0\"", 8,
                "size=\"4 0\", expected numbers from 1e-06 to 1e+06"},
        Mistake{"APlaneOfNegativeSize", "size=\"4 2\"", "size=\"-4 2\"", 8, "size=\"-4 2\""},
        Mistake{"APlaneWithoutANormal", "normal=\"0 0 2\"", "", 8, "<plane> without normal"},
        Mistake{"APlaneWithANormalOfZero", "normal=\"0 0 2\"", "normal=\"0 0 0\"", 8,
                "plane floor has a normal of length zero"},
        Mistake{"APlaneForwardAlongItsNormal", "normal=\"0 0 2\"",
                "normal=\"0 0 2\" forward=\"0 0 1\"", 8, "plane floor has a forward direction"},
        Mistake{"APlaneBeyondAllPlaces", "center=\"1 2 0\"", "center=\"1e7 2 0\"", 8,
                "center=\"1e7 2 0\""},
        Mistake{"FrictionOfNothing", "size=\"4 2\"", "size=\"4 2\" friction=\"0\"", 8,
                "friction is 0"},
        Mistake{"FrictionThatNobodyKnows", "<environment friction=\"0.8\">", "<environment>", 8,
                "the friction of 'floor' is not known"},
        Mistake{"ABoxOfTwoSizes", "size=\"0.4 0.3 0.2\"", "size=\"0.4 0.3\"", 9,
                "expected 3 finite numbers"},
        Mistake{"ABoxLargerThanAllBoxes", "size=\"0.4 0.3 0.2\"", "size=\"0.4 1e7 0.2\"", 9,
                "size=\"0.4 1e7 0.2\""},
        Mistake{"ABoxTurnedByTwoAngles", "size=\"0.4 0.3 0.2\"", "size=\"0.4 0.3 0.2\" rpy=\"0 1\"",
                9, "expected 3 finite numbers"},
        Mistake{"TheSameNameTwice", "name=\"stone\"", "name=\"floor\"", 9, "a second 'floor'"},
        Mistake{"TheNameOfAFace", "name=\"bar\"", "name=\"stone left\"", 10,
                "a second 'stone left'"},
        Mistake{"ABarWithoutLength", "to=\"1 0.5 1\"", "to=\"1 -0.5 1\"", 10,
                "rung bar ends where it begins"},
        Mistake{"ABarWithoutRadius", " radius=\"0.02\"", "", 10, "<rung> without radius"},
        Mistake{"ABarOfNegativeRadius", "\"0.02\"", "\"-0.02\"", 10, "radius is -0.02"}),
    mistake_name);

}  // namespace
}  // namespace locograph
