#include <locograph/apps/live_refine.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/scene_perception.h>
#include <locograph/common/deadline.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/online/window_cause.h>
#include <locograph/planners/plan/seen_world.h>

#include <algorithm>
#include <optional>

namespace locograph {
namespace {

/// The client went away in the middle of a plan.
struct ChannelClosed {};

void send(LiveChannel& channel, const Json& message) {
  if (!channel.send(message.dump(-1, ' ', false, Json::error_handler_t::replace))) {
    throw ChannelClosed();
  }
}

double time_of(const PlanFile& file, int index) {
  return file.graph.vertex(VertexId<VertexConfiguration>{file.plan.slots[index]}).time_s;
}

Json violation_json(const CycleReport& cycle) {
  if (!cycle.violation) return nullptr;
  return {{"constraint", constraint_name(cycle.violation->tag)},
          {"worst", cycle.violation->amount},
          {"unit", cycle.violation->label.unit},
          {"index", cycle.violated_at}};
}

Json cycle_json(const PlanFile& file, const CycleReport& cycle) {
  Json configurations = Json::object();
  for (int i = cycle.executed; i <= cycle.executed + cycle.window; ++i) {
    const int slot = file.plan.slots[static_cast<std::size_t>(i)];
    const double* state = file.graph.state(slot);
    Json numbers = Json::array();
    for (int k = 0; k < file.graph.state_size(slot); ++k) numbers.push_back(rounded(state[k]));
    configurations[std::to_string(i)] = std::move(numbers);
  }
  return {{"type", "cycle"},
          {"executed", cycle.executed},
          {"window", cycle.window},
          {"configurations", std::move(configurations)},
          {"feasible", cycle.success()},
          {"cycle_time", cycle.statistics.total_s},
          {"violation", violation_json(cycle)}};
}

void run(const LiveJob& job, LiveChannel& channel) {
  PlanFile file = load_plan(job.plan, job.plugins);
  const WorldOptions world = {.scenario = {}, .map = job.map, .obstacles = job.obstacles};
  const Judging judging = judging_of(file, world);
  WalkOptions options;
  options.planner.horizon = job.horizon;
  std::optional<PerceptionScene> seen;
  WorldAt world_at;
  if (job.perception.given()) {
    seen.emplace(file, judging, job.perception);
    seen->eyes().equip(options);
    world_at = seen->eyes().world_at();
  } else {
    options.verify = step_check(judging);
    const auto known = seen_world(file.graph, file.plan, judging.world->world());
    world_at = [known](int executed) { return executed == 0 ? known : nullptr; };
  }
  send(channel, {{"type", "start"},
                 {"count", file.plan.slots.size()},
                 {"dof", file.plan.robot->robot->tangent_size()},
                 {"speed", job.speed}});
  Stopwatch since_last;
  options.on_cycle = [&](const CycleReport& cycle) {
    const double now_s = time_of(file, cycle.executed);
    Json message = cycle_json(file, cycle);
    if (seen) message["perception"] = seen->news(now_s);
    send(channel, message);
    const double step_s = time_of(file, cycle.executed + 1) - now_s;
    if (!channel.wait(std::max(0.0, step_s / job.speed - since_last.seconds())))
      throw ChannelClosed();
    since_last.lap();
  };
  WalkReport report = walk_plan(file.graph, world_at, options);
  if (seen && report.configurations > 1) {
    // Steps were judged by what was seen; this is in the world as it is.
    file.plan = plan_of_file(file.graph, file.name);
    take_verdict(check_plan(file, judging_of(file, world)), report);
  }
  send(channel, {{"type", "end"},
                 {"success", report.success()},
                 {"reason", report.reason},
                 {"left", report.configurations}});
}

}  // namespace

void live_refine(const LiveJob& job, LiveChannel& channel) {
  try {
    run(job, channel);
  } catch (const ChannelClosed&) {
  } catch (const Error& error) {
    const Json end = {{"type", "end"}, {"success", false}, {"reason", error.what()}};
    channel.send(end.dump(-1, ' ', false, Json::error_handler_t::replace));
  }
}

}  // namespace locograph
