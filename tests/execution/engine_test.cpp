// What MuJoCo computes of a robot against what we do, and whether it keeps what physics keeps.
#include <locograph/common/error.h>
#include <locograph/execution/engine.h>
#include <locograph/robots/dynamics.h>

#include <limits>
#include <memory>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

constexpr double kTolerance = 1e-9;  // of the largest entry

class DynamicsOfMujoco : public ComparedTest<std::tuple<RobotFile, bool>> {
 protected:
  void SetUp() override {
    const std::filesystem::path& file = std::get<0>(GetParam()).urdf;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not on this machine";
    robot =
        std::make_unique<Robot>(Robot::load(file, {}, {.floating_base = std::get<1>(GetParam())}));
    state = std::make_unique<RobotState>(*robot);
    dynamics = std::make_unique<RobotDynamics>(*robot);
    size = robot->tangent_size();
    engine = std::make_unique<Engine>(*robot, std::span<const EndEffector>(), World{});
  }

  /// Both robots where the drawn numbers say.
  void place(double speed) {
    const Eigen::VectorXd q = random_configuration(*robot, random);
    velocity = random_vector(size, speed, random);
    state->update(q.data());
    engine->set_state(q, velocity);
    compare(engine->configuration(), q, 1e-15);
    if (speed > 0.0) compare(engine->velocity(), velocity, 1e-14);
  }

  std::mt19937 random = std::mt19937(31);
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state;
  std::unique_ptr<RobotDynamics> dynamics;
  std::unique_ptr<Engine> engine;
  Eigen::VectorXd velocity;
  int size = 0;
};

TEST_P(DynamicsOfMujoco, HaveOurMassMatrix) {
  Eigen::MatrixXd mass(size, size);
  for (int sample = 0; sample < 10; ++sample) {
    place(1.0);
    dynamics->mass_matrix(*state, mass);
    const Eigen::MatrixXd theirs = engine->mass_matrix();
    // Each entry by the inertias it couples: a wrist is judged by its own, not by the trunk's.
    const Eigen::VectorXd scale = mass.diagonal().cwiseSqrt().cwiseInverse();
    compare(scale.asDiagonal() * theirs * scale.asDiagonal(),
            scale.asDiagonal() * mass * scale.asDiagonal(), kTolerance);
  }
}

TEST_P(DynamicsOfMujoco, HaveOurGravityTorques) {
  Eigen::VectorXd torques(size);
  for (int sample = 0; sample < 10; ++sample) {
    place(0.0);
    gravity_torques(*state, standard_gravity(), torques);
    compare(engine->bias_forces(), torques, kTolerance);
  }
}

TEST_P(DynamicsOfMujoco, HaveOurBiasForces) {
  Eigen::VectorXd torques(size);
  for (int sample = 0; sample < 10; ++sample) {
    place(3.0);
    dynamics->bias_forces(*state, velocity, torques);
    compare(engine->bias_forces(), torques, kTolerance);
  }
}

TEST_P(DynamicsOfMujoco, HaveOurInverseDynamics) {
  Eigen::VectorXd torques(size);
  for (int sample = 0; sample < 10; ++sample) {
    place(3.0);
    const Eigen::VectorXd acceleration = random_vector(size, 10.0, random);
    dynamics->inverse_dynamics(*state, velocity, acceleration, {}, torques);
    compare(engine->inverse_dynamics(acceleration), torques, kTolerance);
  }
}

TEST_P(DynamicsOfMujoco, HaveOurJacobians) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, size);
  for (int sample = 0; sample < 3; ++sample) {
    place(1.0);
    for (int link = 0; link < static_cast<int>(robot->links().size()); ++link) {
      const Eigen::Vector3d point = random_vector(3, 0.3, random);
      state->frame_jacobian(link, Eigen::Isometry3d(Eigen::Translation3d(point)), jacobian);
      if (jacobian.isZero(0.0)) {
        EXPECT_TRUE(engine->frame_jacobian(link, point).isZero(0.0));
      } else {
        compare(engine->frame_jacobian(link, point), jacobian, kTolerance);
      }
    }
  }
}

/// Energy [J], and momentum in the world [N s, N m s about the centre of mass].
struct Kept {
  double energy;
  Eigen::Vector3d linear, angular;

  Kept(const Engine& engine, RobotState& state, RobotDynamics& dynamics) {
    const Robot& robot = state.robot();
    const Eigen::VectorXd q = engine.configuration(), velocity = engine.velocity();
    state.update(q.data());
    Eigen::MatrixXd mass(robot.tangent_size(), robot.tangent_size());
    dynamics.mass_matrix(state, mass);
    const Eigen::VectorXd momentum = mass * velocity;
    const Eigen::Vector3d com = state.center_of_mass();
    const Eigen::Matrix3d rotation = state.world_from_link(0).linear();
    energy = 0.5 * velocity.dot(momentum) + 9.81 * robot.total_mass() * com.z();
    linear = rotation * momentum.head<3>();
    angular = rotation * momentum.segment<3>(3) -
              (com - state.world_from_link(0).translation()).cross(linear);
  }
};

TEST_P(DynamicsOfMujoco, KeepEnergyAndMomentumInFreeFlight) {
  if (!robot->floating_base()) GTEST_SKIP() << "a robot that flies";
  *engine =
      Engine(*robot, {}, {},
             {.timestep_s = 0.00025, .integrator = Integrator::kRungeKutta4, .constraints = false});
  place(0.5);
  const Kept before(*engine, *state, *dynamics);
  while (engine->time_s() < 1.0 - 1e-9) engine->step();
  ASSERT_FALSE(engine->diverged());
  const Kept after(*engine, *state, *dynamics);
  const double weight = 9.81 * robot->total_mass();
  // What gravity has moved in this second is the scale of both.
  EXPECT_NEAR(after.energy, before.energy, 1e-6 * weight * 4.905);
  EXPECT_LT((after.linear - before.linear + weight * Eigen::Vector3d::UnitZ()).norm(),
            1e-6 * weight);
  EXPECT_LT((after.angular - before.angular).norm(), 1e-6 * before.angular.norm());
}

INSTANTIATE_TEST_SUITE_P(All, DynamicsOfMujoco,
                         testing::Combine(testing::ValuesIn(public_and_own_robots()),
                                          testing::Bool()),
                         floating_or_fixed<RobotFile>);

class EngineWithMimicJoints : public ComparedTest<bool> {};

TEST_P(EngineWithMimicJoints, HasOurDynamicsAndKeepsThemTogether) {
  const TemporaryFolder folder;
  const Robot robot = Robot::load(folder.write("mimic.urdf", mimic_robot_urdf()), {},
                                  {.floating_base = GetParam()});
  RobotState state(robot);
  RobotDynamics dynamics(robot);
  Engine engine(robot, {}, {});
  std::mt19937 random(31);
  const int size = robot.tangent_size();
  for (int sample = 0; sample < 10; ++sample) {
    const Eigen::VectorXd q = random_configuration(robot, random);
    const Eigen::VectorXd velocity = random_vector(size, 1.0, random);
    const Eigen::VectorXd acceleration = random_vector(size, 10.0, random);
    state.update(q.data());
    engine.set_state(q, velocity);
    compare(engine.configuration(), q, 1e-15);
    compare(engine.velocity(), velocity, 1e-14);
    Eigen::MatrixXd mass(size, size);
    dynamics.mass_matrix(state, mass);
    compare(engine.mass_matrix(), mass, kTolerance);
    Eigen::VectorXd torques(size);
    dynamics.inverse_dynamics(state, velocity, acceleration, {}, torques);
    compare(engine.inverse_dynamics(acceleration), torques, kTolerance);
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, size);
    const int thumb = robot.link_index("thumb");
    state.frame_jacobian(thumb, Eigen::Isometry3d::Identity(), jacobian);
    compare(engine.frame_jacobian(thumb, Eigen::Vector3d::Zero()), jacobian, kTolerance);
  }
  // Moved by gravity, the thumb is where the joints that lead say.
  engine.set_state(robot.neutral_configuration(), Eigen::VectorXd::Zero(size));
  for (int i = 0; i < 200; ++i) engine.step();
  const Eigen::VectorXd q = engine.configuration();
  EXPECT_GT((q - robot.neutral_configuration()).norm(), 0.05);
  state.update(q.data());
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, size);
  const int thumb = robot.link_index("thumb");
  state.frame_jacobian(thumb, Eigen::Isometry3d::Identity(), jacobian);
  compare(engine.frame_jacobian(thumb, Eigen::Vector3d::Zero()), jacobian, 5e-3);
}

INSTANTIATE_TEST_SUITE_P(FixedOrFloating, EngineWithMimicJoints, testing::Bool());

TEST(Engine, ObstaclesMoveAndComeAndGo) {
  const Robot robot =
      Robot::load(model("go2/go2.urdf"), model("go2/go2.srdf"), {.floating_base = true});
  Obstacle cart;
  cart.size = Eigen::Vector3d::Constant(0.2);
  cart.world_from_obstacle.translation().x() = 3.0;
  cart.motion = {{.time_s = 1.0}, {.time_s = 2.0}};  // at the base
  cart.motion[1].pose.translation().x() = 3.0;
  cart.vanishes_s = 2.5;
  Obstacle ball;
  ball.shape = Obstacle::Shape::kSphere;
  ball.size.x() = 0.1;
  ball.appears_s = 4.0;
  Engine engine(robot, {}, {.obstacles = {cart, ball}});
  const auto penetration_m = [&](double time_s) {
    engine.set_obstacle_time(time_s);
    engine.set_state(robot.neutral_configuration(), Eigen::VectorXd::Zero(robot.tangent_size()));
    return engine.penetration_m();
  };
  EXPECT_EQ(penetration_m(0.0), 0.0);
  EXPECT_GT(penetration_m(1.0), 0.05);
  EXPECT_EQ(penetration_m(2.4), 0.0);
  EXPECT_EQ(penetration_m(3.0), 0.0);
  EXPECT_GT(penetration_m(4.5), 0.05);
}

TEST(Engine, ARobotTouchesItself) {
  const Robot robot =
      Robot::load(model("go2/go2.urdf"), model("go2/go2.srdf"), {.floating_base = true});
  Engine engine(robot, {}, {});
  Eigen::VectorXd q = robot.neutral_configuration();
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(robot.tangent_size());
  engine.set_state(q, still);
  EXPECT_EQ(engine.penetration_m(), 0.0);
  // Both front feet to the middle.
  const auto turn = [&](const char* joint, double by_rad) {
    for (int i = 0; i < robot.active_joint_count(); ++i) {
      if (robot.active_joint(i).name == joint) q[robot.base_configuration_size() + i] += by_rad;
    }
  };
  turn("FL_hip_joint", -0.6);
  turn("FR_hip_joint", 0.6);
  engine.set_state(q, still);
  EXPECT_GT(engine.penetration_m(), 0.0);
  engine.step();
  const Engine::OtherTouch touch = engine.other_touch();
  EXPECT_GT(touch.pressing_N, 1.0);
  ASSERT_GE(touch.touched, 0);
  const std::string& one = robot.links()[static_cast<std::size_t>(touch.link)].name;
  const std::string& other = robot.links()[static_cast<std::size_t>(touch.touched)].name;
  EXPECT_TRUE(one.starts_with("F") && other.starts_with("F")) << one << " and " << other;
  EXPECT_NE(one.substr(0, 2), other.substr(0, 2));
  EXPECT_EQ(engine.total_contact_force().norm(), 0.0) << "of the world";
}

TEST(Engine, RefusesVectorsOfAnotherSize) {
  const Robot robot = Robot::load(model("go2/go2.urdf"));
  Engine engine(robot, {}, {});
  const Eigen::VectorXd none;
  EXPECT_THROW(engine.set_state(none, Eigen::VectorXd::Zero(robot.tangent_size())), Error);
  EXPECT_THROW(engine.set_state(robot.neutral_configuration(), none), Error);
  EXPECT_THROW(engine.set_torques(none), Error);
  EXPECT_THROW(engine.inverse_dynamics(none), Error);
}

TEST(Engine, RefusesNumbersThatAreNone) {
  const Robot robot = Robot::load(model("go2/go2.urdf"), {}, {.floating_base = true});
  Engine engine(robot, {}, {});
  const Eigen::VectorXd q = robot.neutral_configuration();
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(robot.tangent_size());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Eigen::VectorXd wrong = q;
  wrong[9] = nan;
  EXPECT_THROW(engine.set_state(wrong, rest), Error);
  wrong = q;
  wrong.segment<4>(3).setZero();
  EXPECT_THROW(engine.set_state(wrong, rest), Error);
  EXPECT_THROW(engine.set_state(q, Eigen::VectorXd::Constant(rest.size(), nan)), Error);
  EXPECT_THROW(engine.set_torques(Eigen::VectorXd::Constant(robot.active_joint_count(), nan)),
               Error);
  EXPECT_THROW(engine.contact_force(-1), Error);
  EXPECT_THROW(engine.contact_force(0), Error);
  EXPECT_THROW(engine.frame_jacobian(-1, Eigen::Vector3d::Zero()), Error);
  EXPECT_THROW(
      engine.frame_jacobian(static_cast<int>(robot.links().size()), Eigen::Vector3d::Zero()),
      Error);
  for (const double timestep_s : {0.0, -1.0, 1e9, nan}) {
    EXPECT_THROW(Engine(robot, {}, {}, {.timestep_s = timestep_s}), Error) << timestep_s;
  }
}

TEST(Engine, MeshesTouchWithTheirHulls) {
  const TemporaryFolder folder;
  std::string stl = "solid wedge\n";  // of 0.2 m, its edge on top of the middle, scaled by half
  const auto facet = [&](const std::string& a, const std::string& b, const std::string& c) {
    stl += "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
           "\nendloop\nendfacet\n";
  };
  facet("-0.2 -0.2 0", "0.2 -0.2 0", "0.2 0.2 0");
  facet("-0.2 -0.2 0", "0.2 0.2 0", "-0.2 0.2 0");
  facet("-0.2 -0.2 0", "0.2 -0.2 0", "0 0 0.4");
  facet("0.2 0.2 0", "-0.2 0.2 0", "0 0 0.4");
  folder.write("wedge.stl", stl + "endsolid wedge\n");
  const Robot robot = Robot::load(
      folder.write("wedge.urdf",
                   "<robot name='wedge'><link name='wedge'><inertial><mass value='1'/><inertia "
                   "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision>"
                   "<origin xyz='0 0 0.1'/><geometry><mesh filename='wedge.stl' "
                   "scale='0.5 0.5 0.5'/></geometry></collision></link></robot>"),
      {}, {.floating_base = true});
  World world;
  world.surfaces.emplace_back();  // the plane z = 0
  const auto penetration_m = [&](double z, const Eigen::Quaterniond& turned) {
    Engine engine(robot, {}, world);
    Eigen::VectorXd q = robot.neutral_configuration();
    q[2] = z;
    q.segment<4>(3) = turned.coeffs();
    engine.set_state(q, Eigen::VectorXd::Zero(robot.tangent_size()));
    return engine.penetration_m();
  };
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond on_its_head(0.0, 1.0, 0.0, 0.0);
  EXPECT_EQ(penetration_m(-0.099, upright), 0.0);
  EXPECT_NEAR(penetration_m(-0.101, upright), 0.001, 1e-5);
  EXPECT_EQ(penetration_m(0.301, on_its_head), 0.0);
  EXPECT_NEAR(penetration_m(0.299, on_its_head), 0.001, 1e-5);
}

TEST(Engine, FlatMeshesArePlates) {
  const TemporaryFolder folder;
  folder.write("flat.stl",
               "solid flat\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0.2 0 0\n"
               "vertex 0 0.2 0\nendloop\nendfacet\nendsolid flat\n");
  const Robot robot = Robot::load(
      folder.write("flat.urdf",
                   "<robot name='flat'><link name='flat'><inertial><mass value='1'/><inertia "
                   "ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision>"
                   "<geometry><mesh filename='flat.stl'/></geometry></collision></link></robot>"),
      {}, {.floating_base = true});
  World world;
  world.surfaces.emplace_back();
  Engine engine(robot, {}, world);
  Eigen::VectorXd q = robot.neutral_configuration();
  for (const auto& [z, deep_m] : {std::pair(0.002, 0.0), std::pair(-0.001, 0.002)}) {
    q[2] = z;
    engine.set_state(q, Eigen::VectorXd::Zero(robot.tangent_size()));
    EXPECT_NEAR(engine.penetration_m(), deep_m, 1e-5);
  }
}

TEST(Engine, KeepsTorquesWithinTheEfforts) {
  const TemporaryFolder folder;
  const Robot robot = Robot::load(folder.write("small.urdf", small_robot_urdf()));
  Engine within(robot, {}, {}), beyond(robot, {}, {});
  const Eigen::VectorXd q = robot.neutral_configuration();
  for (Engine* engine : {&within, &beyond}) {
    engine->set_state(q, Eigen::VectorXd::Zero(robot.tangent_size()));
  }
  within.set_torques(Eigen::Vector2d(20.0, -30.0));
  beyond.set_torques(Eigen::Vector2d(500.0, -500.0));
  within.step();
  beyond.step();
  EXPECT_GT(within.velocity().norm(), 1e-3);
  EXPECT_EQ(within.velocity(), beyond.velocity());
}

}  // namespace
}  // namespace locograph::test
