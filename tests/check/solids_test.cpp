// Boxes are solid: nobody stands in one, and only what touches a box may reach into it a little.
#include <gtest/gtest.h>
#include <locograph/check/judge.h>
#include <locograph/check/limits.h>

#include <cmath>
#include <set>

#include "check/centauro_on_wheels.h"
#include "check/coman_plus_standing.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Eigen::Vector3d;
using test::standing;
using Names = std::set<std::string>;

SolidBox box(const Vector3d& middle, const Vector3d& size) {
  SolidBox box{.name = "box", .size_m = size};
  box.world_from_box.translation() = middle;
  return box;
}

/// COMAN+ on the ground with a box somewhere.
CheckReport with_box(const SolidBox& box) {
  World world = standing().world();
  world.solids = {box};
  return Judge(standing().robot, world).check(standing().home, standing().feet);
}

TEST(ComanAndABox, StandsBesideIt) {
  EXPECT_FALSE(
      violated(with_box(box({3.0, 0.0, 0.5}, {1.0, 1.0, 1.0}))).contains("ground_penetration"));
}

TEST(ComanAndABox, IsRefusedWhollyInsideIt) {
  const CheckReport report = with_box(box({0.0, 0.0, 1.0}, {6.0, 6.0, 4.0}));
  EXPECT_FALSE(report.feasible);
  EXPECT_TRUE(violated(report).contains("ground_penetration"));
  EXPECT_GT(report.constraint("ground_penetration").worst, 1.0);
}

TEST(ComanAndABox, IsRefusedWithAHandInIt) {
  RobotState state(*standing().robot);
  state.update(standing().home.data());
  const Vector3d hand = state.world_from_link(standing().robot->link_index("LBall")).translation();
  const CheckReport report = with_box(box(hand, Vector3d::Constant(0.4)));
  EXPECT_FALSE(report.feasible);
  EXPECT_TRUE(violated(report).contains("ground_penetration"));
  EXPECT_EQ(report.constraint("ground_penetration").what, "LBall and box");
  EXPECT_GT(report.constraint("ground_penetration").worst, 0.2);
}

TEST(ComanAndABox, StandsOnItsTopAsOnTheGround) {
  World world;
  world.surfaces = {ground()};
  world.surfaces[0].half_x_m = world.surfaces[0].half_y_m = 1.0;
  const auto check = [&] {
    return Judge(standing().robot, world).check(standing().home, standing().feet);
  };
  const CheckReport on_plate = check();
  world.solids = {box({0.0, 0.0, -0.25}, {2.0, 2.0, 0.5})};
  const CheckReport on_box = check();
  EXPECT_TRUE(on_box.feasible) << violation_text(on_box.worst());
  for (std::size_t i = 0; i < on_box.violations.size(); ++i)
    EXPECT_NEAR(on_box.violations[i].worst, on_plate.violations[i].worst, 1e-9)
        << on_box.violations[i].constraint;
}

/// A ball of 0.02 m radius on a shin of 0.2 m without a joint between them; another link, a ball of
/// 0.05 m on a joint, is the body above.
class ShinOnAStone : public ::testing::Test {
 protected:
  static Contact ball() {
    Contact contact;
    contact.effector = {.name = "foot",
                        .link = "foot",
                        .kind = ContactKind::kPoint,
                        .radius_m = 0.02,
                        .friction = 0.5,
                        .max_force_N = 1000.0};
    return contact;
  }

  /// The shin is turned by an angle about y about the ball, which touches the stone's top at x.
  CheckReport check(double x, double angle, const CheckOptions& options = {}) const {
    Contact contact = ball();
    contact.position.x() = x;
    Eigen::VectorXd q = robot_->neutral_configuration();
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(angle, Vector3d::UnitY()));
    q.segment<4>(3) = turned.coeffs();
    q.head<3>() = Vector3d(x, 0.0, 0.02) - turned * Vector3d(0.0, 0.0, -0.2);
    return Judge(robot_, world_).check(q, {{contact}}, options);
  }
  ShinOnAStone() {
    world_.surfaces = {ground()};
    world_.surfaces[0].name = "top";
    world_.surfaces[0].half_x_m = world_.surfaces[0].half_y_m = 0.1;
    world_.solids = {box({0.0, 0.0, -0.1}, {0.2, 0.2, 0.2})};
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_ = std::make_shared<const Robot>(Robot::load(folder_.write(
      "shin.urdf",
      "<robot name='shin'><link name='shin'><inertial><mass value='1'/><inertia ixx='1' ixy='0' "
      "ixz='0' iyy='1' iyz='0' izz='1'/></inertial><collision><origin xyz='0 0 -0.09'/><geometry>"
      "<cylinder radius='0.01' length='0.18'/></geometry></collision></link><link name='foot'>"
      "<collision><geometry><sphere radius='0.02'/></geometry></collision></link><joint "
      "name='ankle' type='fixed'><parent link='shin'/><child link='foot'/><origin "
      "xyz='0 0 -0.2'/></joint><link name='body'><inertial><mass value='1'/><inertia ixx='1' "
      "ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial><collision><geometry><sphere "
      "radius='0.05'/></geometry></collision></link><joint name='knee' type='revolute'><parent "
      "link='shin'/><child link='body'/><origin xyz='0 0 0.06'/><axis xyz='0 1 0'/><limit "
      "lower='-1' upper='1' velocity='1' effort='100'/></joint></robot>")));
  World world_;
};

const Names kDistances = {"ground_penetration", "touching_depth", "obstacle_distance"};

Names distances_violated(const CheckReport& report) {
  Names names;
  for (const std::string& name : violated(report))
    if (kDistances.contains(name)) names.insert(name);
  return names;
}

TEST_F(ShinOnAStone, StandsUpright) {
  EXPECT_EQ(distances_violated(check(0.0, 0.0)), Names{});
  EXPECT_EQ(distances_violated(check(0.09, 0.0)), Names{});
}

TEST_F(ShinOnAStone, IsRefusedInTheStoneThatItsOwnFootStandsOn) {
  const CheckReport report = check(0.0, M_PI);
  EXPECT_TRUE(violated(report).contains("touching_depth"));
  EXPECT_GT(report.constraint("touching_depth").worst, limits::kTouchingDepth_m);
  // Aslant, out of its side.
  EXPECT_TRUE(violated(check(0.05, 0.75 * M_PI)).contains("touching_depth"));
  // Over the edge it hangs free beside the stone.
  world_.surfaces[0].half_x_m = 0.05;
  world_.solids[0].size_m.x() = 0.1;
  EXPECT_EQ(distances_violated(check(0.05, 0.5 * M_PI)), Names{});
}

TEST_F(ShinOnAStone, IsRefusedInsideTheNextStone) {
  world_.solids.push_back(box({0.25, 0.0, -0.05}, {0.2, 0.2, 0.5}));
  EXPECT_EQ(distances_violated(check(0.0, 0.0)), Names{});
  EXPECT_EQ(distances_violated(check(0.05, 0.5 * M_PI)), Names{"ground_penetration"});
}

TEST_F(ShinOnAStone, KeepsTheClearanceThatIsAskedForFromAllThatItDoesNotTouch) {
  CheckOptions options;
  const auto nearest = [&](double clearance) {
    options.min_clearance_m = clearance;
    return check(0.0, 0.0, options).constraint("obstacle_distance");
  };
  // 0.03 m above the body.
  Surface ceiling = ground();
  ceiling.name = "ceiling";
  ceiling.world_from_surface.linear() = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).matrix();
  ceiling.world_from_surface.translation().z() = 0.02 + 0.2 + 0.06 + 0.05 + 0.03;
  world_.surfaces.push_back(ceiling);
  EXPECT_FALSE(nearest(0.0).violated) << "not asked for";
  EXPECT_FALSE(nearest(0.029).violated);
  EXPECT_TRUE(nearest(0.031).violated);
  EXPECT_NEAR(nearest(0.031).worst, 0.03, 1e-6);
  EXPECT_EQ(nearest(0.031).what, "body and ceiling");
  world_.surfaces.pop_back();
  EXPECT_FALSE(nearest(0.2).violated) << "but for the stone that it stands on";
  world_.bars = {
      {.name = "rail", .from = {0.1, -1.0, 0.28}, .to = {0.1, 1.0, 0.28}, .radius_m = 0.01}};
  EXPECT_FALSE(nearest(0.03).violated);
  EXPECT_TRUE(nearest(0.05).violated);
  EXPECT_NEAR(nearest(0.05).worst, 0.04, 1e-5);
  world_.bars.clear();
  world_.solids.push_back(box({0.2, 0.0, 0.28}, {0.2, 0.2, 0.2}));
  EXPECT_FALSE(nearest(0.04).violated);
  EXPECT_TRUE(nearest(0.06).violated);
}

TEST_F(ShinOnAStone, MayLeaveWhatItTouchesWhereAClearanceIsAskedFor) {
  CheckOptions options;
  options.min_clearance_m = 0.05;
  Contact contact = ball();
  Contact other = contact;  // touches elsewhere: the foot is in the air
  other.position.z() = 1.0;
  Eigen::VectorXd q = robot_->neutral_configuration();
  q[2] = 0.22;
  Motion motion;
  motion.stances_only = true;
  motion.time_s = {0.0, 1.0, 2.0, 3.0};
  motion.configurations = {q, q, q, q};
  motion.stances = {{{contact}}, {{other}}, {{other}}};
  motion.stance_from = {0, 1, 1, 1};
  const Judge judge(robot_, world_);
  EXPECT_FALSE(judge.check(motion, options).constraint("obstacle_distance").violated);
  motion.stance_from = {1, 1, 1, 1};
  EXPECT_TRUE(judge.check(motion, options).constraint("obstacle_distance").violated);
}

}  // namespace
}  // namespace locograph
