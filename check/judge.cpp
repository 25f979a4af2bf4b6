#include <locograph/check/balance_along.h>
#include <locograph/check/clearance_search.h>
#include <locograph/check/contact_check.h>
#include <locograph/check/judge.h>
#include <locograph/check/limits.h>
#include <locograph/check/numbers_check.h>
#include <locograph/check/robustness.h>
#include <locograph/check/wrench_check.h>
#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <locograph/common/thread_pool.h>
#include <locograph/robots/names.h>

#include <algorithm>

namespace locograph {
namespace {

/// Distances matter up to here: to report the clearance of a motion, and to judge a posture.
constexpr double kMotionCutoff_m = 0.5, kPostureCutoff_m = 0.05;

void require_whole(const Motion& motion) {
  const std::size_t vertices = motion.configurations.size();
  if (vertices == 0) throw Error("an empty motion", "at least one configuration");
  if (motion.time_s.size() != vertices)
    throw Error(std::to_string(motion.time_s.size()) + " times for " + std::to_string(vertices) +
                    " configurations",
                "one each");
  if (!motion.stance_from.empty() && motion.stance_from.size() != vertices)
    throw Error(std::to_string(motion.stance_from.size()) + " stances of steps for " +
                    std::to_string(vertices) + " configurations",
                "one each, or none");
  if (!motion.wrenches.empty() && motion.wrenches.size() != vertices)
    throw Error("wrenches of " + std::to_string(motion.wrenches.size()) + " of " +
                    std::to_string(vertices) + " configurations",
                "of each, or none");
  for (const int stance : motion.stance_from) {
    if (stance < -1 || stance >= int(motion.stances.size()))
      throw Error("a step with stance " + std::to_string(stance),
                  "one of the " + std::to_string(motion.stances.size()) + " stances, or -1");
  }
}

class Check {
 public:
  Check(CheckContext& context) : context_(context), vertices_(context.vertices()) {}

  CheckReport run() {
    const Stopwatch watch;
    ThreadPool threads(context_.single ? 1 : context_.options.threads);
    for (Stance stance : context_.motion.stances) {
      // Nothing is known of how they would roll from one configuration to the next.
      for (Contact& contact : stance.contacts)
        contact.locked |=
            context_.motion.stances_only && contact.effector.kind == ContactKind::kWheel;
      context_.stances.emplace_back(context_.robot, context_.world, stance, context_.options.known,
                                    context_.options.places);
    }
    NumbersCheck numbers(context_);
    numbers.run();
    check_stances();
    ContactCheck contacts(context_);
    ClearanceSearch around(context_), self(context_);
    threads.run(3, [&](int part) {
      if (part == 0) around.run_around(obstacle_distance_, ground_penetration_, touching_depth_);
      if (part == 1) self.run_self(self_collision_);
      if (part == 2) contacts.run();
    });

    CheckReport report;
    report.violations.push_back(stance_.result("the base is fixed to the world"));
    report.violations.push_back(claims_.result(context_.options.known.empty()
                                                   ? "nothing is known of end effectors"
                                                   : "no contact is known"));
    numbers.report(report.violations);
    contacts.report(report.violations);
    report_distances(report.violations);
    report.geometry_s = watch.seconds();

    BalanceAlong balance(context_);
    const bool rest_holds = holds(report.violations);
    const Stopwatch balance_watch;
    if (rest_holds || !context_.options.certify_only_if_rest_holds) balance.run(threads);
    WrenchCheck wrenches(context_);
    wrenches.run();
    report.balance_s = balance_watch.seconds();
    balance.report(report.violations);
    if (!rest_holds && context_.options.certify_only_if_rest_holds)
      for (Violation* v : {&report.violations.end()[-2], &report.violations.back()})
        v->why_not = "something else is violated";
    wrenches.report(report.violations);

    // Whatever else is not judged cannot be, of such a motion, or something is violated.
    const bool balance_required = context_.robot.floating_base();
    report.feasible = holds(report.violations) && has_shapes_ &&
                      (!balance_required || report.constraint("static_balance").judged);
    report.configurations = int(vertices_);
    report.samples = context_.samples + around.samples() + self.samples();
    report.trusted = trusted();
    if (has_shapes_ && !obstacle_distance_.empty())
      report.min_clearance_m = obstacle_distance_.worst();
    if (has_shapes_ && !self_collision_.empty())
      report.min_self_clearance_m = self_collision_.worst();
    report.min_balance_margin = balance.min_margin();
    report.max_torque_ratio = balance.max_torque_ratio();
    report.max_velocity_ratio = numbers.max_velocity_ratio();
    report.max_contact_error_m = contacts.max_contact_error_m();
    report.ball_rolling = contacts.ball_rolling();
    report.balance = balance.worst();
    if (context_.options.robustness) report.robustness = robustness_of(context_, threads);
    return report;
  }

 private:
  static bool holds(const std::vector<Violation>& violations) {
    return std::none_of(violations.begin(), violations.end(),
                        [](const Violation& v) { return v.violated; });
  }

  void check_stances() {
    for (std::size_t i = 0; i < vertices_; ++i) {
      const int vertex = int(i);
      const double time_s = context_.motion.time_s[i];
      const JudgedStance* stance = context_.stance_from(vertex);
      if (context_.robot.floating_base())
        stance_.add(stance == nullptr ? 1.0 : 0.0, vertex, time_s, Eigen::Vector3d::Zero(), [&] {
          return std::string(stance != nullptr    ? "every step has one"
                             : i + 1 == vertices_ ? "the stance that it ends in is not known"
                                                  : "the stance of a step is not known");
        });
      if (stance == nullptr || context_.options.known.empty()) continue;
      std::vector<std::string> claims = stance->other;
      if (context_.options.compare_claims)
        claims.insert(claims.end(), stance->larger.begin(), stance->larger.end());
      claims_.add(double(claims.size()), vertex, time_s, Eigen::Vector3d::Zero(), [&] {
        return claims.empty() ? std::string("nothing beyond what is known") : claims.front();
      });
    }
  }

  void report_distances(std::vector<Violation>& violations) const {
    const std::string no_vertex = "no vertex can be looked at";
    violations.push_back(obstacle_distance_.result(no_vertex));
    violations.push_back(ground_penetration_.result(
        has_places(context_.world) ? no_vertex : "the world has no surfaces"));
    violations.push_back(touching_depth_.result("no contact is known"));
    violations.push_back(self_collision_.result(no_vertex));
    if (has_shapes_) return;
    for (auto v = violations.end() - 4; v != violations.end(); ++v) {
      v->judged = v->violated = false;
      v->count = 0;
      v->why_not = "no link of the robot has a collision shape";
    }
  }

  /// Each once, in the order of the stances.
  std::vector<std::string> trusted() const {
    std::vector<std::string> trusted;
    const auto add = [&](const std::string& what) {
      if (std::find(trusted.begin(), trusted.end(), what) == trusted.end()) trusted.push_back(what);
    };
    for (const JudgedStance& stance : context_.stances) {
      for (const std::string& name : stance.unknown) add(name + ": what it can bear");
      for (const JudgedContact& contact : stance.contacts) {
        if (!has_places(context_.world) ||
            (!contact.is_placed() && !context_.options.surfaces_known))
          add(contact.name() + ": that there is a " + (contact.is_grasp() ? "bar" : "surface"));
      }
    }
    const std::vector<std::string> shapeless = context_.robot.links_without_collision();
    if (!shapeless.empty() && has_shapes_)
      add(listed_names(shapeless) + ": that " +
          (shapeless.size() > 1 ? "they touch nothing" : "it touches nothing") +
          " (no collision shape)");
    if (const auto& pairs = context_.robot.left_out_pairs(); !pairs.empty()) {
      std::vector<std::string> names;
      for (const auto& [first, second] : pairs) {
        const auto& links = context_.robot.links();
        names.push_back(links[static_cast<std::size_t>(first)].name + " and " +
                        links[static_cast<std::size_t>(second)].name);
      }
      add(listed_names(names) +
          ": that they may overlap (they do as the robot is built, and there is no SRDF)");
    }
    return trusted;
  }

  CheckContext& context_;
  std::size_t vertices_;
  bool has_shapes_ = context_.robot.has_collision_shapes();
  ViolationTally stance_{"stance", "count", 0.0, Worse::kHigher, vertices_};
  ViolationTally claims_{"contact_claims", "count", 0.0, Worse::kHigher, vertices_};
  ViolationTally obstacle_distance_{"obstacle_distance", "m", context_.options.min_clearance_m,
                                    Worse::kLower, vertices_};
  ViolationTally ground_penetration_{"ground_penetration", "m", limits::kDepthRounding_m,
                                     Worse::kHigher, vertices_};
  ViolationTally touching_depth_{"touching_depth", "m", limits::kTouchingDepth_m, Worse::kHigher,
                                 vertices_};
  ViolationTally self_collision_{"self_collision", "m", context_.options.min_self_clearance_m,
                                 Worse::kLower, vertices_};
};

}  // namespace

struct Judge::Parts {
  std::shared_ptr<const Robot> robot;
  std::shared_ptr<const WorldSnapshot> snapshot;
  CollisionWorld exact;
  MovingShapes shapes;

  Parts(std::shared_ptr<const Robot> given_robot, std::shared_ptr<const WorldSnapshot> world)
      : robot(std::move(given_robot)),
        snapshot(std::move(world)),
        exact(*robot, snapshot->solids()),
        shapes(*robot) {}

  std::optional<CheckReport> check(const Motion& motion, const CheckOptions& options, bool single,
                                   const JobControl& job) const {
    options.validate();
    require_whole(motion);
    std::optional<MovingShapes> moving;  // it keeps numbers of a step
    if (!single) moving = shapes;
    const MotionCurve curve(*robot, motion);
    const double cutoff = single ? kPostureCutoff_m : kMotionCutoff_m;
    CheckContext context{.robot = *robot,
                         .world = snapshot->world(),
                         .exact = exact,
                         .motion = motion,
                         .options = options,
                         .shapes = moving ? &*moving : nullptr,
                         .curve = curve,
                         .job = job,
                         .cutoff_m = std::max({cutoff, 2.0 * options.min_clearance_m,
                                               2.0 * options.min_self_clearance_m}),
                         .single = single};
    try {
      return Check(context).run();
    } catch (const CheckStopped&) {
      return std::nullopt;
    }
  }
};

Judge::Judge(std::shared_ptr<const Robot> robot, std::shared_ptr<const WorldSnapshot> world)
    : parts_(std::make_unique<const Parts>(std::move(robot), std::move(world))) {}
Judge::Judge(std::shared_ptr<const Robot> robot, World world)
    : Judge(std::move(robot), std::make_shared<const WorldSnapshot>(std::move(world))) {}
Judge::~Judge() = default;
Judge::Judge(Judge&&) noexcept = default;
Judge& Judge::operator=(Judge&&) noexcept = default;

CheckReport Judge::check(const Motion& motion, const CheckOptions& options) const {
  return *check(motion, options, JobControl());
}

std::optional<CheckReport> Judge::check(const Motion& motion, const CheckOptions& options,
                                        const JobControl& job) const {
  return parts_->check(motion, options, false, job);
}

CheckReport Judge::check(const Eigen::VectorXd& configuration, const Stance& stance,
                         const CheckOptions& options, const StanceWrenches& wrenches) const {
  Motion motion;
  if (!wrenches.empty()) motion.wrenches = {wrenches};
  motion.time_s = {0.0};
  motion.configurations = {configuration};
  motion.stances = {stance};
  motion.stance_from = {0};
  return *parts_->check(motion, options, true, JobControl());
}

double Judge::self_distance_m(const RobotState& state) const {
  LinkPoses poses;
  for (int link = 0; link < int(robot().links().size()); ++link)
    poses.push_back(state.world_from_link(link));
  return parts_->exact.self_distance(poses, kPostureCutoff_m).distance_m;
}

const World& Judge::world() const { return parts_->snapshot->world(); }
const Robot& Judge::robot() const { return *parts_->robot; }

}  // namespace locograph
