// What simulate() makes of bad input, of perturbations, and of robots that fall.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/execution/engine.h>
#include <locograph/execution/simulation.h>

#include <cmath>
#include <limits>

#include "execution/standing_coman.h"

namespace locograph::test {
namespace {

template <class F>
void expect_error(F&& job, const std::string& words) {
  try {
    job();
    ADD_FAILURE() << "no error about " << words;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

class Simulations : public testing::Test {
 protected:
  StandingComan coman;
  EndEffector hand() const {
    return {.name = "hand",
            .link = "LBall",
            .kind = ContactKind::kPoint,
            .point = {0.0, 0.0, -0.0105},
            .radius_m = 0.071,
            .friction = 0.6,
            .max_force_N = 100.0};
  }
  Eigen::Vector3d hand_centre() const {
    RobotState state(coman.robot);
    state.update(coman.configuration.data());
    return state.world_from_link(coman.robot.link_index(hand().link)) * hand().point;
  }
  SimulationResult run(const Motion& motion, const SimulationOptions& options = {}) const {
    return simulate(coman.robot, coman.effectors, coman.world, motion, options);
  }
};

TEST_F(Simulations, TheSameSeedGivesTheSameRun) {
  const SimulationOptions options = {.mass_error = 0.05,
                                     .contact_error_m = 0.002,
                                     .push_N = 20.0,
                                     .initial_error_rad = 0.003,
                                     .seed = 7,
                                     .record_every_s = 0.1};
  const SimulationResult one = run(coman.standing(), options), two = run(coman.standing(), options);
  EXPECT_TRUE(one.upright) << one.reason;
  EXPECT_GE(one.pushed_at_s, 0.0);
  ASSERT_EQ(one.samples.size(), two.samples.size());
  EXPECT_EQ(one.samples.back().configuration, two.samples.back().configuration);
  SimulationOptions other = options;
  other.seed = 8;
  EXPECT_NE(run(coman.standing(), other).samples.back().configuration,
            one.samples.back().configuration);
}

TEST_F(Simulations, ForcesAndMomentsThatAreMeasuredHoldTheRobot) {
  const SimulationResult result = run(coman.standing(), {.record_every_s = 0.5});
  ASSERT_GT(result.samples.size(), 3U);
  const SimulationSample& sample = result.samples[result.samples.size() - 2];
  RobotState state(coman.robot);
  state.update(sample.configuration.data());
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (std::size_t e = 0; e < coman.effectors.size(); ++e) {
    const Eigen::Vector3d arm = coman.sole(e, sample.configuration) - state.center_of_mass();
    force += sample.forces[e];
    moment += arm.cross(sample.forces[e]) + sample.moments[e];
    EXPECT_GT(sample.moments[e].norm(), 0.1);  // it does not stand over the middle of its soles
  }
  EXPECT_LT((force - coman.weight_N() * Eigen::Vector3d::UnitZ()).norm(), 0.01 * coman.weight_N());
  EXPECT_LT(moment.norm(), 0.005 * coman.weight_N());
}

TEST_F(Simulations, SurfacesAreThinFromBelow) {
  const EndEffector ball = hand();
  const Eigen::Vector3d centre = hand_centre();
  Surface shelf = ground();
  shelf.half_x_m = shelf.half_y_m = 0.1;
  const auto penetration_m = [&](double above_m) {
    shelf.world_from_surface.translation() =
        centre + (ball.radius_m + above_m) * Eigen::Vector3d::UnitZ();
    Engine engine(coman.robot, {&ball, 1}, {.surfaces = {shelf}});
    engine.set_state(coman.configuration, Eigen::VectorXd::Zero(coman.robot.tangent_size()));
    return engine.penetration_m();
  };
  EXPECT_EQ(penetration_m(0.004), 0.0);
  EXPECT_GT(penetration_m(-0.004), 0.003);
}

TEST_F(Simulations, AFreeHandThatTouchesIsTold) {
  std::vector<EndEffector> effectors = coman.effectors;
  effectors.push_back(hand());
  Surface shelf = ground();
  shelf.half_x_m = shelf.half_y_m = 0.05;
  const auto link_that_touches = [&](double above_m) {
    shelf.world_from_surface.translation() =
        hand_centre() - (hand().radius_m + above_m) * Eigen::Vector3d::UnitZ();
    return simulate(coman.robot, effectors, {.surfaces = {ground(), shelf}}, coman.standing())
        .other_link;
  };
  EXPECT_EQ(link_that_touches(-0.0028), "LBall");
  EXPECT_EQ(link_that_touches(0.01), "");
}

/// COMAN+ stands, one hand round a bar, which it holds in the second half or all the time.
struct HandOnABar {
  StandingComan coman;
  EndEffector hand{.name = "grip",
                   .link = "LBall",
                   .kind = ContactKind::kGrasp,
                   .point = {0.0, 0.0, -0.08},
                   .friction = 0.6,
                   .max_force_N = 300.0,
                   .max_moment_Nm = 20.0};
  Bar bar{.name = "rail", .radius_m = 0.02};
  Motion motion = coman.standing();

  HandOnABar() {
    RobotState state(coman.robot);
    state.update(coman.configuration.data());
    const Eigen::Isometry3d& pose = state.world_from_link(coman.robot.link_index(hand.link));
    const Eigen::Vector3d at = pose * hand.point;
    // The bar lies across; the hand's own axes are those that fit.
    hand.normal = pose.linear().transpose() * Eigen::Vector3d::UnitZ();
    hand.forward = pose.linear().transpose() * Eigen::Vector3d::UnitX();
    bar.from = at - 0.1 * Eigen::Vector3d::UnitY();
    bar.to = at + 0.1 * Eigen::Vector3d::UnitY();
    Stance held = coman.both_feet();
    held.contacts.push_back(
        {.effector = hand, .position = at, .forward = Eigen::Vector3d::UnitX()});
    motion.stances = {held};
  }
  SimulationResult run(const SimulationOptions& options = {}) const {
    std::vector<EndEffector> effectors = coman.effectors;
    effectors.push_back(hand);
    return simulate(coman.robot, effectors, {.surfaces = {ground()}, .bars = {bar}}, motion,
                    options);
  }
};

TEST(Grasps, HoldARobotThatIsPushed) {
  HandOnABar held;
  held.motion.time_s.back() = 4.0;
  const SimulationOptions push{.push_N = 150.0, .push_s = 0.3, .seed = 2, .record_every_s = 0.01};
  const SimulationResult with = held.run(push);
  EXPECT_TRUE(with.carried_out) << with.reason;
  double most_N = 0.0;
  for (const SimulationSample& sample : with.samples) {
    most_N = std::max(most_N, sample.forces[2].norm());
  }
  EXPECT_GT(most_N, 50.0);
  held.motion.stances[0].contacts.pop_back();
  EXPECT_FALSE(held.run(push).carried_out);
}

TEST(Grasps, CloseWhenTheirStanceListsThemAndOpenAfterIt) {
  HandOnABar held;
  const Eigen::VectorXd q = held.coman.configuration;
  held.motion.time_s = {0.0, 2.0, 4.0, 6.0};
  held.motion.configurations = {q, q, q, q};
  held.motion.stances = {held.coman.both_feet(), held.motion.stances[0]};
  held.motion.stance_from = {0, 1, 0, 0};
  const SimulationResult result = held.run({.record_every_s = 0.02});
  EXPECT_TRUE(result.carried_out) << result.reason;
  bool held_in_between = false;
  for (const SimulationSample& sample : result.samples) {
    const double force_N = sample.forces[2].norm();
    if (sample.stance == 0) {
      EXPECT_EQ(force_N, 0.0) << sample.plan_time_s;
    }
    held_in_between = held_in_between || force_N > 0.01;
  }
  EXPECT_TRUE(held_in_between);
}

TEST(Grasps, GiveWayBeyondTheirLimits) {
  HandOnABar held;
  held.hand.max_force_N = 20.0;
  held.motion.stances[0].contacts.back().effector.max_force_N = 20.0;
  held.motion.time_s.back() = 4.0;
  const SimulationResult result =
      held.run({.push_N = 150.0, .push_s = 0.3, .seed = 2, .record_every_s = 0.01});
  EXPECT_FALSE(result.carried_out);
  EXPECT_NE(result.reason.find("the grasp of grip gave way at "), std::string::npos)
      << result.reason;
  EXPECT_FALSE(result.samples.back().forces[2].norm() > 0.0);
}

TEST(Grasps, HoldNothingWhereThereIsNoBar) {
  HandOnABar held;
  held.bar.from.z() += 0.05;
  held.bar.to.z() += 0.05;
  EXPECT_FALSE(held.run().carried_out);
}

TEST_F(Simulations, ObstaclesDoNotWaitForTheRobot) {
  Obstacle cart;
  cart.size = Eigen::Vector3d(0.2, 0.2, 0.4);
  cart.world_from_obstacle.translation() = Eigen::Vector3d(-3.0, 0.0, 1.0);
  cart.motion = {{.time_s = 1.5}};
  cart.motion[0].pose.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  const auto run_past = [&](double x) {
    cart.motion[0].pose.translation().x() = x;
    return simulate(coman.robot, coman.effectors, {.obstacles = {cart}, .surfaces = {ground()}},
                    coman.standing());
  };
  EXPECT_FALSE(run_past(0.0).carried_out);
  EXPECT_TRUE(run_past(-1.0).carried_out);
}

TEST_F(Simulations, MapsAreInTheWay) {
  const auto map = std::make_shared<octomap::OcTree>(0.05);
  const Eigen::Vector3f at = hand_centre().cast<float>();
  map->updateNode(octomap::point3d(at.x(), at.y(), at.z()), true);
  expect_error(
      [&] {
        simulate(coman.robot, coman.effectors, {.map = map, .surfaces = {ground()}},
                 coman.standing());
      },
      "deep");
}

TEST_F(Simulations, ASoleOnABarIsKeptAsItWasPlanned) {
  Surface right = ground();
  right.half_x_m = 1.0;
  right.half_y_m = 0.5;
  right.world_from_surface.translation().y() = -0.5;
  const Eigen::Vector3d left = coman.sole(0, coman.configuration);
  const Bar bar = {.name = "bar",
                   .from = {left.x(), 0.05, left.z() - 0.02},
                   .to = {left.x(), 0.6, left.z() - 0.02},
                   .radius_m = 0.02,
                   .friction = 0.6};
  Motion motion = coman.standing();
  motion.time_s.back() = 10.0;
  const SimulationResult result =
      simulate(coman.robot, coman.effectors, {.surfaces = {right}, .bars = {bar}}, motion,
               {.initial_error_rad = 0.01, .seed = 3, .record_every_s = 1.0});
  EXPECT_TRUE(result.carried_out) << result.reason;
  RobotState state(coman.robot);
  state.update(result.samples.back().configuration.data());
  const int link = coman.robot.link_index("l_sole");
  const Eigen::Vector3d up = state.world_from_link(link).linear().col(2);
  state.update(coman.configuration.data());
  EXPECT_LT(angle_between(state.world_from_link(link).linear().col(2), up), 0.03);
}

TEST_F(Simulations, ARobotThatStandsOnNothingFalls) {
  Motion motion = coman.standing();
  motion.time_s.back() = 5.0;
  const SimulationResult result = run(motion, {.push_N = 2000.0, .push_s = 1.0});
  EXPECT_FALSE(result.upright);
  EXPECT_FALSE(result.reached_goal);
  EXPECT_NE(result.reason.find("falls"), std::string::npos) << result.reason;
}

TEST_F(Simulations, OnIceItSlipsAndThatIsTold) {
  Motion motion = coman.standing();
  motion.configurations.back()[0] += 0.05;  // its feet do not come along
  const SimulationResult result = run(motion, {.friction_factor = 0.001});
  EXPECT_FALSE(result.carried_out);
  EXPECT_FALSE(result.reason.empty());
}

TEST_F(Simulations, ContactsThatAreSaidToBeElsewhereAreNotReached) {
  Motion motion = coman.standing();
  motion.stances[0].contacts[1].position.x() += 0.05;
  const SimulationResult result = run(motion);
  EXPECT_FALSE(result.reached_goal);
  EXPECT_NE(result.reason.find("contact of right_foot ends 50 mm off"), std::string::npos)
      << result.reason;
}

TEST_F(Simulations, RefuseWhatCannotBeCarriedOut) {
  Motion motion = coman.standing();
  motion.time_s.back() = 0.0;
  expect_error([&] { run(motion); }, "not after the one before");
  motion = coman.standing();
  motion.stance_from.back() = -1;
  expect_error([&] { run(motion); }, "has no stance");
  motion = coman.standing();
  motion.stances_only = true;
  expect_error([&] { run(motion); }, "no times");
  motion = coman.standing();
  motion.configurations.back()[3] = std::numeric_limits<double>::quiet_NaN();
  expect_error([&] { run(motion); }, "not finite");
  motion = coman.standing();
  motion.stances[0].contacts[0].effector.name = "third_foot";
  expect_error([&] { run(motion); }, "third_foot");
  motion = coman.standing();
  for (Eigen::VectorXd& q : motion.configurations) q[2] -= 0.05;
  expect_error([&] { run(motion); }, "50 mm deep");
}

TEST_F(Simulations, RefusePerturbationsWithoutSense) {
  const Motion motion = coman.standing();
  expect_error([&] { run(motion, {.controller = "magic"}); }, "controller");
  expect_error([&] { run(motion, {.friction_factor = -1.0}); }, "friction_factor");
  expect_error([&] { run(motion, {.mass_error = 1.0}); }, "mass_error");
  expect_error([&] { run(motion, {.contact_error_m = std::nan("")}); }, "contact_error_m");
  expect_error([&] { run(motion, {.push_N = -30.0}); }, "push_N");
  expect_error([&] { run(motion, {.initial_error_rad = 1.0}); }, "initial_error_rad");
}

}  // namespace
}  // namespace locograph::test
