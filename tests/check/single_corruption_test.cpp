#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "check/centauro_on_wheels.h"

namespace locograph {
namespace {

void turn_base(Eigen::VectorXd& q, double angle, const Eigen::Vector3d& axis) {
  const Eigen::Quaterniond before(Eigen::Vector4d(q.segment<4>(3)));
  const Eigen::Quaterniond turned = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * before;
  q.segment<4>(3) = turned.coeffs();
}

// One thing is wrong in a drive of 11 vertices; exactly the constraints named must be violated, the
// first one as told.
struct Corruption {
  std::string name;
  std::function<void(Motion&)> spoil;
  std::vector<std::string> constraints;
  int at_vertex;
  double worst;
  std::string unit;
  double tolerance = 1e-6;
  int count = 1;
  std::vector<Obstacle> obstacles = {};
  std::string what = "";
};

void PrintTo(const Corruption& corruption, std::ostream* out) { *out << corruption.name; }

double upper(const std::string& joint) {
  return centauro().robot.joints()[centauro().robot.joint_index(joint)].upper;
}

// Yaw of the whole robot about its pelvis, from vertex `first` on; the wheels roll on as if nothing
// had happened, along the new heading.
void turn_on_the_spot(Motion& motion, std::size_t first, double yaw) {
  motion.configurations[first] = motion.configurations[first - 1];
  turn_base(motion.configurations[first], yaw, Eigen::Vector3d::UnitZ());
  for (std::size_t i = first + 1; i < motion.configurations.size(); ++i)
    motion.configurations[i] = motion.configurations[first];
}

std::vector<Corruption> corruptions() {
  const Centauro& c = centauro();
  std::vector<Corruption> all;
  all.push_back(
      {"JointBeyondItsLimit",
       [&](Motion& m) { m.configurations[5][c.index("j_arm1_7")] = upper("j_arm1_7") + 0.01; },
       {"joint_limits"},
       5,
       0.01,
       "rad",
       1e-9,
       1,
       {},
       "j_arm1_7"});
  all.push_back({"WheelTooFast",
                 [](Motion& m) {
                   for (std::size_t i = 4; i < 11; ++i) m.time_s[i] -= 0.775;
                 },
                 {"velocity_limits"},
                 3,
                 2.0813908313908405,  // 0.08 / kRadius / 0.025 / 20.0 in the mean
                 "ratio",
                 1e-6,
                 3,
                 {},
                 "j_wheel_"});
  all.push_back({"TimeStandsStill",
                 [](Motion& m) { m.time_s[6] = m.time_s[5]; },
                 {"time_order"},
                 5,
                 0.0,
                 "s",
                 0.0});
  all.push_back({"TimeRunsBackwards",
                 [](Motion& m) { m.time_s[6] = m.time_s[5] - 0.3; },
                 {"time_order"},
                 5,
                 -0.3,
                 "s",
                 1e-12});
  all.push_back({"BaseLiftedByFiveMillimetres",
                 [](Motion& m) { m.configurations[4][2] += 0.005; },
                 {"contact_position", "contact_between"},
                 4,
                 0.005,
                 "m",
                 1e-5,
                 1,
                 {},
                 "wheel_"});
  all.push_back({"BaseSunkByFiveMillimetres",
                 [](Motion& m) { m.configurations[4][2] -= 0.005; },
                 {"contact_position", "contact_between"},
                 4,
                 0.005,
                 "m",
                 1e-5,
                 1,
                 {},
                 "wheel_"});
  all.push_back({"WheelsDeepInTheGround",
                 [](Motion& m) { m.configurations[4][2] -= 0.0133; },
                 {"touching_depth", "contact_position", "contact_between",
                  "ground_penetration"},  // of the forks
                 4,
                 0.0133,
                 "m",
                 2e-4,
                 2,
                 {},
                 "wheel_"});
  all.push_back({"BodyInTheGround",
                 [](Motion& m) {
                   m.configurations[0][2] -= 0.5;
                   m.configurations.resize(1);
                   m.time_s.resize(1);
                   m.stance_from.resize(1);
                 },
                 {"ground_penetration", "contact_position", "touching_depth"},
                 0,
                 kNaN,
                 "m",
                 0.0,
                 1});
  all.push_back({"BaseRolledBySixDegrees",
                 [](Motion& m) {
                   turn_base(m.configurations[6], 6.0 * std::numbers::pi / 180.0,
                             Eigen::Vector3d::UnitX());
                 },
                 {"contact_orientation", "contact_position", "contact_between", "touching_depth",
                  "lateral_slip", "ground_penetration"},
                 6,
                 6.0 * std::numbers::pi / 180.0,
                 "rad",
                 1e-5,
                 1});
  all.push_back({"SidewaysWithoutSteering",
                 [](Motion& m) {
                   for (std::size_t i = 5; i < 11; ++i) m.configurations[i][1] += 0.03;
                 },
                 {"lateral_slip"},
                 5,
                 0.032633744855563876,  // the curve goes beyond, and comes back
                 "m",
                 1e-6,
                 2,
                 {},
                 "wheel_"});
  all.push_back({"WheelsBlockedForOneStep",
                 [&](Motion& m) {
                   for (std::size_t i = 8; i < 11; ++i) c.roll(m.configurations[i], -0.08);
                 },
                 {"longitudinal_slip"},
                 8,
                 0.091851851851851588,
                 "m",
                 1e-6,
                 3,
                 {},
                 "wheel_"});
  all.push_back({"OneWheelTurnsTheWrongWay",
                 [&](Motion& m) {
                   for (Eigen::VectorXd& q : m.configurations)
                     q[c.roll_joints[2]] = -q[c.roll_joints[2]];
                 },
                 {"longitudinal_slip"},
                 9,
                 1.6 * 0.005 / (0.005 + 0.02 * 0.8),
                 "m",
                 1e-6,
                 10,
                 {},
                 "wheel_3"});
  all.push_back({"TurnOnTheSpotWithWheelsStraight",
                 [](Motion& m) { turn_on_the_spot(m, 3, 0.2); },
                 {"lateral_slip", "longitudinal_slip"},
                 3,
                 0.081198996372195575,
                 "m",
                 1e-5,
                 3});
  all.push_back({"TurnOnTheSpotWithWheelsBlocked",
                 [](Motion& m) { turn_on_the_spot(m, 3, 0.2); },
                 {"longitudinal_slip", "lateral_slip"},
                 3,
                 0.080366563562865007,
                 "m",
                 1e-5,
                 3});
  all.push_back({"ANumberThatIsNone",
                 [](Motion& m) {
                   m.configurations[7][12] = kNaN;
                   m.configurations[7][3] = kInfinity;
                 },
                 {"not_finite"},
                 7,
                 2.0,
                 "count",
                 0.0});
  all.push_back({"ATimeThatIsNone",
                 [](Motion& m) { m.time_s[2] = kInfinity; },
                 {"not_finite"},
                 2,
                 1.0,
                 "count",
                 0.0});
  all.push_back({"AConfigurationTooShort",
                 [](Motion& m) { m.configurations[10].conservativeResize(20); },
                 {"configuration_size"},
                 10,
                 double(c.home.size() - 20),
                 "count",
                 0.0});
  all.push_back({"AQuaternionTooLong",
                 [](Motion& m) { m.configurations[1].segment<4>(3) *= 1.01; },
                 {"base_orientation"},
                 1,
                 0.01,
                 "1",
                 1e-12});
  all.push_back({"AQuaternionOfZeros",
                 [](Motion& m) { m.configurations[1].segment<4>(3).setZero(); },
                 {"base_orientation"},
                 1,
                 1.0,
                 "1",
                 0.0});
  all.push_back({"ATeleport",
                 [&](Motion& m) {
                   for (std::size_t i = 9; i < 11; ++i)
                     m.configurations[i] = c.at(1000.0 + 0.08 * double(i));
                   for (std::size_t i = 9; i < 11; ++i) m.time_s[i] += 1e5;
                 },
                 {"step_size"},
                 8,
                 1000001.0,
                 "count",
                 1.0});
  all.push_back({"BoxInTheWay",
                 [](Motion&) {},
                 {"obstacle_distance"},
                 10,
                 kNaN,
                 "m",
                 0.0,
                 2,
                 {box("crate", {1.36, 0.35, 0.1}, {0.3, 0.2, 0.2})},
                 "crate"});
  all.push_back({"ThinWallBetweenTwoVertices",
                 [&](Motion& m) {
                   for (std::size_t i = 3; i < 11; ++i) {
                     m.configurations[i] = c.at(3.0 + 0.08 * double(i));
                     m.time_s[i] += 30.0;
                   }
                 },
                 {"obstacle_distance"},
                 2,
                 kNaN,
                 "m",
                 0.0,
                 1,
                 {box("wall", {1.66, 0.0, 1.0}, {0.002, 4.0, 2.0})},
                 "wall"});
  all.push_back({"LegAgainstLeg",
                 [&](Motion& m) {
                   m.configurations[5][c.index("hip_yaw_1")] = 1.27;
                   m.configurations[5][c.index("ankle_yaw_1")] = -1.27;
                 },
                 {"self_collision", "lateral_slip", "longitudinal_slip"},
                 5,
                 -0.0162521,
                 "m",
                 1e-6,
                 2,
                 {},
                 "knee_1 and hip1_2"});
  all.push_back({"OnItsFrontWheelsAlone",
                 [](Motion& m) {
                   m.stances.push_back(m.stances[0]);
                   m.stances[1].contacts.resize(2);
                   m.stance_from[10] = 1;
                 },
                 {"static_balance"},
                 10,
                 kNaN,
                 "1",
                 0.0,
                 1,
                 {},
                 "a moment on the base is left over"});
  all.push_back({"HeldByOneHandAlone",
                 [&](Motion& m) {
                   m = c.drive(1, 0.0, 1.0);
                   m.configurations[0][2] += 1.0;
                   RobotState state(c.robot);
                   state.update(m.configurations[0].data());
                   Contact grasp;
                   grasp.effector = {.name = "hand",
                                     .link = "ball1_tip",
                                     .kind = ContactKind::kGrasp,
                                     .max_force_N = 1e5,
                                     .max_moment_Nm = 1e5};
                   const Eigen::Isometry3d& pose =
                       state.world_from_link(c.robot.link_index("ball1_tip"));
                   grasp.position = pose.translation();
                   grasp.normal = Eigen::Vector3d::UnitX();  // a bar along z
                   grasp.forward = Eigen::Vector3d::UnitY();
                   grasp.effector.normal = pose.linear().transpose() * grasp.normal;
                   grasp.effector.forward = pose.linear().transpose() * *grasp.forward;
                   m.stances = {{{grasp}}};
                 },
                 {"torque_limits", "contact_on_surface"},  // there is no bar
                 0,
                 kNaN,
                 "ratio",
                 0.0});
  all.push_back({"AStepWithoutAStance",
                 [](Motion& m) { m.stance_from[6] = -1; },
                 {"stance"},
                 6,
                 1.0,
                 "count",
                 0.0});
  all.push_back({"AWheelThatIsTooLarge",
                 [](Motion& m) {
                   for (Contact& wheel : m.stances[0].contacts) wheel.position.z() -= 0.05;
                 },
                 {"contact_position", "contact_between", "contact_on_surface"},
                 0,
                 0.05,
                 "m",
                 1e-5,
                 11});
  return all;
}

class OneThingWrong : public ::testing::TestWithParam<Corruption> {};

TEST_P(OneThingWrong, IsFoundAndNamedWithVertexAmountAndUnit) {
  const Corruption& corruption = GetParam();
  Motion motion = centauro().drive(11, 0.08, 0.8);
  corruption.spoil(motion);
  CheckOptions options;
  if (corruption.constraints.front() != "torque_limits" &&
      corruption.constraints.front() != "static_balance")
    options.certify_only_if_rest_holds = true;
  const CheckReport report = check_with(corruption.obstacles, motion, options);
  EXPECT_EQ(violated(report),
            std::set<std::string>(corruption.constraints.begin(), corruption.constraints.end()));
  const Violation& violation = report.constraint(corruption.constraints.front());
  EXPECT_EQ(violation.at_vertex, corruption.at_vertex);
  EXPECT_EQ(violation.unit, corruption.unit);
  EXPECT_EQ(violation.count, corruption.count);
  EXPECT_NE(violation.what.find(corruption.what), std::string::npos) << violation.what;
  if (std::isnan(corruption.worst)) return;
  EXPECT_NEAR(violation.worst, corruption.worst, corruption.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Judge, OneThingWrong, ::testing::ValuesIn(corruptions()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace locograph
