// Boxes and spheres that appear in the way of plans on legs: does the online planner lead the robot
// past them, and does it stop without contact where it does not.
//
//     appearing_campaign [--cases N] [--seed N] [--rate HZ] [--horizon S] [--deep M] [--deepest M]
//     [--replan] [--save DIR] PLAN.g2o…
//
// An obstacle of 0.1 to 0.3 m is at least 5 cm deep in the volume that the plan sweeps at some
// time. It is seen 1 to 2 s before that, when the robot is 2 cm clear of it, and stays. Start, goal
// and the places of all contacts are 5 cm clear of it. Prints one JSON object: how many arrive and
// are judged feasible in the world as it is, how many stop and are judged so, and why.
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/robots/robot_state.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

constexpr double kLeast_m = 0.1, kMost_m = 0.3;
constexpr double kFreeEnds_m = 0.05, kFreeWhenSeen_m = 0.02;

constexpr double kSeenLeast_s = 1.0, kSeenMost_s = 2.0;
constexpr int kMostDraws = 20000;
constexpr double kMostResume_s = 20.0;

struct Case {
  Obstacle obstacle;
  double hit_s = 0.0, seen_s = 0.0;
  std::string link;  ///< that is deepest in it
};

class Campaign {
 public:
  Campaign(std::uint64_t seed, WalkOptions options, std::string folder, bool resumes, double deep_m,
           double deepest_m)
      : random_(seed),
        options_(std::move(options)),
        folder_(std::move(folder)),
        resumes_(resumes),
        deep_m_(deep_m),
        deepest_m_(deepest_m) {
    types_ = standard_types();
    add_robot_types(types_);
  }

  Json run(const std::string& file, int cases) {
    file_ = file;
    const Graph graph = read_graph(file, types_);
    const Plan plan = plan_of(graph);
    motion_ = motion_of(graph, plan);
    robot_ = plan.robot;
    judging_ = judging_of(graph, plan, {.data_folder = data_folder()});
    centres_.clear();
    RobotState state(*robot_->robot);
    for (const Eigen::VectorXd& q : motion_.configurations) {
      state.update(q.data());
      std::vector<Vector3d>& centres = centres_.emplace_back();
      for (const CollisionSphere& sphere : robot_->spheres) {
        centres.push_back(state.world_from_link(sphere.link) * sphere.center);
      }
    }
    Json rows = Json::array();
    int arrived = 0, stopped = 0;
    for (int k = 0; k < cases; ++k) {
      const std::optional<Case> one = draw();
      if (!one) break;
      rows.push_back(walk(*one, std::to_string(k)));
      arrived += rows.back()["arrived"].get<bool>() ? 1 : 0;
      stopped += rows.back()["stopped_safely"].get<bool>() ? 1 : 0;
      std::cerr << file << ' ' << k << ": " << rows.back().dump() << '\n';
    }
    return {{"plan", std::filesystem::path(file).filename().string()},
            {"cases", rows.size()},
            {"arrived", arrived},
            {"stopped_safely", stopped},
            {"rows", std::move(rows)}};
  }

 private:
  /// Of the robot's spheres from the obstacle, negative in it.
  double clearance(const Obstacle& obstacle, std::size_t i, int* nearest = nullptr) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < centres_[i].size(); ++k) {
      const CollisionSphere& sphere = robot_->spheres[k];
      const double distance = obstacle.distance(centres_[i][k], 0.0) - sphere.radius;
      if (distance < least && nearest != nullptr) *nearest = sphere.link;
      least = std::min(least, distance);
    }
    return least;
  }

  bool contacts_are_free(const Obstacle& obstacle) const {
    for (const Stance& stance : motion_.stances) {
      for (const Contact& contact : stance.contacts) {
        if (obstacle.distance(contact.position, 0.0) < kFreeEnds_m) {
          return false;
        }
      }
    }
    return true;
  }

  std::optional<Case> draw() {
    const std::size_t last = motion_.configurations.size() - 1;
    for (int draw = 0; draw < kMostDraws; ++draw) {
      Case one;
      const std::size_t at = random_() % (last + 1);
      one.hit_s = motion_.time_s[at];
      one.seen_s = one.hit_s - uniform(random_, kSeenLeast_s, kSeenMost_s);
      const bool is_box = random_() % 2 == 0;
      Obstacle& obstacle = one.obstacle;
      obstacle.name = is_box ? "box" : "sphere";
      obstacle.shape = is_box ? Obstacle::Shape::kBox : Obstacle::Shape::kSphere;
      if (is_box) {
        for (double& side : obstacle.size) side = uniform(random_, kLeast_m, kMost_m);
      } else {
        obstacle.size.x() = 0.5 * uniform(random_, kLeast_m, kMost_m);
      }
      const Vector3d& near = centres_[at][random_() % centres_[at].size()];
      Vector3d offset;
      for (double& value : offset) value = uniform(random_, -0.3, 0.3);
      obstacle.world_from_obstacle.translation() = near + offset;
      if (!(one.seen_s > motion_.time_s.front())) continue;
      const auto seen = static_cast<std::size_t>(
          std::ranges::lower_bound(motion_.time_s, one.seen_s) - motion_.time_s.begin());
      if (clearance(obstacle, seen) < kFreeWhenSeen_m) continue;
      if (clearance(obstacle, 0) < kFreeEnds_m || clearance(obstacle, last) < kFreeEnds_m) continue;
      if (!contacts_are_free(obstacle)) continue;
      int link = -1;
      const double depth_m = -clearance(obstacle, at, &link);
      if (depth_m < deep_m_ || depth_m > deepest_m_) continue;
      // It is met for the first time then, and not before it was seen.
      bool sooner = false;
      for (std::size_t i = 0; i < at && !sooner; ++i) {
        const bool before_seen = motion_.time_s[i] < one.seen_s + kSeenLeast_s - 1e-9;
        sooner = before_seen ? i >= seen && clearance(obstacle, i) < 0.0 : false;
      }
      if (sooner) continue;
      one.link = robot_->robot->links()[static_cast<std::size_t>(link)].name;
      return one;
    }
    return {};
  }

  Json walk(const Case& one, const std::string& number) {
    Graph graph = read_graph(file_, types_);
    const Plan plan = plan_of(graph);
    DistanceFieldOptions view;
    if (plan.world->ground_z_m) view.ground_z = *plan.world->ground_z_m;
    World known = plan.world->snapshot->world();
    known.obstacles.push_back(one.obstacle);
    const auto with = std::make_shared<const WorldSnapshot>(known, 0.0, WorldFiles(), view);
    Judging judging = judging_;
    World truth = judging_.world->world();
    truth.obstacles.push_back(one.obstacle);
    truth.obstacles.back().appears_s = one.seen_s;
    judging.world = std::make_shared<const WorldSnapshot>(std::move(truth));
    WalkOptions options = options_;
    options.verify = step_check(judging);
    std::vector<double> resumed_s;
    std::string not_resumed;
    if (resumes_) {
      options.resume = [&](const Graph& stopped) -> std::optional<Graph> {
        const auto now = std::make_shared<const WorldSnapshot>(
            world_at_rest(judging.world->world(), one.seen_s + kSeenMost_s));
        ResumedPlan resumed =
            resume_plan(stopped, *judging_.task, now,
                        {.seed = 1, .termination = {.deadline = Deadline::after(kMostResume_s)}});
        resumed_s.push_back(resumed.total_s);
        not_resumed = resumed.success() ? "" : resumed.reason;
        return std::move(resumed.graph);
      };
    }
    // Of windows that were optimised: what the judge says of those that are called feasible.
    int changed = 0, wrongly = 0;
    std::string refused;
    options.on_cycle = [&](const CycleReport& cycle) {
      if (!cycle.success() || cycle.statistics.iterations == 0) return;
      ++changed;
      const CheckReport check = options.verify(
          motion_of(graph, plan_of(graph), cycle.executed, cycle.executed + cycle.window));
      if (check.feasible) return;
      ++wrongly;
      if (refused.empty()) refused = violation_text(check.worst());
    };
    bool shown = false;
    const auto world_at = [&](int executed) -> std::shared_ptr<const WorldSnapshot> {
      if (shown || motion_.time_s[static_cast<std::size_t>(executed)] < one.seen_s) return nullptr;
      shown = true;
      return with;
    };
    const Stopwatch watch;
    const WalkReport report = walk_plan(graph, world_at, options);
    const double seconds = watch.seconds();
    if (!folder_.empty()) {
      const std::string stem =
          folder_ + "/" + std::filesystem::path(file_).stem().string() + "_" + number;
      save_obstacles(judging.world->world().obstacles, stem + ".xml");
      write_graph(graph, stem + ".g2o");
    }
    const Plan walked = plan_of(graph);
    judging.incomplete = walked.incomplete;
    const CheckReport check = judged(graph, walked, judging);
    std::vector<double> times;
    int iterations = 0;
    for (const CycleReport& cycle : report.cycles) {
      times.push_back(1e3 * cycle.statistics.total_s);
      iterations += cycle.statistics.iterations;
    }
    std::ranges::sort(times);
    const auto percentile = [&](double p) {
      return times[static_cast<std::size_t>(p * static_cast<double>(times.size() - 1))];
    };
    Json row = {
        {"arrived", report.success() && check.feasible},
        {"stopped_safely", !report.success() && check.feasible},
        {"feasible", check.feasible},
        {"obstacle", one.obstacle.name},
        {"size", {one.obstacle.size[0], one.obstacle.size[1], one.obstacle.size[2]}},
        {"hits", one.link},
        {"hit_s", one.hit_s},
        {"seen_s", one.seen_s},
        {"reason", report.reason},
        {"resumed_s", resumed_s},
        {"not_resumed", not_resumed},
        {"iterations", iterations},
        {"windows_changed", changed},
        {"windows_wrongly_feasible", wrongly},
        {"refused", refused},
        {"seconds", seconds},
        {"cycle_ms", {{"p50", percentile(0.5)}, {"p99", percentile(0.99)}, {"max", times.back()}}}};
    for (const Violation* violation : check.violated()) {
      row["violated"].push_back({{"constraint", violation->constraint},
                                 {"worst", violation->worst},
                                 {"limit", violation->limit},
                                 {"vertex", violation->at_vertex}});
    }
    return row;
  }

  std::mt19937_64 random_;
  WalkOptions options_;
  TypeRegistry types_;
  std::string file_, folder_;
  bool resumes_;
  double deep_m_, deepest_m_;
  Motion motion_;
  std::shared_ptr<const RobotParameter> robot_;
  Judging judging_;
  std::vector<std::vector<Vector3d>> centres_;  // of spheres, by configuration
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Obstacles that appear in the way of plans on legs",
                              "appearing_campaign");
  int cases = 50;
  std::uint64_t seed = 1;
  locograph::WalkOptions options;
  options.rate_hz = 50.0;
  options.planner.horizon_s = 2.0;
  options.cycle_iterations = 1;
  std::string folder;
  bool replan = false;
  double deep_m = 0.05, deepest_m = 1.0;
  std::vector<std::string> files;
  app.add_option("--cases", cases, "Obstacles for each plan").positive();
  app.add_option("--seed", seed, "Of the obstacles");
  app.add_option("--rate", options.rate_hz, "Cycles in a second of the plan").positive();
  app.add_option("--horizon", options.planner.horizon_s, "Of the window [s]").positive();
  app.add_option("--iterations", options.planner.solver.max_iterations, "Of a run").positive();
  app.add_option("--cycle-iterations", options.cycle_iterations, "Of a cycle; 0: no limit")
      .not_negative();
  app.add_option("--rounds", options.planner.solver.max_rounds, "Of raising").not_negative();
  app.add_option("--deep", deep_m, "How deep in the way an obstacle is at least [m]").positive();
  app.add_option("--deepest", deepest_m, "And at most").positive();
  app.add_flag("--replan", replan, "Plan on from where the robot has stopped, 20 s at most");
  app.add_option("--save", folder, "Folder for the plans and obstacles");
  app.add_option("PLAN", files, "Plan files (.g2o)").required();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Campaign campaign(seed, options, folder, replan, deep_m, deepest_m);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& file : files) rows.push_back(campaign.run(file, cases));
    std::cout << nlohmann::ordered_json({{"seed", seed}, {"plans", rows}}).dump(2) << '\n';
  });
}
