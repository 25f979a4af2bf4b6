// Contacts on round bars: soles stand along a line, balls anywhere around, grasps hold the axis;
// and bars are in the way.
#include <gtest/gtest.h>
#include <locograph/check/bar_contact.h>
#include <locograph/check/judge.h>
#include <locograph/check/judged_stance.h>
#include <locograph/check/limits.h>
#include <locograph/robots/robot_state.h>

#include <cmath>
#include <numbers>

#include "check/centauro_on_wheels.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Eigen::Vector3d;
using Names = std::set<std::string>;

/// A block of 0.3 x 0.2 x 0.1 m that stands on its bottom, on a ball 0.05 m below it or hangs on a
/// hand there; above it, on a joint, a ball of 0.05 m at 0.5 m. The centre of mass is above the
/// middle of the bottom.
class OnBars : public ::testing::Test {
 protected:
  OnBars() : q_(robot_->neutral_configuration()) { q_[2] = 1.0; }

  /// Along y, 0.02 m thick, so high that the bottom of the block is on it.
  static Bar rung(double x = 0.0) {
    return {.name = "rung", .from = {x, -0.5, 0.98}, .to = {x, 0.5, 0.98}, .radius_m = 0.02};
  }
  static Contact sole() {
    return {.effector = {.name = "foot",
                         .link = "block",
                         .half_x_m = 0.15,
                         .half_y_m = 0.1,
                         .friction = 0.5,
                         .max_force_N = 1000.0},
            .position = {0.0, 0.0, 1.0},
            .forward = Vector3d::UnitX()};
  }
  /// Touches below the centre of mass, by a normal that is turned from z towards x by the angle.
  static Contact ball(double angle = 0.0) {
    Contact contact;
    contact.effector = {.name = "ball",
                        .link = "block",
                        .kind = ContactKind::kPoint,
                        .point = {0.03 * std::sin(angle), 0.0, -0.05},
                        .radius_m = 0.03,
                        .friction = 0.5,
                        .max_force_N = 1000.0};
    contact.normal = {std::sin(angle), 0.0, std::cos(angle)};
    contact.position = {0.0, 0.0, 0.95 - 0.03 * std::cos(angle)};
    return contact;
  }
  static Bar below(const Contact& ball) {
    Bar bar = rung();
    for (Vector3d* end : {&bar.from, &bar.to})
      *end = ball.position - bar.radius_m * ball.normal + end->y() * Vector3d::UnitY();
    return bar;
  }
  static Contact grasp() {
    return {.effector = {.name = "hand",
                         .link = "block",
                         .kind = ContactKind::kGrasp,
                         .point = {0.0, 0.0, -0.05},
                         .max_force_N = 1000.0,
                         .max_moment_Nm = 10.0},
            .position = {0.0, 0.0, 0.95},
            .forward = Vector3d::UnitX()};
  }
  static Bar held() {
    Bar bar = rung();
    bar.from.z() = bar.to.z() = 0.95;
    return bar;
  }
  void turn(double yaw, Contact& contact) {
    const Eigen::AngleAxisd turned(yaw, Vector3d::UnitZ());
    q_.segment<4>(3) = Eigen::Quaterniond(turned).coeffs();
    contact.forward = turned * Vector3d::UnitX();
  }

  static World with(std::vector<Bar> bars) {
    World world;
    world.bars = std::move(bars);
    return world;
  }
  CheckReport check(const Contact& contact, const World& world,
                    const CheckOptions& options = {}) const {
    return Judge(robot_, world).check(q_, {{contact}}, options);
  }
  CheckReport check(const Contact& contact, const Bar& bar) const {
    return check(contact, with({bar}));
  }
  Support support(const Contact& contact, const World& world) const {
    RobotState state(*robot_);
    state.update(q_.data());
    std::vector<Eigen::Isometry3d> poses;
    for (int link = 0; link < 2; ++link) poses.push_back(state.world_from_link(link));
    const JudgedStance stance(*robot_, world, {{contact}}, {});
    return support_of(stance.contacts[0], world, poses);
  }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_ = std::make_shared<const Robot>(Robot::load(folder_.write(
      "block.urdf",
      "<robot name='block'><link name='block'><inertial><origin xyz='0 0 0.05'/><mass value='10'/>"
      "<inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial><collision><origin "
      "xyz='0 0 0.05'/><geometry><box size='0.3 0.2 0.1'/></geometry></collision></link><link "
      "name='pole'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' "
      "izz='1'/></inertial><collision><geometry><sphere radius='0.05'/></geometry></collision>"
      "</link><joint name='neck' type='revolute'><parent link='block'/><child link='pole'/><origin "
      "xyz='0 0 0.5'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' velocity='1' effort='100'/>"
      "</joint></robot>")));
  Eigen::VectorXd q_;
};

void expect_line(const Support& support, double length, const Eigen::Vector2d& along) {
  EXPECT_TRUE(support.known);
  EXPECT_EQ(support.outside_m, 0.0);
  ASSERT_EQ(support.area.size(), 2u);
  const Eigen::Vector2d way = support.area[1] - support.area[0];
  EXPECT_NEAR(std::abs(way.dot(along.normalized())), length, 1e-9);
  EXPECT_NEAR(way.norm(), length, 1e-9);
}

TEST_F(OnBars, ASoleAcrossABarStandsOnALine) {
  const CheckReport report = check(sole(), rung());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_TRUE(report.feasible);
  EXPECT_GT(report.min_balance_margin.value(), 0.1);
  EXPECT_EQ(report.trusted, std::vector<std::string>{"foot: what it can bear"});
  EXPECT_TRUE(report.constraint("contact_on_surface").judged);
  EXPECT_NE(report.constraint("contact_on_surface").what.find("on rung"), std::string::npos);
  const Support whole = support(sole(), with({rung()}));
  expect_line(whole, 0.2, Eigen::Vector2d::UnitY());
  EXPECT_NEAR(whole.area[0].x(), 0.0, 1e-12);
  EXPECT_EQ(whole.friction, 0.5);
  // A line bears no moment about itself.
  EXPECT_EQ(violated(check(sole(), rung(0.01))), Names{"static_balance"});
  // Two of them are an area again.
  EXPECT_EQ(violated(check(sole(), with({rung(-0.05), rung(0.1)}))), Names{});
  EXPECT_EQ(support(sole(), with({rung(-0.05), rung(0.1)})).area.size(), 4u);
}

TEST_F(OnBars, TheLineIsWhatTheBarAndTheSoleHaveInCommon) {
  Bar half = rung();
  half.to.y() = 0.04;
  half.friction = 0.2;
  expect_line(support(sole(), with({half})), 0.14, Eigen::Vector2d::UnitY());
  EXPECT_EQ(support(sole(), with({half})).friction, 0.2);
  // Turned, so that the bar is along the sole's own x.
  Contact turned = sole();
  turn(0.5 * std::numbers::pi, turned);
  expect_line(support(turned, with({rung()})), 0.3, Eigen::Vector2d::UnitX());
  EXPECT_EQ(violated(check(turned, rung())), Names{});
  turn(0.25 * std::numbers::pi, turned);
  expect_line(support(turned, with({rung()})), 0.2 * std::numbers::sqrt2, {1.0, 1.0});
  EXPECT_EQ(violated(check(turned, rung())), Names{});
}

TEST_F(OnBars, ASoleIsRefusedOnABarThatItMisses) {
  // Beside it, as near as a corner gets to the middle.
  CheckReport report = check(sole(), rung(0.16));
  EXPECT_EQ(violated(report), (Names{"contact_on_surface", "static_balance"}));
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.01, 1e-9);
  report = check(sole(), rung(0.5));
  EXPECT_TRUE(violated(report).contains("contact_on_surface"));
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.5 - std::hypot(0.15, 0.1), 1e-9);
  // Beyond its end.
  Bar beyond = rung();
  beyond.from.y() = 0.3;
  report = check(sole(), beyond);
  EXPECT_EQ(violated(report), (Names{"contact_on_surface", "static_balance"}));
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.2, 1e-9);
  EXPECT_NE(report.constraint("contact_on_surface").what.find("beyond"), std::string::npos);
  // Too low, and across the normal no longer.
  Bar low = rung();
  low.from.z() = low.to.z() -= 5e-4;
  EXPECT_NEAR(check(sole(), low).constraint("contact_on_surface").worst, 5e-4, 1e-9);
  low = rung();
  low.to.z() += 5e-3;
  EXPECT_TRUE(violated(check(sole(), low)).contains("contact_on_surface"));
}

TEST_F(OnBars, ABallStandsOnABarAnywhereAroundIt) {
  for (const double angle : {0.0, 0.3, -0.3}) {
    const Bar bar = below(ball(angle));
    EXPECT_EQ(violated(check(ball(angle), bar)), Names{}) << angle;
    // Steeper than what friction holds.
    Bar slippery = bar;
    slippery.friction = 0.2;
    EXPECT_EQ(violated(check(ball(angle), slippery)),
              angle == 0.0 ? Names{} : Names{"static_balance"});
  }
  Bar bar = below(ball());
  bar.from.z() = bar.to.z() -= 1e-3;
  CheckReport report = check(ball(), bar);
  EXPECT_EQ(violated(report), Names{"contact_on_surface"});
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 1e-3, 1e-9);
  // A normal that is none of the bar's.
  EXPECT_TRUE(violated(check(ball(0.1), below(ball(0.0)))).contains("contact_on_surface"));
  bar = below(ball());
  bar.from.y() = 0.2;
  report = check(ball(), bar);
  EXPECT_EQ(violated(report), (Names{"contact_on_surface", "static_balance"}));
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.2, 1e-9);
}

TEST_F(OnBars, AHandHoldsTheAxisOfABar) {
  CheckReport report = check(grasp(), held());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_EQ(report.trusted, std::vector<std::string>{"hand: what it can bear"});
  EXPECT_TRUE(report.constraint("contact_on_surface").judged);
  Bar bar = held();
  std::swap(bar.from, bar.to);
  EXPECT_EQ(violated(check(grasp(), bar)), Names{});
  // Beyond its end, beside it, and along it.
  bar = held();
  bar.to.y() = -0.1;
  report = check(grasp(), bar);
  EXPECT_EQ(violated(report), (Names{"contact_on_surface", "static_balance"}));
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.1, 1e-9);
  bar = held();
  bar.from.x() = bar.to.x() = 3e-4;
  EXPECT_NEAR(check(grasp(), bar).constraint("contact_on_surface").worst, 3e-4, 1e-9);
  Contact along = grasp();
  along.forward = along.effector.forward = Vector3d::UnitY();
  EXPECT_TRUE(violated(check(along, held())).contains("contact_on_surface"));
}

TEST_F(OnBars, AHandThatHoldsNothingIsRefusedWhereTheWorldIsKnown) {
  World world;
  world.surfaces = {ground()};
  CheckReport report = check(grasp(), world);
  EXPECT_EQ(violated(report), Names{"contact_on_surface"});
  EXPECT_NE(report.constraint("contact_on_surface").what.find("hand holds no bar"),
            std::string::npos);
  report = check(grasp(), rung(1.0));
  EXPECT_EQ(violated(report), Names{"contact_on_surface"});
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, std::hypot(1.0, 0.03), 1e-9);
  // What is not known is told.
  CheckOptions options;
  options.surfaces_known = false;
  const std::vector<std::string> trusted = {"hand: what it can bear", "hand: that there is a bar"};
  report = check(grasp(), world, options);
  EXPECT_EQ(violated(report), Names{});
  EXPECT_EQ(report.trusted, trusted);
  report = check(grasp(), World{});
  EXPECT_EQ(violated(report), Names{});
  EXPECT_FALSE(report.constraint("contact_on_surface").judged);
  EXPECT_EQ(report.trusted, trusted);
}

TEST_F(OnBars, StandingInTheAirBesideBarsIsRefused) {
  World world;
  world.bars = {rung(1.0)};
  world.bars[0].to = world.bars[0].from + Vector3d::UnitZ();  // upright
  EXPECT_TRUE(violated(check(sole(), world)).contains("contact_on_surface"));
  EXPECT_TRUE(violated(check(ball(), world)).contains("contact_on_surface"));
}

TEST_F(OnBars, ALinkThroughABarIsFound) {
  Bar high = rung();
  high.name = "high";
  high.from.z() = high.to.z() = 1.46;  // into the ball on the pole
  CheckReport report = check(sole(), with({rung(), high}));
  EXPECT_EQ(violated(report), Names{"ground_penetration"});
  EXPECT_NEAR(report.constraint("ground_penetration").worst, 0.03, 1e-4);
  EXPECT_EQ(report.constraint("ground_penetration").what, "pole and high");
  high.from.z() = high.to.z() = 1.5701;
  EXPECT_EQ(violated(check(sole(), with({rung(), high}))), Names{});
  // Another one than the foot stands on, which comes up in front of it.
  Bar next = rung(0.1);
  next.from.z() = next.to.z() += 0.01;
  EXPECT_EQ(violated(check(sole(), with({rung(), next}))), Names{"ground_penetration"});
  // The one that it touches, too deep.
  Bar deep = held();
  deep.from.z() = deep.to.z() = 1.0;
  Contact inside = grasp();
  inside.effector.point.setZero();
  inside.position.z() = 1.0;
  report = check(inside, deep);
  EXPECT_EQ(violated(report), Names{"touching_depth"});
  EXPECT_NEAR(report.constraint("touching_depth").worst, 0.02, 1e-4);
}

TEST_F(OnBars, AHandThatOverlapsItsBarMayBeginAndEndToHoldIt) {
  // The ball on the pole is 11.5 mm deep in the bar whose axis is `above` its middle.
  const auto grasp_above = [](double above) {
    Contact contact = grasp();
    contact.effector.link = "pole";
    contact.effector.point = {0.0, 0.0, above};
    contact.position.z() = 1.5 + above;
    return contact;
  };
  const auto check_plan = [&](double above, std::vector<int> stance_from, bool stances_only) {
    Bar high = rung();
    high.name = "high";
    high.from.z() = high.to.z() = 1.5 + above;
    Motion motion;
    motion.stances_only = stances_only;
    motion.stances = {{{sole()}}, {{sole(), grasp_above(above)}}};
    motion.stance_from = std::move(stance_from);
    for (std::size_t i = 0; i < motion.stance_from.size(); ++i) {
      motion.time_s.push_back(static_cast<double>(i));
      motion.configurations.push_back(q_);
    }
    return Judge(robot_, with({rung(), high})).check(motion);
  };
  constexpr double kOverlaps_m = 0.05 + 0.02 - 0.0115, kTooDeep_m = 0.05 + 0.02 - 0.013;
  EXPECT_EQ(violated(check_plan(kOverlaps_m, {1}, true)), Names{});
  const CheckReport ends = check_plan(kOverlaps_m, {1, 0}, true);
  EXPECT_EQ(violated(ends), Names{});
  EXPECT_NEAR(ends.constraint("touching_depth").worst, 0.0115, 1e-4) << "it is told";
  EXPECT_TRUE(violated(check_plan(kTooDeep_m, {1, 0}, true)).contains("touching_depth"));
  // Where it holds nothing before and after it is in the way.
  EXPECT_EQ(violated(check_plan(kOverlaps_m, {1, 0, 0}, true)), Names{"ground_penetration"});
  EXPECT_EQ(violated(check_plan(kOverlaps_m, {0, 1}, true)), Names{"ground_penetration"});
  // A motion goes on with its hand in the bar.
  EXPECT_EQ(violated(check_plan(kOverlaps_m, {1, 0}, false)), Names{"ground_penetration"});
}

TEST(BarContact, WheelsAreOnNoBar) {
  Contact wheel;
  wheel.effector.kind = ContactKind::kWheel;
  wheel.effector.radius_m = 0.1;
  wheel.position.z() = 0.02;
  EXPECT_EQ(off_bar_m(wheel, {.name = "rung", .radius_m = 0.02}), kInfinity);
}

}  // namespace
}  // namespace locograph
