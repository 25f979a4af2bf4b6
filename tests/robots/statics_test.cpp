// Gravity torques, wrench torques and their derivatives with respect to the configuration.
#include <locograph/robots/statics.h>

#include "common/allocation_counter.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

constexpr double kStaticsStep = 1e-5;
constexpr double kStaticsTolerance = 1e-6;  // of the largest entry

class Statics : public ComparedTest<std::tuple<RobotFile, bool>> {
 protected:
  void SetUp() override {
    const RobotFile& file = std::get<0>(GetParam());
    const std::filesystem::path urdf = file_of(file.name, file.urdf, folder);
    if (!std::filesystem::exists(urdf)) GTEST_SKIP() << urdf << " is not on this machine";
    robot =
        std::make_unique<Robot>(Robot::load(urdf, {}, {.floating_base = std::get<1>(GetParam())}));
    state = std::make_unique<RobotState>(*robot);
    moved = std::make_unique<RobotState>(*robot);
    size = robot->tangent_size();
  }

  Eigen::VectorXd configuration(int sample) {
    return sample % 2 == 0 ? random_configuration(*robot, random)
                           : configuration_at_limits(*robot, random);
  }

  /// d f / d q by central differences; f maps a state to a vector of `rows` entries.
  template <class Function>
  Eigen::MatrixXd difference(const Eigen::VectorXd& q, int rows, const Function& f) {
    Eigen::MatrixXd result(rows, size);
    Eigen::VectorXd next(q.size()), plus(rows), minus(rows);
    for (int k = 0; k < size; ++k) {
      for (const double sign : {1.0, -1.0}) {
        const Eigen::VectorXd tangent = sign * kStaticsStep * Eigen::VectorXd::Unit(size, k);
        robot->integrate(q.data(), tangent.data(), next.data());
        moved->update(next.data());
        f(*moved, sign > 0.0 ? plus : minus);
      }
      result.col(k) = (plus - minus) / (2.0 * kStaticsStep);
    }
    return result;
  }

  void compare(const Eigen::MatrixXd& ours, const Eigen::MatrixXd& expected) {
    ComparedTest::compare(ours, expected, kStaticsTolerance);
  }

  TemporaryFolder folder;
  std::mt19937 random{30};
  const Eigen::Vector3d gravity = Eigen::Vector3d(1.3, -2.1, -9.4);
  std::unique_ptr<Robot> robot;
  std::unique_ptr<RobotState> state, moved;
  int size = 0;
};

TEST_P(Statics, GravityTorquesAreTheGradientOfThePotentialEnergy) {
  for (int sample = 0; sample < 4; ++sample) {
    const Eigen::VectorXd q = configuration(sample);
    state->update(q.data());
    Eigen::VectorXd torques(size);
    gravity_torques(*state, gravity, torques);
    const Eigen::MatrixXd gradient =
        difference(q, 1, [&](const RobotState& other, Eigen::VectorXd& energy) {
          energy[0] = 0.0;
          for (int l = 0; l < static_cast<int>(robot->links().size()); ++l) {
            const Link& link = robot->links()[static_cast<std::size_t>(l)];
            energy[0] -= link.mass * gravity.dot(other.world_from_link(l) * link.com);
          }
        });
    compare(torques, gradient.transpose());
  }
}

TEST_P(Statics, GravityTorqueDerivativeIsTheirDifference) {
  for (int sample = 0; sample < 6; ++sample) {
    const Eigen::VectorXd q = configuration(sample);
    state->update(q.data());
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Constant(size, size, 1e9);
    gravity_torque_derivative(*state, gravity, derivative);
    compare(derivative, difference(q, size, [&](const RobotState& other, Eigen::VectorXd& torques) {
              gravity_torques(other, gravity, torques);
            }));
  }
}

TEST_P(Statics, WrenchTorquesAreTheTransposedJacobianTimesTheWrench) {
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, size);
  for (const PointWrench& wrench : random_wrenches(*robot, 20, random)) {
    state->update(random_configuration(*robot, random).data());
    Eigen::Isometry3d link_from_point = Eigen::Isometry3d::Identity();
    link_from_point.translation() = wrench.point;
    state->frame_jacobian(wrench.link, link_from_point, jacobian);
    Eigen::Matrix<double, 6, 1> stacked;
    stacked << wrench.force, wrench.moment;
    Eigen::VectorXd torques = Eigen::VectorXd::Constant(size, 0.5);
    add_wrench_torques(*state, wrench, -0.7, torques);
    const Eigen::VectorXd expected =
        Eigen::VectorXd::Constant(size, 0.5) - 0.7 * jacobian.transpose() * stacked;
    EXPECT_LT((torques - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(Statics, WrenchTorqueDerivativeIsTheirDifference) {
  int sample = 0;
  for (PointWrench wrench : random_wrenches(*robot, 12, random)) {
    const Eigen::VectorXd q = configuration(++sample);
    if (sample % 3 == 1) wrench.moment.setZero();
    if (sample % 3 == 2) wrench.force.setZero();
    state->update(q.data());
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Zero(size, size);
    add_wrench_torque_derivative(*state, wrench, 1.0, derivative);
    const Eigen::MatrixXd expected =
        difference(q, size, [&](const RobotState& other, Eigen::VectorXd& torques) {
          torques.setZero();
          add_wrench_torques(other, wrench, 1.0, torques);
        });
    const double scale =
        wrench.force.norm() + wrench.moment.norm();  // the root may not move at all
    EXPECT_LT((derivative - expected).cwiseAbs().maxCoeff(),
              kStaticsTolerance * std::max(scale, expected.cwiseAbs().maxCoeff()));
  }
}

TEST_P(Statics, WrenchTorqueDerivativeIsAddedAndScaled) {
  for (const PointWrench& wrench : random_wrenches(*robot, 5, random)) {
    state->update(random_configuration(*robot, random).data());
    Eigen::MatrixXd once = Eigen::MatrixXd::Zero(size, size);
    Eigen::MatrixXd added = Eigen::MatrixXd::Constant(size, size, 100.0);
    add_wrench_torque_derivative(*state, wrench, 1.0, once);
    add_wrench_torque_derivative(*state, wrench, -2.5, added);
    const Eigen::MatrixXd expected = Eigen::MatrixXd::Constant(size, size, 100.0) - 2.5 * once;
    EXPECT_LT((added - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
    const std::span<const int> support = robot->support(wrench.link);
    for (int i = 0; i < robot->active_joint_count(); ++i) {
      if (std::any_of(support.begin(), support.end(), [&](int axis) {
            return robot->axes()[static_cast<std::size_t>(axis)].active == i;
          })) {
        continue;
      }
      const int entry = robot->base_tangent_size() + i;
      EXPECT_TRUE((added.row(entry).array() == 100.0).all());
      EXPECT_TRUE((added.col(entry).array() == 100.0).all());
    }
  }
}

TEST_P(Statics, StaticTorquesAreGravityLessWrenches) {
  const std::vector<PointWrench> wrenches = random_wrenches(*robot, 4, random);
  for (int sample = 0; sample < 4; ++sample) {
    const Eigen::VectorXd q = configuration(sample);
    state->update(q.data());
    Eigen::VectorXd torques = Eigen::VectorXd::Constant(size, 1e9), expected(size);
    static_torques(*state, gravity, wrenches, torques);
    gravity_torques(*state, gravity, expected);
    for (const PointWrench& wrench : wrenches) {
      add_wrench_torques(*state, wrench, -1.0, expected);
    }
    EXPECT_LT((torques - expected).norm(), 1e-12 * expected.norm());
    Eigen::MatrixXd derivative = Eigen::MatrixXd::Constant(size, size, 1e9);
    static_torque_derivative(*state, gravity, wrenches, derivative);
    compare(derivative, difference(q, size, [&](const RobotState& other, Eigen::VectorXd& there) {
              static_torques(other, gravity, wrenches, there);
            }));
  }
}

TEST_P(Statics, WritesIntoABlockOfALargerMatrix) {
  const std::vector<PointWrench> wrenches = random_wrenches(*robot, 2, random);
  state->update(random_configuration(*robot, random).data());
  Eigen::MatrixXd alone(size, size);
  Eigen::MatrixXd larger = Eigen::MatrixXd::Constant(size + 3, size + 2, 4.0);
  static_torque_derivative(*state, gravity, wrenches, alone);
  static_torque_derivative(*state, gravity, wrenches, larger.block(1, 2, size, size));
  EXPECT_EQ(larger.block(1, 2, size, size), alone);
  EXPECT_TRUE((larger.leftCols(2).array() == 4.0).all());
  EXPECT_TRUE((larger.row(0).array() == 4.0).all());
  EXPECT_TRUE((larger.bottomRows(2).array() == 4.0).all());
}

TEST_P(Statics, AllocatesNothing) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  const std::vector<PointWrench> wrenches = random_wrenches(*robot, 4, random);
  state->update(random_configuration(*robot, random).data());
  Eigen::VectorXd torques(size);
  Eigen::MatrixXd derivative(size, size);
  const long before = allocation_count();
  ASSERT_GT(before, 0);
  static_torques(*state, gravity, wrenches, torques);
  static_torque_derivative(*state, gravity, wrenches, derivative);
  EXPECT_EQ(allocation_count(), before);
  EXPECT_TRUE(torques.allFinite());
}

std::vector<RobotFile> with_small_robots() {
  std::vector<RobotFile> files = public_and_own_robots();
  files.push_back({"small", {}});
  files.push_back({"mimic", {}});
  return files;
}

INSTANTIATE_TEST_SUITE_P(All, Statics,
                         testing::Combine(testing::ValuesIn(with_small_robots()), testing::Bool()),
                         floating_or_fixed<RobotFile>);

}  // namespace
}  // namespace locograph::test
