// What somebody might write into a motion to have it called feasible: each lie is refused by the
// constraint that it breaks, and the honest originals are accepted.
#include <gtest/gtest.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/error.h>

#include "check/centauro_on_wheels.h"
#include "check/coman_plus_standing.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Names = std::set<std::string>;
using test::standing;

/// The LP is what takes longest, and not what these lies break.
CheckOptions quick() {
  CheckOptions options;
  options.certify_only_if_rest_holds = true;
  return options;
}

void expect_refused(const CheckReport& report, const std::string& constraint) {
  EXPECT_FALSE(report.feasible);
  EXPECT_TRUE(report.constraint(constraint).violated) << constraint << ": " << [&] {
    std::string all;
    for (const Violation& v : report.violations)
      if (v.violated) all += violation_text(v) + "; ";
    return all;
  }();
}

/// Every vertex in a stance of its own, whose contacts are where the effectors are by then.
void follow(Motion& motion, const Robot& robot) {
  RobotState state(robot);
  const Stance original = motion.stances[0];
  motion.stances.clear();
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    state.update(motion.configurations[i].data());
    Stance stance = original;
    for (Contact& contact : stance.contacts) {
      const Eigen::Isometry3d& pose =
          state.world_from_link(robot.link_index(contact.effector.link));
      contact.position = pose * contact.effector.point;
      contact.normal = pose.linear() * contact.effector.normal;
      contact.forward = pose.linear() * contact.effector.forward;
    }
    motion.stances.push_back(stance);
    motion.stance_from[i] = int(i);
  }
}

TEST(Honest, LinksThatMayOverlapAreTold) {
  Robot robot = *standing().robot;
  robot.leave_out_pairs({robot.self_collision_pairs().front()});
  const CheckReport report =
      Judge(std::make_shared<const Robot>(std::move(robot)), standing().world())
          .check(standing().home, standing().feet, {});
  ASSERT_FALSE(report.trusted.empty());
  EXPECT_NE(report.trusted.back().find("that they may overlap"), std::string::npos)
      << report.trusted.back();
}

TEST(Honest, StandingAndDrivingAreAccepted) {
  CheckOptions options;
  options.known = standing().known;
  const CheckReport report = standing().check(standing().motion(6), options);
  EXPECT_EQ(violated(report), Names{});
  EXPECT_EQ(report.trusted,
            std::vector<std::string>{"HeadHokuyo: that it touches nothing (no collision shape)"});
  EXPECT_GT(report.min_balance_margin.value(), 0.1);
  EXPECT_EQ(violated(Judge(standing().robot, standing().world())
                         .check(standing().home, standing().feet, options)),
            Names{});
  EXPECT_EQ(violated(check_with({}, centauro().drive(50, 0.08, 0.8))), Names{});
}

TEST(Lie, TheRobotIsRaisedAndItsContactsStay) {
  Motion motion = standing().motion(4);
  for (Eigen::VectorXd& q : motion.configurations) q[2] += 1.0;
  expect_refused(standing().check(motion, quick()), "contact_position");
}

TEST(Lie, ContactsAreRaisedTogetherWithTheRobot) {
  Motion motion = standing().motion(4);
  for (Eigen::VectorXd& q : motion.configurations) q[2] += 1.0;
  for (Contact& contact : motion.stances[0].contacts) contact.position.z() += 1.0;
  const CheckReport report = standing().check(motion);
  EXPECT_EQ(violated(report), Names{"contact_on_surface"});
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 1.0, 1e-3);
  // A world that does not say what there is to touch cannot tell; the report says so.
  const CheckReport nowhere = Judge(standing().robot, World{}).check(motion);
  EXPECT_FALSE(nowhere.constraint("contact_on_surface").judged);
  EXPECT_EQ(nowhere.trusted.size(), 5u);
}

TEST(Lie, SolesSlideAMetreWhileInContact) {
  Motion motion = standing().motion(11);
  for (std::size_t i = 0; i < 11; ++i) motion.configurations[i][0] += 0.1 * double(i);
  const CheckReport report = standing().check(motion, quick());
  expect_refused(report, "contact_position");
  expect_refused(report, "contact_motion");
  expect_refused(report, "contact_between");
}

TEST(Lie, SolesSlideByNewLabelsForTheirPlaces) {
  Motion motion = standing().motion(11);
  for (std::size_t i = 0; i < 11; ++i) motion.configurations[i][0] += 0.1 * double(i);
  follow(motion, *standing().robot);
  expect_refused(standing().check(motion, quick()), "contact_relabelled");
  // So little at a time that every stance is closed on both sides.
  Motion fine = standing().motion(21);
  for (std::size_t i = 0; i < 21; ++i) fine.configurations[i][0] += 8e-5 * double(i);
  follow(fine, *standing().robot);
  const CheckReport report = standing().check(fine);
  EXPECT_EQ(violated(report), (Names{"contact_motion", "contact_relabelled"}));
  EXPECT_NEAR(report.constraint("contact_motion").worst, 1.6e-3, 1e-4);
  // With other points of the same sole, by other names, as points instead of surfaces.
  for (std::size_t i = 0; i < fine.stances.size(); ++i) {
    for (Contact& contact : fine.stances[i].contacts) {
      contact.effector.name += std::to_string(i);
      if (i % 2 == 1) contact.effector.kind = ContactKind::kPoint;
      const double shift = 1e-3 * double(i);
      contact.effector.point.x() += shift;
      contact.position += shift * contact.forward->normalized();
    }
  }
  expect_refused(standing().check(fine, quick()), "contact_motion");
}

TEST(Lie, SolesTurnByNewLabels) {
  Motion motion = standing().motion(21);
  Motion turned = motion;
  for (std::size_t i = 0; i < 21; ++i) {
    // About the middle between the soles: they move by less than they turn.
    Eigen::VectorXd& q = turned.configurations[i];
    const Eigen::AngleAxisd turn(7e-4 * double(i), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d middle(0.4, 0.0, 0.0);
    q.head<3>() = middle + turn * (q.head<3>() - middle);
    q.segment<4>(3) =
        (Eigen::Quaterniond(turn) * Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(3)))).coeffs();
  }
  follow(turned, *standing().robot);
  expect_refused(standing().check(turned, quick()), "contact_turn");
}

TEST(Lie, ThePlanFloatsAndJumps) {
  Motion motion = standing().motion(2);
  motion.time_s = {0.0, 0.001};
  for (Eigen::VectorXd& q : motion.configurations) q[2] += 50.0;
  motion.configurations[1][0] += 100.0;
  const CheckReport on_feet = standing().check(motion, quick());
  expect_refused(on_feet, "contact_position");
  motion.stance_from = {-1, -1};
  expect_refused(standing().check(motion), "stance");
  motion.stance_from.clear();
  expect_refused(standing().check(motion), "stance");
  // With a stance for its end only.
  motion = standing().motion(3);
  motion.stance_from = {-1, 0, 0};
  EXPECT_EQ(violated(standing().check(motion)), Names{"stance"});
}

TEST(Lie, MoreIsClaimedThanIsKnown) {
  CheckOptions options;
  options.known = standing().known;
  const auto claims = [&](auto&& change) {
    Motion motion = standing().motion(2);
    change(motion.stances[0].contacts[0]);
    return violated(standing().check(motion, options));
  };
  const Names refused = {"contact_claims"};
  EXPECT_EQ(claims([](Contact& c) { c.effector.half_x_m *= 1.5; }), refused);
  EXPECT_EQ(claims([](Contact& c) { c.effector.half_y_m *= 1.001; }), refused);
  EXPECT_EQ(claims([](Contact& c) { c.effector.friction *= 1.5; }), refused);
  EXPECT_EQ(claims([](Contact& c) { c.effector.max_force_N *= 1.5; }), refused);
  EXPECT_EQ(claims([](Contact& c) { c.effector.kind = ContactKind::kPoint; }), refused);
  EXPECT_EQ(claims([](Contact& c) { c.effector.name = "third_foot"; }), refused);
  EXPECT_EQ(claims([](Contact& c) {
              c.effector.point.x() += 0.05;
              c.position += 0.05 * c.forward->normalized();
            }),
            refused);
  // Less is no lie.
  EXPECT_EQ(claims([](Contact& c) { c.effector.half_x_m *= 0.9; }), Names{});
  // By a scenario's word alone sizes count as it says, whatever the plan says.
  options.compare_claims = false;
  EXPECT_EQ(claims([](Contact& c) { c.effector.half_x_m *= 100.0; }), Names{});
  options.known[0].half_x_m = options.known[1].half_x_m = 0.001;
  EXPECT_EQ(claims([](Contact& c) { c.effector.half_x_m *= 100.0; }), Names{"static_balance"});
}

TEST(Lie, AnEndEffectorThatNobodyKnowsBears) {
  CheckOptions options;
  options.known = {standing().known.front()};
  EXPECT_EQ(violated(standing().check(standing().motion(2), options)), Names{"contact_claims"});
  options.known.clear();
  EXPECT_EQ(violated(standing().check(standing().motion(2), options)), Names{}) << "on trust";
}

TEST(Lie, TheSolesStandBesideWhatIsThere) {
  World world = standing().world();
  const auto on = [&](double half_x) {
    world.surfaces[0].half_x_m = half_x;
    world.surfaces[0].half_y_m = 2.0;
    return Judge(standing().robot, world).check(standing().motion(2));
  };
  // The soles reach to 0.48 m, what they balance about is at 0.37 m.
  EXPECT_EQ(violated(on(0.5)), Names{});
  EXPECT_EQ(violated(on(0.33)), Names{"static_balance"});
  EXPECT_TRUE(violated(on(0.3)).contains("contact_on_surface"));
  // On ice.
  world = standing().world();
  world.surfaces[0].friction = 1e-4;
  const Names slippery = violated(Judge(standing().robot, world).check(standing().motion(2)));
  EXPECT_EQ(slippery, Names{"static_balance"});
}

TEST(Lie, CentauroStandsOnItsRearWheelsAlone) {
  Motion motion = centauro().drive(3, 0.08, 0.8);
  std::vector<Contact>& wheels = motion.stances[0].contacts;
  std::erase_if(wheels, [](const Contact& wheel) { return wheel.position.x() > 0.0; });
  ASSERT_EQ(wheels.size(), 2u);
  expect_refused(check_with({}, motion), "static_balance");
}

TEST(Lie, WheelsSlideSidewaysInFineSteps) {
  Motion motion = centauro().drive(10001, 0.0, 0.01);
  for (std::size_t i = 0; i < motion.configurations.size(); ++i)
    motion.configurations[i][1] += 4.9e-4 * double(i);
  const CheckReport report = check_with({}, motion, quick());
  EXPECT_EQ(violated(report), Names{"lateral_slip"});
  EXPECT_NEAR(report.constraint("lateral_slip").worst, 4.9, 1e-6);
}

TEST(Lie, BlockedWheelsGoAt49MetresASecond) {
  Motion motion = centauro().drive(50, 0.004, 0.004 / 49.0);
  for (Eigen::VectorXd& q : motion.configurations) centauro().roll(q, centauro().home[0] - q[0]);
  const CheckReport report = check_with({}, motion, quick());
  EXPECT_EQ(violated(report), Names{"longitudinal_slip"});
  // Whoever starts that fast tips over.
  expect_refused(check_with({}, motion), "static_balance");
}

TEST(Lie, CentauroTurnsNineRadiansOnTheSpot) {
  Motion motion = centauro().drive(901, 0.0, 0.1);
  for (std::size_t i = 0; i < motion.configurations.size(); ++i)
    motion.configurations[i].segment<4>(3) =
        (Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * double(i), Eigen::Vector3d::UnitZ())) *
         Eigen::Quaterniond(Eigen::Vector4d(centauro().home.segment<4>(3))))
            .coeffs();
  EXPECT_EQ(violated(check_with({}, motion, quick())),
            (Names{"lateral_slip", "longitudinal_slip"}));
}

TEST(Lie, WheelsAreLifted) {
  Motion motion = centauro().drive(4, 0.08, 0.8);
  motion.configurations[2][2] += 1.5e-4;
  EXPECT_EQ(violated(check_with({}, motion)), Names{"contact_position"});
}

TEST(Lie, LockedWheelsRollAndRollingWheelsAreCalledFeet) {
  Motion motion = centauro().drive(4, 0.08, 0.8);
  for (Contact& wheel : motion.stances[0].contacts) wheel.locked = true;
  const CheckReport report = check_with({}, motion, quick());
  expect_refused(report, "contact_turn");
  expect_refused(report, "contact_motion");
  // Standing still they may well be locked.
  motion = centauro().drive(4, 0.0, 0.8);
  for (Contact& wheel : motion.stances[0].contacts) wheel.locked = true;
  EXPECT_EQ(violated(check_with({}, motion)), Names{});
}

TEST(Lie, WheelsSlideWhileTheyTakeTurnsAtBeingLocked) {
  Motion motion = centauro().drive(41, 0.0, 0.5);
  motion.stances.push_back(motion.stances[0]);
  for (Contact& wheel : motion.stances[1].contacts) wheel.locked = true;
  for (std::size_t i = 0; i < 41; ++i) {
    motion.stance_from[i] = int(i % 2);
    motion.configurations[i][1] += 3e-4 * double((i + 1) / 2);  // only while they may roll
  }
  expect_refused(check_with({}, motion, quick()), "lateral_slip");
}

TEST(Lie, TimeIsCompressed) {
  Motion motion = centauro().drive(11, 0.08, 0.8);
  for (double& time : motion.time_s) time *= 0.1;
  // 1 m/s from rest and back within a tenth of a second each, at the height of its trunk.
  CheckReport report = check_with({}, motion);
  expect_refused(report, "static_balance");
  CheckOptions options;
  options.base_linear_m_s = 0.5;
  options.joint_acceleration_rad_s2 = 10.0;
  report = check_with({}, motion, options);
  expect_refused(report, "base_velocity");
  expect_refused(report, "acceleration_limits");
  EXPECT_EQ(violated(check_with({}, centauro().drive(11, 0.08, 0.8), options)), Names{});
  for (double& time : motion.time_s) time *= 0.05;
  expect_refused(check_with({}, motion, options), "velocity_limits");
}

TEST(Lie, ATurnIsFastestWhereItsRotationVectorIsNot) {
  Motion motion = centauro().drive(2, 0.0, 1.0);
  const Eigen::Vector3d turn(-2.430978883, -0.178682109, -0.751169746);
  motion.configurations[1].segment<4>(3) =
      Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())).coeffs();
  motion.slopes.assign(2, Eigen::VectorXd::Zero(centauro().robot.tangent_size()));
  motion.slopes[0].segment<3>(3) << 0.562065627, -2.080794819, 1.314689775;
  motion.slopes[1].segment<3>(3) << -3.034748382, 1.721448108, -0.094579217;
  const MotionCurve curve(centauro().robot, motion);
  CurvePoint point;
  double fastest = 0.0;
  for (int i = 0; i <= 1000; ++i) {
    curve.step(0).at(i / 1000.0, point);
    fastest = std::max(fastest, point.velocity.segment<3>(3).norm());
  }
  CheckOptions options = quick();
  options.base_angular_rad_s = fastest;
  EXPECT_GE(check_with({}, motion, options).constraint("base_velocity").worst, 1.0);
}

TEST(Lie, APostureMoves) {
  Motion motion = centauro().drive(1, 0.0, 1.0);
  EXPECT_FALSE(check_with({}, motion).constraint("end_at_rest").judged);
  motion.slopes.assign(1, Eigen::VectorXd::Zero(centauro().robot.tangent_size()));
  EXPECT_EQ(violated(check_with({}, motion)), Names{});
  motion.slopes[0][0] = 0.5;
  expect_refused(check_with({}, motion), "end_at_rest");
}

TEST(Lie, AThinObstacleStandsBetweenVertices) {
  Motion motion = centauro().drive(2, 3.0, 30.0);
  const Obstacle wall = box("wall", {1.66, 0.0, 1.0}, {0.002, 4.0, 2.0});
  EXPECT_EQ(violated(check_with({wall}, motion)), Names{"obstacle_distance"});
}

TEST(Lie, AnObstacleComesWhenTheMotionIsOver) {
  Obstacle cart = box("cart", {4.0, 0.0, 0.5}, {0.3, 0.3, 1.0});
  KeyFrame arrives{20.0, Eigen::Isometry3d::Identity()};
  arrives.pose.translation() << 0.5, 0.0, 0.5;
  cart.motion = {arrives};
  const Motion motion = centauro().drive(3, 0.08, 0.8);
  EXPECT_EQ(violated(check_with({cart}, motion)), Names{});
  CheckOptions options;
  options.until_s = 30.0;
  EXPECT_EQ(violated(check_with({cart}, motion, options)), Names{"obstacle_distance"});
  options.until_s = 3.0;
  EXPECT_EQ(violated(check_with({cart}, motion, options)), Names{});
}

TEST(Lie, NumbersAreNone) {
  Motion motion = standing().motion(3);
  motion.configurations[1][9] = kNaN;
  expect_refused(standing().check(motion), "not_finite");
}

/// A block of 10 kg that stands on a point 0.3 m beside its middle, and on one below it.
TEST(Lie, AContactIsOpenBetweenVertices) {
  const test::TemporaryFolder folder;
  const auto robot = std::make_shared<const Robot>(Robot::load(folder.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><mass value='10'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial></link></robot>")));
  Motion motion;
  Contact pivot;
  pivot.effector = {.name = "pivot",
                    .link = "block",
                    .kind = ContactKind::kPoint,
                    .point = {0.3, 0.0, 0.0},
                    .friction = 0.5,
                    .max_force_N = 1000.0};
  motion.stances = {{{pivot}}};
  motion.time_s = {0.0, 10.0};
  motion.stance_from = {0, 0};
  for (const double yaw : {-0.3, 0.3}) {
    Eigen::VectorXd q(7);
    q << -0.3 * std::cos(yaw), -0.3 * std::sin(yaw), 0.0, 0.0, 0.0, std::sin(0.5 * yaw),
        std::cos(0.5 * yaw);
    motion.configurations.push_back(q);
  }
  const CheckReport report = Judge(robot, World{}).check(motion);
  EXPECT_FALSE(report.constraint("contact_position").violated);
  expect_refused(report, "contact_between");
  EXPECT_NEAR(report.constraint("contact_between").worst, 0.3 * (1.0 - std::cos(0.3)), 1e-4);
}

TEST(Lie, WheelsRollBetweenTheStancesOfAPlan) {
  Motion honest = centauro().drive(2, 0.0, 1.0);
  honest.stances_only = true;
  honest.stances.push_back(honest.stances[0]);
  std::erase_if(honest.stances[1].contacts, [](const Contact& c) { return c.name() == "wheel_3"; });
  honest.stance_from = {0, 1};
  const CheckReport report = check_with({}, honest);
  EXPECT_EQ(violated(report), Names{});
  EXPECT_TRUE(report.constraint("contact_motion").judged);
  EXPECT_TRUE(report.constraint("contact_turn").judged);
  Motion elsewhere = honest;
  elsewhere.configurations[1] = centauro().at(0.01);
  expect_refused(check_with({}, elsewhere, quick()), "contact_position");
  expect_refused(check_with({}, elsewhere, quick()), "contact_motion");
  Motion turned = honest;
  turned.configurations[1][centauro().roll_joints[0]] += 0.1;
  EXPECT_EQ(violated(check_with({}, turned)), Names{"contact_turn"});
  // The one that is lifted, before it is.
  turned = honest;
  turned.configurations[1][centauro().roll_joints[2]] += 0.1;
  EXPECT_EQ(violated(check_with({}, turned)), Names{"contact_turn"});
  Motion relabelled = honest;
  for (Contact& wheel : relabelled.stances[1].contacts) wheel.position.x() += 5e-3;
  EXPECT_EQ(violated(check_with({}, relabelled, quick())),
            (Names{"contact_position", "contact_relabelled"}));
}

TEST(Lie, APlanOfStancesHoldsOnToNothingOrToTwoPlaces) {
  Motion plan = standing().motion(2);
  plan.configurations[1] = plan.configurations[0];
  plan.stances_only = true;
  plan.stances.push_back(plan.stances[0]);
  plan.stances[1].contacts.pop_back();
  plan.stance_from = {0, 1};
  // Lifts the right foot, on which it would have to stand before.
  const CheckReport report = standing().check(plan);
  EXPECT_EQ(violated(report), Names{"static_balance"});
  EXPECT_EQ(report.constraint("velocity_limits").why_not, "a plan of stances has no motion");
  EXPECT_FALSE(report.constraint("lateral_slip").judged);
  plan.stances[1] = plan.stances[0];
  EXPECT_TRUE(violated(standing().check(plan)).contains("contact_relabelled"));
  plan.stances[1].contacts[0].position.x() += 0.01;
  EXPECT_TRUE(violated(standing().check(plan)).contains("contact_relabelled"));
}

}  // namespace
}  // namespace locograph
