// integrate() and difference() on the configuration space.
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

class Configurations : public testing::TestWithParam<bool> {
 protected:
  const Robot robot =
      Robot::load(model("centauro/centauro.urdf"), {}, {.floating_base = GetParam()});
  std::mt19937 random{10};
};

TEST_P(Configurations, ComeBackFromADifference) {
  for (int sample = 0; sample < 50; ++sample) {
    const Eigen::VectorXd from = random_configuration(robot, random);
    const Eigen::VectorXd to = random_configuration(robot, random);
    Eigen::VectorXd tangent(robot.tangent_size()), back(robot.configuration_size());
    robot.difference(from.data(), to.data(), tangent.data());
    robot.integrate(from.data(), tangent.data(), back.data());
    if (robot.floating_base() && back.segment<4>(3).dot(to.segment<4>(3)) < 0.0) {
      back.segment<4>(3) = -back.segment<4>(3).eval();
    }
    EXPECT_LT((back - to).norm(), 1e-12);
  }
}

TEST_P(Configurations, ComeBackFromAStep) {
  for (const double scale : {2.0, 1e-3, 1e-5, 1e-9, 0.0}) {
    const Eigen::VectorXd from = random_configuration(robot, random);
    const Eigen::VectorXd tangent = random_vector(robot.tangent_size(), scale / 2.0, random);
    Eigen::VectorXd to(robot.configuration_size()), back(robot.tangent_size());
    robot.integrate(from.data(), tangent.data(), to.data());
    robot.difference(from.data(), to.data(), back.data());
    EXPECT_LT((back - tangent).norm(), 1e-13 + 1e-14 * scale) << scale;
  }
}

TEST_P(Configurations, AreIntegratedInPlace) {
  const Eigen::VectorXd tangent = random_vector(robot.tangent_size(), 1.0, random);
  Eigen::VectorXd q = random_configuration(robot, random), expected = q;
  robot.integrate(q.data(), tangent.data(), expected.data());
  robot.integrate(q.data(), tangent.data(), q.data());
  EXPECT_EQ(q, expected);
}

INSTANTIATE_TEST_SUITE_P(Bases, Configurations, testing::Bool(),
                         [](const testing::TestParamInfo<bool>& info) {
                           return info.param ? "floating" : "fixed";
                         });

TEST(FloatingBase, MovesAndTurnsInItsOwnFrame) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"));
  Eigen::VectorXd q = robot.neutral_configuration();
  Eigen::VectorXd tangent = Eigen::VectorXd::Zero(robot.tangent_size());
  tangent[5] = EIGEN_PI / 2.0;  // a quarter turn to the left
  robot.integrate(q.data(), tangent.data(), q.data());
  tangent.setZero();
  tangent[0] = 1.0;  // then a metre ahead, which is now world y
  tangent[3] = 0.2;  // while rolling about the new x
  robot.integrate(q.data(), tangent.data(), q.data());
  EXPECT_LT((q.head<3>() - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(EIGEN_PI / 2.0, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  EXPECT_LT((q.segment<4>(3) - expected.coeffs()).norm(), 1e-12);
}

TEST(FloatingBase, TurnsTheShortWay) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"));
  const Eigen::VectorXd from = robot.neutral_configuration();
  Eigen::VectorXd to = from;
  to.segment<4>(3) << 0, 0, -std::sin(0.1), -std::cos(0.1);  // 0.2 rad about z, sign flipped
  Eigen::VectorXd tangent(robot.tangent_size());
  robot.difference(from.data(), to.data(), tangent.data());
  EXPECT_LT((tangent.segment<3>(3) - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-12);
}

TEST(FloatingBase, KeepsItsQuaternionUnitOverManySteps) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"));
  std::mt19937 random(11);
  Eigen::VectorXd q = random_configuration(robot, random);
  const Eigen::VectorXd tangent = random_vector(robot.tangent_size(), 0.3, random);
  for (int i = 0; i < 10000; ++i) robot.integrate(q.data(), tangent.data(), q.data());
  EXPECT_NEAR(q.segment<4>(3).norm(), 1.0, 1e-14);
}

}  // namespace
}  // namespace locograph::test
