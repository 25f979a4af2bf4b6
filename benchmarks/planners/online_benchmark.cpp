// What a cycle of the online planner takes while the world changes.
//
//     online_benchmark [--cycles N] [--seed N] [--rate HZ] [--horizon N | --horizon-s S] PLAN.g2o…
//
// Each plan is gone along again and again, `--rate` cycles of one step for each second of it, until
// there were so many cycles. A ball of 0.1 to 0.3 m is 1 cm to 0.5 m from what the robot sweeps in
// the next 2 s; each second it is somewhere else, and until then it trembles by 1 mm: the world is
// another one at each configuration. Prints one JSON object: processor time of the cycles [ms],
// alone of those without a proposal; by elapsed time parts of them, of the slowest hundredth and of
// the longest one; windows called feasible; how much memory the process has more at the end than
// after the first time along the plan. What shows the world and what makes the snapshot are not in
// the times, nor is the judge.
#include <locograph/common/simd_level.h>
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/robots/robot_state.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

constexpr double kLeast_m = 0.1, kMost_m = 0.3;
constexpr double kNearest_m = 0.01, kFarthest_m = 0.5, kAhead_s = 2.0, kStays_s = 1.0;
constexpr double kTrembles_m = 1e-3;

/// Processor seconds of this thread.
double processor_s() {
  timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double resident_MB() {
  std::ifstream file("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  file >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

Json percentiles_ms(std::vector<double> seconds) {
  if (seconds.empty()) return nullptr;
  std::ranges::sort(seconds);
  const auto at = [&](double share) {
    return 1e3 * seconds[static_cast<std::size_t>(share * static_cast<double>(seconds.size() - 1))];
  };
  return {{"cycles", seconds.size()},
          {"p50", at(0.5)},
          {"p95", at(0.95)},
          {"p99", at(0.99)},
          {"max", at(1.0)}};
}

/// Seconds.
using Parts = std::array<double, 5>;

Json parts_ms(const Parts& parts) {
  return {{"compile", 1e3 * parts[0]},
          {"linearise", 1e3 * parts[1]},
          {"solve", 1e3 * parts[2]},
          {"evaluate", 1e3 * parts[3]},
          {"proposals", 1e3 * parts[4]}};
}

/// Where a ball is beside a plan.
class Balls {
 public:
  Balls(const RobotParameter& robot, const Motion& motion, std::uint64_t seed)
      : random_(seed), time_s_(motion.time_s) {
    RobotState state(*robot.robot);
    for (const Eigen::VectorXd& q : motion.configurations) {
      state.update(q.data());
      std::vector<Sphere>& spheres = spheres_.emplace_back();
      for (const CollisionSphere& sphere : robot.spheres) {
        spheres.push_back({state.world_from_link(sphere.link) * sphere.center, sphere.radius});
      }
    }
  }

  /// The one seen at a configuration.
  Obstacle at(int configuration) {
    const double now_s = time_s_[static_cast<std::size_t>(configuration)];
    if (now_s < drawn_s_ || now_s > drawn_s_ + kStays_s) {
      draw(configuration);
      drawn_s_ = now_s;
    }
    Obstacle ball = ball_;
    for (double& x : ball.world_from_obstacle.translation()) {
      x += uniform(random_, -kTrembles_m, kTrembles_m);
    }
    return ball;
  }

 private:
  struct Sphere {
    Vector3d centre;
    double radius_m;
  };

  void draw(int configuration) {
    ball_.name = "ball";
    ball_.shape = Obstacle::Shape::kSphere;
    ball_.size = {0.5 * uniform(random_, kLeast_m, kMost_m), 0.0, 0.0};
    const double until_s = time_s_[static_cast<std::size_t>(configuration)] + kAhead_s;
    constexpr int kDraws = 1000;
    for (int k = 0; k < kDraws; ++k) {
      const std::vector<Sphere>& now = spheres_[static_cast<std::size_t>(configuration)];
      Vector3d centre = now[random_() % now.size()].centre;
      for (double& x : centre) x += uniform(random_, -kFarthest_m, kFarthest_m);
      double nearest_m = kFarthest_m + 1.0;
      for (auto i = static_cast<std::size_t>(configuration);
           i < time_s_.size() && time_s_[i] <= until_s; ++i) {
        for (const Sphere& sphere : spheres_[i]) {
          nearest_m = std::min(nearest_m, (centre - sphere.centre).norm() - sphere.radius_m);
        }
      }
      nearest_m -= ball_.size[0];
      ball_.world_from_obstacle.translation() = centre;
      if (nearest_m >= kNearest_m && nearest_m <= kFarthest_m) return;
    }
    ball_.world_from_obstacle.translation() << 0.0, 0.0, 1e3;
  }

  std::mt19937_64 random_;
  std::vector<double> time_s_;
  std::vector<std::vector<Sphere>> spheres_;  // by configuration
  Obstacle ball_;
  double drawn_s_ = 1e9;
};

struct Options {
  int cycles = 10000, horizon = 0;
  double rate_hz = 50.0, horizon_s = 0.0;
  std::uint64_t seed = 1;
};

class Benchmark {
 public:
  explicit Benchmark(const Options& options) : options_(options) { add_robot_types(types_); }

  Json run(const std::string& file) {
    // Their memory is there before, and is none that grows.
    constexpr std::size_t kOnceAlong = 100000;
    const std::size_t most = static_cast<std::size_t>(options_.cycles) + kOnceAlong;
    for (std::vector<double>* times : {&all_s_, &without_s_}) {
      times->assign(most, 0.0);
      times->clear();
    }
    parts_.assign(most, {});
    parts_.clear();
    feasible_ = iterations_ = 0;
    const Graph first = read_graph(file, types_);
    const Plan plan = plan_of(first);
    planned_ = motion_of(first, plan);
    Balls balls(*plan.robot, planned_, options_.seed);
    double before_MB = 0.0;
    int times = 0;
    for (; static_cast<int>(all_s_.size()) < options_.cycles; ++times) {
      go_along(file, balls);
      if (times == 0) before_MB = resident_MB();
    }
    const double grew_MB = resident_MB() - before_MB;
    const auto cycles = static_cast<double>(all_s_.size());
    return {{"plan", std::filesystem::path(file).filename().string()},
            {"configurations", planned_.configurations.size()},
            {"duration_s", planned_.time_s.back()},
            {"window", window_},
            {"degrees_of_freedom", plan.robot->robot->tangent_size()},
            {"times_along", times},
            {"feasible", feasible_ / cycles},
            {"iterations_per_cycle", iterations_ / cycles},
            {"processor_ms", percentiles_ms(all_s_)},
            {"without_proposals_ms", percentiles_ms(without_s_)},
            {"mean_ms", parts_ms(parts_of_slowest(1.0))},
            {"slowest_hundredth_ms", parts_ms(parts_of_slowest(0.01))},
            {"longest_ms", parts_ms(parts_of_slowest(0.0))},
            {"memory_grew_MB", times > 1 ? Json(grew_MB) : Json(nullptr)}};
  }

 private:
  void go_along(const std::string& file, Balls& balls) {
    Graph graph = read_graph(file, types_);
    const Plan plan = plan_of(graph);
    WalkOptions options = walk_options_for(plan);
    if (options_.horizon > 0) {
      options.planner.horizon = options_.horizon;
      options.planner.horizon_s = 0.0;
    }
    if (options_.horizon_s > 0.0) options.planner.horizon_s = options_.horizon_s;
    const World known = plan.world->snapshot->world();
    DistanceFieldOptions view;
    if (plan.world->ground_z_m) view.ground_z = *plan.world->ground_z_m;
    LocalPlanner planner(graph, options.planner);
    for (int at = 0; at + 1 < planner.plan_size(); ++at) {
      World world = known;
      world.obstacles.push_back(balls.at(at));
      planner.show(
          std::make_shared<const WorldSnapshot>(std::move(world), 0.0, WorldFiles(), view));
      for (int left = cycles_of(at); left > 0; --left) cycle(planner, at);
    }
  }

  int cycles_of(int at) const {
    const auto before = [this](int i) {
      return std::ceil(planned_.time_s[static_cast<std::size_t>(i)] * options_.rate_hz);
    };
    return std::max(1, static_cast<int>(before(at + 1) - before(at)));
  }

  void cycle(LocalPlanner& planner, int at) {
    const double begin_s = processor_s();
    const CycleReport report = planner.cycle(at, {.max_iterations = 1});
    const double took_s = processor_s() - begin_s;
    all_s_.push_back(took_s);
    if (!report.detour) without_s_.push_back(took_s);
    feasible_ += report.success() ? 1.0 : 0.0;
    iterations_ += report.statistics.iterations;
    window_ = std::max(window_, report.window);
    const WindowStatistics& s = report.statistics;
    parts_.push_back({s.compile_s, s.linearise_s, s.solve_s, s.evaluate_s, s.proposals_s});
  }

  /// Mean of the slowest cycles, of one at least.
  Parts parts_of_slowest(double share) const {
    std::vector<std::size_t> order(all_s_.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, std::greater(), [this](std::size_t i) { return all_s_[i]; });
    const double most = share * static_cast<double>(order.size());
    order.resize(std::max<std::size_t>(1, static_cast<std::size_t>(most)));
    Parts mean = {};
    for (const std::size_t i : order) {
      for (std::size_t k = 0; k < mean.size(); ++k) {
        mean[k] += parts_[i][k] / static_cast<double>(order.size());
      }
    }
    return mean;
  }

  Options options_;
  TypeRegistry types_;
  Motion planned_;
  std::vector<double> all_s_, without_s_;
  std::vector<Parts> parts_;
  double feasible_ = 0.0, iterations_ = 0.0;
  int window_ = 0;
};

Json load() {
  std::array<double, 3> average = {};
  return getloadavg(average.data(), 3) == 3 ? Json(average) : Json(nullptr);
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Cycles of the online planner while the world changes",
                              "online_benchmark");
  locograph::Options options;
  std::vector<std::string> files;
  app.add_option("--cycles", options.cycles, "At least, for each plan").positive();
  app.add_option("--seed", options.seed, "Of the balls");
  app.add_option("--rate", options.rate_hz, "Cycles in a second of the plan").positive();
  app.add_option("--horizon", options.horizon, "Configurations; 0: as refine has it")
      .not_negative();
  app.add_option("--horizon-s", options.horizon_s, "Seconds; 0: as refine has it").not_negative();
  app.add_option("PLAN", files, "Plan files (.g2o)").required();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Benchmark benchmark(options);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& file : files) rows.push_back(benchmark.run(file));
    std::cout << nlohmann::ordered_json({{"vector_level", locograph::simd_level()},
                                         {"load", locograph::load()},
                                         {"seed", options.seed},
                                         {"rate_hz", options.rate_hz},
                                         {"plans", rows}})
                     .dump(2)
              << '\n';
  });
}
