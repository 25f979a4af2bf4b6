// Robots that are off their plan, as something has pushed them: does the online planner lead them
// back.
//
//     push_campaign [--cases N] [--seed N] [--rate HZ] [--walk S] [--push M] [--turn RAD]
//     [--joints RAD] [--contacts M] PLAN.g2o…
//
// Each case draws a time of the plan and a displacement: the base by up to `--push` and `--turn`,
// each joint by up to `--joints`. The robot is put on the contacts that it has there, balls where
// they have rolled to, others by up to `--contacts` beside where they are planned, wheels that
// stand as the plan has turned them; what is off by more, or is refused by the judge as it stands,
// is drawn again. It is measured there, at the velocity of the plan, and walked on for 2 s of the
// plan, or `--walk`, each step judged. It is back when its base is within 1 cm and 0.01 rad of the
// plan then.
// Prints one JSON object.
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/posture/contact_projection.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kBack_m = 0.01, kBack_rad = 0.01;
constexpr int kMostDraws = 200;

struct Push {
  double base_m = 0.05, base_rad = 0.05, joint_rad = 0.05, contact_m = 0.0;
};

/// How far a configuration is from another one.
struct Distance {
  double base_m, base_rad, joint_rad;
};

class Campaign {
 public:
  Campaign(std::uint64_t seed, const Push& push, double rate_hz, double walk_s)
      : random_(seed), push_(push), rate_hz_(rate_hz), walk_s_(walk_s) {
    types_ = standard_types();
    add_robot_types(types_);
  }

  Json run(const std::string& file, int cases) {
    const Graph graph = read_graph(file, types_);
    const Plan plan = plan_of(graph);
    planned_ = motion_of(graph, plan);
    judging_ = judging_of(graph, plan, {.data_folder = data_folder()});
    Json rows = Json::array();
    int back = 0, refused = 0;
    for (int k = 0; k < cases; ++k) {
      const auto pushed = draw(graph, plan, refused);
      if (!pushed) break;
      rows.push_back(walk(file, pushed->first, pushed->second));
      back += rows.back()["back"].get<bool>() ? 1 : 0;
      std::cerr << file << ' ' << k << ": " << rows.back().dump() << '\n';
    }
    return {{"plan", std::filesystem::path(file).filename().string()},
            {"cases", rows.size()},
            {"back", back},
            {"drawn_and_refused", refused},
            {"rows", std::move(rows)}};
  }

 private:
  const Robot& robot() const { return *judging_.robot; }

  Distance distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    Eigen::VectorXd off(robot().tangent_size());
    robot().difference(a.data(), b.data(), off.data());
    return {off.head<3>().norm(), off.segment<3>(3).norm(),
            off.tail(robot().active_joint_count()).lpNorm<Eigen::Infinity>()};
  }

  Eigen::Vector3d within(double radius) {
    Eigen::Vector3d v;
    do {
      for (double& x : v) x = uniform(random_, -1.0, 1.0);
    } while (v.norm() > 1.0);
    return radius * v;
  }

  /// Off by, along what the contact is on. A bar is where it is.
  Eigen::Vector3d along(const Contact& contact) {
    const bool held =
        push_.contact_m == 0.0 || contact.bar || contact.effector.kind == ContactKind::kGrasp;
    if (held) return Eigen::Vector3d::Zero();
    const Eigen::Matrix3d axes = axes_in_world(contact);
    const Eigen::Vector3d off = within(push_.contact_m);
    return axes.leftCols<2>() * off.head<2>();
  }

  /// A configuration of the plan, and where the robot is in its place.
  std::optional<std::pair<int, Eigen::VectorXd>> draw(const Graph& graph, const Plan& plan,
                                                      int& refused) {
    const auto& time_s = planned_.time_s;
    const auto until = static_cast<int>(std::ranges::upper_bound(time_s, time_s.back() - walk_s_) -
                                        time_s.begin());
    for (int k = 0; k < kMostDraws; ++k) {
      const int at =
          1 + static_cast<int>(random_() % static_cast<unsigned>(std::max(1, until - 2)));
      const Eigen::VectorXd& was = planned_.configurations[static_cast<std::size_t>(at)];
      Eigen::VectorXd off(robot().tangent_size());
      for (double& x : off) x = uniform(random_, -push_.joint_rad, push_.joint_rad);
      off.head<3>() = within(push_.base_m);
      off.segment<3>(3) = within(push_.base_rad);
      Eigen::VectorXd pushed(was.size());
      robot().integrate(was.data(), off.data(), pushed.data());
      if (!close_contacts(graph, plan, at, pushed)) continue;
      const Distance d = distance(was, pushed);
      if (d.base_m > push_.base_m || d.base_rad > push_.base_rad ||
          d.joint_rad > 2.0 * push_.joint_rad) {
        continue;
      }
      if (holds(at, pushed)) return std::pair(at, pushed);
      ++refused;
    }
    return std::nullopt;
  }

  /// Whether the robot stands there for the judge.
  bool holds(int at, const Eigen::VectorXd& q) const {
    Motion still = planned_;
    still.configurations = {q, q};
    still.time_s = {0.0, 0.1};
    still.slopes.assign(2, Eigen::VectorXd::Zero(robot().tangent_size()));
    still.wrenches.clear();
    still.stance_from.assign(2, planned_.stance_from[static_cast<std::size_t>(at)]);
    return step_check(judging_)(still).feasible;
  }

  /// Puts the robot on the contacts of a configuration of the plan, which it is near. Balls roll
  /// there from where the plan has them.
  bool close_contacts(const Graph& graph, const Plan& plan, int at, Eigen::VectorXd& q) {
    RobotState planned(robot());
    planned.update(planned_.configurations[static_cast<std::size_t>(at)].data());
    std::vector<Contact> contacts;
    for (const int number : contacts_at(plan.stance_from, static_cast<std::size_t>(at))) {
      contacts.push_back(graph.parameters().get<ContactParameter>(number)->contact);
    }
    const HeldBalls balls = held_balls(planned, contacts, [](const Contact&) { return true; });
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      if (!balls[i]) contacts[i].position += along(contacts[i]);
    }
    ContactProjection closed(robot());
    closed.set(contacts, balls);
    const Stance& stance = plan.stance_from[static_cast<std::size_t>(at)]->stance;
    constexpr int kTries = 20;
    for (int k = 0; k < kTries; ++k) {
      if (!closed.project(q)) return false;
      if (turn_back(planned, stance, q)) return true;
    }
    return false;
  }

  /// Turns wheels that stand as the plan has them; whether they all were.
  bool turn_back(const RobotState& planned, const Stance& stance, Eigen::VectorXd& q) {
    constexpr double kTurned_rad = 1e-7;
    WheelMotion wheels(robot(), stance);
    bool as_planned = true;
    for (int w = 0; w < wheels.wheels(); ++w) {
      const StanceParameter::StandingWheel& standing = wheels.wheel(w);
      if (!standing.locked) continue;
      const Eigen::Vector3d heading = WheelPose(planned, standing.wheel).heading(standing.normal);
      const Eigen::Vector3d now = wheels.pose(q, w).heading(standing.normal);
      if (heading.cross(now).norm() <= kTurned_rad) continue;
      as_planned = false;
      wheels.steer(q, w, heading);
    }
    return as_planned;
  }

  Json walk(const std::string& file, int at, const Eigen::VectorXd& pushed) {
    Graph graph = read_graph(file, types_);
    WalkOptions options = walk_options_for(plan_of(graph));
    options.rate_hz = rate_hz_;
    options.verify = step_check(judging_);
    const auto& time_s = planned_.time_s;
    const double end_s = time_s[static_cast<std::size_t>(at)] + walk_s_;
    const Distance off = distance(planned_.configurations[static_cast<std::size_t>(at)], pushed);
    PlanWalk walk(graph, {}, options, at);
    walk.measure(pushed);
    bool goes_on = true;
    while (goes_on && walk.time_s(walk.executed()) < end_s) goes_on = walk.step();
    const Motion motion = walk.motion();  // shorter where it has stopped
    const int there = std::min(walk.executed(), static_cast<int>(motion.configurations.size()) - 1);
    const auto k = static_cast<std::size_t>(there);
    const Distance left = distance(planned_.configurations[k], motion.configurations[k]);
    const WalkReport report = walk.report();
    double worst_ms = 0.0;
    for (const CycleReport& cycle : report.cycles) {
      worst_ms = std::max(worst_ms, 1e3 * cycle.statistics.total_s);
    }
    const bool arrived = goes_on || there + 1 == static_cast<int>(time_s.size());
    return {{"back", arrived && left.base_m <= kBack_m && left.base_rad <= kBack_rad},
            {"at", at},
            {"off", {off.base_m, off.base_rad, off.joint_rad}},
            {"left", {left.base_m, left.base_rad, left.joint_rad}},
            {"walked_s", walk.time_s(there) - time_s[static_cast<std::size_t>(at)]},
            {"reason", arrived ? "" : report.reason},
            {"cycles", report.cycles.size()},
            {"worst_ms", worst_ms}};
  }

  std::mt19937_64 random_;
  Push push_;
  double rate_hz_, walk_s_;
  TypeRegistry types_;
  Motion planned_;
  Judging judging_;
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Robots that are off their plan are led back", "push_campaign");
  int cases = 40;
  std::uint64_t seed = 1;
  double rate_hz = 50.0, walk_s = 2.0;
  locograph::Push push;
  std::vector<std::string> files;
  app.add_option("--cases", cases, "Pushes for each plan").positive();
  app.add_option("--seed", seed, "Of the pushes");
  app.add_option("--rate", rate_hz, "Cycles in a second of the plan").positive();
  app.add_option("--walk", walk_s, "Until it has to be back, in the plan's time [s]").positive();
  app.add_option("--push", push.base_m, "Of the base, at most [m]").positive();
  app.add_option("--turn", push.base_rad, "Of the base, at most [rad]").positive();
  app.add_option("--joints", push.joint_rad, "Of each joint, at most [rad]").positive();
  app.add_option("--contacts", push.contact_m, "Of contacts but balls and bars, at most [m]")
      .not_negative();
  app.add_option("PLAN", files, "Plan files (.g2o)").required();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Campaign campaign(seed, push, rate_hz, walk_s);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& file : files) rows.push_back(campaign.run(file, cases));
    std::cout << nlohmann::ordered_json({{"seed", seed}, {"plans", rows}}).dump(2) << '\n';
  });
}
