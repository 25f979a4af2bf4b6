// Robots that are dropped come to rest, and what they stand on bears their weight.
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
