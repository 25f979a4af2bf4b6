#include <locograph/apps/about_file.h>
#include <locograph/apps/common_options.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/simulate_command.h>
#include <locograph/apps/statistics.h>
#ifdef LOCOGRAPH_WITH_MUJOCO
#include <locograph/apps/refine_perception.h>
#include <locograph/apps/simulation_record.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/stop_signals.h>
#include <locograph/core/graph_file.h>
#include <locograph/execution/simulation.h>
#include <locograph/planners/online/walk_ahead.h>
#include <locograph/planners/plan/seen_world.h>
#include <locograph/planners/task/task.h>
#endif

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, output, csv, controller = "whole_body", push;
  WorldOptions world;
  double friction = 1.0, mass_error = 0.0, contact_error_m = 0.0, initial_error_rad = 0.005;
  unsigned seed = 0;
  bool estimate = false, refine = false, cameras = false, json = false;
};

#ifdef LOCOGRAPH_WITH_MUJOCO

/// "30,0.2": for how long how hard.
void read_push(const std::string& text, SimulationOptions& options) {
  if (text.empty()) return;
  std::size_t comma = 0, end = 0;
  try {
    options.push_N = std::stod(text, &comma);
    if (comma < text.size() && text[comma] == ',') {
      options.push_s = std::stod(text.substr(comma + 1), &end);
      if (comma + 1 + end == text.size()) return;
    }
  } catch (const std::exception&) {
  }
  throw Error("--push '" + text + "'", "newtons and seconds, as in 30,0.2");
}

/// Of simulated time, from one moment of a record to the next.
constexpr double kRecordEvery_s = 0.02;

SimulationOptions simulation_options(const CommandOptions& command) {
  SimulationOptions options{.controller = command.controller,
                            .friction_factor = command.friction,
                            .mass_error = command.mass_error,
                            .contact_error_m = command.contact_error_m,
                            .initial_error_rad = command.initial_error_rad,
                            .seed = command.seed};
  read_push(command.push, options);
  if (command.estimate) options.sensors.emplace();
  if (!command.output.empty() || !command.csv.empty()) options.record_every_s = kRecordEvery_s;
  options.validate();
  return options;
}

/// The plan is refined while it is carried out.
class Refining {
 public:
  /// file: walked along, its graph is that of the refined plan. All must outlive it.
  Refining(PlanFile& file, const Judging& judging, const CommandOptions& command) {
    if (!file.plan.world) throw Error(file.name, 0, "the plan has no world", "a PARAMS_WORLD line");
    WalkOptions options = walk_options_for(file.plan);
    options.termination.stop = &stop_flag();
    if (command.cameras) {
      choice_.cameras = true;
      choice_.seed = command.seed;
      eyes_.emplace(file, judging, choice_);
      eyes_->equip(options);
    } else {
      seen_ = seen_world(file.graph, file.plan, judging.world->world());
      options.verify = step_check(judging);
    }
    walk_.emplace(
        file.graph, [this](int) { return std::exchange(seen_, nullptr); }, options);
  }

  std::optional<Motion> revise(const SimulationMoment& now) {
    if (eyes_) {
      auto newest = eyes_->world_from(now.clock_s, now.configuration);
      if (newest != shown_) seen_ = shown_ = std::move(newest);
    }
    return walk_->at(now.plan_time_s);
  }

  WalkReport report() const { return walk_->report(); }

  Json json() const {
    const WalkReport walked = report();
    std::vector<double> times;
    for (const CycleReport& cycle : walked.cycles) times.push_back(cycle.statistics.total_s);
    Json json = {{"success", walked.success()},
                 {"reason", walked.reason},
                 {"cycles", walked.cycles.size()},
                 {"configurations", walked.configurations},
                 {"goal_distance_m", walked.goal_distance_m},
                 {"goal_angle_rad", walked.goal_angle_rad},
                 {"cycle_time", statistics_json(std::move(times))}};
    if (eyes_) eyes_->tell(json);
    return json;
  }

 private:
  PerceptionChoice choice_;
  std::optional<RefinePerception> eyes_;
  std::shared_ptr<const WorldSnapshot> seen_, shown_;  ///< not shown yet, and the last one that was
  std::optional<WalkAhead> walk_;
};

Json result_json(const SimulationResult& result, bool estimated) {
  Json json = {
      {"upright", result.upright},
      {"reached_goal", result.reached_goal},
      {"carried_out", result.carried_out},
      {"reason", result.reason},
      {"time_s", result.time_s},
      {"plan_time_s", result.plan_time_s},
      {"waited_s", result.waited_s},
      {"max_joint_error_rad", result.max_joint_error_rad},
      {"max_base_error_m", result.max_base_error_m},
      {"max_base_error_rad", result.max_base_error_rad},
      {"max_contact_slip_m", result.max_contact_slip_m},
      {"slipping", result.slipping},
      {"other_link", result.other_link},
      {"touched_link", result.touched_link},
      {"other_touch_N", result.other_touch_N},
      {"max_torque_ratio", result.max_torque_ratio},
      {"max_estimate_error_m", nullptr},
      {"max_estimate_error_rad", nullptr},
      {"pushed_at_s", nullptr},
      {"controller_time", statistics_json(result.controller_s)},
      {"real_time_factor", result.processor_s > 0.0 ? result.time_s / result.processor_s : 0.0}};
  if (estimated) {
    json["max_estimate_error_m"] = result.max_estimate_error_m;
    json["max_estimate_error_rad"] = result.max_estimate_error_rad;
  }
  if (result.pushed_at_s >= 0.0) json["pushed_at_s"] = result.pushed_at_s;
  return json;
}

/// Before the simulation, as what is given must not be lost, nor what it takes minutes to find.
void check_outputs(const CommandOptions& command,
                   const std::vector<std::filesystem::path>& inputs) {
  for (const std::string& output : {command.output, command.csv}) {
    if (!output.empty()) check_output(output, inputs, command.json);
  }
}

/// The world that the command line names is the record's, too.
void take_world(PlanFile& file, const WorldOptions& given, const World& world) {
  if (!given.given()) return;
  const WorldFiles files{.map = given.map, .obstacles = given.obstacles};
  file.plan.world = std::make_shared<const WorldParameter>(
      std::make_shared<const WorldSnapshot>(World{.map = world.map, .obstacles = world.obstacles},
                                            0.0, files),
      file.plan.world ? file.plan.world->ground_z_m : std::nullopt);
}

void write_record(const CommandOptions& command, PlanFile& file, const Judging& judging,
                  std::span<const EndEffector> effectors, const SimulationResult& result) {
  if (!command.output.empty()) {
    take_world(file, command.world, judging.world->world());
    Record record = record_of_run(file.graph, file.plan, effectors, result.samples);
    if (command.input != "-") record.plan_file = command.input;
    write_graph(record_graph(file.graph, file.plan, record), command.output);
  }
  if (command.csv.empty()) return;
  write_file_atomically(command.csv,
                        samples_csv(*file.plan.robot->robot, effectors, result.samples));
}

ExitCode simulate_plan(const CommandOptions& command) {
  if (command.cameras && !command.refine) throw Error("--cameras without --refine", "both");
  SimulationOptions options = simulation_options(command);
  const std::vector<std::filesystem::path> inputs = {command.input, command.world.map,
                                                     command.world.obstacles};
  check_outputs(command, inputs);
  std::optional<Progress> progress("reading " + command.input);
  PlanFile file = load_plan(command.input);
  require_plan(file.plan, file.name);
  for (const std::string& output : {command.output, command.csv}) {
    if (!output.empty()) check_not_input(output, files_of(file));
  }
  const Judging judging = judging_of(file, command.world);
  const Motion motion = motion_of(file.graph, file.plan);
  const std::vector<EndEffector> effectors = effectors_of(
      motion, judging.task ? judging.task->end_effectors() : std::vector<EndEffector>());
  progress.emplace("carrying out " + command.input);
  std::optional<Refining> refining;
  std::optional<FinishOnSignal> finish;  // the walk ends where the robot can stop
  if (command.refine) {
    finish.emplace();
    about_file(file.name, [&] { refining.emplace(file, judging, command); });
    options.revise = [&](const SimulationMoment& now) { return refining->revise(now); };
  }
  SimulationResult result = about_file(file.name, [&] {
    return simulate(*judging.robot, effectors, judging.world->world(), motion, options);
  });
  if (refining) file.plan = plan_of(file.graph);
  // The engine knows where the plan ends, not where it should have led.
  std::string why = missed_goals(motion_of(file.graph, file.plan), judging);
  if (refining) {
    if (const WalkReport walked = refining->report(); !walked.success()) why = walked.reason;
  }
  if (!why.empty()) {
    result.reached_goal = result.carried_out = false;
    if (result.reason.empty()) result.reason = why;
  }
  progress.emplace("writing " + (command.output.empty() ? command.csv : command.output));
  write_record(command, file, judging, effectors, result);
  progress.reset();
  Json json = result_json(result, command.estimate);
  if (refining) json["refine"] = refining->json();
  if (!command.output.empty()) json["output"] = command.output;
  if (!command.csv.empty()) json["csv"] = command.csv;
  print_result(json, command.json);
  return result.upright ? kDone : kNo;
}

#else

ExitCode simulate_plan(const CommandOptions&) {
  throw Error("this locograph is built without the physics engine MuJoCo",
              "Debian's libmujoco-dev installed, and locograph built again");
}

#endif

}  // namespace

Command add_simulate(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser = app.add_subcommand(
      "simulate", "Carry a plan out in a physics engine, under a torque controller");
  parser.add_option("PLAN", o.input, "Plan file (.g2o); - reads standard input").required();
  parser.add_option("-o,--output", o.output,
                    "Record to write (.g2o): what was measured; - is standard output");
  parser.add_option("--csv", o.csv, "The same to write as a table (.csv); - is standard output");
  add_world_options(parser, o.world);
  parser.add_option("--controller", o.controller, "whole_body or joint_impedance").show_default();
  parser.add_option("--friction", o.friction, "Factor of the world's friction").show_default();
  parser.add_option("--mass-error", o.mass_error, "Share by which each link's mass may be off")
      .show_default();
  parser
      .add_option("--contact-error", o.contact_error_m,
                  "How far what may be touched is off along its normal, up or down [m]")
      .show_default();
  parser.add_option("--push", o.push, "Newtons and seconds of a push at the root link")
      .value_name("N,S");
  parser
      .add_option("--initial-error", o.initial_error_rad,
                  "By how much each joint may be off at the start [rad]")
      .show_default();
  parser.add_flag("--estimate", o.estimate,
                  "The controller knows its sensors only: encoders, attitude and rates, forces");
  parser.add_flag("--refine", o.refine,
                  "Refine the plan on the way, as refine does, a second ahead of the robot");
  parser.add_flag("--cameras", o.cameras,
                  "With --refine: knowing of the world what the robot's cameras show of it");
  parser.add_option("--seed", o.seed, "Of all that is drawn at random").show_default();
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return simulate_plan(*options); }};
}

}  // namespace locograph
