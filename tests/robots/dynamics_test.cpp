// Mass matrix, bias forces and inverse dynamics agree with each other, with the kinetic energy of
// the links and with the balance of power.
#include <locograph/common/error.h>
#include <locograph/robots/dynamics.h>
#include <locograph/robots/kinematic_tree.h>

#include <Eigen/Cholesky>

#include "common/allocation_counter.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

struct DynamicsCase {
  std::string name;
  std::filesystem::path urdf;  // empty: one of the small robots
  std::filesystem::path srdf = {};
  std::vector<std::string> active = {};
};

void PrintTo(const DynamicsCase& used, std::ostream* stream) { *stream << used.name; }

class Dynamics : public testing::TestWithParam<std::tuple<DynamicsCase, bool>> {
 protected:
  void SetUp() override {
    const DynamicsCase& used = std::get<0>(GetParam());
    const std::filesystem::path urdf = file_of(used.name, used.urdf, folder);
    if (!std::filesystem::exists(urdf)) GTEST_SKIP() << urdf << " is not on this machine";
    robot = std::make_unique<Robot>(Robot::load(
        urdf, used.srdf, {.floating_base = std::get<1>(GetParam()), .active_joints = used.active}));
    state = std::make_unique<RobotState>(*robot);
    dynamics = std::make_unique<RobotDynamics>(*robot, gravity);
    size = robot->tangent_size();
    mass.resize(size, size);
    torques.resize(size);
  }

  Eigen::VectorXd inverse_dynamics(const Eigen::VectorXd& velocity,
                                   const Eigen::VectorXd& acceleration,
                                   std::span<const PointWrench> wrenches = {}) {
    Eigen::VectorXd result(size);
    dynamics->inverse_dynamics(*state, velocity, acceleration, wrenches, result);
    return result;
  }

  /// Kinetic and potential energy [J].
  double energy(const Eigen::VectorXd& q, const Eigen::VectorXd& velocity) {
    state->update(q.data());
    dynamics->mass_matrix(*state, mass);
    return 0.5 * velocity.dot(mass * velocity) -
           robot->total_mass() * gravity.dot(state->center_of_mass());
  }

  TemporaryFolder folder;
  std::mt19937 random{40};
  const Eigen::Vector3d gravity = Eigen::Vector3d(1.3, -2.1, -9.4);
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state;
  std::unique_ptr<RobotDynamics> dynamics;
  Eigen::MatrixXd mass;
  Eigen::VectorXd torques;
  int size = 0;
};

TEST_P(Dynamics, HaveTheMassMatrixOfTheKineticEnergyOfTheLinks) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, size);
  for (int sample = 0; sample < 3; ++sample) {
    state->update(random_configuration(*robot, random).data());
    dynamics->mass_matrix(*state, mass);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(size, size);
    for (int l = 0; l < static_cast<int>(robot->links().size()); ++l) {
      const Link& link = robot->links()[static_cast<std::size_t>(l)];
      Eigen::Isometry3d link_from_com = Eigen::Isometry3d::Identity();
      link_from_com.translation() = link.com;
      state->frame_jacobian(l, link_from_com, jacobian);
      const Eigen::Matrix3d rotation = state->world_from_link(l).linear();
      const Eigen::Matrix3d inertia = rotation * link.inertia * rotation.transpose();
      expected += link.mass * jacobian.topRows<3>().transpose() * jacobian.topRows<3>() +
                  jacobian.bottomRows<3>().transpose() * inertia * jacobian.bottomRows<3>();
    }
    EXPECT_LT((mass - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
  }
}

TEST_P(Dynamics, HaveASymmetricPositiveDefiniteMassMatrix) {
  for (int sample = 0; sample < 5; ++sample) {
    state->update(random_configuration(*robot, random).data());
    mass.setConstant(1e9);
    dynamics->mass_matrix(*state, mass);
    EXPECT_EQ(mass, Eigen::MatrixXd(mass.transpose()));
    const Eigen::LLT<Eigen::MatrixXd> factor(mass);
    EXPECT_EQ(factor.info(), Eigen::Success);
    if (robot->floating_base()) {
      EXPECT_DOUBLE_EQ(mass(0, 0), mass(2, 2));
      EXPECT_NEAR(mass(0, 0), robot->total_mass(), 1e-12 * robot->total_mass());
    }
  }
}

TEST_P(Dynamics, AreLinearInTheAcceleration) {
  for (int sample = 0; sample < 5; ++sample) {
    state->update(random_configuration(*robot, random).data());
    const Eigen::VectorXd velocity = random_vector(size, 3.0, random);
    const Eigen::VectorXd acceleration = random_vector(size, 10.0, random);
    const Eigen::VectorXd expected = inverse_dynamics(velocity, acceleration);
    dynamics->mass_matrix(*state, mass);
    dynamics->bias_forces(*state, velocity, torques);
    EXPECT_LT((mass * acceleration + torques - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(Dynamics, AreStaticAtRest) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(size);
  for (int sample = 0; sample < 5; ++sample) {
    state->update(random_configuration(*robot, random).data());
    gravity_torques(*state, gravity, torques);
    EXPECT_LT((inverse_dynamics(zero, zero) - torques).norm(), 1e-12 * torques.norm());
    Eigen::VectorXd bias(size);
    dynamics->bias_forces(*state, zero, bias);
    EXPECT_LT((bias - torques).norm(), 1e-12 * torques.norm());

    const std::vector<PointWrench> wrenches = random_wrenches(*robot, 3, random);
    static_torques(*state, gravity, wrenches, torques);
    EXPECT_LT((inverse_dynamics(zero, zero, wrenches) - torques).norm(), 1e-12 * torques.norm());
  }
}

// E(t) along q(t +- s) = q (+) +-s v, v(t +- s) = v +- s a; terms of even order cancel.
TEST_P(Dynamics, BalanceThePower) {
  constexpr double kPowerStep = 1e-5;
  for (int sample = 0; sample < 5; ++sample) {
    const Eigen::VectorXd q = random_configuration(*robot, random);
    const Eigen::VectorXd velocity = random_vector(size, 1.0, random);
    const Eigen::VectorXd acceleration = random_vector(size, 3.0, random);
    state->update(q.data());
    const Eigen::VectorXd driving = inverse_dynamics(velocity, acceleration);
    Eigen::VectorXd next(q.size());
    Eigen::VectorXd tangent = kPowerStep * velocity;
    robot->integrate(q.data(), tangent.data(), next.data());
    const double after = energy(next, velocity + kPowerStep * acceleration);
    tangent = -tangent;
    robot->integrate(q.data(), tangent.data(), next.data());
    const double before = energy(next, velocity - kPowerStep * acceleration);
    const double power = (after - before) / (2.0 * kPowerStep);
    EXPECT_NEAR(power, velocity.dot(driving), 1e-6 * driving.norm() * velocity.norm());
  }
}

TEST_P(Dynamics, DoNotDependOnWhatWasAskedBefore) {
  std::mt19937 other_random(41);
  const Eigen::VectorXd q = random_configuration(*robot, random);
  const Eigen::VectorXd velocity = random_vector(size, 1.0, random);
  state->update(q.data());
  const Eigen::VectorXd first = inverse_dynamics(velocity, velocity);
  dynamics->mass_matrix(*state, mass);
  state->update(random_configuration(*robot, other_random).data());
  Eigen::MatrixXd other_mass(size, size);
  dynamics->mass_matrix(*state, other_mass);
  inverse_dynamics(2.0 * velocity, -velocity);
  state->update(q.data());
  EXPECT_EQ(inverse_dynamics(velocity, velocity), first);
  dynamics->mass_matrix(*state, other_mass);
  EXPECT_EQ(other_mass, mass);
}

TEST_P(Dynamics, AllocateNothingOnceBuilt) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const Eigen::VectorXd velocity = random_vector(size, 1.0, random);
  const PointWrench wrenches[] = {{.link = 0, .force = Eigen::Vector3d(1.0, 2.0, 3.0)}};
  const long before = allocation_count();
  ASSERT_GT(before, 0);
  dynamics->mass_matrix(*state, mass);
  dynamics->inverse_dynamics(*state, velocity, velocity, wrenches, torques);
  dynamics->bias_forces(*state, velocity, torques);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(torques.allFinite());
}

std::vector<DynamicsCase> dynamics_cases() {
  std::vector<DynamicsCase> all;
  for (const RobotFile& file : public_and_own_robots()) all.push_back({file.name, file.urdf});
  all.push_back({"small", {}});
  all.push_back({"mimic", {}});
  all.push_back({"centauro_with_frozen_arms",
                 model("centauro/centauro.urdf"),
                 model("centauro/centauro.srdf"),
                 {"lower_body"}});
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, Dynamics,
                         testing::Combine(testing::ValuesIn(dynamics_cases()), testing::Bool()),
                         floating_or_fixed<DynamicsCase>);

TEST(BodyInertias, TakeFixedAndFrozenLinksTogether) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"),
                                  {.active_joints = {"lower_body"}});
  const std::vector<BodyInertia> bodies = body_inertias(robot);
  ASSERT_EQ(bodies.size(), robot.tree().bodies.size());
  double sum = 0.0;
  for (const BodyInertia& body : bodies) sum += body.mass;
  EXPECT_NEAR(sum, robot.total_mass(), 1e-9);
  const RobotState state(robot);
  Eigen::Vector3d com = Eigen::Vector3d::Zero();
  double mass = 0.0;
  for (std::size_t l = 0; l < robot.links().size(); ++l) {
    if (robot.tree().body_of_link[l] != 0) continue;
    com +=
        robot.links()[l].mass * (state.world_from_link(static_cast<int>(l)) * robot.links()[l].com);
    mass += robot.links()[l].mass;
  }
  EXPECT_LT((bodies[0].com - com / mass).norm(), 1e-12);
}

}  // namespace
}  // namespace locograph::test
