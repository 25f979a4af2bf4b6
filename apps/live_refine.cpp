#include <locograph/apps/live_refine.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/scene.h>
#include <locograph/planners/online/walk_plan.h>
#include <locograph/planners/online/window_cause.h>
#include <locograph/planners/plan/seen_world.h>

#include <algorithm>

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
  const Judging judging =
      judging_of(file, {.scenario = {}, .map = job.map, .obstacles = job.obstacles});
  const auto seen = seen_world(file.graph, file.plan, judging.world->world());
  send(channel, {{"type", "start"},
                 {"count", file.plan.slots.size()},
                 {"dof", file.plan.robot->robot->tangent_size()},
                 {"speed", job.speed}});
  WalkOptions options;
  options.planner.horizon = job.horizon;
  options.verify = step_check(judging);
  options.on_cycle = [&](const CycleReport& cycle) {
    send(channel, cycle_json(file, cycle));
    const double step_s = time_of(file, cycle.executed + 1) - time_of(file, cycle.executed);
    if (!channel.wait(std::max(0.0, step_s / job.speed - cycle.statistics.total_s)))
      throw ChannelClosed();
  };
  const WalkReport report = walk_plan(
      file.graph, [&seen](int executed) { return executed == 0 ? seen : nullptr; }, options);
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
