#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/check/judged_stance.h>
#include <locograph/check/wheel_rolling.h>
#include <locograph/common/error.h>

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
      : robot_(
            std::make_shared<const Robot>(Robot::load(folder_.write("unicycle.urdf", kUnicycle)))),
        wheel_(robot_->link_index("wheel")) {}

  Eigen::VectorXd at(double x, double y, double yaw, double steer, double spin) const {
    Eigen::VectorXd q(9);
    q << x, y, 0.1, 0.0, 0.0, std::sin(0.5 * yaw), std::cos(0.5 * yaw), steer, spin;
    return q;
  }
  Contact contact() const {
    Contact wheel;
    wheel.effector = {.name = "wheel",
                      .link = "wheel",
                      .kind = ContactKind::kWheel,
                      .radius_m = 0.1,
                      .friction = 0.5,
                      .max_force_N = 100.0};
    return wheel;
  }
  CheckReport step(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    const Motion motion{{0.0, 10.0}, {from, to}, {{{contact()}}}, {0, 0}};
    World world;
    world.surfaces = {ground()};
    return Judge(robot_, world).check(motion);
  }
  /// It has no mass, so balance is not judged, and without that nothing is feasible.
  static void expect_nothing_violated(const CheckReport& report) {
    for (const Violation& v : report.violations) EXPECT_FALSE(v.violated) << violation_text(v);
    EXPECT_EQ(report.constraint("static_balance").why_not, "no link has a mass");
    EXPECT_FALSE(report.feasible);
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_;
  int wheel_;
};

TEST_F(Unicycle, RollsForwardsBackwardsAndAtAnyHeadingWithoutSlip) {
  for (const double yaw : {0.0, 1.0, -2.5}) {
    for (const double distance : {1.0, -1.0}) {
      const CheckReport report = step(at(0.0, 0.0, yaw, 0.3, 0.0),
                                      at(distance * std::cos(yaw + 0.3),
                                         distance * std::sin(yaw + 0.3), yaw, 0.3, distance / 0.1));
      expect_nothing_violated(report);
      EXPECT_LT(report.constraint("lateral_slip").worst, 1e-9);
      EXPECT_LT(report.constraint("longitudinal_slip").worst, 1e-9);
      EXPECT_LT(report.max_contact_error_m.value(), 1e-9);
    }
  }
}

TEST_F(Unicycle, SteersOnTheSpotWithoutSlip) {
  const CheckReport report = step(at(0.0, 0.0, 0.0, -1.0, 0.0), at(0.0, 0.0, 0.0, 1.0, 0.0));
  expect_nothing_violated(report);
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
  // Half-way is 0.25 m of way on, where 5 mm and 2 % are allowed: as much of 5 mm it counts.
  EXPECT_GT(report.constraint("lateral_slip").worst, sideways * 0.005 / 0.010 - 1e-4);
  EXPECT_LT(report.constraint("lateral_slip").worst, sideways);
  EXPECT_TRUE(report.constraint("lateral_slip").violated);
  // Along the heading there is what slipped sideways before the wheel had turned, no more.
  EXPECT_FALSE(report.constraint("longitudinal_slip").violated);
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

// Half a turn about the vertical between two slides: along the wheel's own axle they cancel.
TEST_F(Unicycle, SlidingDoesNotGoAwayBySteering) {
  Motion motion{{}, {}, {{{contact()}}}, {}};
  for (int i = 0; i <= 20; ++i) {
    const double yaw = i % 2 == 0 ? 0.0 : 3.0;
    const double y = 0.002 * double(i);
    motion.configurations.push_back(at(0.0, y, 3.0 - yaw, 0.0, 0.0));
    motion.configurations.push_back(at(0.0, y, yaw, 0.0, 0.0));
  }
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    motion.time_s.push_back(10.0 * double(i));
    motion.stance_from.push_back(0);
  }
  World world;
  world.surfaces = {ground()};
  const CheckReport report = Judge(robot_, world).check(motion);
  EXPECT_TRUE(report.constraint("lateral_slip").violated);
}

TEST_F(Unicycle, SlipCountsWithinAnyStretchAndInTotal) {
  WheelSlip slip;
  WheelStep step;
  step.across = Eigen::Vector3d::UnitY();
  step.heading = Eigen::Vector3d::UnitX();
  step.way_m = 0.01;
  // 1.5 % for good: 1.5 mm in any stretch, in total less than what is allowed.
  step.lateral_m = 1.5e-4;
  for (int i = 0; i < 1000; ++i) slip.add(step);
  EXPECT_NEAR(slip.way_m(), 10.0, 1e-9);
  EXPECT_LT(slip.lateral_m(), 0.005);
  // 2.5 % for good is too much in the end, ...
  WheelSlip more;
  step.lateral_m = 2.5e-4;
  for (int i = 0; i < 50; ++i) more.add(step);
  EXPECT_LT(more.lateral_m(), 0.005);
  for (int i = 0; i < 950; ++i) more.add(step);
  EXPECT_GT(more.lateral_m(), 0.005);
  // ... and 6 mm at once are, however long the way was.
  step.lateral_m = 6e-3;
  slip.add(step);
  EXPECT_GT(slip.lateral_m(), 0.006);
  EXPECT_EQ(slip.longitudinal_m(), 0.0);
}

TEST_F(Unicycle, ItsTouchingPointAndTiltFollowTheAxleOnAnyPlane) {
  World world;
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.3, 0.0, 1.0).normalized().eval()}) {
    Contact given = contact();
    given.normal = normal;
    const JudgedStance stance(*robot_, world, {{given}}, {});
    const Eigen::Quaterniond tilted =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    for (const double angle : {0.0, 0.3, M_PI_2}) {
      std::vector<Eigen::Isometry3d> poses(robot_->links().size(), Eigen::Isometry3d::Identity());
      Eigen::Isometry3d& pose = poses[std::size_t(wheel_)];
      pose.linear() = (tilted * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX())).matrix();
      pose.translation() = normal * 0.25;
      const ContactError error = closure_error(stance.contacts[0], poses);
      EXPECT_NEAR(error.angle_rad, angle, 1e-7);
      EXPECT_NEAR(error.position_m, 0.25 - 0.1 * std::cos(angle), 1e-9);
      EXPECT_TRUE(touching_point(stance.contacts[0], poses).allFinite());
    }
  }
}

}  // namespace
}  // namespace locograph
