// Plans of the planners in the engine: carried out, and with the same dynamics.
#include <gtest/gtest.h>
#include <locograph/common/data_folder.h>
#include <locograph/execution/engine.h>
#include <locograph/execution/simulation.h>
#include <locograph/planners/balance/linear_programme.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/offline/motion/motion_planner.h>
#include <locograph/robots/dynamics.h>

#include "common/sanitized.h"
#include "planners/stance_tasks.h"

namespace locograph::test {
namespace {

const Task& standing_up() {
  static const Task task = stance_task_with_margin("standing_up");
  return task;
}
const Motion& standing_up_motion() {
  static const MotionPlan plan = plan_motion(standing_up(), {.seed = 1});
  return plan.motion;
}

class PlannedMotions : public testing::Test {
 protected:
  void SetUp() override {
    if (kSanitized) GTEST_SKIP() << "plans take long there";
  }
};

SimulationResult carried_out(const Task& task, const Motion& motion,
                             const SimulationOptions& options) {
  return simulate(*task.robot->robot, effectors_of(motion, task.end_effectors()),
                  task.world->world(), motion, options);
}

TEST_F(PlannedMotions, CentauroDrives) {
  const Task task = task_of(load_scenario("centauro_drive", data_folder()));
  const Motion motion = plan_wheeled_drive(task).motion;
  ASSERT_FALSE(motion.configurations.empty());
  const SimulationResult result =
      carried_out(task, motion, {.initial_error_rad = 0.005, .seed = 3});
  EXPECT_TRUE(result.carried_out) << result.reason;
  EXPECT_LT(result.max_base_error_m, 0.01);
}

TEST_F(PlannedMotions, ComanStandsUp) {
  ASSERT_FALSE(standing_up_motion().configurations.empty());
  const SimulationResult result =
      carried_out(standing_up(), standing_up_motion(), {.initial_error_rad = 0.005, .seed = 4});
  EXPECT_TRUE(result.carried_out) << result.reason;
  EXPECT_LE(result.max_torque_ratio, 1.0);
  EXPECT_LT(result.max_base_error_m, 0.02);
}

TEST_F(PlannedMotions, InverseDynamicsAreThoseOfTheEngine) {
  const Robot& robot = *standing_up().robot->robot;
  const Motion& motion = standing_up_motion();
  Engine engine(robot, standing_up().end_effectors(), standing_up().world->world());
  RobotDynamics dynamics(robot);
  RobotState state(robot);
  const MotionCurve curve(robot, motion);
  CurvePoint point;
  Eigen::VectorXd ours(robot.tangent_size());
  double worst = 0.0, largest = 0.0;
  for (int i = 0; i + 1 < static_cast<int>(motion.configurations.size()); ++i) {
    curve.step(i).at(0.3, point);
    engine.set_state(point.configuration, point.velocity);
    state.update(point.configuration.data());
    dynamics.inverse_dynamics(state, point.velocity, point.acceleration, {}, ours);
    worst =
        std::max(worst, (engine.inverse_dynamics(point.acceleration) - ours).cwiseAbs().maxCoeff());
    largest = std::max(largest, ours.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(largest, 100.0);
  EXPECT_LT(worst, 1e-9 * largest);
}

/// The least and the most that each contact can be pressed with while all of them hold the robot.
std::vector<std::pair<double, double>> certified_range(const RobotState& state,
                                                       const Stance& stance, double weight_N) {
  std::vector<BearingRay> rays;
  std::vector<std::size_t> of;
  for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
    for (const BearingRay& ray : bearing_rays({stance.contacts[c]}, 0.0, weight_N)) {
      rays.push_back(ray);
      of.push_back(c);
    }
  }
  std::vector<std::pair<double, double>> ranges;
  for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
    double bounds[2];
    for (const int sign : {1, -1}) {
      LinearProgramme programme;
      programme.resize(6, static_cast<int>(rays.size()));
      for (std::size_t r = 0; r < rays.size(); ++r) {
        const BearingRay& ray = rays[r];
        const Eigen::Vector3d arm = ray.at - state.center_of_mass();
        const auto column = static_cast<Eigen::Index>(r);
        programme.matrix().col(column) << ray.force, ray.moment + arm.cross(ray.force);
        programme.cost()[column] = of[r] == c ? sign : 0.0;
      }
      for (int i = 0; i < 6; ++i) programme.bound_row(i, i == 2 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0);
      EXPECT_EQ(programme.solve(), LinearAnswer::kOptimal);
      bounds[sign < 0] = sign * programme.value() * weight_N;
    }
    ranges.emplace_back(bounds[0], bounds[1]);
  }
  return ranges;
}

TEST_F(PlannedMotions, ForcesAtRestAreAmongThoseThatBalance) {
  const Robot& robot = *standing_up().robot->robot;
  const Motion& motion = standing_up_motion();
  const double weight_N = robot.total_mass() * standard_gravity().norm();
  RobotState state(robot);
  const std::vector<EndEffector> effectors = effectors_of(motion, standing_up().end_effectors());
  for (const std::size_t at : {std::size_t{0}, motion.configurations.size() - 1}) {
    const Eigen::VectorXd& q = motion.configurations[at];
    const Stance& stance = motion.stances[static_cast<std::size_t>(motion.stance_from[at])];
    const Motion standing{
        .time_s = {0.0, 1.0}, .configurations = {q, q}, .stances = {stance}, .stance_from = {0, 0}};
    const SimulationResult result = carried_out(standing_up(), standing, {.record_every_s = 0.01});
    ASSERT_TRUE(result.carried_out) << result.reason;
    state.update(q.data());
    const auto ranges = certified_range(state, stance, weight_N);
    for (std::size_t c = 0; c < stance.contacts.size(); ++c) {
      const Contact& contact = stance.contacts[c];
      const auto named = std::find_if(effectors.begin(), effectors.end(), [&](const auto& known) {
        return known.name == contact.name();
      });
      const double pressing =
          result.samples.back().forces[static_cast<std::size_t>(named - effectors.begin())].dot(
              contact.normal);
      EXPECT_GE(pressing, ranges[c].first - 0.005 * weight_N) << contact.name();
      EXPECT_LE(pressing, ranges[c].second + 0.005 * weight_N) << contact.name();
    }
  }
}

}  // namespace
}  // namespace locograph::test
