#include <locograph/apps/trajectory_file.h>
#include <locograph/apps/trajectory_parts.h>
#include <locograph/common/suggestion.h>
#include <locograph/planners/plan/plan_edges.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/plugins/configuration/segment_parameter.h>
#include <locograph/plugins/surface_distance/places_parameter.h>

#include <algorithm>
#include <array>

namespace locograph {
namespace {

/// Rolls somewhere, as a drive does: a plan of its own kind.
bool is_drive(const Plan& plan) {
  return std::ranges::any_of(plan.stance_from, [](const auto& stance) {
    return stance && std::ranges::any_of(stance->wheels, [](const auto& w) { return !w.locked; });
  });
}

/// What may be touched, by the scenario's word, where the plan does not say it itself.
void add_places(PlanFile& file, const Task& task) {
  Parameters& parameters = file.graph.parameters();
  if (parameters.find<PlacesParameter>()) return;
  const auto& all = parameters.all();
  const VertexConfiguration& first =
      file.graph.vertex(VertexId<VertexConfiguration>{file.plan.slots.front()});
  parameters.set(all.contains(kPlacesNumber) ? all.rbegin()->first + 1 : kPlacesNumber,
                 std::make_shared<const PlacesParameter>(first.robot, first.robot_number,
                                                         task.world->world()));
}

}  // namespace

void require_motion(const PlanFile& file) {
  if (file.plan.stances_only) {
    throw Error(file.name, 0, "is a plan of stances, which has no motion", "a whole plan");
  }
  require_increasing_times(file);
}

std::vector<std::string> parameter_lines(const Graph& graph, const std::filesystem::path& folder) {
  constexpr std::array<std::string_view, 9> kTags = {
      "PARAMS_ROBOT",   "PARAMS_PLAN",   "PARAMS_WORLD",   "PARAMS_SCENARIO", "PARAMS_CONTACTS",
      "PARAMS_CONTACT", "PARAMS_STANCE", "PARAMS_SEGMENT", "PARAMS_PLACES"};
  std::vector<std::string> lines;
  for (const auto& [number, parameter] : graph.parameters().all()) {
    if (std::ranges::find(kTags, parameter->tag()) == kTags.end()) continue;
    FieldWriter out(folder);
    out.tag(parameter->tag());
    out.integer(number);
    parameter->write(out);
    lines.push_back(out.text());
  }
  return lines;
}

std::vector<int> joint_order(const Robot& robot, const std::vector<std::string>& names,
                             std::string& what, std::string& expected) {
  std::vector<std::string> known;
  for (int i = 0; i < robot.active_joint_count(); ++i) known.push_back(robot.active_joint(i).name);
  std::vector<int> order;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(known, name);
    order.push_back(static_cast<int>(found - known.begin()));
    if (found == known.end()) {
      what = "the joint '" + name + "'";
      expected = "an active joint of the robot" + did_you_mean(name, known);
      return {};
    }
    if (std::ranges::count(order, order.back()) > 1) {
      what = "the joint '" + name + "' a second time";
      expected = "each joint once";
      return {};
    }
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (std::ranges::find(order, static_cast<int>(i)) != order.end()) continue;
    what = "the joint '" + known[i] + "' is missing";
    expected = "all " + std::to_string(known.size()) + " active joints of the robot";
    return {};
  }
  return order;
}

ConfigurationReader::ConfigurationReader(Graph& graph, std::string file)
    : graph_(graph), where_{std::move(file), 0, {}} {
  const auto number = graph.parameters().number_of<RobotParameter>();
  if (!number) throw Error(where_.file, 0, "names no robot", "a PARAMS_ROBOT");
  robot_number_ = *number;
  robot_ = graph.parameters().get<RobotParameter>(*number);
}

void ConfigurationReader::add(const std::vector<std::string>& fields, int line) {
  std::string text = std::to_string(robot_number_);
  for (const std::string& field : fields) text += ' ' + field;
  where_.line = line;
  FieldReader in(text, where_);
  in.set_parameters(&graph_.parameters());
  VertexConfiguration vertex;
  try {
    vertex.read(in);
    in.expect_end();
  } catch (const Error& error) {
    if (error.line() > 0 || line == 0) throw;
    throw Error(where_.file, line, error.what(), "");
  }
  if (count_ > 0 && !(vertex.time_s > last_s_)) {
    throw Error(
        where_.file, line,
        "the time " + std::to_string(vertex.time_s) + " s after " + std::to_string(last_s_) + " s",
        "times that increase");
  }
  last_s_ = vertex.time_s;
  const auto id = graph_.add_vertex(count_, std::move(vertex));
  graph_.set_fixed(id, count_++ == 0);
}

Graph with_edges(ReadTrajectory trajectory, const std::string& file) {
  PlanFile plan = plan_in(std::move(trajectory.graph), file);
  require_motion(plan);
  PlanEdgeOptions edges = drive_edges();
  if (!is_drive(plan.plan)) {
    const Judging judging = judging_of(plan, {});
    if (judging.task) add_places(plan, *judging.task);
    edges = motion_edges(judging.options);
  }
  add_plan_edges(plan.graph, edges, trajectory.wrenches);
  return std::move(plan.graph);
}

}  // namespace locograph
