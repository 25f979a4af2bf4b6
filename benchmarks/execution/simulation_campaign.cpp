// Plans carried out in the physics engine, as they are and with what is other than planned.
//
//     simulation_campaign [--seeds N] [--seed N] [--kinds LIST] [--robustness] PLAN.g2o…
//
// Each kind of run is done N times for each plan; every joint is off by up to 5 mrad at the start.
//   nominal    nothing else
//   friction   20 % less of it
//   mass       each link's by its own factor within 5 %
//   contact    each surface, box and bar 2 mm along its normal, in either direction
//   push       30 N for 0.2 s at the root link, in a random horizontal direction at a random time
//   all        all of these at once
//   estimate   the controller knows what sensors with their errors tell, not the true state
//   rough      twice all of them, and 60 N: what margins are told apart by
// --robustness: of each plan, as `check` tells it, and how well it tells falls from survivals in
// all these runs (area under the curve). Prints one JSON object.
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/core/graph_file.h>
#include <locograph/execution/simulation.h>
#include <locograph/planners/plan/judging.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

SimulationOptions options_of(const std::string& kind, unsigned seed) {
  SimulationOptions options{.initial_error_rad = 0.005, .seed = seed};
  const bool all = kind == "all", rough = kind == "rough";
  if (kind == "friction" || all) options.friction_factor = 0.8;
  if (kind == "mass" || all) options.mass_error = 0.05;
  if (kind == "contact" || all) options.contact_error_m = 0.002;
  if (kind == "push" || all) options.push_N = 30.0;
  if (kind == "estimate") options.sensors.emplace();
  if (rough) {
    options.friction_factor = 0.6;
    options.mass_error = 0.1;
    options.contact_error_m = 0.004;
    options.push_N = 60.0;
  }
  return options;
}

struct Tally {
  int runs = 0, carried_out = 0, reached = 0, upright = 0;
  void count(const SimulationResult& result) {
    ++runs;
    carried_out += result.carried_out ? 1 : 0;
    reached += result.reached_goal ? 1 : 0;
    upright += result.upright ? 1 : 0;
  }
  Json json() const {
    return {{"runs", runs},
            {"carried_out", carried_out},
            {"reached_goal", reached},
            {"upright", upright}};
  }
};

/// How likely a run that is carried out has more of a measure than one that is not.
double area_under_curve(const std::vector<std::pair<double, bool>>& runs) {
  double wins = 0.0, pairs = 0.0;
  for (const auto& [good, carried_out] : runs) {
    if (!carried_out) continue;
    for (const auto& [bad, other] : runs) {
      if (other) continue;
      pairs += 1.0;
      wins += good > bad ? 1.0 : good == bad ? 0.5 : 0.0;
    }
  }
  return pairs > 0.0 ? wins / pairs : 0.5;
}

class Campaign {
 public:
  Campaign(std::vector<std::string> kinds, unsigned seed, int seeds, bool robustness)
      : kinds_(std::move(kinds)), seed_(seed), seeds_(seeds), robustness_(robustness) {
    types_ = standard_types();
    add_robot_types(types_);
  }

  void run(const std::string& file) {
    Graph graph = read_graph(file, types_);
    const Plan plan = plan_of(graph);
    Judging judging = judging_of(graph, plan, {.data_folder = data_folder()});
    const Motion motion = motion_of(graph, plan);
    if (const std::string why = missed_goals(motion, judging); !why.empty()) {
      throw Error(file + ": " + why, "a plan that reaches its goals");
    }
    Json told = {{"plan", std::filesystem::path(file).filename().string()}};
    const std::map<std::string, double> measures = measures_of(graph, plan, judging);
    for (const auto& [name, value] : measures) told["robustness"][name] = value;
    const std::vector<EndEffector> effectors = effectors_of(
        motion, judging.task ? judging.task->end_effectors() : std::vector<EndEffector>());
    for (const std::string& kind : kinds_) {
      Tally tally;
      for (int i = 0; i < seeds_; ++i) {
        const unsigned seed = seed_ + static_cast<unsigned>(i);
        const SimulationResult result = simulate(*judging.robot, effectors, judging.world->world(),
                                                 motion, options_of(kind, seed));
        tally.count(result);
        tallies_[kind].count(result);
        for (const auto& [name, value] : measures) {
          curves_[name].emplace_back(value, result.upright && result.reached_goal);
        }
        cycles_.insert(cycles_.end(), result.controller_s.begin(), result.controller_s.end());
        simulated_s_ += result.time_s;
        processor_s_ += result.processor_s;
        if (result.carried_out) continue;
        failures_.push_back({{"plan", told["plan"]},
                             {"kind", kind},
                             {"seed", seed},
                             {"upright", result.upright},
                             {"reached_goal", result.reached_goal},
                             {"plan_time_s", result.plan_time_s},
                             {"reason", result.reason}});
      }
      told[kind] = tally.json();
    }
    plans_.push_back(std::move(told));
  }

  Json json() {
    Json result = {{"seed", seed_}, {"seeds", seeds_}, {"plans", plans_}};
    for (const std::string& kind : kinds_) result["pooled"][kind] = tallies_[kind].json();
    result["failures"] = failures_;
    for (const auto& [name, runs] : curves_) {
      result["area_under_curve"][name] = area_under_curve(runs);
    }
    std::sort(cycles_.begin(), cycles_.end());
    double sum = 0.0;
    for (const double cycle : cycles_) sum += cycle;
    const auto count = static_cast<double>(std::max<std::size_t>(1, cycles_.size()));
    const auto at = [&](double share) {
      return cycles_.empty() ? 0.0 : cycles_[static_cast<std::size_t>(share * (count - 1.0))];
    };
    result["controller_us"] = {
        {"mean", 1e6 * sum / count}, {"p50", 1e6 * at(0.5)}, {"p99", 1e6 * at(0.99)}};
    result["real_time_factor"] = processor_s_ > 0.0 ? simulated_s_ / processor_s_ : 0.0;
    return result;
  }

 private:
  std::map<std::string, double> measures_of(const Graph& graph, const Plan& plan,
                                            Judging& judging) const {
    if (!robustness_) return {};
    judging.options.robustness = true;
    const CheckReport report = judged(graph, plan, judging);
    if (!report.robustness) return {};
    const Robustness& least = report.robustness->least;
    std::map<std::string, double> result;
    const auto add = [&](const char* name, const std::optional<double>& value) {
      result[name] = value.value_or(1.0);
    };
    add("friction", least.friction);
    add("area", least.area);
    add("torque", least.torque);
    add("mass", least.mass);
    result["push"] =
        least.push_N.value_or(1e3) / (judging.robot->total_mass() * standard_gravity().norm());
    return result;
  }

  const std::vector<std::string> kinds_;
  const unsigned seed_;
  const int seeds_;
  const bool robustness_;
  TypeRegistry types_;
  Json plans_ = Json::array(), failures_ = Json::array();
  std::map<std::string, Tally> tallies_;
  std::map<std::string, std::vector<std::pair<double, bool>>> curves_;
  std::vector<double> cycles_;
  double simulated_s_ = 0.0, processor_s_ = 0.0;
};

std::vector<std::string> words_of(const std::string& list) {
  std::vector<std::string> words;
  std::istringstream in(list);
  for (std::string word; std::getline(in, word, ',');) {
    static const std::vector<std::string> known = {"nominal", "friction", "mass",  "contact",
                                                   "push",    "all",      "rough", "estimate"};
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      throw Error("a run of kind '" + word + "'",
                  "nominal, friction, mass, contact, push, all, rough or estimate");
    }
    words.push_back(word);
  }
  return words;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::OptionParser app("Plans carried out in the physics engine", "simulation_campaign");
  std::vector<std::string> plans;
  std::string kinds = "nominal,friction,mass,contact,push,all";
  int seeds = 1;
  unsigned seed = 1;
  bool robustness = false;
  app.add_option("PLAN", plans).required();
  app.add_option("--seeds", seeds, "Runs of each kind").positive();
  app.add_option("--seed", seed, "Of the first one");
  app.add_option("--kinds", kinds, "Which, separated by commas").show_default();
  app.add_flag("--robustness", robustness, "Compare with what check --robustness says");
  return locograph::run_benchmark(app, argc, argv, [&] {
    locograph::Campaign campaign(locograph::words_of(kinds), seed, seeds, robustness);
    for (const std::string& plan : plans) {
      campaign.run(plan);
      std::cerr << plan << '\n';
    }
    std::cout << campaign.json().dump(2) << '\n';
  });
}
