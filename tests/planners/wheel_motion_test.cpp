#include <locograph/planners/offline/drive/wheel_motion.h>

#include "planners/planned_drive.h"

namespace locograph {
namespace {

/// One wheel below a steering joint, both 0.1 m above the ground.
std::string one_wheel(const std::string& steering) {
  return "<robot name=\"one_wheel\">\n"
         "<link name=\"base\"/><link name=\"fork\"/><link name=\"wheel\"/>\n"
         "<joint name=\"steering\" " +
         steering +
         "<parent link=\"base\"/><child link=\"fork\"/></joint>\n"
         "<joint name=\"roll\" type=\"continuous\"><axis xyz=\"0 1 0\"/>"
         "<origin xyz=\"0 0 0.1\"/><parent link=\"fork\"/><child link=\"wheel\"/></joint>\n"
         "</robot>\n";
}

struct OneWheel {
  explicit OneWheel(const std::string& steering)
      : robot(Robot::load(folder.write("robot.urdf", one_wheel(steering)))),
        motion(robot, standing()),
        q(robot.neutral_configuration()) {}
  static Stance standing() {
    Contact wheel;
    wheel.effector = {.link = "wheel",
                      .kind = ContactKind::kWheel,
                      .radius_m = 0.1,
                      .friction = 1.0,
                      .max_force_N = 1.0};
    return {{wheel}};
  }
  TemporaryFolder folder;
  Robot robot;
  WheelMotion motion;
  Eigen::VectorXd q;
};

std::string revolute(const std::string& axis, double lower, double upper) {
  return "type=\"revolute\"><axis xyz=\"" + axis + "\"/><limit lower=\"" + std::to_string(lower) +
         "\" upper=\"" + std::to_string(upper) + "\" effort=\"1\" velocity=\"1\"/>";
}

Eigen::Vector3d along(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

/// CENTAURO at the start of the straight drive: every wheel heads along x.
struct Drive {
  Drive()
      : graph(planned_drive(centauro_drive())),
        plan(plan_of(graph)),
        robot(*plan.robot->robot),
        motion(robot, plan.stance_from.front()->stance),
        q(configurations(graph).front()) {}
  int yaw(int wheel) const {
    return 7 + robot.joints()[robot.joint_index("ankle_yaw_" + std::to_string(wheel + 1))].index;
  }
  int spin(int wheel) const {
    return 7 + robot.joints()[robot.joint_index("j_wheel_" + std::to_string(wheel + 1))].index;
  }
  Graph graph;
  Plan plan;
  const Robot& robot;
  WheelMotion motion;
  Eigen::VectorXd q;
};

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

double cross(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.cross(b).z(); }

TEST(WheelMotion, SteersAWheelAlongADirectionAndMovesNothingElse) {
  Drive drive;
  for (int wheel = 0; wheel < 4; ++wheel) {
    for (const double angle : {-3.0, -1.2, -0.1, 0.0, 0.4, 1.5, 2.9}) {
      Eigen::VectorXd q = drive.q;
      ASSERT_TRUE(drive.motion.steer(q, wheel, 3.0 * along(angle))) << wheel << ' ' << angle;
      const Eigen::Vector3d heading = drive.motion.pose(q, wheel).heading(kUp);
      EXPECT_NEAR(cross(heading, along(angle)), 0.0, 1e-9);
      EXPECT_LE(std::abs(q[drive.yaw(wheel)] - drive.q[drive.yaw(wheel)]),
                0.5 * std::numbers::pi + 1e-9)
          << "not the smaller turn";
      q[drive.yaw(wheel)] = drive.q[drive.yaw(wheel)];
      EXPECT_EQ(q, drive.q);
    }
  }
}

TEST(WheelMotion, SteersTheOtherWayRoundWhenALimitIsInTheWay) {
  Drive drive;
  for (int wheel = 0; wheel < 4; ++wheel) {
    const Joint& joint = drive.robot.active_joint(drive.yaw(wheel) - 7);
    for (const double sign : {-1.0, 1.0}) {
      Eigen::VectorXd q = drive.q;
      const double limit = sign > 0.0 ? joint.upper : joint.lower;
      q[drive.yaw(wheel)] = limit - 0.05 * sign;
      // Wherever the steering axis points, one of two small turns goes beyond the limit.
      for (const double turn : {-0.1, 0.1}) {
        Eigen::VectorXd steered = q;
        const Eigen::Vector3d heading = drive.motion.pose(q, wheel).heading(kUp);
        const Eigen::Vector3d direction = along(std::atan2(heading.y(), heading.x()) + turn);
        ASSERT_TRUE(drive.motion.steer(steered, wheel, direction));
        EXPECT_GE(steered[drive.yaw(wheel)], joint.lower);
        EXPECT_LE(steered[drive.yaw(wheel)], joint.upper);
        EXPECT_NEAR(cross(drive.motion.pose(steered, wheel).heading(kUp), direction), 0.0, 1e-9);
      }
    }
  }
}

TEST(WheelMotion, SteersAsFarAsTheLimitsGoAndNoFurther) {
  OneWheel wheel(revolute("0 0 1", -0.3, 0.3));
  ASSERT_TRUE(wheel.motion.steer(wheel.q, 0, along(0.2)));
  EXPECT_NEAR(wheel.q[7], 0.2, 1e-12);
  ASSERT_TRUE(wheel.motion.steer(wheel.q, 0, -along(0.1))) << "backwards";
  EXPECT_NEAR(wheel.q[7], 0.1, 1e-12);
  const Eigen::VectorXd before = wheel.q;
  for (const double angle : {0.5, -0.4, 1.5, -1.5}) {
    EXPECT_FALSE(wheel.motion.steer(wheel.q, 0, along(angle))) << angle;
    EXPECT_EQ(wheel.q, before);
  }
}

TEST(WheelMotion, AnAxisUpsideDownTurnsTheOtherWay) {
  OneWheel wheel(revolute("0 0 -1", -0.3, 0.3));
  ASSERT_TRUE(wheel.motion.steer(wheel.q, 0, along(0.2)));
  EXPECT_NEAR(wheel.q[7], -0.2, 1e-12);
}

TEST(WheelMotion, DoesNotSteerAboutAnAxisThatIsNotUpright) {
  OneWheel wheel(revolute("0.6 0 0.8", -2.0, 2.0));
  const Eigen::VectorXd before = wheel.q;
  EXPECT_FALSE(wheel.motion.steer(wheel.q, 0, along(0.2)));
  EXPECT_EQ(wheel.q, before);
}

TEST(WheelMotion, AWheelWithoutSteeringGoesWhereItHeadsForwardsAndBackwards) {
  OneWheel wheel("type=\"fixed\">");
  EXPECT_TRUE(wheel.motion.steer(wheel.q, 0, along(0.0)));
  EXPECT_TRUE(wheel.motion.steer(wheel.q, 0, -along(0.0)));
  EXPECT_FALSE(wheel.motion.steer(wheel.q, 0, along(0.01)));
}

TEST(WheelMotion, RollsEveryWheelAsFarAsItsCentreComesTheRightWayRound) {
  Drive drive;
  RobotState state(drive.robot);
  state.update(drive.q.data());
  for (const double distance : {0.1, -0.25}) {
    Eigen::VectorXd to = drive.q;
    to[0] += distance;
    drive.motion.roll(drive.q, to);
    for (int wheel = 0; wheel < 4; ++wheel) {
      const Wheel& of = drive.motion.wheel(wheel).wheel;
      const Eigen::Vector3d axle = state.world_from_link(of.link).linear() *
                                   drive.robot.active_joint(drive.spin(wheel) - 7).axis;
      // The contact point rests: v + ω × (−r ẑ) = 0.
      const Eigen::Vector3d spin = (to[drive.spin(wheel)] - drive.q[drive.spin(wheel)]) * axle;
      const Eigen::Vector3d contact =
          Eigen::Vector3d(distance, 0, 0) + spin.cross(Eigen::Vector3d(0, 0, -kRadius));
      EXPECT_NEAR(contact.norm(), 0.0, 1e-9) << of.name;
    }
  }
}

TEST(WheelMotion, LeavesALockedWheelAsItIs) {
  Drive drive;
  Stance stance = drive.plan.stance_from.front()->stance;
  stance.contacts[2].locked = true;
  WheelMotion motion(drive.robot, stance);
  Eigen::VectorXd to = drive.q;
  to[0] += 0.1;
  motion.roll(drive.q, to);
  EXPECT_EQ(to[drive.spin(2)], drive.q[drive.spin(2)]);
  EXPECT_NE(to[drive.spin(1)], drive.q[drive.spin(1)]);
}

TEST(WheelMotion, HoldsALockedWheelOnTheGroundAsItsCarrierPitches) {
  Drive drive;
  Stance stance = drive.plan.stance_from.front()->stance;
  stance.contacts[2].locked = true;
  WheelMotion motion(drive.robot, stance);
  Eigen::VectorXd to = drive.q;
  Eigen::VectorXd pitch = Eigen::VectorXd::Zero(drive.robot.tangent_size());
  pitch[4] = 0.3;
  drive.robot.integrate(drive.q.data(), pitch.data(), to.data());
  motion.hold(drive.q, to);
  EXPECT_NEAR(std::abs(to[drive.spin(2)] - drive.q[drive.spin(2)]), 0.3, 1e-9);
  RobotState before(drive.robot), after(drive.robot);
  before.update(drive.q.data());
  after.update(to.data());
  const Wheel& wheel = motion.wheel(2).wheel;
  const Eigen::AngleAxisd turned(after.world_from_link(wheel.link).linear() *
                                 before.world_from_link(wheel.link).linear().transpose());
  const Eigen::Vector3d axle = WheelPose(before, wheel).axle;
  EXPECT_NEAR(turned.angle() * turned.axis().dot(axle), 0.0, 1e-9) << "it turns on the ground";
  for (const int other : {0, 1, 3}) EXPECT_EQ(to[drive.spin(other)], drive.q[drive.spin(other)]);
}

}  // namespace
}  // namespace locograph
