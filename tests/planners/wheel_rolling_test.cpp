#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/planners/plan/feasibility_checker.h>
#include <locograph/planners/plan/wheel_rolling.h>

#include <cmath>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

// A single wheel of radius 0.1 m about +y, its centre in the base's origin.
constexpr const char* kUnicycle = R"(<robot name="unicycle">
  <link name="base"/>
  <link name="fork"/>
  <link name="wheel"><collision><origin rpy="1.5707963267948966 0 0"/>
    <geometry><cylinder radius="0.1" length="0.02"/></geometry></collision></link>
  <joint name="steer" type="revolute"><parent link="base"/><child link="fork"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="10" effort="1"/></joint>
  <joint name="spin" type="continuous"><parent link="fork"/><child link="wheel"/><axis xyz="0 1 0"/>
    <limit velocity="50" effort="1"/></joint>
</robot>
)";

class Unicycle : public ::testing::Test {
 protected:
  Unicycle()
      : robot_(Robot::load(folder_.write("unicycle.urdf", kUnicycle))),
        wheel_(robot_.link_index("wheel")) {}

  Eigen::VectorXd at(double x, double y, double yaw, double steer, double spin) const {
    Eigen::VectorXd q(9);
    q << x, y, 0.1, 0.0, 0.0, std::sin(0.5 * yaw), std::cos(0.5 * yaw), steer, spin;
    return q;
  }
  CheckReport step(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    const Motion motion{{0.0, 10.0}, {from, to}, {{wheel_, 0.1}}};
    return check_motion(robot_, CollisionWorld(robot_, nullptr, {}), motion);
  }

  test::TemporaryFolder folder_;
  Robot robot_;
  int wheel_;
};

TEST_F(Unicycle, RollsForwardsBackwardsAndAtAnyHeadingWithoutSlip) {
  for (const double yaw : {0.0, 1.0, -2.5}) {
    for (const double distance : {1.0, -1.0}) {
      const CheckReport report = step(at(0.0, 0.0, yaw, 0.3, 0.0),
                                      at(distance * std::cos(yaw + 0.3),
                                         distance * std::sin(yaw + 0.3), yaw, 0.3, distance / 0.1));
      EXPECT_TRUE(report.feasible);
      EXPECT_LT(report.constraint("lateral_slip").worst, 1e-9);
      EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-9);
      EXPECT_LT(report.max_contact_error_m, 1e-9);
    }
  }
}

TEST_F(Unicycle, SteersOnTheSpotWithoutSlip) {
  const CheckReport report = step(at(0.0, 0.0, 0.0, -1.0, 0.0), at(0.0, 0.0, 0.0, 1.0, 0.0));
  EXPECT_TRUE(report.feasible);
  EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-9);
}

TEST_F(Unicycle, SpinningOnTheSpotSlipsByRadiusTimesAngle) {
  const CheckReport report = step(at(0.0, 0.0, 0.2, 0.0, 0.0), at(0.0, 0.0, 0.2, 0.0, 7.0));
  EXPECT_NEAR(report.constraint("longitudinal_slip").worst, 0.7, 1e-9);
  EXPECT_LT(report.constraint("lateral_slip").worst, 1e-9);
}

// Along the chord of an arc that the heading follows: at both ends of the step the slip is the
// same, half-way it is d / angle (1 - cos(angle / 2)).
TEST_F(Unicycle, SlipWithinAStepCountsEvenIfItComesBackToZero) {
  const double distance = 0.5, angle = 0.4;
  const double sideways = distance / angle * (1.0 - std::cos(0.5 * angle));
  const double rolled = distance * std::sin(0.5 * angle) / (0.5 * angle);
  const CheckReport report =
      step(at(0.0, 0.0, -0.5 * angle, 0.0, 0.0), at(distance, 0.0, 0.5 * angle, 0.0, rolled / 0.1));
  // The nearest of at least 50 samples is up to 1/100 of the step away from the extremum.
  const double missed = 0.5 * distance * angle * 0.01 * 0.01;
  EXPECT_NEAR(report.constraint("lateral_slip").worst, sideways, missed);
  EXPECT_NEAR(report.constraint("lateral_slip").time_s, 5.0, 0.3);
  EXPECT_TRUE(report.constraint("lateral_slip").violated);
  // Rolling at constant speed, the projection on the heading is not: a second order effect.
  EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-3);
}

TEST_F(Unicycle, TheSpinIsThatOfTheWheelInTheWorldWhateverTurnsIt) {
  // A base that pitches forward turns the wheel with it, its joint turns it back.
  Eigen::VectorXd to = at(0.0, 0.0, 0.0, 0.0, -0.8);
  to.segment<4>(3) << 0.0, std::sin(0.4), 0.0, std::cos(0.4);
  EXPECT_LT(step(at(0.0, 0.0, 0.0, 0.0, 0.0), to).constraint("longitudinal_slip").worst, 1e-9);
  to[8] = 0.0;
  EXPECT_NEAR(step(at(0.0, 0.0, 0.0, 0.0, 0.0), to).constraint("longitudinal_slip").worst, 0.08,
              1e-9);
}

TEST_F(Unicycle, ItsLowestPointAndTiltFollowTheAxle) {
  const WheelOnGround wheel(robot_, {wheel_, 0.1});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 1.0, 2.0, 0.5;
  pose.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(wheel.tilt_rad(pose), 0.3, 1e-12);
  const Eigen::Vector3d lowest(1.0, 2.0 + 0.1 * std::sin(0.3), 0.5 - 0.1 * std::cos(0.3));
  EXPECT_LT((wheel.lowest_point(pose) - lowest).norm(), 1e-12);
  pose.linear() = Eigen::AngleAxisd(M_PI_2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NEAR(wheel.tilt_rad(pose), M_PI_2, 1e-6);
  EXPECT_TRUE(wheel.lowest_point(pose).allFinite());
}

TEST_F(Unicycle, RefusesALinkThatIsNoWheel) {
  EXPECT_THROW(WheelOnGround(robot_, {0, 0.1}), Error);
  EXPECT_THROW(WheelOnGround(robot_, {-1, 0.1}), Error);
  EXPECT_THROW(WheelOnGround(robot_, {wheel_, -0.1}), Error);
}

}  // namespace
}  // namespace locograph
