#include <locograph/planners/online/window_cause.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace locograph {
namespace {

/// Puts configurations where they were planned until it is destroyed.
class AsPlanned {
 public:
  AsPlanned(const OnlinePlan& plan, int first, int last) : plan_(plan), first_(first) {
    for (int i = first; i <= last; ++i) {
      kept_.emplace_back(state(i));
      state(i) = plan.as_it_came()[static_cast<std::size_t>(i)];
    }
  }
  ~AsPlanned() {
    for (std::size_t k = 0; k < kept_.size(); ++k) state(first_ + static_cast<int>(k)) = kept_[k];
  }
  AsPlanned(const AsPlanned&) = delete;
  AsPlanned& operator=(const AsPlanned&) = delete;

 private:
  Eigen::Map<Eigen::VectorXd> state(int index) {
    const int slot = plan_.slot(index);
    return {plan_.graph().state(slot), plan_.graph().state_size(slot)};
  }

  const OnlinePlan& plan_;
  int first_;
  std::vector<Eigen::VectorXd> kept_;
};

/// The name of the obstacle that is nearest to a point at a time, of those that are there since
/// another one, or the map.
std::string nearest_thing(const WorldDistance& world, const Eigen::Vector3d& point, double since_s,
                          double time_s) {
  std::string name = "the map";
  double nearest =
      world.sees_map() ? world.sample_map(point).distance : std::numeric_limits<double>::infinity();
  for (const Obstacle& obstacle : world.obstacles) {
    if (!obstacle.is_there(since_s, time_s)) continue;
    const double distance = obstacle.sample_shape(point, time_s).distance;
    if (distance >= nearest) continue;
    nearest = distance;
    name = obstacle.name;
  }
  return name;
}

/// The obstacle that a violated row is about; empty where it is about something else.
std::string obstacle_of(const OnlinePlan& plan, const ConstraintViolation& violation, int at) {
  const Graph& graph = plan.graph();
  const int edge = violation.edge.slot;
  const bool on_its_way = edge_is<EdgeSweptObstacleDistance>(graph, edge);
  if (!on_its_way && !edge_is<EdgeObstacleDistance>(graph, edge)) return "";
  RobotState state(plan.robot());
  state.update(graph.state(plan.slot(at)));
  const CollisionSphere& sphere =
      plan.plan().robot->spheres[static_cast<std::size_t>(violation.row)];
  return nearest_thing(plan.world().distance(), state.world_from_link(sphere.link) * sphere.center,
                       plan.time_s(on_its_way ? at - 1 : at), plan.time_s(at));
}

}  // namespace

std::string constraint_name(const std::string& tag) {
  std::string name = tag.starts_with("EDGE_") ? tag.substr(5) : tag;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

std::string violated_text(const ConstraintViolation& violation, int vertex) {
  std::ostringstream text;
  text << constraint_name(violation.tag);
  if (!violation.label.name.empty()) text << " (" << violation.label.name << ")";
  text << " violated by " << violation.amount << (violation.label.unit.empty() ? "" : " ")
       << violation.label.unit << " at vertex " << vertex;
  return text.str();
}

std::optional<WindowCause> find_cause(const OnlinePlan& plan, int executed, int last) {
  Graph& graph = plan.graph();
  const AsPlanned as_planned(plan, executed + 1, last);
  const std::vector<int>& slots = plan.plan().slots;
  const std::vector<int> window(slots.begin() + executed + 1, slots.begin() + last + 1);
  Problem problem;
  // Without the edges that tie the window to the executed configuration, which may be beside the
  // plan by now.
  problem.compile(graph, window, {});
  Workspace workspace;
  workspace.allocate(problem);
  workspace.bind(plan.bindings());
  workspace.load_state();
  workspace.evaluate(workspace.state());
  const auto index_of = [&](const CompiledConstraint& c) {
    int index = executed + 1;
    for (const int v : graph.edge_vertices(c.edge)) {
      const auto found = std::find(window.begin(), window.end(), v);
      if (found == window.end()) continue;
      index = std::max(index, executed + 1 + static_cast<int>(found - window.begin()));
    }
    return index;
  };
  const ConstraintReader reader(workspace);
  ConstraintReader::Row first;
  int at = last + 1;
  reader.each([&](const ConstraintReader::Row& row) {
    if (row.ratio <= 1.0) return;
    const int index = index_of(problem.constraints()[static_cast<std::size_t>(row.constraint)]);
    if (index > at || (index == at && row.ratio <= first.ratio)) return;
    first = row;
    at = index;
  });
  if (first.constraint < 0) return std::nullopt;
  WindowCause cause{reader.describe(first), at, ""};
  const ConstraintViolation& violation = cause.violation;
  std::ostringstream text;
  text << constraint_name(violation.tag) << ": " << violation.label.name;
  if (const std::string thing = obstacle_of(plan, violation, at); !thing.empty()) {
    text << " (" << thing << ")";
  }
  text << ", by " << violation.amount << (violation.label.unit.empty() ? "" : " ")
       << violation.label.unit << " at vertex " << graph.vertex_record(plan.slot(at)).id;
  cause.text = text.str();
  return cause;
}

}  // namespace locograph
