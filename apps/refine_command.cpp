#include <locograph/apps/about_file.h>
#include <locograph/apps/common_options.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/refine_command.h>
#include <locograph/apps/refine_perception.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/parse_number.h>
#include <locograph/common/stop_signals.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/free_drive.h>
#include <locograph/planners/online/free_way.h>
#include <locograph/planners/online/resumed_drive.h>
#include <locograph/planners/online/resumed_plan.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/plan/seen_world.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, output;
  WorldOptions world;
  PerceptionChoice perception;
  std::string horizon;
  double rate_hz = walk_options_for({}).rate_hz;
  double deadline_ms = 0.0;
  bool replan = false;
  double replan_timeout_s = 20.0;
  double goal_tolerance_m = WalkOptions().goal_tolerance_m;
  double goal_tolerance_rad = WalkOptions().goal_tolerance_rad;
  std::vector<std::string> plugins;
  int threads = 1;
  bool json = false;
};

template <class F>
Json over_cycles(const WalkReport& report, F&& figure) {
  std::vector<double> values;
  for (const CycleReport& cycle : report.cycles) values.push_back(figure(cycle));
  return statistics_json(std::move(values));
}

Json phases_json(const WalkReport& report) {
  return {
      {"compile", over_cycles(report, [](const CycleReport& c) { return c.statistics.compile_s; })},
      {"linearise",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.linearise_s; })},
      {"solve", over_cycles(report, [](const CycleReport& c) { return c.statistics.solve_s; })},
      {"evaluate",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.evaluate_s; })},
      {"detour",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.proposals_s; })},
      {"check", over_cycles(report, [](const CycleReport& c) { return c.statistics.check_s; })},
  };
}

/// The cycles that took longer than they may, and what in them took longest.
Json misses_json(const WalkReport& report) {
  Json misses = Json::array();
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const CycleReport& cycle = report.cycles[i];
    if (!cycle.deadline_missed) continue;
    const WindowStatistics& s = cycle.statistics;
    const std::pair<const char*, double> phases[] = {{"compile", s.compile_s},
                                                     {"linearise", s.linearise_s},
                                                     {"solve", s.solve_s},
                                                     {"evaluate", s.evaluate_s},
                                                     {"detour", s.proposals_s}};
    const auto* longest = std::ranges::max_element(
        phases, [](const auto& a, const auto& b) { return a.second < b.second; });
    misses.push_back({{"cycle", i},
                      {"configuration", cycle.executed},
                      {"time", s.total_s},
                      {"longest_phase", longest->first},
                      {"longest_phase_time", longest->second}});
  }
  return misses;
}

Json report_json(const WalkReport& report, const CommandOptions& options, double field_s,
                 double judge_s) {
  int iterations = 0, detours = 0;
  Json cycle_times = Json::array();
  for (const CycleReport& cycle : report.cycles) {
    cycle_times.push_back(cycle.statistics.total_s);
    iterations += cycle.statistics.iterations;
    detours += cycle.detour ? 1 : 0;
  }
  return {
      {"success", report.success()},
      {"status", planner_status_name(report.status)},
      {"reason", report.reason},
      {"cycles", report.cycles.size()},
      {"rate_hz", options.rate_hz},
      {"horizon", report.cycles.empty() ? 0 : report.cycles.front().window},
      {"dof", report.dof},
      {"configurations", report.configurations},
      {"feasible_cycles", report.feasible_cycles},
      {"deadline_misses", report.deadline_misses},
      {"deadline_miss_log", misses_json(report)},
      {"goal_distance_m", report.goal_distance_m},
      {"goal_angle_rad", report.goal_angle_rad},
      {"short_of_goal_m", report.short_of_goal_m},
      {"iterations", iterations},
      {"constraints", report.cycles.empty() ? 0 : report.cycles.front().statistics.constraints},
      {"detours_searched", detours},
      {"cycle_time",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.total_s; })},
      {"iteration_time",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.iteration_s; })},
      {"optimize_time",
       over_cycles(report, [](const CycleReport& c) { return c.statistics.optimise_s; })},
      {"map_update_time", statistics_json(report.map_update_s)},
      {"verify_time", statistics_json(report.verify_s)},
      {"phases", phases_json(report)},
      {"distance_field_s", field_s},
      {"judge_s", judge_s},
      {"cycle_times", std::move(cycle_times)},
  };
}

/// The judge's word on the plan as whoever checks the file that is written will have it. task: of
/// the plan's scenario, null where it has none.
CheckReport final_check(const PlanFile& file, const std::shared_ptr<const Task>& task) {
  const Plan plan = plan_of(file.graph);
  const Judging judging =
      judging_of(file.graph, plan, {.task = task, .data_folder = data_folder()});
  return judged(file.graph, plan, judging);
}

/// What of the judge's word is about the world that the cameras saw.
Json truth_json(const CheckReport& check) {
  bool touched = false;
  for (const Violation& violation : check.violations) {
    touched = touched || (violation.violated && (violation.constraint == "obstacle_distance" ||
                                                 violation.constraint == "ground_penetration"));
  }
  Json json = {{"feasible", check.feasible}, {"contact", touched}, {"min_clearance_m", nullptr}};
  if (check.min_clearance_m) json["min_clearance_m"] = *check.min_clearance_m;
  return json;
}

/// From now on what the command line names is the plan's world: the file that is written needs
/// nothing else.
void replace_world(PlanFile& file, const WorldOptions& given, const World& world) {
  const WorldFiles files{.map = given.map, .obstacles = given.obstacles};
  file.plan.world = std::make_shared<const WorldParameter>(
      std::make_shared<const WorldSnapshot>(World{.map = world.map, .obstacles = world.obstacles},
                                            0.0, files),
      file.plan.world->ground_z_m);
  file.graph.replace_parameter(file.plan.world_number, file.plan.world);
}

/// As `--horizon` says. Throws Error for what is neither a number of
/// configurations nor one of seconds, and for a horizon that is longer than the plan.
void set_horizon(const std::string& text, const PlanFile& file, LocalPlannerOptions& options) {
  const std::vector<int>& slots = file.plan.slots;
  const auto time_s = [&](int slot) {
    return file.graph.vertex(VertexId<VertexConfiguration>{slot}).time_s;
  };
  const int steps = static_cast<int>(slots.size()) - 1;
  const double duration_s = time_s(slots.back()) - time_s(slots.front());
  const auto given = [&](const std::string& what) { return "--horizon " + text + ": " + what; };
  if (text.empty()) return;
  if (text.ends_with('s')) {
    if (!parse_number(text.substr(0, text.size() - 1), options.horizon_s) ||
        !(options.horizon_s > 0.0)) {
      throw UsageError(given("seconds are a number above 0, as 2s"));
    }
    if (options.horizon_s > duration_s) {
      throw UsageError(given("the plan takes " + short_number(duration_s) + " s"));
    }
    return;
  }
  options.horizon_s = 0.0;
  if (!parse_number(text, options.horizon) || options.horizon < 1) {
    throw UsageError(given("expected configurations, 1 or more, as 20, or seconds, as 2s"));
  }
  if (options.horizon > steps) {
    throw UsageError(given("the plan has " + counted(steps, "step", "steps")));
  }
}

double end_of(const Graph& graph) {
  return graph.vertex(VertexId<VertexConfiguration>{plan_of(graph).slots.back()}).time_s;
}

/// Throws UsageError where `--replan` makes no sense.
void check_replan(const PlanFile& file, const Judging& judging, bool by_eye) {
  if (!judging.task) throw UsageError("--replan: " + file.name + " is no plan of a scenario");
  if (!judging.task->drive || !by_eye) return;
  throw UsageError(
      "--replan: not of drives with --cameras or --clouds, as they would go back and "
      "to the side, where cameras do not look");
}

/// What a robot does where it has had to stop: it waits, or plans on.
class GoingOn {
 public:
  /// eyes: what is known of the world; null: all of it.
  GoingOn(const PlanFile& file, const Judging& judging, const CommandOptions& options,
          const RefinePerception* eyes)
      : judging_(judging),
        eyes_(eyes),
        options_(options),
        planned_(motion_of(file.graph, file.plan)),
        segments_(file.plan.segments) {
    waits_ = judging.task && eyes == nullptr &&
             ChangingObstacles(*file.plan.robot, judging.world->world()).any();
  }

  bool can() const { return waits_ || options_.replan; }
  /// Empty: it has not stopped, or went on.
  const std::string& why_not() const { return why_not_; }

  std::optional<Graph> from(const Graph& stopped) {
    ResumedPlan resumed;
    resumed.status = PlannerStatus::kNotFound;
    why_not_.clear();
    if (waits_ && plan_of(stopped).slots.size() < planned_.configurations.size()) {
      const Task& task = *judging_.task;
      resumed = task.drive ? wait_for_free_drive(stopped, planned_, task, judging_.world)
                           : wait_for_free_way(stopped, planned_, segments_, task, judging_.world);
      if (resumed.success()) {
        ++waited_;
        waited_s_ += resumed.waits_s;
      } else {
        why_not_ = "; waiting: " + resumed.reason;
      }
    }
    if (!resumed.success() && options_.replan) {
      const Termination termination{.deadline = Deadline::of_limit(options_.replan_timeout_s),
                                    .stop = &stop_flag()};
      const Task& task = *judging_.task;
      resumed = task.drive ? resume_drive(stopped, planned_, task, world_now(stopped), termination)
                           : resume_plan(stopped, task, world_now(stopped),
                                         {.termination = termination, .threads = options_.threads});
      resume_s_ += resumed.total_s;
      why_not_ = resumed.success() ? "" : why_not_ + "; planning on: " + resumed.reason;
    }
    if (!resumed.success()) return {};
    const Plan now = plan_of(*resumed.graph);
    planned_ = motion_of(*resumed.graph, now);
    segments_ = now.segments;
    return std::move(resumed.graph);
  }

  void tell(int resumed, Json& json) const {
    if (waits_) {
      json["waits"] = waited_;
      json["waits_s"] = waited_s_;
    }
    if (options_.replan) {
      json["resumed"] = resumed - waited_;
      json["resume_s"] = resume_s_;
    }
  }

 private:
  std::shared_ptr<const WorldSnapshot> world_now(const Graph& stopped) const {
    return std::make_shared<const WorldSnapshot>(
        eyes_ != nullptr ? eyes_->walk().seen()
                         : world_at_rest(judging_.world->world(), end_of(stopped)));
  }

  const Judging& judging_;
  const RefinePerception* eyes_;
  const CommandOptions& options_;
  Motion planned_;
  std::vector<PlanSegment> segments_;
  bool waits_ = false;
  int waited_ = 0;
  double waited_s_ = 0.0, resume_s_ = 0.0;
  std::string why_not_;
};

ExitCode refine_plan(const OptionParser& parser, const CommandOptions& options) {
  const std::vector<std::filesystem::path> inputs = {
      options.input, options.world.map, options.world.obstacles, options.perception.known_map};
  check_output(options.output, inputs, options.json);
  check_perception_options(parser, options.perception, inputs);
  std::optional<Progress> progress("reading " + options.input);
  PlanFile file = load_plan(options.input, options.plugins);
  require_plan(file.plan, file.name);
  WalkOptions walk_options = walk_options_for(file.plan);
  walk_options.rate_hz = options.rate_hz;
  walk_options.cycle_deadline_s = 1e-3 * options.deadline_ms;
  walk_options.goal_tolerance_m = options.goal_tolerance_m;
  walk_options.goal_tolerance_rad = options.goal_tolerance_rad;
  walk_options.validate();
  walk_options.termination.stop = &stop_flag();
  set_horizon(options.horizon, file, walk_options.planner);
  if (!file.plan.world) throw Error(file.name, 0, "the plan has no world", "a PARAMS_WORLD line");
  check_not_input(options.output, files_of(file));
  const Judging judging = judging_of(file, options.world);
  if (options.replan) check_replan(file, judging, options.perception.given());
  if (!options.replan && parser.given("--replan-timeout")) {
    throw UsageError("--replan-timeout: not without --replan");
  }
  const Stopwatch watch;
  std::optional<RefinePerception> eyes;
  std::shared_ptr<const WorldSnapshot> seen;
  bool shown = true;  // as much of it as the plan goes through
  WorldAt world_at;
  if (options.perception.given()) {
    eyes.emplace(file, judging, options.perception);
    check_not_input(options.output, eyes->files());
    world_at = eyes->world_at();
    eyes->equip(walk_options);
  } else {
    seen = seen_world(file.graph, file.plan, judging.world->world());
    seen->distance();
    world_at = [&seen, &shown](int executed) {
      return executed == 0 || !std::exchange(shown, true) ? seen : nullptr;
    };
    walk_options.verify = step_check(judging);
  }
  const double field_s = watch.seconds();
  if (options.world.given()) replace_world(file, options.world, judging.world->world());

  GoingOn going_on(file, judging, options, eyes ? &*eyes : nullptr);
  if (going_on.can()) {
    walk_options.resume = [&](const Graph& stopped) {
      progress.emplace("planning on");
      std::optional<Graph> graph = going_on.from(stopped);
      if (graph && seen) {
        seen = seen_world(*graph, plan_of(*graph), judging.world->world());
        seen->distance();
        shown = false;
      }
      progress.emplace("refining " + options.input);
      return graph;
    };
  }
  const double configurations = static_cast<double>(file.plan.slots.size());
  progress.emplace("refining " + options.input);
  walk_options.on_cycle = [&](const CycleReport& cycle) {
    progress->show((cycle.executed + 1) / configurations);
  };
  const FinishOnSignal finish;
  WalkReport report =
      about_file(file.name, [&] { return walk_plan(file.graph, world_at, walk_options); });
  if (!report.success()) report.reason += going_on.why_not();
  progress.emplace("judging " + options.input);
  const Stopwatch judge_watch;
  std::optional<CheckReport> check;
  if (report.success() || report.configurations > 1) {
    check = final_check(file, judging.task);
    take_verdict(*check, report);
  }
  const double judge_s = check ? judge_watch.seconds() : 0.0;
  progress.emplace("writing " + options.output);
  write_graph(file.graph, options.output);
  if (eyes) eyes->save_map();
  progress.reset();

  Json json = report_json(report, options, field_s, judge_s);
  going_on.tell(report.resumed, json);
  if (eyes) eyes->tell(json);
  if (eyes && check) json["truth"] = truth_json(*check);
  if (options.json) {
    print_result(json, true);
    return report.success() ? kDone : kNo;
  }
  const auto ms = [&json](const char* which) {
    return short_number(1e3 * json["cycle_time"][which].get<double>());
  };
  print_text(options.input + ": " + counted(report.feasible_cycles, "cycle", "cycles") + " of " +
             std::to_string(report.cycles.size()) + " feasible, horizon " +
             std::to_string(json["horizon"].get<int>()) + ", " + std::to_string(report.dof) +
             " degrees of freedom\n" + (report.success() ? "" : "not refined: ") + report.reason +
             "\ncycle time " + ms("p50") + " ms (p95 " + ms("p95") + ", max " + ms("max") +
             ")\nends " + short_number(report.goal_distance_m) + " m and " +
             short_number(report.goal_angle_rad) + " rad from the goal\n" +
             (eyes ? eyes->text() : "") + "written: " + options.output + '\n');
  return report.success() ? kDone : kNo;
}

}  // namespace

Command add_refine(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("refine", "Walk along a plan and re-optimise a moving horizon of it");
  parser.add_option("PLAN", o.input, "Plan file (.g2o); - reads standard input").required();
  parser.add_option("-o,--output", o.output, "Refined plan to write (.g2o); - is standard output")
      .required();
  add_world_options(parser, o.world);
  add_perception_options(parser, o.perception);
  parser.add_option("--save-map", o.perception.save_map,
                    "Where to write the OctoMap of what was seen and known (.bt)");
  parser
      .add_option("--horizon", o.horizon,
                  "What one cycle optimises: configurations, as 20, or seconds, as 2s (default: 20 "
                  "on wheels, else 2s)")
      .value_name("N|Ts");
  parser
      .add_option("--rate", o.rate_hz, "Cycles in a second of the plan, one for each step at least")
      .positive()
      .between(0.0, kMostRate_Hz)
      .show_default();
  parser.add_option("--deadline-ms", o.deadline_ms, "Time one cycle may take; 0: no limit")
      .not_negative()
      .show_default();
  parser.add_flag("--replan", o.replan, "Where the robot has stopped, plan on from there");
  parser
      .add_option("--replan-timeout", o.replan_timeout_s,
                  "Seconds that planning on may take each time; 0: no limit")
      .not_negative()
      .show_default();
  parser
      .add_option("--goal-tolerance", o.goal_tolerance_m,
                  "How far from the plan's goal the base may end, in any direction [m]")
      .not_negative()
      .show_default();
  parser
      .add_option("--goal-angle-tolerance", o.goal_tolerance_rad,
                  "How far from its heading there it may end [rad]")
      .not_negative()
      .show_default();
  add_threads_option(parser, o.threads);
  add_plugin_option(parser, o.plugins);
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [parser, options] { return refine_plan(parser, *options); }};
}

}  // namespace locograph
