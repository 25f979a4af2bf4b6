// Robots that are dropped come to rest, and what they stand on bears their weight.
#include <locograph/common/error.h>
#include <locograph/execution/engine.h>
#include <locograph/robots/robot_state.h>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

struct Dropped {
  std::string name;
  std::string waist;  // the joint that moves, others are frozen
  ContactKind kind;
  std::vector<std::string> links;
  double radius_m;
};

void PrintTo(const Dropped& dropped, std::ostream* stream) { *stream << dropped.name; }

class DroppedRobots : public testing::TestWithParam<Dropped> {
 protected:
  const Robot robot = Robot::load(model(GetParam().name + "/" + GetParam().name + ".urdf"),
                                  model(GetParam().name + "/" + GetParam().name + ".srdf"),
                                  {.active_joints = {GetParam().waist}});

  std::vector<EndEffector> effectors() const {
    std::vector<EndEffector> result;
    for (const std::string& link : GetParam().links) {
      EndEffector effector{.name = link, .link = link, .kind = GetParam().kind};
      if (effector.kind == ContactKind::kSurface) effector.half_x_m = 0.08;
      if (effector.kind == ContactKind::kSurface) effector.half_y_m = 0.035;
      effector.radius_m = GetParam().radius_m;
      effector.friction = 0.6;
      effector.max_force_N = 2000.0;
      result.push_back(effector);
    }
    return result;
  }

  /// At home, its end effectors 1 cm above what it falls on.
  void expect_rest_on(const World& world, double height_m) const {
    Eigen::VectorXd q = robot.named_configuration("home");
    RobotState state(robot);
    state.update(q.data());
    const int link = robot.link_index(GetParam().links.front());
    q[2] += height_m + 0.01 + GetParam().radius_m - state.world_from_link(link).translation().z();
    Engine engine(robot, effectors(), world);
    engine.set_state(q, Eigen::VectorXd::Zero(robot.tangent_size()));
    EXPECT_EQ(engine.total_contact_force().norm(), 0.0);
    const double place = q.tail<1>()[0];
    while (engine.time_s() < 2.0 - 1e-9) {
      const double torque = 500.0 * (place - engine.configuration().tail<1>()[0]) -
                            20.0 * engine.velocity().tail<1>()[0];
      engine.set_torques(Eigen::VectorXd::Constant(1, torque));
      engine.step();
    }
    ASSERT_FALSE(engine.diverged());
    EXPECT_LT(engine.velocity().norm(), 5e-3);
    EXPECT_NEAR(engine.configuration()[2], q[2] - 0.01, 2e-3);

    const double weight = 9.81 * robot.total_mass();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < GetParam().links.size(); ++i) {
      const Eigen::Vector3d force = engine.contact_force(static_cast<int>(i));
      EXPECT_GE(force.z(), 0.0);
      sum += force;
    }
    EXPECT_LT((sum - weight * Eigen::Vector3d::UnitZ()).norm(), 1e-3 * weight) << sum.transpose();
    EXPECT_LT((sum - engine.total_contact_force()).norm(), 1e-9 * weight);
    RecordProperty("error_of_weight",
                   scientific((sum - weight * Eigen::Vector3d::UnitZ()).norm() / weight));
    RecordProperty("velocity", scientific(engine.velocity().norm()));
  }
};

/// COMAN+ by both hands on a bar, its head down.
TEST(HangingRobot, IsHeldByItsHandsUntilTheyOpen) {
  const Robot robot =
      Robot::load(model("coman_plus/coman_plus.urdf"), model("coman_plus/coman_plus.srdf"),
                  {.active_joints = {"WaistYaw"}});
  std::vector<EndEffector> hands;
  for (const char* link : {"LBall", "RBall"}) {
    hands.push_back({.name = link,
                     .link = link,
                     .kind = ContactKind::kGrasp,
                     .max_force_N = 1000.0,
                     .max_moment_Nm = 100.0});
  }
  Eigen::VectorXd q = robot.named_configuration("home");
  RobotState state(robot);
  state.update(q.data());
  const auto hand = [&](std::size_t i) {
    return state.world_from_link(robot.link_index(hands[i].link)).translation().eval();
  };
  // Turned about the bar so that its centre of mass is under it.
  const Eigen::Vector3d bar = (hand(0) - hand(1)).normalized();
  const Eigen::Vector3d middle = 0.5 * (hand(0) + hand(1));
  Eigen::Vector3d hangs = state.center_of_mass() - middle;
  hangs -= hangs.dot(bar) * bar;
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  down -= down.dot(bar) * bar;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(hangs, down);
  q.segment<4>(3) = (turn * Eigen::Quaterniond(q[6], q[3], q[4], q[5])).coeffs();
  state.update(q.data());
  for (EndEffector& effector : hands) {
    const Eigen::Matrix3d link = state.world_from_link(robot.link_index(effector.link)).linear();
    const Eigen::Vector3d along = (hand(0) - hand(1)).normalized();
    effector.normal = link.transpose() * along.unitOrthogonal();
    effector.forward = link.transpose() * along.cross(along.unitOrthogonal());
  }
  Engine engine(robot, hands, {});
  engine.set_state(q, Eigen::VectorXd::Zero(robot.tangent_size()));
  EXPECT_FALSE(engine.grasps(0));
  const Eigen::Vector3d left = hand(0), right = hand(1);
  engine.grasp(0, left, left - right);
  engine.grasp(1, right, right - left);
  EXPECT_TRUE(engine.grasps(0));
  const double weight = 9.81 * robot.total_mass();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto hold_waist = [&] {
    const double torque =
        -500.0 * engine.configuration().tail<1>()[0] - 20.0 * engine.velocity().tail<1>()[0];
    engine.set_torques(Eigen::VectorXd::Constant(1, torque));
  };
  for (int i = 0; i < 2000; ++i) {
    hold_waist();
    engine.step();
    const Eigen::Vector3d both = engine.contact_force(0) + engine.contact_force(1);
    EXPECT_LT((both - engine.total_contact_force()).norm(), 1e-9 * weight);
    if (i >= 1000) mean += both / 1000.0;
  }
  ASSERT_FALSE(engine.diverged());
  EXPECT_LT((mean - weight * Eigen::Vector3d::UnitZ()).norm(), 0.01 * weight) << mean.transpose();
  state.update(engine.configuration().data());
  EXPECT_LT((hand(0) - left).norm(), 2e-3);
  EXPECT_LT((hand(1) - right).norm(), 2e-3);
  // Forces and moments hold it about its centre of mass, too.
  Eigen::Vector3d moment = engine.contact_moment(0) + engine.contact_moment(1);
  moment += (hand(0) - state.center_of_mass()).cross(engine.contact_force(0));
  moment += (hand(1) - state.center_of_mass()).cross(engine.contact_force(1));
  EXPECT_LT(moment.norm(), 0.02 * weight);

  engine.release(0);
  engine.release(1);
  EXPECT_FALSE(engine.grasps(0));
  const double height = engine.configuration()[2];
  for (int i = 0; i < 200; ++i) engine.step();
  EXPECT_EQ(engine.total_contact_force().norm(), 0.0);
  EXPECT_LT(engine.configuration()[2], height - 0.15);
  EXPECT_THROW(engine.grasp(2, left, right), Error);
}

TEST_P(DroppedRobots, RestOnAPlane) { expect_rest_on({.surfaces = {ground()}}, 0.0); }

TEST_P(DroppedRobots, RestOnABox) {
  SolidBox box;
  box.size_m = Eigen::Vector3d(4.0, 4.0, 0.4);
  Surface top = ground();
  top.half_x_m = top.half_y_m = 2.0;
  top.world_from_surface.translation().z() = 0.2;
  expect_rest_on({.surfaces = {top}, .solids = {box}}, 0.2);
}

INSTANTIATE_TEST_SUITE_P(
    All, DroppedRobots,
    testing::Values(
        Dropped{"coman_plus", "WaistYaw", ContactKind::kSurface, {"l_sole", "r_sole"}, 0.0},
        Dropped{"centauro",
                "torso_yaw",
                ContactKind::kWheel,
                {"wheel_1", "wheel_2", "wheel_3", "wheel_4"},
                0.078},
        Dropped{"go2",
                "FL_hip_joint",
                ContactKind::kPoint,
                {"FL_foot", "FR_foot", "RL_foot", "RR_foot"},
                0.022}),
    [](const testing::TestParamInfo<Dropped>& info) { return info.param.name; });

}  // namespace
}  // namespace locograph::test
