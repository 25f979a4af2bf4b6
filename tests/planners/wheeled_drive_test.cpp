#include <locograph/common/error.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/solvers/linear_solvers.h>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

TEST(WheeledDrive, StraightOnIsFiftyConfigurationsOverFourMetresAtOneHeight) {
  const Graph graph = planned_drive(centauro_drive());
  const Plan plan = plan_of(graph);
  const Motion motion = motion_of(graph, plan);
  ASSERT_EQ(motion.configurations.size(), 50u);
  EXPECT_TRUE(graph.vertex_record(plan.slots.front()).fixed);
  RobotState state(*plan.robot->robot);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd& q = motion.configurations[i];
    const Eigen::VectorXd& first = motion.configurations.front();
    const double distance = 4.0 * i / 49.0;
    // The first and the last step take twice as long as the others: it speeds up, and brakes.
    const double later_m = (i == 0 ? 0.0 : 4.0 / 49.0) + (i == 49 ? 4.0 / 49.0 : 0.0);
    EXPECT_NEAR(motion.time_s[i], (distance + later_m) / 0.1, 1e-12);
    EXPECT_EQ(motion.slopes[i][0], i == 0 || i == 49 ? 0.0 : 0.1);
    EXPECT_NEAR(q[0], distance, 1e-12);
    EXPECT_EQ(q[1], 0.0);
    EXPECT_EQ(q[2], first[2]) << "height";
    EXPECT_EQ(q.segment<4>(3), Eigen::Vector4d(0, 0, 0, 1));
    state.update(q.data());
    for (const auto& standing : plan.stance_from.front()->wheels) {
      const Wheel& wheel = standing.wheel;
      const Joint& joint = plan.robot->robot->active_joint(wheel.joint);
      const double axle_y = (state.world_from_link(wheel.link).linear() * joint.axis).y();
      EXPECT_NEAR(std::abs(axle_y), 1.0, 1e-9);
      EXPECT_NEAR(q[7 + wheel.joint] - first[7 + wheel.joint],
                  std::copysign(distance / kRadius, axle_y), 1e-9)
          << wheel.name;
    }
  }
}

class Curved : public testing::TestWithParam<double> {};

TEST_P(Curved, DriveStandsOnItsWheelsAndRollsToTheOrderOfTheEdge) {
  const double curvature = GetParam();
  const Graph graph = planned_drive(centauro_drive(4.0, curvature));
  const Plan plan = plan_of(graph);
  const std::vector<Eigen::VectorXd> all = configurations(graph);
  RobotState state(*plan.robot->robot);
  for (const Eigen::VectorXd& q : all) {
    state.update(q.data());
    for (const auto& standing : plan.stance_from.front()->wheels) {
      const WheelPose pose(state, standing.wheel);
      EXPECT_NEAR(lowest_point(pose, kRadius, Eigen::Vector3d::UnitZ()).z(), 0.0, 1e-9);
    }
  }
  // The ends of a chord are tangent to the arc: the edge's midpoint rule holds exactly …
  ConfigurationState a(plan.robot), b(plan.robot);
  ASSERT_EQ(graph.edges_of<EdgeRolling>().size(), all.size() - 1);
  for (std::size_t i = 1; i < all.size(); ++i) {
    a.update(all[i - 1].data());
    b.update(all[i].data());
    Eigen::VectorXd error(8);
    graph.edges_of<EdgeRolling>()[i - 1].error(a, b, error);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-9) << i;
  }
  // … and turns a wheel by Δθ²/24 of its arc too little.
  const double turn = curvature * 4.0 / 49.0;
  for (const auto& standing : plan.stance_from.front()->wheels) {
    const Wheel& wheel = standing.wheel;
    state.update(all.front().data());
    const Eigen::Vector3d centre = state.world_from_link(wheel.link).translation();
    const double radius =
        (centre.head<2>() - Eigen::Vector2d(0.0, curvature == 0.0 ? 0.0 : 1.0 / curvature)).norm();
    const double arc = curvature == 0.0 ? 4.0 : 4.0 * std::abs(curvature) * radius;
    const double rolled =
        kRadius * std::abs(all.back()[7 + wheel.joint] - all.front()[7 + wheel.joint]);
    EXPECT_NEAR(1.0 - rolled / arc, turn * turn / 24.0, 1e-3 * turn * turn + 1e-10);
  }
}

TEST_P(Curved, DriveIsFeasibleForTheIndependentChecker) {
  const Graph graph = planned_drive(centauro_drive(4.0, GetParam()));
  const CheckReport report = check_plan(graph);
  expect_feasible(report);
  EXPECT_EQ(report.configurations, 50);
  // Between vertices the base moves straight while it turns by Δθ: half-way a wheel has slipped
  // by Δθ/8 of the step, and back at the end. The outer wheels' steps are up to 1.2 of the base's.
  const double step = 4.0 / 49.0;
  EXPECT_LT(report.constraint("lateral_slip").worst,
            1.2 * step * std::abs(GetParam() * step) / 8.0 + 1e-6);
  EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-4);
}

TEST_P(Curved, DriveSaysThatItStandsOnItsFourWheels) {
  const Graph graph = planned_drive(centauro_drive(4.0, GetParam(), 7));
  const Plan plan = plan_of(graph);
  const Motion motion = motion_of(graph, plan);
  ASSERT_EQ(motion.stances.size(), 1u);
  EXPECT_EQ(motion.stance_from, std::vector<int>(7, 0));
  ASSERT_EQ(motion.stances[0].contacts.size(), 4u);
  for (const Contact& contact : motion.stances[0].contacts) {
    EXPECT_EQ(contact.effector.kind, ContactKind::kWheel);
    EXPECT_EQ(contact.position.z(), 0.0);
    EXPECT_FALSE(contact.locked);
  }
  EXPECT_EQ(graph.edges_of<EdgeContact>().size(), 4u * 7u);
  EXPECT_EQ(graph.edges_of<EdgeRolling>().size(), 6u);
}

TEST_P(Curved, DriveFollowsItsArc) {
  const double curvature = GetParam();
  const std::vector<Eigen::VectorXd> all =
      configurations(planned_drive(centauro_drive(4.0, curvature)));
  const Eigen::VectorXd& last = all.back();
  EXPECT_NEAR(2.0 * std::atan2(last[5], last[6]), 4.0 * curvature, 1e-12);
  if (curvature == 0.0) {
    EXPECT_NEAR(last[0], 4.0, 1e-12);
  } else {
    const Eigen::Vector2d centre(0.0, 1.0 / curvature);
    for (const Eigen::VectorXd& q : all) {
      EXPECT_NEAR((q.head<2>() - centre).norm(), 1.0 / std::abs(curvature), 1e-9);
    }
    EXPECT_GT(last[1] * curvature, 0.0) << "to the other side";
  }
}

TEST_P(Curved, DriveIsAnOptimumOfItsOwnGraph) {
  Graph graph = planned_drive(centauro_drive(4.0, GetParam()));
  const std::vector<Eigen::VectorXd> before = configurations(graph);
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  EXPECT_LT(result.initial.chi2, 1e-3) << result.reason_text();
  const std::vector<Eigen::VectorXd> after = configurations(graph);
  for (std::size_t i = 0; i < before.size(); ++i) {
    // The SRDF rounds joints to 1e-6 rad, and axles are level only to that: so far things may move.
    const Eigen::VectorXd moved = (after[i] - before[i]).cwiseAbs();
    for (int c = 0; c < moved.size(); ++c) EXPECT_LT(moved[c], 5e-5) << i << ' ' << c;
  }
}

TEST_P(Curved, DriveSavesAndLoadsBitByBit) {
  const TemporaryFolder folder;
  const Graph graph = planned_drive(centauro_drive(4.0, GetParam(), 7));
  write_graph(graph, folder.path() / "plan.g2o");
  TypeRegistry types;
  add_robot_types(types);
  const Graph read = read_graph(folder.path() / "plan.g2o", types);
  EXPECT_EQ(configurations(read), configurations(graph));
  EXPECT_EQ(read.edge_count(), graph.edge_count());
  EXPECT_EQ(write_graph_text(read, folder.path()), write_graph_text(graph, folder.path()));
  EXPECT_EQ(read.parameters().get<ScenarioParameter>(kScenarioNumber)->scenario, "centauro_drive");
}

INSTANTIATE_TEST_SUITE_P(WheeledDrive, Curved, testing::Values(0.0, 0.3, -0.3),
                         [](const testing::TestParamInfo<double>& info) {
                           return info.param == 0.0  ? "Straight"
                                  : info.param > 0.0 ? "Left"
                                                     : "Right";
                         });

TEST(WheeledDrive, RefusesAStartStateWhoseWheelsAreNotLevel) {
  Scenario scenario = centauro_drive();
  scenario.end_effectors[2].radius_m = 0.07;
  try {
    planned_drive(scenario);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("level"), std::string::npos) << error.what();
  }
}

TEST(WheeledDrive, RefusesAnArcThatAWheelCannotBeSteeredInto) {
  // As shipped, but for the range of one steering joint: 0.2 rad around where it is.
  const Scenario shipped = centauro_drive();
  const Graph straight = planned_drive(shipped);
  const Robot& robot = *plan_of(straight).robot->robot;
  const Joint& yaw = robot.joints()[robot.joint_index("ankle_yaw_3")];
  const double home = configurations(straight).front()[7 + yaw.index];
  std::ifstream in(shipped.urdf, std::ios::binary);
  std::string urdf((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const std::size_t joint = urdf.find("<joint name=\"ankle_yaw_3\"");
  const std::size_t begin = urdf.find("<limit ", joint);
  ASSERT_NE(begin, std::string::npos);
  urdf.replace(begin, urdf.find("/>", begin) - begin,
               "<limit lower=\"" + std::to_string(home - 0.2) + "\" upper=\"" +
                   std::to_string(home + 0.2) + "\" velocity=\"20\" effort=\"35\"");
  const TemporaryFolder folder;
  Scenario scenario = shipped;
  scenario.urdf = folder.write("stiff.urdf", urdf);
  scenario.drive->curvature_1_m = 0.3;
  EXPECT_EQ(check_plan(planned_drive(scenario)).feasible, true);
  scenario.drive->curvature_1_m = 1.5;
  try {
    planned_drive(scenario);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("wheel_3 cannot be steered"), std::string::npos)
        << error.what();
  }
}

TEST(WheeledDrive, RefusesAScenarioWithoutADrive) {
  Scenario scenario = centauro_drive();
  scenario.drive.reset();
  EXPECT_THROW(planned_drive(scenario), Error);
}

TEST(WheeledDrive, SlipsLessInEachStepTheShorterSteps) {
  const auto most_m = [](int configurations) {
    const Graph graph = planned_drive(centauro_drive(4.0, 0.0, configurations));
    double most = 0.0;
    for (int e = 0; e < graph.edge_slots(); ++e) {
      const Graph::EdgeRecord& record = graph.edge_record(e);
      if (graph.edge_pools()[record.pool]->tag() != EdgeRolling::kTag) continue;
      most = std::max(most, record.tolerance > 0.0 ? record.tolerance : EdgeRolling::kTolerance);
    }
    return most;
  };
  EXPECT_EQ(most_m(50), EdgeRolling::kTolerance);
  EXPECT_NEAR(most_m(201), 0.0125 * 0.02, 1e-6) << "as much in 0.1 m of the way";
}

TEST(WheeledDrive, EndsWithItsDeadlineWhereverThatPasses) {
  const Scenario scenario = centauro_drive(1.0, 0.0, 5);
  std::vector<std::string> parts;
  JobControl job;
  job.report = [&parts](std::string_view part, double fraction) {
    EXPECT_GE(fraction, 0.0);
    EXPECT_LT(fraction, 1.0);
    if (parts.empty() || parts.back() != part) parts.emplace_back(part);
  };
  ASSERT_TRUE(planned_drive(scenario, job));
  EXPECT_EQ(parts, (std::vector<std::string>{"rolling", "placing configurations", "comparing links",
                                             "adding constraints"}));
  for (const std::string& last : parts) {
    JobControl ended;
    ended.report = [&](std::string_view part, double) {
      if (part == last) ended.termination.deadline = Deadline::after(0.0);
    };
    EXPECT_FALSE(planned_drive(scenario, ended)) << last;
    if (last != "rolling") continue;
    EXPECT_EQ(plan_wheeled_drive(task_of(scenario), ended).status, PlannerStatus::kDeadline);
  }
}

}  // namespace
}  // namespace locograph
