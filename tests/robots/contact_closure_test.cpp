// Closure of contacts: what each kind holds, its Jacobian against differences, and allocation.
#include <locograph/common/error.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/robots/wheel.h>

#include "common/allocation_counter.h"
#include "robots/blade_contact.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct ClosureCase {
  std::string name;
  ContactKind kind;
  bool free_yaw = false;
  double radius_m = 0.0;
  bool locked = false;
};

void PrintTo(const ClosureCase& one, std::ostream* stream) { *stream << one.name; }

Eigen::Vector3d direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

Robot centauro_with_arms() {
  return Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
}

class Closure : public testing::TestWithParam<ClosureCase> {
 protected:
  /// With axes and a place on the link that are nothing special.
  EndEffector effector() const {
    EndEffector end;
    end.kind = GetParam().kind;
    end.radius_m = GetParam().radius_m;
    end.link = "ball1_tip";
    end.point = {0.05, -0.03, 0.1};
    end.normal = {0.4, -0.3, 1.7};
    end.forward = {1.0, 0.2, 0.0};
    if (end.kind == ContactKind::kWheel) {
      end.link = "wheel_2";
      const Joint& joint = robot.joints()[static_cast<std::size_t>(robot.joint_index("j_wheel_2"))];
      end.point = 0.02 * joint.axis;
    }
    end.half_x_m = end.half_y_m = 0.05;
    end.friction = 0.5;
    end.max_force_N = 100.0;
    return end;
  }

  /// Somewhere near, but not closed.
  Contact contact() {
    Contact placed{.effector = effector(), .locked = GetParam().locked};
    const Eigen::Isometry3d& pose = state.world_from_link(robot.link_index(placed.effector.link));
    placed.position = pose * placed.effector.point + 0.2 * direction(random);
    placed.normal = pose.linear() * placed.effector.normal + 0.5 * direction(random);
    if (placed.effector.kind == ContactKind::kWheel) placed.normal = 3.0 * direction(random);
    if (!GetParam().free_yaw) {
      placed.forward = pose.linear() * placed.effector.forward + 0.3 * direction(random);
    }
    return placed;
  }

  Eigen::VectorXd error(const ContactClosure& closure, const RobotState& at) {
    Eigen::VectorXd e(closure.rows());
    closure.error(at, e.data());
    return e;
  }

  std::mt19937 random{11};
  Robot robot = centauro_with_arms();
  RobotState state{robot};
};

TEST_P(Closure, HasTheJacobianOfNumericDifferences) {
  constexpr double kStep = 1e-6;
  RobotState moved(robot);
  for (int sample = 0; sample < 20; ++sample) {
    const Eigen::VectorXd q = random_configuration(robot, random);
    state.update(q.data());
    const ContactClosure closure(robot, contact());
    RowMajor jacobian = RowMajor::Zero(closure.rows(), robot.tangent_size());
    closure.add_jacobian(state, jacobian.data(), jacobian.cols());
    for (int k = 0; k < robot.tangent_size(); ++k) {
      Eigen::VectorXd tangent = Eigen::VectorXd::Zero(robot.tangent_size()), next(q.size());
      Eigen::VectorXd difference = Eigen::VectorXd::Zero(closure.rows());
      for (const double sign : {1.0, -1.0}) {
        tangent[k] = sign * kStep;
        robot.integrate(q.data(), tangent.data(), next.data());
        moved.update(next.data());
        difference += sign / (2.0 * kStep) * error(closure, moved);
      }
      EXPECT_LT((jacobian.col(k) - difference).norm(), 1e-6 * (1.0 + difference.norm()))
          << "column " << k;
    }
  }
}

TEST_P(Closure, DoesNotAllocate) {
  if (!allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own malloc";
  state.update(random_configuration(robot, random).data());
  const ContactClosure closure(robot, contact());
  Eigen::VectorXd e(closure.rows());
  RowMajor jacobian = RowMajor::Zero(closure.rows(), robot.tangent_size());
  const long before = allocation_count();
  closure.error(state, e.data());
  closure.add_jacobian(state, jacobian.data(), jacobian.cols());
  EXPECT_EQ(allocation_count(), before);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, Closure,
    testing::Values(ClosureCase{"Surface", ContactKind::kSurface},
                    ClosureCase{"SurfaceWithFreeYaw", ContactKind::kSurface, true},
                    ClosureCase{"Point", ContactKind::kPoint},
                    ClosureCase{"Ball", ContactKind::kPoint, false, 0.04},
                    ClosureCase{"Rung", ContactKind::kGrasp},
                    ClosureCase{"Wheel", ContactKind::kWheel, false, 0.078},
                    ClosureCase{"LockedWheel", ContactKind::kWheel, false, 0.078, true},
                    ClosureCase{"KindOfTheTest", blade()}),
    [](const testing::TestParamInfo<ClosureCase>& one) { return one.param.name; });

class OneClosure : public testing::Test {
 protected:
  OneClosure() { state.update(q.data()); }

  static EndEffector end(ContactKind kind, const std::string& link) {
    return {.link = link,
            .kind = kind,
            .half_x_m = 0.05,
            .half_y_m = 0.05,
            .friction = 0.5,
            .max_force_N = 100.0};
  }
  std::vector<double> rows(const Contact& contact) const {
    const ContactClosure closure(robot, contact);
    std::vector<double> e(static_cast<std::size_t>(closure.rows()));
    closure.error(state, e.data());
    return e;
  }

  Robot robot = centauro_with_arms();
  Eigen::VectorXd q = robot.named_configuration("home");
  RobotState state{robot};
};

TEST_F(OneClosure, OfABallHoldsItsCentreARadiusAboveTheSurface) {
  Contact hand{.effector = end(ContactKind::kPoint, "ball1_tip")};
  hand.effector.radius_m = 0.04;
  hand.normal = {-3.0, 0.0, 4.0};
  const Eigen::Vector3d centre = state.world_from_link(robot.link_index("ball1_tip")).translation();
  hand.position = centre - 0.04 * Eigen::Vector3d(-0.6, 0.0, 0.8);
  for (const double row : rows(hand)) EXPECT_NEAR(row, 0.0, 1e-15);
  hand.effector.radius_m = 0.0;
  EXPECT_NEAR(rows(hand)[2], 0.04, 1e-15) << "along the normal";
}

TEST_F(OneClosure, OfAWheelIsTheHeightOfItsLowestPointAboveAnyPlane) {
  Contact wheel{.effector = end(ContactKind::kWheel, "wheel_1")};
  wheel.effector.radius_m = 0.078;
  const Wheel disc = wheel_of(robot, wheel.effector);
  const WheelPose pose(state, disc);
  for (const double tilt_rad : {0.0, 0.2, -0.7}) {
    // A plane that the axle is inclined to by the tilt, anywhere under the disc.
    const Eigen::Vector3d upright = pose.axle.unitOrthogonal();
    wheel.normal = 2.0 * (std::cos(tilt_rad) * upright + std::sin(tilt_rad) * pose.axle);
    const Eigen::Vector3d normal = wheel.normal.normalized();
    const Eigen::Vector3d lowest = lowest_point(pose, 0.078, normal);
    EXPECT_NEAR((lowest - pose.centre).norm(), 0.078, 1e-12);
    wheel.position = lowest - 0.01 * normal + 1.5 * normal.unitOrthogonal();
    EXPECT_NEAR(rows(wheel)[0], 0.01, 1e-12);
    EXPECT_NEAR(rows(wheel)[1], std::sin(tilt_rad), 1e-12);
  }
}

TEST_F(OneClosure, OfALockedWheelHoldsTheLowestPointToo) {
  Contact wheel{.effector = end(ContactKind::kWheel, "wheel_1")};
  wheel.effector.radius_m = 0.078;
  const WheelPose pose(state, wheel_of(robot, wheel.effector));
  wheel.normal = 2.0 * pose.axle.unitOrthogonal();
  const Eigen::Matrix3d axes = axes_in_world(wheel);
  const Eigen::Vector3d lowest = lowest_point(pose, 0.078, wheel.normal);
  wheel.position = lowest - axes * Eigen::Vector3d(0.03, -0.02, 0.01);
  const std::vector<double> rolls = rows(wheel);
  ASSERT_EQ(rolls.size(), 2u);
  wheel.locked = true;
  const std::vector<double> stands = rows(wheel);
  ASSERT_EQ(stands.size(), 4u);
  EXPECT_NEAR(stands[0], 0.03, 1e-12);
  EXPECT_NEAR(stands[1], -0.02, 1e-12);
  EXPECT_NEAR(stands[2], 0.01, 1e-12);
  EXPECT_EQ(std::vector<double>(stands.begin() + 2, stands.end()), rolls);
}

TEST_F(OneClosure, OfAWheelDoesNotChangeWhenItTurns) {
  Contact wheel{.effector = end(ContactKind::kWheel, "wheel_1")};
  wheel.effector.radius_m = 0.078;
  wheel.normal = {0.1, 0.2, 1.0};
  for (const bool locked : {false, true}) {
    wheel.locked = locked;
    const std::vector<double> before = rows(wheel);
    q[robot.base_configuration_size() +
      robot.joints()[static_cast<std::size_t>(robot.joint_index("j_wheel_1"))].index] += 2.0;
    state.update(q.data());
    EXPECT_EQ(rows(wheel), before);
  }
}

TEST_F(OneClosure, OfARungIsBlindToTurningRoundTheBarOnly) {
  Contact grasp{.effector = end(ContactKind::kGrasp, "ball1_tip")};
  const Eigen::Isometry3d& pose = state.world_from_link(robot.link_index("ball1_tip"));
  grasp.position = pose.translation();
  const Eigen::Matrix3d turned =
      pose.linear() * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  grasp.normal = turned.col(2);
  grasp.forward = turned.col(0);
  for (const double row : rows(grasp)) EXPECT_NEAR(row, 0.0, 1e-12);
  grasp.forward =
      pose.linear() * (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) * Eigen::Vector3d::UnitX());
  grasp.normal = pose.linear().col(2);
  EXPECT_NEAR(rows(grasp)[4], -0.3, 1e-12);
}

TEST_F(OneClosure, IsRefusedForAWheelWhoseCentreIsBesideItsAxle) {
  EndEffector wheel = end(ContactKind::kWheel, "wheel_1");
  wheel.radius_m = 0.078;
  wheel.point = {0.01, 0.01, 0.01};
  EXPECT_THROW(ContactClosure(robot, Contact{.effector = wheel}), Error);
}

}  // namespace
}  // namespace locograph::test
