// Postures on given contacts, and the check that accepts them.
#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/scenario/contacts_file.h>
#include <locograph/plugins/configuration/vertex_configuration.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/solvers/linear_solvers.h>

#include <map>

#include "benchmarks/planners/random_contact_sets.h"
#include "common/sanitized.h"
#include "common/temporary_folder.h"

namespace locograph::test {
namespace {

const PostureRobot& shipped(const std::string& name) {
  static std::map<std::string, PostureRobot> robots;
  const auto found = robots.find(name);
  if (found != robots.end()) return found->second;
  return robots.emplace(name, posture_robot(name, LOCOGRAPH_SOURCE_DIR, LOCOGRAPH_SHARED_DATA))
      .first->second;
}

const PostureSolver& solver_of(const std::string& name) {
  static std::map<std::string, std::unique_ptr<PostureSolver>> solvers;
  std::unique_ptr<PostureSolver>& solver = solvers[name];
  if (!solver) solver = std::make_unique<PostureSolver>(shipped(name).robot);
  return *solver;
}

Contact standing(const PostureRobot& robot, std::size_t foot, const Eigen::Vector3d& at) {
  Contact placed;
  placed.effector = robot.feet[foot];
  placed.position = at;
  placed.forward = Eigen::Vector3d::UnitX();
  return placed;
}

/// COMAN+ on both soles.
PostureProblem coman_standing() {
  const PostureRobot& robot = shipped("coman_plus");
  PostureProblem problem;
  problem.stance.contacts = {standing(robot, 0, {0.0, 0.12, 0.0}),
                             standing(robot, 1, {0.0, -0.12, 0.0})};
  problem.preferred = placed_at(robot.model(), robot.home, problem.stance);
  return problem;
}

double joint(const Robot& robot, const Eigen::VectorXd& q, const std::string& name) {
  return q[7 + robot.joints()[static_cast<std::size_t>(robot.joint_index(name))].index];
}

TEST(PostureSolver, AHumanoidStandsOnItsSoles) {
  const PostureSolver& solver = solver_of("coman_plus");
  const PostureProblem problem = coman_standing();
  const PostureResult result = solver.solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  EXPECT_TRUE(result.report.feasible);
  const Robot& robot = solver.robot();
  RobotState state(robot);
  state.update(result.configuration.data());
  const Eigen::Isometry3d& sole = state.world_from_link(robot.link_index("l_sole"));
  EXPECT_LT((sole.translation() - Eigen::Vector3d(0.0, 0.12, 0.0)).norm(), 1e-4);
  EXPECT_LT((sole.linear() - Eigen::Matrix3d::Identity()).norm(), 2e-3);
  EXPECT_GT(joint(robot, result.configuration, "LKneePitch"), 0.1) << "knees bend forwards";
  EXPECT_GT(state.world_from_link(robot.root_link()).translation().z(), 0.7);
  // Newton: what the ground gives is the weight, and acts below the centre of mass.
  const StanceWrenches& wrenches = result.report.balance.value().wrenches;
  ASSERT_EQ(wrenches.size(), 2U);
  EXPECT_NEAR(wrenches[0][2] + wrenches[1][2], 9.81 * robot.total_mass(), 1e-3);
  EXPECT_LT(std::abs(state.center_of_mass().x()), 0.08);
}

/// `scenario_start` and `scenario_goals`, which only plans have.
constexpr std::size_t kOfWholePlans = 2;

/// `check` of the saved posture says to the last bit what the solver said.
void expect_saved_is_judged_alike(const PostureSolver& solver, const PostureProblem& problem,
                                  const PostureResult& result) {
  const TemporaryFolder folder;
  write_graph(solver.graph(problem, result), folder.file("posture.g2o"));
  TypeRegistry types;
  add_robot_types(types);
  const Graph read = read_graph(folder.file("posture.g2o"), types);
  const Plan plan = plan_of(read);
  const Judging judging = judging_of(read, plan, {.data_folder = folder.path()});
  const CheckReport report = judged(read, plan, judging);
  EXPECT_EQ(report.feasible, result.success()) << violation_text(report.worst());
  ASSERT_EQ(report.violations.size(), result.report.violations.size() + kOfWholePlans);
  for (std::size_t i = 0; i < result.report.violations.size(); ++i) {
    if (!result.report.violations[i].judged) continue;
    EXPECT_EQ(report.violations[i].worst, result.report.violations[i].worst)
        << report.violations[i].constraint;
  }
}

class ReachableSets : public testing::TestWithParam<std::string> {};

TEST_P(ReachableSets, ArePosturesThatTheCheckAccepts) {
  const std::string name = GetParam();
  if ((name == "go2" || name == "anymal") &&
      !std::filesystem::exists(std::string(LOCOGRAPH_SHARED_DATA) + "/robots/" + name + ".urdf")) {
    GTEST_SKIP() << "no shared data folder " LOCOGRAPH_SHARED_DATA;
  }
  const PostureRobot& robot = shipped(name);
  const PostureSolver& solver = solver_of(name);
  const Judge judge(robot.robot->robot, posture_world());
  ContactSets sets(robot, 11);
  int known = 0, solved = 0;
  constexpr int kSets = kSanitized ? 3 : 10;
  while (known < kSets) {
    const ContactSet set = sets.draw();
    if (!judge.check(set.drawn, set.stance, posture_check()).feasible) continue;
    ++known;
    const PostureResult result =
        solver.solve({set.stance, placed_at(robot.model(), robot.home, set.stance)});
    solved += result.success();
    EXPECT_EQ(result.success(),
              judge.check(result.configuration, set.stance, posture_check()).feasible)
        << result.reason;
    expect_saved_is_judged_alike(solver, {set.stance, result.configuration}, result);
  }
  EXPECT_GE(solved, kSets - 1);
}

INSTANTIATE_TEST_SUITE_P(Robots, ReachableSets,
                         testing::Values("coman_plus", "centauro", "go2", "anymal"),
                         [](const auto& info) { return info.param; });

// To rounding: where vectors lie in memory decides how Eigen groups their sums.
TEST(PostureSolver, TakesTheSameStepsForTheSameSeed) {
  const PostureRobot& robot = shipped("coman_plus");
  ContactSets sets(robot, 3);
  for (int i = 0; i < 3; ++i) {
    const ContactSet set = sets.draw();
    const PostureProblem problem{set.stance, placed_at(robot.model(), robot.home, set.stance)};
    PostureOptions options;
    options.seed = 5;
    options.max_restarts = 2;
    const PostureResult once = solver_of("coman_plus").solve(problem, options);
    const PostureResult again = PostureSolver(robot.robot).solve(problem, options);
    EXPECT_EQ(once.success(), again.success());
    EXPECT_EQ(once.statistics.restarts, again.statistics.restarts);
    EXPECT_EQ(once.statistics.iterations, again.statistics.iterations);
    EXPECT_LT((once.configuration - again.configuration).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(PostureSolver, SaysWhichContactIsOutOfReachAndByHowMuch) {
  PostureProblem problem = coman_standing();
  Contact hand;
  hand.effector = shipped("coman_plus").hands[0];
  hand.position = {5.0, 0.3, 1.0};
  hand.normal = -Eigen::Vector3d::UnitX();
  problem.stance.contacts.push_back(hand);
  PostureOptions options;
  options.max_restarts = 2;
  const PostureResult result = solver_of("coman_plus").solve(problem, options);
  EXPECT_FALSE(result.success());
  EXPECT_EQ(result.statistics.restarts, 2);
  const Violation& worst = result.report.worst();
  EXPECT_EQ(worst.constraint, "contact_position");
  EXPECT_GT(worst.worst, 1.0);
  EXPECT_NE(result.reason.find("contact_position"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find(" m, limit"), std::string::npos) << result.reason;
}

TEST(PostureSolver, EndsWhenItsTimeIsUp) {
  PostureProblem problem = coman_standing();
  problem.preferred[2] += 0.5;
  PostureOptions options;
  options.termination.deadline = Deadline::after(0.0);
  const PostureResult result = solver_of("coman_plus").solve(problem, options);
  EXPECT_FALSE(result.success());
  EXPECT_EQ(result.statistics.restarts, 0);
  EXPECT_NE(result.reason.find("time allowed is used up"), std::string::npos) << result.reason;
}

TEST(PostureSolver, ReportsBalanceThatNoPostureHas) {
  // Both soles on the same line, ten times steeper than friction allows.
  PostureProblem problem = coman_standing();
  for (Contact& contact : problem.stance.contacts) contact.effector.friction = 0.01;
  for (Contact& contact : problem.stance.contacts) {
    contact.normal = {0.0, std::sin(0.2), std::cos(0.2)};
  }
  problem.stance.contacts[1].position = {0.0, -0.12, 0.24 * std::tan(0.2)};
  PostureOptions options;
  options.max_restarts = 1;
  const PostureResult result = solver_of("coman_plus").solve(problem, options);
  EXPECT_FALSE(result.success());
  EXPECT_FALSE(result.report.feasible);
}

TEST(PostureSolver, AContactThatBearsNoLoadIsClosedAllTheSame) {
  PostureProblem problem = coman_standing();
  Contact hand;
  hand.effector = shipped("coman_plus").hands[0];
  hand.position = {0.35, 0.25, 1.0};
  hand.normal = -Eigen::Vector3d::UnitX();
  hand.bears_load = false;
  problem.stance.contacts.push_back(hand);
  const PostureResult result = solver_of("coman_plus").solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  EXPECT_EQ(result.report.balance.value().wrenches.size(), 3U);
  EXPECT_TRUE(result.report.balance->wrenches[2].isZero(0.0));
  EXPECT_LT(result.report.constraint("contact_position").worst, 1e-4);
}

TEST(PostureSolver, KeepsClearOfObstacles) {
  // A block where the right elbow is at home.
  const PostureRobot& robot = shipped("coman_plus");
  const PostureProblem problem = coman_standing();
  RobotState state(robot.model());
  state.update(problem.preferred.data());
  const TemporaryFolder folder;
  const Eigen::Vector3d at =
      state.world_from_link(robot.model().link_index("RForearm")).translation();
  folder.write("block.xml", "<obstacles version=\"1\">\n<sphere name=\"ball\" center=\"" +
                                std::to_string(at.x()) + " " + std::to_string(at.y() - 0.05) + " " +
                                std::to_string(at.z()) + "\" radius=\"0.08\"/>\n</obstacles>\n");
  const World world = posture_world(load_world({}, folder.file("block.xml")));
  const PostureSolver solver(robot.robot, world);
  const Judge judge(robot.robot->robot, world);
  EXPECT_TRUE(judge.check(problem.preferred, problem.stance, posture_check())
                  .constraint("obstacle_distance")
                  .violated);
  const PostureResult result = solver.solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  EXPECT_GE(result.report.constraint("obstacle_distance").worst, 0.0);
}

// A stone that the contacts file says nothing of: the foot on it comes nearer to the ground than
// links that keep away from it.
TEST(PostureSolver, AFootStandsOnWhatIsJustAboveTheGround) {
  PostureProblem problem = coman_standing();
  problem.stance.contacts[0].position.z() = 1e-3;
  const PostureResult result = solver_of("coman_plus").solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  EXPECT_LT(result.report.constraint("contact_position").worst, 1e-4);
}

TEST(PostureSolver, SavesAGraphThatIsAtItsOptimum) {
  const PostureSolver& solver = solver_of("coman_plus");
  const PostureProblem problem = coman_standing();
  const PostureResult result = solver.solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  const TemporaryFolder folder;
  Graph graph = solver.graph(problem, result);
  write_graph(graph, folder.file("standing.g2o"));
  TypeRegistry types;
  add_robot_types(types);
  Graph read = read_graph(folder.file("standing.g2o"), types);
  const VertexId<VertexConfiguration> q = read.find<VertexConfiguration>(0);
  EXPECT_EQ(read.vertex(q).state, result.configuration) << "17 digits";
  const OptimiserResult optimum = optimise(read, {}, *make_linear_solver("dense"));
  EXPECT_LT(optimum.initial.chi2, 0.1);
  EXPECT_LE(optimum.final.chi2, optimum.initial.chi2);
}

TEST(PostureSolver, SavesAPlanThatIsJudgedAsThePostureWas) {
  const TemporaryFolder folder;
  const PostureSolver& solver = solver_of("coman_plus");
  PostureProblem problem = coman_standing();
  problem.file = folder.write(
      "contacts.xml",
      "<contacts version=\"1\">\n"
      "<contact link=\"l_sole\" kind=\"surface\" position=\"0 0.12 0\" normal=\"0 0 1\" "
      "forward=\"1 0 0\" half_x=\"0.08\" half_y=\"0.04\" mu=\"0.6\" max_force=\"3000\"/>\n"
      "<contact link=\"r_sole\" kind=\"surface\" position=\"0 -0.12 0\" normal=\"0 0 1\" "
      "forward=\"1 0 0\" half_x=\"0.08\" half_y=\"0.04\" mu=\"0.6\" max_force=\"3000\"/>\n"
      "</contacts>\n");
  const PostureResult result = solver.solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  write_graph(solver.graph(problem, result), folder.file("standing.g2o"));
  TypeRegistry types;
  add_robot_types(types);
  const Graph read = read_graph(folder.file("standing.g2o"), types);
  const Plan plan = plan_of(read);
  const Judging judging = judging_of(read, plan, {.data_folder = folder.path()});
  EXPECT_EQ(judging.options.known.size(), 2u);
  const CheckReport report = judged(read, plan, judging);
  EXPECT_TRUE(report.feasible) << violation_text(report.worst());
  ASSERT_EQ(report.violations.size(), result.report.violations.size() + kOfWholePlans);
  for (std::size_t i = 0; i < result.report.violations.size(); ++i) {
    if (report.violations[i].constraint == "plan_wrenches") continue;  // only a plan states them
    EXPECT_EQ(report.violations[i].worst, result.report.violations[i].worst)
        << report.violations[i].constraint;
  }
}

TEST(PostureSolver, AWheeledRobotStandsOnItsWheels) {
  const PostureRobot& robot = shipped("centauro");
  PostureProblem problem;
  const double x[] = {0.35, 0.35, -0.35, -0.35}, y[] = {0.35, -0.35, 0.35, -0.35};
  for (int i = 0; i < 4; ++i) {
    Contact wheel;
    wheel.effector = {.link = "wheel_" + std::to_string(i + 1),
                      .kind = ContactKind::kWheel,
                      .radius_m = 0.078,
                      .friction = 0.6,
                      .max_force_N = 3000.0};
    wheel.position = {x[i], y[i], 0.0};
    problem.stance.contacts.push_back(wheel);
  }
  problem.preferred = placed_at(robot.model(), robot.home, problem.stance);
  const PostureResult result = solver_of("centauro").solve(problem);
  ASSERT_TRUE(result.success()) << result.reason;
  const StanceWrenches& wrenches = result.report.balance.value().wrenches;
  double carried = 0.0;
  for (const auto& wrench : wrenches) carried += wrench[2];
  EXPECT_NEAR(carried, 9.81 * robot.model().total_mass(), 1e-2);
}

TEST(PostureSolver, RefusesContactsThatMakeNoSense) {
  const PostureSolver& solver = solver_of("coman_plus");
  const PostureProblem sound = coman_standing();
  const auto refused = [&](auto&& spoil, const std::string& words) {
    PostureProblem problem = sound;
    spoil(problem);
    try {
      solver.solve(problem);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](PostureProblem& p) { p.stance.contacts.clear(); }, "no contacts");
  refused(
      [](PostureProblem& p) {
        for (auto& c : p.stance.contacts) c.bears_load = false;
      },
      "bears load");
  refused([](PostureProblem& p) { p.stance.contacts[0].effector.link = "l_soul"; }, "l_sole");
  refused([](PostureProblem& p) { p.stance.contacts[0].normal.setZero(); },
          "normal of length zero");
  refused([](PostureProblem& p) { p.stance.contacts[0].forward = Eigen::Vector3d::UnitZ(); },
          "along its normal");
  refused([&](PostureProblem& p) { p.stance.contacts[0].position.x() = nan; }, "not finite");
  refused([&](PostureProblem& p) { p.stance.contacts[0].normal.x() = nan; }, "not finite");
  refused([](PostureProblem& p) { p.stance.contacts[0].effector.friction = -0.5; }, "friction");
  refused([](PostureProblem& p) { p.stance.contacts[0].effector.half_x_m = 0.0; }, "half size");
  refused([](PostureProblem& p) { p.stance.contacts[1].effector.link = "l_sole"; }, "contradict");
  refused([](PostureProblem& p) { p.stance.contacts.push_back(p.stance.contacts[0]); }, "the same");
  refused(
      [](PostureProblem& p) {
        p.stance.contacts[0].effector.kind = ContactKind::kGrasp;
        p.stance.contacts[0].forward.reset();
      },
      "rung without forward");
  refused([](PostureProblem& p) { p.preferred.conservativeResize(7); }, "35 finite numbers");
  refused([&](PostureProblem& p) { p.preferred[3] = nan; }, "35 finite numbers");
  PostureOptions options;
  options.wrench_margin = 1.0;
  EXPECT_THROW(solver.solve(sound, options), Error);
}

// The check -------------------------------------------------------------------------------------

class PostureCheck : public testing::Test {
 protected:
  PostureCheck() {
    result = solver_of("coman_plus").solve(problem);
    q = result.configuration;
  }
  int index(const std::string& name) const {
    return 7 + robot.joints()[static_cast<std::size_t>(robot.joint_index(name))].index;
  }
  CheckReport check() const { return judge.check(q, problem.stance, posture_check()); }

  const PostureProblem problem = coman_standing();
  const Robot& robot = solver_of("coman_plus").robot();
  const Judge judge{shipped("coman_plus").robot->robot, posture_world()};
  PostureResult result;
  Eigen::VectorXd q;
};

TEST_F(PostureCheck, HoldsForAFoundPostureAndListsEverything) {
  const CheckReport report = check();
  EXPECT_TRUE(report.feasible);
  for (const char* name :
       {"not_finite", "base_orientation", "contact_position", "contact_orientation", "joint_limits",
        "obstacle_distance", "touching_depth", "self_collision", "ground_penetration",
        "static_balance", "torque_limits"}) {
    EXPECT_FALSE(report.constraint(name).violated) << name;
  }
  EXPECT_THROW(report.constraint("beauty"), Error);
}

TEST_F(PostureCheck, MeasuresHowFarAContactIsAway) {
  q[0] += 0.01;
  const CheckReport report = check();
  EXPECT_FALSE(report.feasible);
  EXPECT_NEAR(report.constraint("contact_position").worst, 0.01, 1e-4);
  EXPECT_EQ(report.worst().constraint, "contact_position");
}

TEST_F(PostureCheck, MeasuresHowFarASoleIsTurned) {
  q[index("LAnkleRoll")] += 0.05;
  const CheckReport report = check();
  EXPECT_NEAR(report.constraint("contact_orientation").worst, 0.05, 2e-3);
  EXPECT_FALSE(report.feasible);
}

TEST_F(PostureCheck, SeesAJointBeyondItsLimit) {
  q[index("LElbj")] = 0.298 + 0.1;
  EXPECT_NEAR(check().constraint("joint_limits").worst, 0.1, 1e-9);
}

TEST_F(PostureCheck, SeesAnArmInTheBody) {
  q[index("LShLat")] = 0.0;
  q[index("LShYaw")] = -1.6;
  q[index("LElbj")] = -2.0;
  EXPECT_TRUE(check().constraint("self_collision").violated);
}

TEST_F(PostureCheck, SeesABodyInTheGround) {
  q[2] -= 0.3;
  const CheckReport report = check();
  EXPECT_TRUE(report.constraint("touching_depth").violated);
  EXPECT_NEAR(report.constraint("touching_depth").worst, 0.3, 5e-3);
  const Judge nowhere{shipped("coman_plus").robot->robot, World()};
  EXPECT_FALSE(
      nowhere.check(q, problem.stance, posture_check()).constraint("touching_depth").violated);
}

TEST_F(PostureCheck, SeesARobotThatWouldFall) {
  // Arms and trunk as they are, on the left sole alone: the weight is between the feet.
  const Stance one{{problem.stance.contacts[0]}};
  const CheckReport report = judge.check(q, one, posture_check());
  EXPECT_TRUE(report.constraint("static_balance").violated);
  EXPECT_LT(report.constraint("static_balance").worst, 0.0);
}

TEST_F(PostureCheck, SaysWhenNumbersAreNone) {
  q[3] = std::numeric_limits<double>::quiet_NaN();
  const CheckReport report = check();
  EXPECT_FALSE(report.feasible);
  EXPECT_EQ(report.worst().constraint, "not_finite");
}

}  // namespace
}  // namespace locograph::test
