#include <locograph/common/error.h>
#include <locograph/planners/online/heading.h>
#include <locograph/planners/online/online_plan.h>

#include <algorithm>
#include <utility>

namespace locograph {

OnlinePlan::OnlinePlan(Graph& graph) : graph_(graph), plan_(plan_of(graph)) {
  for (const auto& stance : plan_.stance_from) {
    if (!stance || stance->wheels.empty()) {
      throw Error("a configuration of the plan stands on no wheels", "a stance with wheels");
    }
  }
  if (!plan_.world) throw Error("the plan has no world", "a PARAMS_WORLD line");
  world_ = plan_.world;
  for (int i = 0; i < size(); ++i) planned_.emplace_back(configuration(i));
}

void OnlinePlan::show(std::shared_ptr<const WorldSnapshot> world) {
  world_ = std::make_shared<const WorldParameter>(std::move(world), plan_.world->ground_z_m);
}

Bindings OnlinePlan::bindings() const {
  Bindings bindings;
  bindings.set(plan_.world_number, world_);
  return bindings;
}

Eigen::Map<Eigen::VectorXd> OnlinePlan::configuration(int index) {
  return {graph_.state(slot(index)), graph_.state_size(slot(index))};
}

Eigen::Map<const Eigen::VectorXd> OnlinePlan::configuration(int index) const {
  return {std::as_const(graph_).state(slot(index)), graph_.state_size(slot(index))};
}

void OnlinePlan::overwrite(int first, std::span<const Eigen::VectorXd> configurations) {
  int index = first;
  for (const Eigen::VectorXd& q : configurations) {
    if (!is_fixed(index)) configuration(index) = q;
    ++index;
  }
}

double OnlinePlan::time_s(int index) const {
  return graph_.vertex(VertexId<VertexConfiguration>{slot(index)}).time_s;
}

void OnlinePlan::drop_slopes_of_moved(int first, int last) {
  for (int i = first; i <= last; ++i) {
    if (configuration(i) == planned_[static_cast<std::size_t>(i)]) continue;
    graph_.vertex(VertexId<VertexConfiguration>{slot(i)}).slopes.resize(0);
  }
}

double OnlinePlan::behind_m(int index) const {
  const Eigen::VectorXd& planned = planned_[static_cast<std::size_t>(index)];
  const Eigen::Vector3d behind = planned.head<3>() - configuration(index).head<3>();
  const Eigen::Vector3d left = left_of(planned.data());
  return behind.dot(left.cross(Eigen::Vector3d::UnitZ()));
}

int OnlinePlan::first_index_on(int slot) const {
  if (index_of(slot) >= 0) return index_of(slot);
  int first = size();
  for (const int e : graph_.incident_edges(slot)) {
    for (const int v : graph_.edge_vertices(e)) {
      if (index_of(v) >= 0) first = std::min(first, index_of(v));
    }
  }
  return first < size() ? first : -1;
}

}  // namespace locograph
