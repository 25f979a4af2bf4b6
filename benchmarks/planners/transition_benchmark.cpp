// The transitions that a stance planner asks for on a scenario, each solved once more by itself:
// as the planner did, and with so many restarts that what is not found then hardly exists.
//
//     transition_benchmark SCENARIO [--transitions N] [--planner NAME] [--seed N] [--restarts N]
//                          [--judge] [--torque-limits enforce|report]
//
// The planner runs with the seeds N, N+1, … until enough were asked for; all attempts count, those
// of shortening and repeated ones, too. Prints one JSON object. `share` is what the planner's own
// settings find of what the restarts find. With --judge, found is what the judge accepts on both
// stances. ms_per_posture is the time of all attempts, failed ones included, for each that is
// found; p50 and p95 are those of single attempts. Times are of the second solving, without the
// judge; what a stance balances is worked out with the first transition that needs it, as in a
// planner. Restarts are only tried where the planner's own settings found nothing: both begin with
// the same attempts.
#include <locograph/check/judge.h>
#include <locograph/common/data_folder.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/offline/stance/stance_space.h>
#include <locograph/planners/offline/stance/started_task.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "command_line.h"

namespace locograph {
namespace {

using Json = nlohmann::ordered_json;

struct TransitionsAsked {
  std::string scenario, planner = "guided", torques;
  int transitions = 10000, restarts = 200;
  std::uint64_t seed = 0;
  bool judge = false;
};

/// An attempt of a planner that ran with this seed.
struct Recorded {
  std::uint64_t seed;
  TransitionAttempt attempt;

  bool places() const { return attempt.to.contacts.size() > attempt.from.contacts.size(); }
};

/// What became of it when it was solved again.
struct Replayed {
  bool solved = false;      ///< by the solver
  bool accepted = false;    ///< by the judge as well, where there is one
  std::string reason = {};  ///< why not
  double seconds = 0.0;
};

std::vector<Recorded> recorded(const Task& task, const TransitionsAsked& asked) {
  const auto planner = make_stance_planner(asked.planner);
  const std::size_t wanted = static_cast<std::size_t>(asked.transitions);
  std::vector<Recorded> all;
  std::atomic<bool> enough = false;
  StancePlannerOptions options;
  options.termination.stop = &enough;
  options.observe = [&](const TransitionAttempt& attempt) {
    if (all.size() < wanted) all.push_back({options.seed, attempt});
    enough = all.size() >= wanted;
  };
  for (options.seed = asked.seed; !enough; ++options.seed) {
    const std::size_t before = all.size();
    planner->plan(task, options);
    if (all.size() == before) throw Error("the planner asks for no transitions", "a way to go");
    std::cerr << all.size() << " of " << wanted << " transitions\n";
  }
  return all;
}

/// Solves transitions as planners do: what is worked out for one is kept for those after it of the
/// same seed.
class Replayer {
 public:
  /// judge: may be null. Both must live.
  Replayer(const Task& task, const Judge* judge) : task_(task), judge_(judge) {}

  Replayed replay(const Recorded& asked, int restarts) {
    if (!space_ || options_.seed != asked.seed) {
      options_.seed = asked.seed;
      space_ = std::make_unique<StanceSpace>(task_, options_);
    }
    const TransitionAttempt& attempt = asked.attempt;
    const Footing from = space_->footing(attempt.from), to = space_->footing(attempt.to);
    const Eigen::VectorXd* before = attempt.before.size() > 0 ? &attempt.before : nullptr;
    const Stopwatch watch;
    const StanceSpace::Attempt found =
        space_->try_transition(from, to, attempt.start, restarts, before);
    Replayed result{.solved = found.found, .accepted = found.found, .seconds = watch.seconds()};
    if (!found.found) {
      result.reason = transition_failure_name(found.failure);
    } else if (judge_ != nullptr) {
      const Eigen::VectorXd& q = found.configuration;
      const CheckReport report = judge_->check(
          stances_motion({space_->rolled_stance(from, from, q), space_->rolled_stance(to, from, q)},
                         {q, q}),
          task_.check);
      result.accepted = report.feasible;
      if (!report.feasible) result.reason = "judge: " + report.worst().constraint;
    }
    return result;
  }

 private:
  const Task& task_;
  const Judge* judge_;
  StancePlannerOptions options_;
  std::unique_ptr<StanceSpace> space_;
};

Json milliseconds(std::vector<double> seconds) {
  std::sort(seconds.begin(), seconds.end());
  const auto quantile = [&seconds](double part) {
    if (seconds.empty()) return Json(nullptr);
    const double last = static_cast<double>(seconds.size() - 1);
    return Json(1e3 * seconds[static_cast<std::size_t>(part * last + 0.5)]);
  };
  return {{"p50", quantile(0.5)}, {"p95", quantile(0.95)}};
}

Json ratio(double a, double b) { return b > 0.0 ? Json(a / b) : Json(nullptr); }

/// Transitions of one kind.
class TransitionTally {
 public:
  /// own: with the planner's settings; most: with all restarts.
  void add(const Replayed& own, const Replayed& most) {
    ++count_;
    found_ += own.accepted;
    found_with_restarts_ += most.accepted;
    own_s_ += own.seconds;
    most_s_ += most.seconds;
    (own.accepted ? found_s_ : failed_s_).push_back(own.seconds);
  }

  Json json() const {
    return {{"transitions", count_},
            {"found", found_},
            {"found_with_restarts", found_with_restarts_},
            {"share", ratio(found_, found_with_restarts_)},
            {"ms_per_posture", ratio(1e3 * own_s_, found_)},
            {"ms_per_posture_with_restarts", ratio(1e3 * most_s_, found_with_restarts_)},
            {"found_ms", milliseconds(found_s_)},
            {"failed_ms", milliseconds(failed_s_)}};
  }

  /// Of transitions that were not found.
  Json failed_json(const std::string& reason) const {
    return {{"reason", reason},
            {"transitions", count_},
            {"found_with_restarts", found_with_restarts_},
            {"ms", milliseconds(failed_s_)}};
  }

  int count() const { return count_; }

 private:
  int count_ = 0, found_ = 0, found_with_restarts_ = 0;
  double own_s_ = 0.0, most_s_ = 0.0;
  std::vector<double> found_s_, failed_s_;
};

Json failures_json(const std::map<std::string, TransitionTally>& failures) {
  std::vector<std::pair<std::string, const TransitionTally*>> all;
  for (const auto& [reason, tally] : failures) all.emplace_back(reason, &tally);
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.second->count() > b.second->count();
  });
  Json json = Json::array();
  for (const auto& [reason, tally] : all) json.push_back(tally->failed_json(reason));
  return json;
}

/// own: each with the restarts that the planner allowed.
Json report(const Task& task, const TransitionsAsked& asked, const std::vector<Recorded>& all,
            const std::vector<Replayed>& own, const std::vector<Replayed>& most) {
  TransitionTally together, lifts, places;
  std::map<std::string, TransitionTally> failures;
  int otherwise = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    otherwise += own[i].solved != all[i].attempt.found;
    together.add(own[i], most[i]);
    (all[i].places() ? places : lifts).add(own[i], most[i]);
    if (!own[i].accepted) failures[own[i].reason].add(own[i], most[i]);
  }
  Json json = {{"scenario", asked.scenario},
               {"planner", asked.planner},
               {"seed", asked.seed},
               {"seeds", all.back().seed - asked.seed + 1},
               {"torque_limits", task.check.enforce_torque_limits ? "enforce" : "report"},
               {"restarts", asked.restarts},
               {"judged", asked.judge},
               {"solved_otherwise_than_by_the_planner", otherwise}};
  json.update(together.json());
  json["lift"] = lifts.json();
  json["place"] = places.json();
  json["failures"] = failures_json(failures);
  return json;
}

Json measure(const TransitionsAsked& asked) {
  Task task = started_task(load_scenario(asked.scenario, data_folder())).task;
  if (!asked.torques.empty()) task.check.enforce_torque_limits = asked.torques == "enforce";
  const std::vector<Recorded> all = recorded(task, asked);
  std::unique_ptr<const Judge> judge;
  if (asked.judge) judge = std::make_unique<const Judge>(task.robot->robot, task.world);

  std::vector<Replayed> own;
  Replayer as_planned(task, judge.get());
  for (const Recorded& one : all) own.push_back(as_planned.replay(one, one.attempt.restarts));
  std::vector<Replayed> most = own;
  Replayer with_restarts(task, judge.get());
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i % 1000 == 0) std::cerr << i << " of " << all.size() << " with restarts\n";
    const int restarts = std::max(asked.restarts, all[i].attempt.restarts);
    if (!own[i].solved) most[i] = with_restarts.replay(all[i], restarts);
  }
  return report(task, asked, all, own, most);
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::TransitionsAsked asked;
  locograph::OptionParser app("Transitions that a stance planner asks for", "transition_benchmark");
  app.add_option("SCENARIO", asked.scenario, "File, or a name that comes with locograph")
      .required();
  app.add_option("--transitions", asked.transitions, "How many").positive().show_default();
  app.add_option("--planner", asked.planner, "That asks for them")
      .one_of(locograph::stance_planner_names())
      .show_default();
  app.add_option("--seed", asked.seed, "The planner's first one").show_default();
  app.add_option("--restarts", asked.restarts, "That nearly all is found with")
      .not_negative()
      .show_default();
  app.add_flag("--judge", asked.judge, "Count what the judge accepts only");
  app.add_option("--torque-limits", asked.torques, "Without it, what the scenario says")
      .one_of({"enforce", "report"});
  return locograph::run_benchmark(app, argc, argv,
                                  [&] { std::cout << locograph::measure(asked).dump(2) << '\n'; });
}
