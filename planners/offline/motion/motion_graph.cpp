#include <locograph/planners/offline/motion/motion_graph.h>
#include <locograph/planners/offline/stance/stance_graph.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/configuration/segment_parameter.h>

namespace locograph {

Graph motion_graph(const Task& task, const MotionPlan& plan) {
  const Motion& motion = plan.motion;
  if (motion.configurations.empty()) throw Error("a motion without configurations", "one or more");
  Graph graph;
  const std::vector<int> numbers =
      add_task(graph, task, motion.stances, {.incomplete = !plan.success()});
  int number = graph.parameters().all().rbegin()->first;
  for (std::size_t j = 0; j < plan.segments.size(); ++j) {
    const SegmentRecord& record = plan.segments[j];
    const auto segment = std::make_shared<SegmentParameter>();
    segment->segment = static_cast<int>(j);
    segment->stance_number = numbers.at(static_cast<std::size_t>(record.stance));
    segment->from_s = motion.time_s.at(static_cast<std::size_t>(record.first));
    segment->duration_s = record.duration_s;
    segment->planner = record.planner;
    graph.parameters().set(++number, segment);
  }
  add_configurations(graph, motion, numbers);
  add_plan_edges(graph, motion_edges(task.check), motion.wrenches);
  return graph;
}

}  // namespace locograph
