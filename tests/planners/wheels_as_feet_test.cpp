// Wheels that stances are made of: where they may stand, and that they stand still.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/standing_wheels.h>
#include <locograph/robots/wheel.h>

#include <cmath>

#include "planners/stance_tasks.h"

namespace locograph::wheels_as_feet_test {
namespace {

using test::contact_of, test::stance_task;

constexpr double kRadius = 0.078;

const Task& platform() {
  static const Task task = stance_task("centauro_platform");
  return task;
}

/// How far a wheel is turned on a plane, but for a constant and whole turns.
double turned(const Task& task, std::size_t effector, const Eigen::Vector3d& normal,
              const Eigen::VectorXd& q) {
  const Robot& robot = *task.robot->robot;
  const Wheel wheel = wheel_of(robot, task.end_effectors()[effector]);
  RobotState state(robot);
  state.update(q.data());
  return q[robot.base_configuration_size() + wheel.joint] + carrier_pitch(state, wheel, normal);
}

double difference(double a, double b) { return std::remainder(a - b, 2.0 * M_PI); }

TEST(WheelsAsFeet, StandStillInScenarios) {
  for (const Contact& contact : platform().start.contacts) EXPECT_TRUE(contact.locked);
  for (const Contact& contact : platform().goals.front().contacts) EXPECT_TRUE(contact.locked);
  // As given: the judge asks for the places, not only for the plane.
  const Judge judge(platform().robot->robot, platform().world);
  Stance moved = platform().start;
  const auto check = [&] {
    return judge.check(platform().start_configuration, moved, platform().check);
  };
  EXPECT_TRUE(check().feasible);
  contact_of(moved, "rear_left_wheel").position.y() += 0.01;
  EXPECT_TRUE(check().constraint("contact_position").violated);
}

TEST(WheelsAsFeet, HavePlacesOnSurfacesARadiusFromTheirBorders) {
  const StancePlannerOptions options;
  StanceSpace space(platform(), options);
  int on_top = 0;
  for (const int number : space.places_near(0, {0.6, 0.0, 0.2}, 0.4)) {
    const Contact& place = space.place(number).bearing.contact;
    EXPECT_TRUE(place.locked);
    EXPECT_FALSE(place.forward.has_value()) << "its heading is free";
    if (!(place.normal.z() > 0.9 && place.position.z() > 0.1)) continue;
    ++on_top;
    EXPECT_GE(place.position.x(), 0.5 + kRadius - 1e-9);
  }
  EXPECT_GT(on_top, 20);
}

TEST(WheelsAsFeet, StepOntoAPlatformAndAreJudged) {
  const StancePlan plan = make_stance_planner("guided")->plan(platform(), StancePlannerOptions());
  ASSERT_TRUE(plan.success()) << plan.reason;
  for (const char* constraint : {"contact_position", "contact_motion", "contact_turn",
                                 "contact_on_surface", "static_balance", "torque_limits"}) {
    EXPECT_TRUE(plan.report.constraint(constraint).judged) << constraint;
  }
  for (const Contact& contact : plan.stances.back().contacts) {
    EXPECT_EQ(contact.position.z(), 0.2) << contact.name();
  }
}

TEST(WheelsAsFeet, TurnBackWhatTheirCarriersPitchWhileTheyTouch) {
  const StancePlannerOptions options;
  StanceSpace space(platform(), options);
  const Footing standing = space.footing(platform().start);
  const Footing lifted = without(standing, 2);
  const Robot& robot = *platform().robot->robot;
  const auto ankle = [&](std::size_t effector) {
    const std::string number = std::to_string(effector + 1);
    return robot.base_configuration_size() +
           robot.joints()[static_cast<std::size_t>(robot.joint_index("ankle_pitch_" + number))]
               .index;
  };
  const Eigen::VectorXd& start = platform().start_configuration;
  Eigen::VectorXd pitched = start;
  for (std::size_t e = 0; e < 4; ++e) pitched[ankle(e)] += 0.1 * static_cast<double>(e + 1);
  Eigen::VectorXd more = pitched;
  for (std::size_t e = 0; e < 4; ++e) more[ankle(e)] -= 0.25;
  StancePath path{{standing, lifted, standing}, {start, pitched, more}};
  hold_wheels(space, path);
  EXPECT_EQ(path.configurations[0], start);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  for (std::size_t e = 0; e < 4; ++e) {
    const double first = turned(platform(), e, up, start);
    EXPECT_GT(std::abs(difference(turned(platform(), e, up, pitched), first)), 0.05);
    EXPECT_NEAR(difference(turned(platform(), e, up, path.configurations[1]), first), 0.0, 1e-9);
    // One that is in the air turns as it likes.
    const double last = turned(platform(), e, up, path.configurations[2]);
    if (e == 2) {
      EXPECT_EQ(path.configurations[2], [&] {
        Eigen::VectorXd others = path.configurations[2];
        const Wheel wheel = wheel_of(robot, platform().end_effectors()[e]);
        const int joint = robot.base_configuration_size() + wheel.joint;
        others[joint] = more[joint];
        return others;
      }());
    } else {
      EXPECT_NEAR(difference(last, first), 0.0, 1e-9);
    }
  }
}

}  // namespace
}  // namespace locograph::wheels_as_feet_test
