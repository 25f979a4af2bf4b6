#include <locograph/check/limits.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/check_option.h>
#include <locograph/common/ranges.h>
#include <locograph/planners/online/ball_slip.h>
#include <locograph/planners/online/braking.h>
#include <locograph/planners/online/changing_obstacles.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/online/window_cause.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/planners/plan/slope_limits.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace locograph {
namespace {

/// The first violation for which the judge refused.
std::string describe(const CheckReport& check) {
  const auto refused = std::ranges::find_if(check.violations, &Violation::violated);
  const std::string what =
      refused == check.violations.end() ? "the judge's refusal" : violation_text(*refused);
  return what + " on the way to the next";
}

/// Steps before the executed one are judged with it, at most so many.
constexpr int kMostVerifiedSteps = 12;

/// Before the step after a measurement, at least: more than one iteration is needed until the
/// forces on the way back balance.
constexpr int kMeasuredCycles = 10;
/// And, on wheels, as long as that step is not feasible: some tens of milliseconds.
constexpr int kMoreCycles = 150;

/// How many times as fast as another one a slope is, along it; up to twice, as on any ramp.
double ratio(const Eigen::VectorXd& slope, const Eigen::VectorXd& along) {
  const double length = along.squaredNorm();
  return length > 0.0 ? std::clamp(slope.dot(along) / length, 0.0, 2.0) : 1.0;
}

/// Walks along the plan and keeps the report.
class Walk {
 public:
  Walk(Graph& graph, const WalkOptions& options)
      : graph_(graph),
        options_(options),
        planner_(graph, options.planner),
        model_(*planner_.plan().robot->robot),
        planned_(motion_of(graph, planner_.plan())),
        goal_(planned_.configurations.back()),
        braking_(graph, planner_.online_plan(), options.verify) {
    const MotionCurve curve(model_, planned_);
    for (int i = 0; i < planner_.plan_size(); ++i) {
      if (!rolls(i)) {
        faster_.push_back(1.0);
        continue;
      }
      vertex(i).slopes = curve.slope(i);
      const bool inside = i > 0 && i + 1 < planner_.plan_size();
      faster_.push_back(inside ? ratio(curve.slope(i), careful_slope(model_, planned_, i)) : 0.0);
    }
    if (options_.pace && !planner_.plan().segments.empty()) {
      throw Error("a plan that tells its segments and how long they take",
                  "one without, where steps may take longer");
    }
    report_.dof = model_.tangent_size();
    report_.status = PlannerStatus::kSolved;
    report_.reason = "every configuration is feasible";
    report_.configurations = planner_.plan_size();
  }

  bool over() const { return over_; }
  int executed() const { return executed_; }
  const Plan& plan() const { return planner_.plan(); }
  double time_s(int i) const { return planner_.online_plan().time_s(i); }

  /// The robot is at this configuration or, before the first step, at rest there.
  void start_at(int configuration) {
    executed_ = verified_to_ = configuration;
    over_ = false;
    find_end();
  }

  void measure(const Eigen::VectorXd& configuration) {
    planner_.measure(configuration);
    measured_at_ = verified_to_ = executed_;
    measured_ = true;
  }

  void step(const WorldAt& world_at, int carried_out) {
    carried_out_ = carried_out;
    over_ = ends_at(executed_) || !step_from(executed_, world_at);
    if (over_) return;
    ++executed_;
    find_end();
  }

  WalkReport& report() { return report_; }

  /// Where the plan ends; of a drive that is planned on, where it did before.
  const Eigen::VectorXd& goal() const { return goal_; }
  void set_goal(const Eigen::VectorXd& goal) {
    goal_ = goal;
    planned_on_ = true;
  }

 private:
  void find_end() {
    if (executed_ + 1 < planner_.plan_size()) return;
    over_ = true;
    arrive();
  }

  /// Whether the termination ends the walk, which then is where the robot is.
  bool ends_at(int executed) {
    const auto end = end_by(options_.termination, executed);
    if (end) end_at(executed, executed, *end);
    return end.has_value();
  }

  /// Whether the robot could take it.
  bool step_from(int executed, const WorldAt& world_at) {
    const Stopwatch watch;
    if (auto world = world_at ? world_at(executed) : nullptr) {
      planner_.show(std::move(world));
      verified_to_ = follows_to_ = executed;
    }
    report_.map_update_s.push_back(watch.seconds());
    if (ends_at(executed)) return false;  // meanwhile: to show the world takes its time
    if (options_.pace) {
      go_at(executed, options_.pace(executed));
      if (ends_too_late(executed)) return false;
    }
    const bool measured = std::exchange(measured_, false);
    off_plan_ = off_plan_ || measured;
    if (follows(executed)) return true;
    const Braking::Passing before = braking_.passing(executed);
    int cycles = cycles_of(executed);
    if (measured) cycles = std::max(cycles, kMeasuredCycles);
    CycleReport cycle = run_cycle(executed);
    for (; cycles > 1; --cycles) cycle = run_cycle(executed);
    const int most = measured && rolls(executed) ? kMoreCycles : 0;
    for (int more = 0; more < most && !cycle.next_feasible; ++more) {
      cycle = run_cycle(executed);
    }
    std::string refused;
    if (!cycle.next_feasible) {
      refused = cycle.reason;
    } else {
      pass_through(executed + 1);
      if (options_.verify) refused = verify(executed);
      if (refused.empty() && !rolls(executed)) refused = slipped(executed + 1);
    }
    if (!refused.empty()) {
      braking_.restore(executed, before);  // it bears the step that is not made
      stop(executed, executed, refused);
      return false;
    }
    if (options_.resume && rolls(executed) && is_led_off(executed)) {
      braking_.restore(executed, before);
      stop(executed, executed, "the way beside the plan");
      return false;
    }
    if (rolls(executed) || cycle.success()) return true;
    if (vertex(cycle.violated_at).time_s - vertex(executed).time_s > kDecide_s) return true;
    if (braking_.rests(executed)) braking_.restore(executed, before);
    stop(executed, executed + cycle.feasible_steps, cycle.reason);
    return false;
  }

  /// Of the step that begins at a configuration.
  int cycles_of(int executed) {
    const auto before = [this](int i) { return std::ceil(vertex(i).time_s * options_.rate_hz); };
    return std::max(1, static_cast<int>(before(executed + 1) - before(executed)));
  }

  CycleReport run_cycle(int executed) {
    CycleReport cycle =
        planner_.cycle(executed, {.deadline = Deadline::of_limit(options_.cycle_deadline_s),
                                  .max_iterations = options_.cycle_iterations});
    if (rolls(executed) || cycle.statistics.iterations > 0) verified_to_ = executed;
    planner_.explain(cycle);
    report_.cycles.push_back(cycle);
    report_.feasible_cycles += cycle.success() ? 1 : 0;
    report_.deadline_misses += cycle.deadline_missed ? 1 : 0;
    if (options_.on_cycle) options_.on_cycle(cycle);
    return cycle;
  }

  /// Why the judge does not let the robot take the step; empty: it does. All of a window that is as
  /// planned is judged at once, and its steps hold until something changes.
  std::string verify(int executed) {
    if (executed < verified_to_) return "";
    const Stopwatch watch;
    const auto judged_to = [&](int last) {
      return options_.verify(motion_of(graph_, planner_.plan(), stretch_before(executed), last));
    };
    const bool moved = rolls(executed) || report_.cycles.back().statistics.iterations > 0;
    const int last = moved ? executed + 1 : planner_.last_of_window(executed);
    CheckReport check = judged_to(last);
    if (check.feasible) {
      verified_to_ = last;
    } else if (last > executed + 1) {
      check = judged_to(executed + 1);
    }
    report_.verify_s.push_back(watch.seconds());
    return check.feasible ? "" : describe(check);
  }

  /// Steps are judged with a few before them: what balls slip adds up from further back.
  std::string slipped(int configuration) const {
    constexpr double kShare = 0.9;  // the judge looks in between, too
    const auto most = most_slipped(planner_.online_plan(), configuration, kShare * limits::kHeld_m);
    if (!most) return "";
    return most->ball + " would have slipped by " + std::to_string(1e3 * most->slip_m) +
           " mm since it touched down";
  }

  /// Whether the robot goes on as the window is, before any search, where the edges ask for more
  /// than the judge, who lets it. Since it was off its plan it does on legs: where balls have
  /// rolled elsewhere, tenths of a millimetre would have to be moved for newtons. On wheels where
  /// it was planned on: it may have stopped nearer to something than edges keep it.
  bool follows(int executed) {
    if (executed < follows_to_) return true;
    const bool may = rolls(executed) ? planned_on_ : off_plan_;
    if (!may || !options_.verify) return false;
    if (planner_.begin_window(executed)) return false;
    const Stopwatch watch;
    constexpr int kFewestSteps = 5;
    for (int last = planner_.last_of_window(executed); last >= executed + kFewestSteps;
         last = executed + (last - executed) / 2) {
      // Slip of wheels counts over a stretch.
      const int first = rolls(executed) ? stretch_before(executed) : executed;
      if (!options_.verify(motion_of(graph_, planner_.plan(), first, last)).feasible) continue;
      verified_to_ = follows_to_ = last;
      break;
    }
    report_.verify_s.push_back(watch.seconds());
    return executed < follows_to_;
  }

  bool rolls(int i) const { return planner_.online_plan().rolls(i); }

  /// Whether the window leads far from the plan, where something that moves meets it, and will have
  /// left it while the robot waits.
  bool is_led_off(int executed) const {
    constexpr double kFar_m = 0.3, kApart_m = 0.02;
    const OnlinePlan& plan = planner_.online_plan();
    const auto off_m = [&](int i) {
      const Eigen::VectorXd& planned = plan.planned()[static_cast<std::size_t>(i)];
      return (plan.configuration(i) - planned).head<3>().dot(left_of(planned.data()));
    };
    const int last = planner_.last_of_window(executed);
    if (std::abs(off_m(last)) <= std::abs(off_m(executed)) + kFar_m) return false;
    ChangingObstacles obstacles(*planner_.plan().robot, plan.world().world());
    bool met = false;
    for (int i = executed + 1; i <= last && obstacles.any() && !met; ++i) {
      const auto centres = obstacles.centres(plan.planned()[static_cast<std::size_t>(i)]);
      met = !obstacles.keep_away(centres, plan.time_s(i), kApart_m);
    }
    if (!met) return false;
    constexpr int kMost = 100;  // configurations
    Motion rest;
    for (int i = executed; i < planner_.plan_size() && i <= executed + kMost; ++i) {
      const bool here = i == executed;
      rest.configurations.push_back(here ? Eigen::VectorXd(plan.configuration(i))
                                         : plan.planned()[static_cast<std::size_t>(i)]);
      rest.time_s.push_back(plan.time_s(i) - plan.time_s(executed));
    }
    return obstacles.free_after(rest, plan.time_s(executed)).has_value();
  }

  /// The configuration from which the robot has gone the stretch within which slip of wheels
  /// counts.
  int stretch_before(int executed) {
    int first = executed;
    double way_m = 0.0;
    while (first > measured_at_ && executed - first < kMostVerifiedSteps &&
           way_m < limits::kSlipStretch_m) {
      way_m += (vertex(first).state - vertex(first - 1).state).head<3>().norm();
      --first;
    }
    return first;
  }

  VertexConfiguration& vertex(int i) {
    const int slot = planner_.plan().slots[static_cast<std::size_t>(i)];
    return graph_.vertex(VertexId<VertexConfiguration>{slot});
  }

  /// The steps from here on take as many times as long as they were planned.
  void go_at(int executed, double pace) {
    if (pace == pace_) return;
    double time_s = vertex(executed).time_s, before_s = time_s;
    for (int i = executed + 1; i < planner_.plan_size(); ++i) {
      const double duration_s = vertex(i).time_s - before_s;
      before_s = vertex(i).time_s;
      time_s += duration_s * pace / pace_;
      vertex(i).time_s = time_s;
      vertex(i).slopes *= pace_ / pace;
    }
    pace_ = pace;
    planner_.plan_changed();
  }

  /// Whether the walk ends because steps that are this slow end later than any file may say.
  bool ends_too_late(int executed) {
    const double end_s = vertex(planner_.plan_size() - 1).time_s;
    if (end_s <= ranges::kTime_s) return false;
    std::ostringstream text;
    text << std::setprecision(10) << "as slow as it goes now, the plan would end at " << end_s
         << " s, which is later than " << ranges::kTime_s << " s";
    end_at(executed, executed, {PlannerStatus::kNotFound, text.str()});
    return true;
  }

  /// Decides how fast the robot passes a configuration: as fast as fits the window after it, and as
  /// fast as the plan did where nothing has moved. Later cycles change the window, but not this.
  void pass_through(int i) {
    if (i + 1 >= planner_.plan_size() || !rolls(i)) return;  // at rest, or as the plan has it
    const Motion around = motion_of(graph_, planner_.plan(), i - 1, i + 1);
    VertexConfiguration& here = vertex(i);
    here.slopes = careful_slope(model_, around, 1) * faster_[static_cast<std::size_t>(i)];
    const double before_s = here.time_s - around.time_s[0],
                 after_s = around.time_s[2] - here.time_s;
    keep_within_limits(model_, here.state, std::max(before_s, after_s), here.slopes);
  }

  void measure_goal(int at) {
    const int slot = planner_.plan().slots[static_cast<std::size_t>(at)];
    const Eigen::Map<const Eigen::VectorXd> is(graph_.state(slot), graph_.state_size(slot));
    const Eigen::VectorXd& goal = goal_;
    report_.goal_distance_m = (is.head<3>() - goal.head<3>()).norm();
    report_.goal_angle_rad =
        Eigen::Quaterniond(is.data() + 3).angularDistance(Eigen::Quaterniond(goal.data() + 3));
  }

  std::string goal_text() const {
    std::ostringstream text;
    text << report_.goal_distance_m << " m and " << report_.goal_angle_rad << " rad";
    return text.str();
  }

  std::string cause_after(int executed) {
    const auto cause =
        find_cause(planner_.online_plan(), executed, planner_.last_of_window(executed));
    return cause ? cause->text : "";
  }

  /// The first executed configuration whose window reaches the end of the plan.
  int first_to_see_the_end() const {
    int executed = 0;
    while (planner_.last_of_window(executed) + 1 < planner_.plan_size()) ++executed;
    return executed;
  }

  void stop(int executed, int furthest, const std::string& symptom) {
    const std::string cause = cause_after(executed);
    end_at(
        executed, furthest,
        {PlannerStatus::kNotFound, (cause.empty() ? "" : cause + "; what gave way is ") + symptom});
  }

  /// The rest of the plan is removed, and the robot comes to rest: where it is, or earlier.
  void end_at(int arrived, int furthest, const PlannerAnswer& why) {
    const std::optional<int> rest = braking_.come_to_rest(arrived, furthest, carried_out_);
    const int executed = rest.value_or(arrived);
    report_.at_rest = rest.has_value();
    report_.stopped_at = executed;
    measure_goal(executed);
    report_.status = why.status;
    report_.reason = "stopped at configuration " + std::to_string(executed) + ": " + why.reason +
                     "; after " + std::to_string(executed) + " of " +
                     std::to_string(planner_.plan_size() - 1) + " steps, " + goal_text() +
                     " from the goal";
    cut_plan(graph_, planner_.plan(), executed);
    report_.configurations = executed + 1;
  }

  void arrive() {
    const int last = planner_.plan_size() - 1;
    report_.short_of_goal_m = planner_.online_plan().behind_m(last);
    measure_goal(last);
    if (report_.goal_distance_m <= options_.goal_tolerance_m &&
        report_.goal_angle_rad <= options_.goal_tolerance_rad) {
      if (report_.goal_distance_m > limits::kGoal_m || report_.goal_angle_rad > limits::kGoal_rad) {
        mark_incomplete(graph_);
      }
      return;
    }
    report_.status = PlannerStatus::kNotFound;
    mark_incomplete(graph_);
    const bool blocked = report_.short_of_goal_m > options_.goal_tolerance_m;
    report_.reason = std::string(blocked ? "blocked" : "beside the goal") +
                     ": feasible, but it ends " + goal_text() + " from the goal of the plan";
    const std::string cause = cause_after(first_to_see_the_end());
    if (!cause.empty()) report_.reason += ", which meets " + cause;
  }

  Graph& graph_;
  const WalkOptions& options_;
  LocalPlanner planner_;
  const Robot& model_;
  const Motion planned_;
  Eigen::VectorXd goal_;
  Braking braking_;
  std::vector<double> faster_;  // than careful, of slopes of the plan
  double pace_ = 1.0;           // how many times as long as planned steps take
  int executed_ = 0;
  int carried_out_ = -1;  // what may not be changed any more
  bool over_ = false;
  bool measured_ = false;  // since the last step
  bool off_plan_ = false;  // it was
  bool planned_on_ = false;
  int measured_at_ = 0;  // the robot was found there; before it the plan is another one
  int follows_to_ = 0;   // likewise; until there the robot does as it is judged
  int verified_to_ = 0;  // steps up to this configuration hold for the judge
  WalkReport report_;
};

bool is_drive(const Plan& plan) {
  return std::ranges::all_of(plan.stance_from,
                             [](const auto& stance) { return stance && rolls_on_wheels(*stance); });
}

/// Adds what a walk did before it stopped and was planned on.
void put_before(const WalkReport& before, WalkReport& report) {
  const auto join = [](const auto& first, auto& then) {
    then.insert(then.begin(), first.begin(), first.end());
  };
  join(before.cycles, report.cycles);
  join(before.map_update_s, report.map_update_s);
  join(before.verify_s, report.verify_s);
  report.feasible_cycles += before.feasible_cycles;
  report.deadline_misses += before.deadline_misses;
  report.resumed = before.resumed;
}

}  // namespace

void WalkOptions::validate() const {
  planner.validate();
  check_option(rate_hz >= 0.0 && rate_hz <= kMostRate_Hz, "rate_hz",
               "0 (one cycle for each step) to 1e5");
  check_option(goal_tolerance_m >= 0.0, "goal_tolerance_m", "0 or more");
  check_option(goal_tolerance_rad >= 0.0, "goal_tolerance_rad", "0 or more");
  check_option(cycle_deadline_s >= 0.0, "cycle_deadline_s", "0 (none) or more");
  termination.validate();
}

WalkOptions walk_options_for(const Plan& plan) {
  WalkOptions options;
  options.rate_hz = 50.0;
  options.cycle_iterations = 1;
  if (is_drive(plan)) return options;
  options.planner.horizon_s = 2.0;
  return options;
}

struct PlanWalk::Own {
  Graph& graph;
  WorldAt world_at;
  WalkOptions options;
  Stopwatch watch = {};
  std::optional<Walk> walk = {};
  WalkReport before = {};  ///< until it was planned on
  std::shared_ptr<const WorldSnapshot> newest = {};
  bool goes_on = false;  ///< planned on, and nothing shown since
  int resumed_at = -1;   ///< where it was planned on last: it goes on from there no second time

  std::shared_ptr<const WorldSnapshot> world(int executed) {
    std::shared_ptr<const WorldSnapshot> shown = world_at ? world_at(executed) : nullptr;
    if (shown) newest = shown;
    if (std::exchange(goes_on, false)) shown = newest;
    return shown;
  }

  /// From where it has stopped; whether that could be planned.
  bool plan_on() {
    const WalkReport& stopped = walk->report();
    if (!options.resume || stopped.success() || !stopped.at_rest ||
        before.resumed >= options.most_resumed || options.termination.stopped()) {
      return false;
    }
    const int last = static_cast<int>(walk->plan().slots.size()) - 1;
    const bool drives = is_drive(walk->plan());
    if (!stopped.stopped_at && !drives) return false;
    const int at = stopped.stopped_at.value_or(last);
    if (at <= resumed_at) return false;
    std::optional<Graph> resumed = options.resume(graph);
    if (!resumed) return false;
    resumed_at = at;
    put_before(before, walk->report());
    before = std::move(walk->report());
    ++before.resumed;
    const Eigen::VectorXd goal = walk->goal();
    walk.reset();
    graph = std::move(*resumed);
    goes_on = true;
    walk.emplace(graph, options);
    if (drives) walk->set_goal(goal);
    walk->start_at(at);
    return true;
  }
};

PlanWalk::PlanWalk(Graph& graph, WorldAt world_at, const WalkOptions& options, int executed) {
  options.validate();
  own_.reset(new Own{graph, std::move(world_at), options});
  own_->walk.emplace(graph, own_->options);
  const int last = static_cast<int>(own_->walk->plan().slots.size()) - 1;
  if (executed < 0 || executed > last) {
    throw Error("executed configuration " + std::to_string(executed),
                "0 to " + std::to_string(last));
  }
  own_->walk->start_at(executed);
}

PlanWalk::~PlanWalk() = default;

int PlanWalk::executed() const { return own_->walk->executed(); }

void PlanWalk::measure(const Eigen::VectorXd& configuration) { own_->walk->measure(configuration); }

bool PlanWalk::step(int carried_out) {
  if (!own_->walk->over()) {
    own_->walk->step([this](int executed) { return own_->world(executed); }, carried_out);
  }
  return !own_->walk->over() || own_->plan_on();
}

Motion PlanWalk::motion() const {
  const Graph& graph = own_->graph;
  return motion_of(graph, own_->walk->over() ? plan_of(graph) : own_->walk->plan());
}

double PlanWalk::time_s(int configuration) const { return own_->walk->time_s(configuration); }

WalkReport PlanWalk::report() const {
  WalkReport report = own_->walk->report();
  put_before(own_->before, report);
  report.statistics.iterations = static_cast<int>(report.cycles.size());
  report.statistics.total_s = own_->watch.seconds();
  return report;
}

WalkReport walk_plan(Graph& graph, const WorldAt& world_at, const WalkOptions& options) {
  PlanWalk walk(graph, world_at, options);
  while (walk.step()) {
  }
  return walk.report();
}

}  // namespace locograph
