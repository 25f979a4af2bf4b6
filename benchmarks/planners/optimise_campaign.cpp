// Plans are optimisable graphs: does optimising one leave it feasible and where it was, bring a
// disturbed one back, and lead it past a box in the way of a swing.
//
//     optimise_campaign [--disturbed N] [--boxes N] [--iterations N] [--seed N] PLAN.g2o…
//
// Plans are those of `locograph plan SCENARIO`. Each is optimised as `locograph optimize` does, in
// at most so many iterations, and then judged in the world of its scenario:
//   as_it_is    how far a coordinate moves at most [m, rad]
//   disturbed   each coordinate of each inner configuration by up to 5 mm or 5 mrad, N times
//   box         a cube of 6 cm reaches 2 cm into the way of a link that swings, N times. No sphere
//               of the robot's is within 15 mm of it at both ends of the swing and in other
//               segments. Drives and plans whose links all stay in contact have none
// Prints one JSON object.
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/deadline.h>
#include <locograph/common/uniform.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/robots/robot_state.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::Vector3d;

constexpr double kDisturbed = 5e-3;  // m, rad
constexpr double kBoxSide_m = 0.06, kIntoTheWay_m = 0.02, kClear_m = 0.015;
constexpr int kMostDraws = 200;

/// A link that swings during a segment.
struct Swing {
  int first, last, link;
};

class Campaign {
 public:
  Campaign(std::uint64_t seed, int disturbed, int boxes, int iterations)
      : random_(seed), disturbed_(disturbed), boxes_(boxes), iterations_(iterations) {
    types_ = standard_types();
    add_robot_types(types_);
  }

  Json run(const std::string& file) {
    Graph graph = read_graph(file, types_);
    const std::vector<Eigen::VectorXd> states = states_of(graph);
    plan_ = plan_of(graph);
    motion_ = motion_of(graph, plan_);
    judging_ = judging_of(graph, plan_, {.data_folder = data_folder()});
    judging_.options.threads = 2;
    centres_.clear();
    ConfigurationState state(plan_.robot);
    for (const Eigen::VectorXd& q : motion_.configurations) {
      state.update(q.data());
      std::vector<Vector3d>& centres = centres_.emplace_back();
      for (const CollisionSphere& sphere : plan_.robot->spheres) {
        centres.push_back(state.kinematics.world_from_link(sphere.link) * sphere.center);
      }
    }
    Json result = {{"plan", std::filesystem::path(file).filename().string()},
                   {"configurations", plan_.slots.size()}};
    result["as_it_is"] = optimised(graph);
    restore(graph, states);
    Json disturbed = Json::array(), boxes = Json::array();
    for (int k = 0; k < disturbed_; ++k) {
      disturb(graph);
      disturbed.push_back(optimised(graph));
      restore(graph, states);
      std::cerr << file << ", disturbed " << k << ": " << disturbed.back().dump() << '\n';
    }
    result["disturbed_feasible"] = feasible(disturbed);
    result["disturbed"] = disturbed;
    const std::vector<Swing> all = swings();
    for (int k = 0; k < boxes_ && !all.empty(); ++k) {
      const std::optional<Obstacle> box = box_in_the_way(graph, all);
      if (!box) continue;
      boxes.push_back(past(graph, *box));
      restore(graph, states);
      std::cerr << file << ", box " << k << ": " << boxes.back().dump() << '\n';
    }
    result["boxes"] = boxes.size();
    result["box_feasible"] = feasible(boxes);
    result["box"] = boxes;
    return result;
  }

 private:
  static std::ptrdiff_t feasible(const Json& rows) {
    return std::ranges::count_if(rows, [](const Json& row) { return row["feasible"].get<bool>(); });
  }

  /// By slot; empty where there is no vertex.
  static std::vector<Eigen::VectorXd> states_of(const Graph& graph) {
    std::vector<Eigen::VectorXd> states(static_cast<std::size_t>(graph.vertex_slots()));
    for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
      if (!graph.vertex_alive(slot)) continue;
      states[static_cast<std::size_t>(slot)] =
          Eigen::Map<const Eigen::VectorXd>(graph.state(slot), graph.state_size(slot));
    }
    return states;
  }

  void restore(Graph& graph, const std::vector<Eigen::VectorXd>& states) const {
    for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
      if (!graph.vertex_alive(slot)) continue;
      std::ranges::copy(states[static_cast<std::size_t>(slot)], graph.state(slot));
    }
    for (std::size_t i = 0; i < plan_.slots.size(); ++i) {
      graph.vertex(VertexId<VertexConfiguration>{plan_.slots[i]}).slopes = motion_.slopes[i];
    }
  }

  /// As `locograph optimize` does it.
  Json optimised(Graph& graph) const {
    OptimiserOptions options = OptimiserOptions::for_any_start();
    options.max_iterations = iterations_;
    const auto solver = make_linear_solver("auto");
    const Motion before = motion_of_slopes(graph, plan_);
    const Stopwatch watch;
    const OptimiserResult result = optimise(graph, options, *solver);
    const double seconds = watch.seconds();
    carry_slopes(before, plan_, graph);
    carry_wrenches(before, plan_, graph);
    const CheckReport report = judged(graph, plan_, judging_);
    double moved = 0.0;
    const Motion after = motion_of(graph, plan_);
    for (std::size_t i = 0; i < after.configurations.size(); ++i) {
      moved = std::max(
          moved, (after.configurations[i] - motion_.configurations[i]).lpNorm<Eigen::Infinity>());
    }
    Json row = {{"feasible", report.feasible},
                {"moved", moved},
                {"iterations", result.iterations},
                {"chi2", {result.initial.chi2, result.final.chi2}},
                {"seconds", seconds}};
    for (const Violation* violation : report.violated()) {
      row["violated"].push_back({{"constraint", violation->constraint},
                                 {"worst", violation->worst},
                                 {"limit", violation->limit},
                                 {"vertex", violation->at_vertex},
                                 {"what", violation->what}});
    }
    return row;
  }

  void disturb(Graph& graph) {
    const Robot& robot = *plan_.robot->robot;
    Eigen::VectorXd by(robot.tangent_size());
    for (std::size_t i = 1; i + 1 < plan_.slots.size(); ++i) {
      for (double& value : by) value = uniform(random_, -kDisturbed, kDisturbed);
      Eigen::VectorXd moved(robot.configuration_size());
      VertexConfiguration& vertex = graph.vertex(VertexId<VertexConfiguration>{plan_.slots[i]});
      robot.integrate(vertex.state.data(), by.data(), moved.data());
      vertex.state = moved;
    }
  }

  /// Links that are in contact before a segment or after it, and not in it.
  std::vector<Swing> swings() const {
    std::vector<Swing> found;
    const Robot& robot = *plan_.robot->robot;
    const auto holds = [](const Stance& stance, const std::string& link) {
      return std::ranges::any_of(
          stance.contacts, [&](const Contact& contact) { return contact.effector.link == link; });
    };
    for (std::size_t j = 0; j < plan_.segments.size(); ++j) {
      const auto stance_at = [&](int i) -> const Stance& {
        return plan_.stance_from[static_cast<std::size_t>(i)]->stance;
      };
      const PlanSegment& segment = plan_.segments[j];
      const Stance& here = stance_at(segment.first);
      if (segment.last - segment.first < 4) continue;
      for (const std::size_t other : {j - 1, j + 1}) {
        if (other >= plan_.segments.size()) continue;
        for (const Contact& contact : stance_at(plan_.segments[other].first).contacts) {
          if (holds(here, contact.effector.link)) continue;
          const Swing swing = {segment.first, segment.last,
                               robot.link_index(contact.effector.link)};
          const auto known = [&](const Swing& s) {
            return s.first == swing.first && s.link == swing.link;
          };
          if (std::ranges::none_of(found, known)) found.push_back(swing);
        }
      }
    }
    return found;
  }

  /// How near a part of the plan comes to a box, negative in it [m].
  double clearance(const Graph& graph, const Obstacle& box, int first, int last) const {
    World world;
    world.obstacles = {box};
    return Judge(judging_.robot, world)
        .check(motion_of(graph, plan_, first, last), judging_.options)
        .constraint("obstacle_distance")
        .worst;
  }

  /// Of all configurations but those of a swing, as the edges see them.
  bool others_are_clear(const Obstacle& box, const Swing& swing) const {
    const std::vector<CollisionSphere>& spheres = plan_.robot->spheres;
    for (std::size_t i = 0; i < centres_.size(); ++i) {
      const int at = static_cast<int>(i);
      if (at > swing.first && at < swing.last) continue;
      for (std::size_t k = 0; k < spheres.size(); ++k) {
        if (box.distance(centres_[i][k], 0.0) - spheres[k].radius < kClear_m) return false;
      }
    }
    return true;
  }

  std::optional<Obstacle> box_in_the_way(const Graph& graph, const std::vector<Swing>& all) {
    RobotState state(*plan_.robot->robot);
    for (int draw = 0; draw < kMostDraws; ++draw) {
      const Swing& swing = all[random_() % all.size()];
      const int at =
          swing.first + static_cast<int>(uniform(random_, 0.35, 0.65) * (swing.last - swing.first));
      state.update(motion_.configurations[static_cast<std::size_t>(at)].data());
      const Vector3d link = state.world_from_link(swing.link).translation();
      Vector3d out;
      for (double& value : out) value = uniform(random_, -1.0, 1.0);
      if (out.norm() > 1.0 || out.norm() < 0.1) continue;
      out.normalize();
      Obstacle box;
      box.name = "in_the_way";
      box.size.setConstant(kBoxSide_m);
      const auto clear_at = [&](double far_m) {
        box.world_from_obstacle.translation() = link + far_m * out;
        return clearance(graph, box, swing.first, swing.last);
      };
      double near_m = 0.0, far_m = 0.5;
      if (!(clear_at(near_m) < -kIntoTheWay_m) || !(clear_at(far_m) > -kIntoTheWay_m)) continue;
      for (int k = 0; k < 12; ++k) {
        const double middle_m = 0.5 * (near_m + far_m);
        (clear_at(middle_m) < -kIntoTheWay_m ? near_m : far_m) = middle_m;
      }
      if (std::abs(clear_at(near_m) + kIntoTheWay_m) > 2e-3) continue;
      if (others_are_clear(box, swing)) return box;
    }
    return {};
  }

  Json past(Graph& graph, const Obstacle& box) {
    const std::shared_ptr<const WorldParameter> own = plan_.world;
    World seen = own->snapshot->world();
    seen.obstacles.push_back(box);
    DistanceFieldOptions view;
    if (own->ground_z_m) view.ground_z = *own->ground_z_m;
    graph.replace_parameter(plan_.world_number, std::make_shared<const WorldParameter>(
                                                    std::make_shared<const WorldSnapshot>(
                                                        std::move(seen), 0.0, WorldFiles(), view),
                                                    own->ground_z_m));
    const auto judged_in = judging_.world;
    World judged_with = judged_in->world();
    judged_with.obstacles.push_back(box);
    judging_.world = std::make_shared<const WorldSnapshot>(std::move(judged_with));
    Json row = optimised(graph);
    graph.replace_parameter(plan_.world_number, own);
    judging_.world = judged_in;
    return row;
  }

  std::mt19937_64 random_;
  int disturbed_, boxes_, iterations_;
  TypeRegistry types_;
  Plan plan_;
  Motion motion_;
  Judging judging_;
  std::vector<std::vector<Vector3d>> centres_;  // of spheres, by configuration
};

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Plans optimised as they are, disturbed, and with a box in the way",
                              "optimise_campaign");
  int disturbed = 20, boxes = 20, iterations = 50;
  std::uint64_t seed = 1;
  std::vector<std::string> files;
  app.add_option("--disturbed", disturbed, "Disturbances of each plan").not_negative();
  app.add_option("--boxes", boxes, "Boxes in the way of each plan").not_negative();
  app.add_option("--iterations", iterations, "Most iterations to make").positive();
  app.add_option("--seed", seed, "Of disturbances and boxes");
  app.add_option("PLAN", files, "Plan files (.g2o)").required();
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Campaign campaign(seed, disturbed, boxes, iterations);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::string& file : files) rows.push_back(campaign.run(file));
    std::cout << nlohmann::ordered_json(
                     {{"seed", seed}, {"disturbed", disturbed}, {"boxes", boxes}, {"plans", rows}})
                     .dump(2)
              << '\n';
  });
}
