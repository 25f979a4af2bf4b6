// A ball that is held rolls: its skin does not slip, on planes and round bars.
#include <locograph/common/error.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/robots/rolling_ball.h>

#include "common/allocation_counter.h"
#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kRadius_m = 0.07, kBarRadius_m = 0.02;

Eigen::Vector3d some_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

Eigen::Matrix3d turned_by(const Eigen::Vector3d& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix();
}

/// On a plane, or on a bar.
class RollingBall : public testing::TestWithParam<bool> {
 protected:
  Contact contact() {
    Contact placed;
    placed.effector.kind = ContactKind::kPoint;
    placed.effector.link = "ball1_tip";
    placed.effector.point = {0.05, -0.03, 0.1};
    placed.effector.radius_m = kRadius_m;
    placed.effector.friction = 0.5;
    placed.effector.max_force_N = 100.0;
    placed.position = some_direction(random);
    placed.normal = some_direction(random);
    if (GetParam()) {
      placed.bar = RoundBar{2.0 * placed.normal.cross(some_direction(random)), kBarRadius_m};
    }
    return placed;
  }

  BallPose touching(const Contact& contact) {
    Eigen::Isometry3d link = Eigen::Isometry3d::Identity();
    link.linear() = turned_by(2.0 * some_direction(random));
    link.translation() = contact.position + kRadius_m * contact.normal;
    return BallPose(link, Eigen::Vector3d::Zero());
  }

  /// c' = w × r n in many small steps, of a turn about one axis.
  static BallPose rolled(const Contact& contact, BallPose pose, const Eigen::Vector3d& turn) {
    constexpr int kSteps = 4000;
    const auto normal = [&](const Eigen::Vector3d& centre) -> Eigen::Vector3d {
      if (!contact.bar) return contact.normal;
      const Eigen::Vector3d along = contact.bar->axis.normalized();
      const Eigen::Vector3d off = centre - contact.position + kBarRadius_m * contact.normal;
      return (off - along * along.dot(off)).normalized();
    };
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Vector3d step = turn / kSteps;
      const Eigen::Vector3d half = pose.centre + 0.5 * kRadius_m * step.cross(normal(pose.centre));
      pose.centre += kRadius_m * step.cross(normal(half));
    }
    pose.world_from_link = turned_by(turn) * pose.world_from_link;
    return pose;
  }

  std::mt19937 random{5};
};

TEST_P(RollingBall, DoesNotSlipWhereItsCentreMovesAsItTurns) {
  for (int sample = 0; sample < 20; ++sample) {
    const Contact placed = contact();
    const BallTrack track(placed);
    const BallPose from = track.moved(touching(placed), {0.03, -0.02});
    const BallPose to = rolled(placed, from, 1.2 * some_direction(random));
    EXPECT_LT(BallStep(track, from, to).error.norm(), 1e-8);
    EXPECT_LT((track.touching(to.centre) - to.centre).norm() - kRadius_m, 1e-12);
  }
}

TEST_P(RollingBall, SlipsAsFarAsItIsMovedWithoutTurning) {
  const Contact placed = contact();
  const BallTrack track(placed);
  const BallPose from = touching(placed);
  const Eigen::Vector2d by(0.01, -0.025);
  const Eigen::Vector3d error = BallStep(track, from, track.moved(from, by)).error;
  EXPECT_LT((error.head<2>() - by).norm(), 1e-12);
  EXPECT_LT(std::abs(error[2]), 1e-12);
}

TEST_P(RollingBall, HasTheDerivativesOfNumericDifferences) {
  constexpr double kStep = 1e-6;
  for (int sample = 0; sample < 20; ++sample) {
    const Contact placed = contact();
    const BallTrack track(placed);
    BallPose from = touching(placed);
    BallPose to = rolled(placed, from, 0.8 * some_direction(random));
    from.centre += 0.01 * some_direction(random);
    to.centre += 0.01 * some_direction(random);
    const BallStep step(track, from, to);
    for (int k = 0; k < 3; ++k) {
      const auto difference = [&](bool of_from, bool turns) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const double sign : {1.0, -1.0}) {
          BallPose a = from, b = to;
          BallPose& moved = of_from ? a : b;
          const Eigen::Vector3d by = sign * kStep * Eigen::Vector3d::Unit(k);
          if (turns) {
            moved.world_from_link = turned_by(by) * moved.world_from_link;
          } else {
            moved.centre += by;
          }
          sum += sign / (2.0 * kStep) * BallStep(track, a, b).error;
        }
        return sum;
      };
      EXPECT_LT((step.by_to().by_centre.col(k) - difference(false, false)).norm(), 1e-8);
      EXPECT_LT((step.by_to().by_turn.col(k) - difference(false, true)).norm(), 1e-8);
      EXPECT_LT((step.by_from().by_centre.col(k) - difference(true, false)).norm(), 1e-8);
      EXPECT_LT((step.by_from().by_turn.col(k) - difference(true, true)).norm(), 1e-8);
    }
  }
}

TEST_P(RollingBall, HasAClosureWithTheJacobianOfNumericDifferencesThatDoesNotAllocate) {
  constexpr double kStep = 1e-6;
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
  RobotState state(robot), moved(robot);
  for (int sample = 0; sample < 5; ++sample) {
    const Eigen::VectorXd q = random_configuration(robot, random);
    state.update(q.data());
    Contact placed = contact();
    BallPose from(state, placed.effector);
    from.world_from_link = turned_by(0.5 * some_direction(random)) * from.world_from_link;
    placed.position = from.centre - kRadius_m * placed.normal + 0.01 * some_direction(random);
    const ContactClosure closure(robot, placed, from);
    ASSERT_EQ(closure.rows(), 3);
    RowMajor jacobian = RowMajor::Zero(3, robot.tangent_size());
    Eigen::Vector3d e;
    const long before = allocation_count();
    closure.error(state, e.data());
    closure.add_jacobian(state, jacobian.data(), jacobian.cols());
    const long allocated = allocation_count() - before;
    EXPECT_TRUE(allocated == 0 || !allocations_are_counted());
    for (int k = 0; k < robot.tangent_size(); ++k) {
      Eigen::VectorXd tangent = Eigen::VectorXd::Zero(robot.tangent_size()), next(q.size());
      Eigen::Vector3d difference = Eigen::Vector3d::Zero();
      for (const double sign : {1.0, -1.0}) {
        tangent[k] = sign * kStep;
        robot.integrate(q.data(), tangent.data(), next.data());
        moved.update(next.data());
        closure.error(moved, e.data());
        difference += sign / (2.0 * kStep) * e;
      }
      EXPECT_LT((jacobian.col(k) - difference).norm(), 1e-7) << "column " << k;
    }
  }
}

TEST_P(RollingBall, IsAtThePlaceThatItHasRolledTo) {
  const Robot robot = Robot::load(model("centauro/centauro.urdf"), model("centauro/centauro.srdf"));
  RobotState state(robot);
  Contact placed = contact();
  const BallPose here(state, placed.effector);
  const BallTrack track(placed);
  // Back from here to where it has touched down.
  placed.position = here.centre - kRadius_m * placed.normal;
  const BallPose before = BallTrack(placed).moved(here, {0.04, 0.03});
  Contact touched = placed;
  touched.normal = BallTrack(placed).normal(before.centre);
  touched.position = BallTrack(placed).touching(before.centre);
  const Contact there = rolled_to(state, touched);
  EXPECT_LT((there.position - placed.position).norm(), 1e-12);
  EXPECT_LT((there.normal - placed.normal).norm(), 1e-12);
  EXPECT_EQ((touched.normal - placed.normal).norm() > 1e-3, GetParam());
}

INSTANTIATE_TEST_SUITE_P(OnAPlaneAndABar, RollingBall, testing::Bool(),
                         [](const auto& of) { return of.param ? "Bar" : "Plane"; });

TEST(BarOfAContact, NeedsARadiusAndAnAxisAcrossTheNormal) {
  Contact placed;
  placed.bar = RoundBar{Eigen::Vector3d::UnitX(), 0.02};
  EXPECT_NO_THROW(require_sound_place(placed));
  placed.bar->radius_m = 0.0;
  EXPECT_THROW(require_sound_place(placed), Error);
  placed.bar = RoundBar{{1.0, 0.0, 1.0}, 0.02};
  EXPECT_THROW(require_sound_place(placed), Error);
  placed.bar = RoundBar{Eigen::Vector3d::Zero(), 0.02};
  EXPECT_THROW(require_sound_place(placed), Error);
}

}  // namespace
}  // namespace locograph::test
