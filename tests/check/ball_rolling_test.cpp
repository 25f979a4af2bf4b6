// Balls that are held roll: on planes and round bars, along curves and from stance to stance.
#include <gtest/gtest.h>
#include <locograph/check/ball_rolling.h>
#include <locograph/check/judge.h>

#include <cmath>

#include "check/centauro_on_wheels.h"
#include "common/temporary_folder.h"

namespace locograph {
namespace {

using Eigen::Vector3d;
using Names = std::set<std::string>;

constexpr double kBall_m = 0.03, kBar_m = 0.02;

/// A ball that flies wherever it is told to; it has no mass, so that balance is not judged.
class Ball : public ::testing::Test {
 protected:
  static Eigen::VectorXd at(const Vector3d& centre, const Eigen::Quaterniond& rotation) {
    Eigen::VectorXd q(7);
    q << centre, rotation.coeffs();
    return q;
  }
  static Contact contact(const Vector3d& position, const Vector3d& normal) {
    return {.effector = {.name = "hand",
                         .link = "ball",
                         .kind = ContactKind::kPoint,
                         .radius_m = kBall_m,
                         .friction = 0.5,
                         .max_force_N = 100.0},
            .position = position,
            .normal = normal};
  }
  /// In a stance that lasts.
  static Motion motion(const std::vector<Eigen::VectorXd>& configurations, const Contact& held) {
    Motion motion;
    motion.stances = {{{held}}};
    for (const Eigen::VectorXd& q : configurations) {
      motion.time_s.push_back(0.5 * double(motion.time_s.size()));
      motion.configurations.push_back(q);
      motion.stance_from.push_back(0);
    }
    return motion;
  }
  static Contact on_the_floor() { return contact(Vector3d::Zero(), Vector3d::UnitZ()); }
  /// Turned about `axis`, and moved along x, in a few steps.
  static Motion on_the_floor(double way_m, const Vector3d& turn, int steps = 20) {
    std::vector<Eigen::VectorXd> all;
    for (int i = 0; i <= steps; ++i) {
      const double share = double(i) / steps;
      const Eigen::AngleAxisd turned(share * turn.norm(), turn.stableNormalized());
      all.push_back(at({share * way_m, 0.0, kBall_m}, Eigen::Quaterniond(turned)));
    }
    return motion(all, on_the_floor());
  }
  static World floor(double half_x = kInfinity) {
    World world;
    world.surfaces = {ground()};
    world.surfaces[0].half_x_m = half_x;
    return world;
  }
  static World bar_along_y() {
    World world;
    world.bars = {
        {.name = "bar", .from = {0.0, -0.5, 1.0}, .to = {0.0, 0.5, 1.0}, .radius_m = kBar_m}};
    return world;
  }
  static Contact on_the_bar() { return contact({0.0, 0.0, 1.0 + kBar_m}, Vector3d::UnitZ()); }
  /// Round the bar by `angle` while it turns by `turn`, and along it by `along`.
  static Motion round_the_bar(double angle, double turn, double along = 0.0, int steps = 100) {
    std::vector<Eigen::VectorXd> all;
    for (int i = 0; i <= steps; ++i) {
      const double share = double(i) / steps, phi = share * angle;
      const Vector3d out(std::sin(phi), 0.0, std::cos(phi));
      all.push_back(at(Vector3d(0.0, share * along, 1.0) + (kBar_m + kBall_m) * out,
                       Eigen::Quaterniond(Eigen::AngleAxisd(share * turn, Vector3d::UnitY()))));
    }
    return motion(all, on_the_bar());
  }
  CheckReport check(const Motion& motion, const World& world,
                    const CheckOptions& options = {}) const {
    return Judge(robot_, world).check(motion, options);
  }
  static double slip(const CheckReport& report) {
    EXPECT_EQ(report.ball_rolling.size(), 1u);
    EXPECT_EQ(report.ball_rolling.at(0).end_effector, "hand");
    EXPECT_NEAR(report.ball_rolling.at(0).slip_m, report.constraint("contact_motion").worst, 1e-12);
    return report.ball_rolling.at(0).slip_m;
  }
  static double way(const CheckReport& report) { return report.ball_rolling.at(0).way_m; }

  test::TemporaryFolder folder_;
  std::shared_ptr<const Robot> robot_ = std::make_shared<const Robot>(
      Robot::load(folder_.write("ball.urdf", "<robot name='ball'><link name='ball'/></robot>")));
};

TEST_F(Ball, RollsAcrossTheFloorAsFarAsItTurns) {
  const CheckReport report = check(on_the_floor(0.3, Vector3d(0.0, 0.3 / kBall_m, 0.0)), floor());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_LT(slip(report), 1e-9);
  EXPECT_NEAR(way(report), 0.3, 1e-9);
}

TEST_F(Ball, MaySpinAboutTheNormal) {
  const CheckReport report = check(on_the_floor(0.0, Vector3d(0.0, 0.0, 5.0)), floor());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_LT(slip(report), 1e-9);
  EXPECT_LT(way(report), 1e-9);
}

TEST_F(Ball, ThatTurnsOnTheSpotSlides) {
  const CheckReport report = check(on_the_floor(0.0, Vector3d(0.0, 0.5, 0.0)), floor());
  EXPECT_EQ(violated(report), Names{"contact_motion"});
  EXPECT_NEAR(slip(report), 0.5 * kBall_m, 1e-9);
  EXPECT_NE(report.constraint("contact_motion").what.find("skin"), std::string::npos);
}

TEST_F(Ball, ThatDoesNotTurnSlides) {
  const CheckReport report = check(on_the_floor(0.02, Vector3d::Zero()), floor());
  EXPECT_EQ(violated(report), Names{"contact_motion"});
  EXPECT_NEAR(slip(report), 0.02, 1e-9);
  // The other way.
  EXPECT_NEAR(slip(check(on_the_floor(0.3, Vector3d(0.0, -0.3 / kBall_m, 0.0)), floor())), 0.6,
              1e-6);
}

TEST_F(Ball, SlipWithinAStepCountsEvenIfItComesBack) {
  Motion swings = on_the_floor(0.0, Vector3d::Zero(), 2);
  swings.slopes.assign(3, Eigen::VectorXd::Zero(6));
  swings.slopes[1][0] = 0.1;  // there and back: 4/27 of the slope times the step's duration
  const CheckReport report = check(swings, floor());
  EXPECT_EQ(violated(report), Names{"contact_motion"});
  EXPECT_NEAR(slip(report), 4.0 / 27.0 * 0.1 * 0.5, 1e-5);
}

TEST_F(Ball, RollsOffItsSurface) {
  const Motion rolls = on_the_floor(0.3, Vector3d(0.0, 0.3 / kBall_m, 0.0));
  EXPECT_EQ(violated(check(rolls, floor(0.31))), Names{});
  const CheckReport report = check(rolls, floor(0.25));
  EXPECT_EQ(violated(report), Names{"contact_on_surface"});
  EXPECT_NEAR(report.constraint("contact_on_surface").worst, 0.05, 1e-9);
  // Beyond its border between two vertices only.
  Motion back = on_the_floor(0.0, Vector3d::Zero(), 2);
  back.slopes.assign(3, Eigen::VectorXd::Zero(6));
  back.slopes[1][0] = 0.3;
  back.slopes[1][4] = 0.3 / kBall_m;
  EXPECT_EQ(violated(check(back, floor(0.03))), Names{});
  EXPECT_EQ(violated(check(back, floor(0.02))), Names{"contact_on_surface"});
}

TEST_F(Ball, StaysOnItsPlane) {
  Motion lifted = on_the_floor(0.3, Vector3d(0.0, 0.3 / kBall_m, 0.0));
  lifted.configurations[10][2] += 2e-4;
  CheckReport report = check(lifted, floor());
  EXPECT_EQ(violated(report), Names{"contact_position"});
  EXPECT_NEAR(report.constraint("contact_position").worst, 2e-4, 1e-12);
  lifted.configurations[10][2] -= 3e-3;
  EXPECT_EQ(violated(check(lifted, floor())), (Names{"contact_position", "contact_between"}));
}

// A turn about one axis after the other: what is integrated is compared with small steps.
TEST_F(Ball, WhatTurnsAboutManyAxesIsIntegratedAlongTheCurve) {
  Motion wobbles = on_the_floor(0.0, Vector3d::Zero(), 6);
  const std::vector<Vector3d> turns = {{0.0, 0.0, 0.0}, {1.0, 0.5, 0.2},   {-0.5, 1.5, 1.0},
                                       {0.3, 0.2, 2.0}, {-1.0, -1.0, 1.0}, {0.5, 0.0, 0.0},
                                       {0.0, 0.0, 0.0}};
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Eigen::AngleAxisd turned(turns[i].norm(), turns[i].stableNormalized());
    wobbles.configurations[i].segment<4>(3) = Eigen::Quaterniond(turned).coeffs();
  }
  const MotionCurve curve(*robot_, wobbles);
  Vector3d skin = Vector3d::Zero();
  double most = 0.0;
  constexpr int kParts = 2000;
  for (int step = 0; step < 6; ++step) {
    for (int part = 0; part < kParts; ++part) {
      CurvePoint middle;
      curve.step(step).at((part + 0.5) / kParts, middle);
      const Eigen::Quaterniond rotation(Eigen::Vector4d(middle.configuration.segment<4>(3)));
      const Vector3d w = rotation * Vector3d(middle.velocity.segment<3>(3));
      skin -= kBall_m * w.cross(Vector3d::UnitZ()) * (0.5 / kParts);
      most = std::max(most, skin.norm());
    }
  }
  EXPECT_GT(most, 0.03);
  EXPECT_NEAR(slip(check(wobbles, floor())), most, 2e-6);
  // Coarse samples are halved until they do.
  CheckOptions coarse;
  coarse.max_step_m = coarse.max_step_rad = 1.0;
  EXPECT_NEAR(slip(check(wobbles, floor(), coarse)), most, 1e-3 * most);
}

TEST_F(Ball, RollsRoundABarAndItsNormalGoesAlong) {
  const double angle = 0.8, turn = angle * (kBar_m + kBall_m) / kBall_m;
  CheckReport report = check(round_the_bar(angle, turn), bar_along_y());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_LT(slip(report), 1e-6);
  EXPECT_NEAR(way(report), kBar_m * angle, 1e-6);
  EXPECT_LT(report.constraint("contact_position").worst, 1e-9);
  // As far as on a plane is too far.
  report = check(round_the_bar(angle, angle), bar_along_y());
  EXPECT_EQ(violated(report), Names{"contact_motion"});
  EXPECT_NEAR(slip(report), kBar_m * angle, 1e-6);
  // With its centre at rest.
  report = check(round_the_bar(0.0, 0.5), bar_along_y());
  EXPECT_EQ(violated(report), Names{"contact_motion"});
  EXPECT_NEAR(slip(report), kBall_m * 0.5, 1e-6);
}

TEST_F(Ball, OnABarThatIsNotThereIsALie) {
  const double angle = 0.8, turn = angle * (kBar_m + kBall_m) / kBall_m;
  CheckOptions options;
  options.known = {on_the_bar().effector};
  Motion motion = round_the_bar(angle, turn);
  motion.stances[0].contacts[0].bar = RoundBar{Vector3d::UnitY(), kBar_m};
  EXPECT_EQ(violated(check(motion, bar_along_y(), options)), Names{});
  motion.stances[0].contacts[0].bar->radius_m = 2.0 * kBar_m;
  EXPECT_EQ(violated(check(motion, bar_along_y(), options)), Names{"contact_claims"});
  motion = on_the_floor(0.3, Vector3d(0.0, 0.3 / kBall_m, 0.0));
  motion.stances[0].contacts[0].bar = RoundBar{Vector3d::UnitY(), kBar_m};
  EXPECT_EQ(violated(check(motion, floor(), options)), Names{"contact_claims"});
}

TEST_F(Ball, RollsAlongABarToItsEnd) {
  const auto along = [](double way) {
    std::vector<Eigen::VectorXd> all;
    for (int i = 0; i <= 20; ++i) {
      const double y = way * i / 20.0;
      all.push_back(at({0.0, y, 1.0 + kBar_m + kBall_m},
                       Eigen::Quaterniond(Eigen::AngleAxisd(-y / kBall_m, Vector3d::UnitX()))));
    }
    return motion(all, on_the_bar());
  };
  const CheckReport report = check(along(0.4), bar_along_y());
  EXPECT_EQ(violated(report), Names{});
  EXPECT_LT(slip(report), 1e-9);
  EXPECT_NEAR(way(report), 0.4, 1e-9);
  EXPECT_EQ(violated(check(along(0.6), bar_along_y())), Names{"contact_on_surface"});
  // Round it and along it, turning for the way round only.
  EXPECT_NEAR(slip(check(round_the_bar(0.6, 1.0, 0.1), bar_along_y())), 0.1, 1e-6);
}

TEST_F(Ball, WhereItTouchedDownOnASurfaceItRollsOnThat) {
  World world = bar_along_y();
  world.surfaces = {ground()};
  world.surfaces[0].world_from_surface.translation() = Vector3d(0.0, 0.0, 1.0 + kBar_m);
  EXPECT_TRUE(
      violated(check(round_the_bar(0.8, 0.8 * 5.0 / 3.0), world)).contains("contact_position"));
  world.surfaces[0].half_x_m = 0.1;
  world.surfaces[0].world_from_surface.translation().x() = 0.5;
  EXPECT_EQ(violated(check(round_the_bar(0.8, 0.8 * 5.0 / 3.0), world)), Names{});
}

TEST_F(Ball, FromStanceToStanceItRollsByTheShortestTurn) {
  Motion plan = on_the_floor(0.06, Vector3d(0.0, 2.0, 0.0), 2);
  plan.stances_only = true;
  CheckReport report = check(plan, floor());
  EXPECT_LT(slip(report), 1e-9);
  EXPECT_NEAR(way(report), 0.06, 1e-9);
  plan.configurations[1].head<3>().x() += 2e-3;
  report = check(plan, floor());
  EXPECT_NEAR(slip(report), 2e-3, 1e-9);
  EXPECT_TRUE(violated(report).contains("contact_motion"));
}

TEST_F(Ball, IsAtItsPlaceWhereItTouchesDown) {
  Motion rolls = on_the_floor(0.3, Vector3d(0.0, 0.3 / kBall_m, 0.0));
  rolls.stances[0].contacts[0].position.x() += 3e-4;
  const CheckReport report = check(rolls, floor());
  EXPECT_EQ(violated(report), Names{"contact_position"});
  EXPECT_EQ(report.constraint("contact_position").at_vertex, 0);
  EXPECT_NEAR(report.constraint("contact_position").worst, 3e-4, 1e-9);
  // A part of a motion begins on the way.
  const MotionCurve curve(*robot_, rolls);
  const Motion part = part_of(curve, 5, 15);
  CheckOptions options;
  EXPECT_TRUE(violated(check(part, floor(), options)).contains("contact_position"));
  options.starts_at_rest = options.ends_at_rest = false;
  EXPECT_EQ(violated(check(part, floor(), options)), Names{});
}

TEST_F(Ball, ANewPlaceInTheNextStanceIsALie) {
  Motion slides = on_the_floor(0.02, Vector3d::Zero());
  for (std::size_t i = 1; i < slides.configurations.size(); ++i) {
    slides.stances.push_back(slides.stances[0]);
    slides.stances.back().contacts[0].position.x() = slides.configurations[i].x();
    slides.stance_from[i] = int(i);
  }
  const CheckReport report = check(slides, floor());
  EXPECT_EQ(violated(report), (Names{"contact_motion", "contact_relabelled"}));
  EXPECT_NEAR(slip(report), 0.02, 1e-9);
}

TEST_F(Ball, APlaceThatWalksInSmallStepsIsALie) {
  Motion stands = on_the_floor(0.0, Vector3d::Zero());
  for (std::size_t i = 1; i < stands.configurations.size(); ++i) {
    stands.stances.push_back(stands.stances.back());
    stands.stances.back().contacts[0].position.x() += 9e-5;
    stands.stance_from[i] = int(i);
  }
  const CheckReport report = check(stands, floor());
  EXPECT_EQ(violated(report), Names{"contact_relabelled"});
  EXPECT_EQ(report.constraint("contact_relabelled").at_vertex, 2);
}

}  // namespace
}  // namespace locograph
