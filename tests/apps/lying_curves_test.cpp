// Plans that lie about what lies between their configurations, before and after them, and in what
// they stand: `check` refuses each by the name of what it breaks, and accepts its honest twin.
#include <apps/command_runner.h>
#include <locograph/robots/contact_closure.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cmath>

#include "apps/standing_plan.h"

namespace locograph {
namespace {

/// The constraints that `check` finds violated, between blanks; " " where the plan is feasible.
std::string violated_by(const CommandRunner& runner, const PlanText& plan,
                        const std::string& options = "") {
  runner.write("plan.g2o", plan.text());
  const Outcome outcome = runner.run("check plan.g2o --json " + options);
  if (outcome.exit_code > 1) return "refused: " + outcome.err;
  const nlohmann::json report = outcome.json();
  EXPECT_EQ(report["feasible"], outcome.exit_code == 0);
  std::string names = " ";
  for (const nlohmann::json& violation : report["violations"]) {
    if (violation["violated"] == true) names += violation["constraint"].get<std::string>() + ' ';
  }
  return names;
}

bool breaks(const std::string& violated, const std::string& constraint) {
  return violated.find(' ' + constraint + ' ') != std::string::npos;
}

const std::string kComan = LOCOGRAPH_SOURCE_DIR "/robots/models/coman_plus/coman_plus";

const Robot& coman() {
  static const Robot robot = Robot::load(kComan + ".urdf", kComan + ".srdf");
  return robot;
}

/// The base this far ahead, the soles where they are.
std::vector<double> leaning(const std::vector<double>& from, double ahead_m) {
  const Robot& robot = coman();
  Eigen::VectorXd q =
      Eigen::Map<const Eigen::VectorXd>(from.data(), static_cast<Eigen::Index>(from.size()));
  RobotState state(robot);
  state.update(q.data());
  std::vector<ContactClosure> soles;
  for (const char* link : {"l_sole", "r_sole"}) {
    const Eigen::Isometry3d& pose = state.world_from_link(robot.link_index(link));
    Contact contact;
    contact.effector = {
        .link = link, .half_x_m = 0.1, .half_y_m = 0.1, .friction = 0.7, .max_force_N = 1.0};
    contact.position = pose.translation();
    contact.normal = pose.linear().col(2);
    contact.forward = pose.linear().col(0);
    soles.emplace_back(robot, contact);
  }
  for (int i = 0; i < 60; ++i) {
    if (i < 20) q[0] += ahead_m / 20;
    state.update(q.data());
    Eigen::VectorXd error(12);
    Eigen::Matrix<double, 12, Eigen::Dynamic, Eigen::RowMajor> jacobian(12, robot.tangent_size());
    jacobian.setZero();
    for (int sole = 0; sole < 2; ++sole) {
      soles[static_cast<std::size_t>(sole)].error(state, error.data() + 6 * sole);
      soles[static_cast<std::size_t>(sole)].add_jacobian(state, jacobian.row(6 * sole).data(),
                                                         robot.tangent_size());
    }
    jacobian.leftCols<6>().setZero();  // the base stays
    const Eigen::VectorXd step = -jacobian.completeOrthogonalDecomposition().solve(error);
    robot.integrate(q.data(), step.data(), q.data());
  }
  return {q.begin(), q.end()};
}

double sole_height(const PlanText& plan) {
  RobotState state(coman());
  state.update(plan.configurations.front().q.data());
  return state.world_from_link(coman().link_index("l_sole")).translation().z();
}

/// A drive on a scenario of its own: `limits` are its attributes.
class Drive : public CommandRunner {
 public:
  explicit Drive(const std::string& limits = "", const std::string& drive =
                                                     "distance=\"2\" speed=\"0.4\" "
                                                     "configurations=\"21\"") {
    std::string wheels;
    for (int i = 1; i <= 4; ++i) {
      wheels += "<wheel link=\"wheel_" + std::to_string(i) + "\" radius=\"0.078\"/>";
    }
    write("drive.xml",
          "<scenario version=\"1\" name=\"drive\"><robot model=\"centauro\" active=\"lower_body\" "
          "state=\"home\"/><wheels>" +
              wheels + "</wheels>" + (limits.empty() ? "" : "<limits " + limits + "/>") +
              "<drive " + drive + "/></scenario>\n");
    const Outcome outcome = run("plan drive.xml -o drive.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
  PlanText plan() const { return PlanText(read("drive.g2o")); }

  /// To and fro over d, from rest to rest in each step of this time.
  PlanText to_and_fro(double way_m, double step_s, int steps) const {
    PlanText plan = this->plan();
    const PlanText original = plan;
    plan.without_slopes();
    plan.mark("incomplete");  // it ends elsewhere
    plan.repeat_first(steps + 1, step_s);
    const std::vector<double>&from = original.configurations.front().q,
          &to = original.configurations.back().q;
    const double share = way_m / (to[0] - from[0]);
    for (std::size_t i = 1; i < plan.configurations.size(); i += 2) {
      for (std::size_t k = 0; k < plan.configurations[i].q.size(); ++k) {
        plan.configurations[i].q[k] += share * (to[k] - from[k]);
      }
    }
    return plan;
  }
};

TEST(LyingCurve, FromRestToRestInOneStepIsHalfAsFastAgain) {
  const Drive runner("base_linear=\"0.5\"");
  // 0.45 m/s in the mean are 0.675 at its fastest.
  EXPECT_TRUE(breaks(violated_by(runner, runner.to_and_fro(0.9, 2.0, 1)), "base_velocity"));
  EXPECT_EQ(violated_by(runner, runner.to_and_fro(0.9, 2.75, 1)), " ");
}

TEST(LyingCurve, FromRestToRestInOneStepAcceleratesBySixDOverTSquared) {
  const Drive runner("joint_acceleration=\"10\"");
  // A wheel of 78 mm: 2 d / T^2 are 6.4 rad/s^2, 6 d / T^2 are 19.
  EXPECT_TRUE(breaks(violated_by(runner, runner.to_and_fro(0.25, 1.0, 1)), "acceleration_limits"));
  EXPECT_EQ(violated_by(runner, runner.to_and_fro(0.25, 1.45, 1)), " ");
}

TEST(LyingCurve, VerticesAtTheTurnsOfABowHideNoInertia) {
  const Drive runner;
  // At each vertex it turns back at 10 m/s^2, which tips it.
  EXPECT_TRUE(breaks(violated_by(runner, runner.to_and_fro(0.2, 0.35, 8)), "static_balance"));
  EXPECT_EQ(violated_by(runner, runner.to_and_fro(0.2, 1.2, 8)), " ");
}

TEST(LyingCurve, AWholePlanDoesNotEndOnItsWayAndNotBeginThere) {
  const Drive runner;
  PlanText plan = runner.plan();
  EXPECT_EQ(violated_by(runner, plan), " ");
  PlanText cut = plan;
  cut.mark("incomplete");
  cut.configurations.resize(12);
  EXPECT_TRUE(breaks(violated_by(runner, cut), "end_at_rest"));
  EXPECT_TRUE(breaks(violated_by(runner, cut, "--until 60"), "end_at_rest"));
  PlanText late = plan;
  late.configurations.erase(late.configurations.begin(), late.configurations.begin() + 8);
  EXPECT_TRUE(breaks(violated_by(runner, late), "end_at_rest"));
}

TEST(LyingCurve, AWholePlanDoesNotEndInTheMiddleOfAFall) {
  // COMAN+ leans forward about its ankles, its feet where they are: 63 mm beyond the toes.
  PlanText plan(squat("2 4 5"));
  EXPECT_EQ(violated_by(CommandRunner(), plan), " ");
  plan.repeat_first(2, 1.0);
  EXPECT_EQ(violated_by(CommandRunner(), plan), " ");
  plan.configurations[1].q = leaning(plan.configurations[1].q, 0.1);
  const std::string falls = violated_by(CommandRunner(), plan);
  EXPECT_TRUE(breaks(falls, "static_balance")) << falls;
  EXPECT_FALSE(breaks(falls, "contact_position")) << falls;
  std::swap(plan.configurations[0].q, plan.configurations[1].q);
  EXPECT_TRUE(breaks(violated_by(CommandRunner(), plan), "static_balance"));
}

TEST(LyingCurve, ThePlansClockIsThatOfTheObstacles) {
  const Drive runner;
  PlanText plan = runner.plan();
  const auto cart = [&](double y) {
    // From left to right through where the robot is parked, in ten seconds.
    runner.write("cart.xml", "<obstacles version=\"1\"><box name=\"cart\" center=\"" +
                                 std::to_string(y) +
                                 " 5 0.5\" size=\"0.4 0.4 1\"><keyframe time=\"10\" position=\"" +
                                 std::to_string(y) + " -5 0.5\"/></box></obstacles>\n");
  };
  for (PlanText::Configuration& c : plan.configurations) c.time_s += 60.0;
  cart(0.0);
  EXPECT_EQ(violated_by(runner, plan, "--obstacles cart.xml"), " obstacle_distance ");
  cart(5.0);
  EXPECT_EQ(violated_by(runner, plan, "--obstacles cart.xml"), " ");
  plan.configurations.front().time_s = -1.0;
  EXPECT_NE(violated_by(runner, plan).find("a time of -1.000000 s, expected 0 or later"),
            std::string::npos);
}

TEST(LyingCurve, NobodyDrivesThroughASill) {
  const Drive runner;
  const auto sill = [&](double x, double height) {
    runner.write("sill.xml", "<obstacles version=\"1\"><box name=\"sill\" center=\"" +
                                 std::to_string(x) + " 0 " + std::to_string(0.5 * height) +
                                 "\" size=\"0.05 3 " + std::to_string(height) +
                                 "\"/></obstacles>\n");
  };
  sill(1.2, 0.0118);
  EXPECT_EQ(violated_by(runner, runner.plan(), "--obstacles sill.xml"), " obstacle_distance ");
  sill(1.2, 0.0003);
  EXPECT_EQ(violated_by(runner, runner.plan(), "--obstacles sill.xml"), " obstacle_distance ");
  sill(4.0, 0.0118);
  EXPECT_EQ(violated_by(runner, runner.plan(), "--obstacles sill.xml"), " ");
}

TEST(LyingCurve, FeetAreNotInASlab) {
  const PlanText plan(squat("2 4 5"));
  const double sole = sole_height(plan);
  const CommandRunner runner;
  const auto slab = [&](double top) {
    std::ostringstream text;
    text.precision(12);
    text << "<obstacles version=\"1\"><box name=\"slab\" center=\"0 0 " << top - 0.05
         << "\" size=\"3 3 0.1\"/></obstacles>\n";
    runner.write("slab.xml", text.str());
  };
  slab(sole + 0.010);
  EXPECT_TRUE(breaks(violated_by(runner, plan, "--obstacles slab.xml"), "obstacle_distance"));
  slab(sole);
  EXPECT_EQ(violated_by(runner, plan, "--obstacles slab.xml"), " ");
}

/// COMAN+ stands up: contacts open and close.
class StandingUp : public CommandRunner {
 public:
  StandingUp() {
    const Outcome outcome = run("plan standing_up --seed 1 -o up.g2o");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  }
  PlanText plan() const { return PlanText(read("up.g2o")); }
};

TEST(LyingCurve, WhatMayBeATenthOfAMillimetreOffMayBeItEverywhere) {
  const StandingUp runner;
  PlanText plan = runner.plan();
  EXPECT_EQ(violated_by(runner, plan), " ");
  for (PlanText::Configuration& c : plan.configurations) c.q[2] -= 2e-5;
  EXPECT_EQ(violated_by(runner, plan), " ");
  for (PlanText::Configuration& c : plan.configurations) c.q[2] -= 2e-4;
  EXPECT_TRUE(breaks(violated_by(runner, plan), "contact_position"));
}

TEST(LyingCurve, OnlyAPlanOfStancesIsFreeOfTime) {
  const StandingUp runner;
  PlanText plan = runner.plan();
  plan.mark("stances_only");
  EXPECT_EQ(violated_by(runner, plan), " ");  // judged as what it is
  for (PlanText::Configuration& c : plan.configurations) c.time_s *= 0.1;
  std::erase_if(plan.parameters,
                [](const std::string& line) { return line.starts_with("PARAMS_SEGMENT"); });
  EXPECT_TRUE(breaks(violated_by(runner, plan), "velocity_limits"));
  // Nor does it help to count configurations.
  for (std::size_t i = 0; i < plan.configurations.size(); ++i) {
    plan.configurations[i].time_s = static_cast<double>(i);
    plan.configurations[i].slopes.clear();
  }
  const Outcome outcome = runner.run("check plan.g2o --json");
  EXPECT_EQ(outcome.json()["stances_only"], false);
  // The honest one.
  EXPECT_EQ(runner.run("plan standing_up --stances-only --seed 1 -o stances.g2o").exit_code, 0);
  const Outcome honest = runner.run("check stances.g2o --json");
  EXPECT_EQ(honest.exit_code, 0);
  EXPECT_EQ(honest.json()["stances_only"], true);
}

}  // namespace
}  // namespace locograph
