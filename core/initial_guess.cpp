#include <locograph/core/initial_guess.h>
#include <locograph/core/workspace.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace locograph {
namespace {

class Walk {
 public:
  explicit Walk(Graph& graph) : graph_(graph), known_(graph.vertex_slots(), false) {}

  void start_at_fixed() {
    for (int v = 0; v < graph_.vertex_slots(); ++v) {
      if (graph_.vertex_alive(v) && graph_.vertex_record(v).fixed) mark(v);
    }
  }

  /// Walks on from all known vertices; starts a new component at the first unknown vertex.
  int run() {
    int unreached = 0;
    advance();
    for (int v = 0; v < graph_.vertex_slots(); ++v) {
      if (!graph_.vertex_alive(v) || known_[v]) continue;
      // A lone start only makes sense where something can be predicted from it.
      if (reached_ > 0 && graph_.incident_edges(v).empty()) continue;
      const int before = reached_;
      mark(v);
      advance();
      if (reached_ == before + 1 && before > 0) ++unreached;
    }
    return unreached;
  }

  /// Follows edges between consecutive ids, in order of id, from the lowest.
  void follow_ids() {
    std::vector<std::pair<int, int>> by_id;
    for (int v = 0; v < graph_.vertex_slots(); ++v) {
      if (graph_.vertex_alive(v)) by_id.emplace_back(graph_.vertex_record(v).id, v);
    }
    std::sort(by_id.begin(), by_id.end());
    if (!by_id.empty() && reached_ == 0) mark(by_id.front().second);
    for (std::size_t i = 1; i < by_id.size(); ++i) {
      if (known_[by_id[i].second] || !known_[by_id[i - 1].second]) continue;
      for (const int e : graph_.incident_edges(by_id[i].second)) {
        if (predict(e, by_id[i - 1].second, by_id[i].second)) break;
      }
    }
  }

 private:
  void mark(int vertex) {
    known_[vertex] = true;
    queue_.push_back(vertex);
    ++reached_;
  }

  bool predict(int edge, int from, int to) {
    const std::span<const int> vertices = graph_.edge_vertices(edge);
    if (vertices.size() != 2) return false;
    const int slot = vertices[0] == to && vertices[1] == from   ? 0
                     : vertices[1] == to && vertices[0] == from ? 1
                                                                : -1;
    if (slot < 0) return false;
    const Graph::EdgeRecord& record = graph_.edge_record(edge);
    if (!graph_.edge_pools()[record.pool]->predict(record.index, slot, graph_.state(from),
                                                   graph_.state(to))) {
      return false;
    }
    mark(to);
    return true;
  }

  void advance() {
    while (!queue_.empty()) {
      const int from = queue_.front();
      queue_.pop_front();
      for (const int e : graph_.incident_edges(from)) {
        for (const int to : graph_.edge_vertices(e)) {
          if (!known_[to]) predict(e, from, to);
        }
      }
    }
  }

  Graph& graph_;
  std::vector<bool> known_;
  std::deque<int> queue_;
  int reached_ = 0;
};

std::vector<double> states(const Graph& graph) {
  std::vector<double> all;
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (!graph.vertex_alive(v)) continue;
    const double* state = graph.state(v);
    all.insert(all.end(), state, state + graph.state_size(v));
  }
  return all;
}

void restore(Graph& graph, const std::vector<double>& all) {
  const double* next = all.data();
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (!graph.vertex_alive(v)) continue;
    std::copy_n(next, graph.state_size(v), graph.state(v));
    next += graph.state_size(v);
  }
}

double cost(Graph& graph) {
  Problem problem;
  problem.compile(graph);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  return workspace.evaluate(workspace.state()).robust;
}

}  // namespace

int guess_from_spanning_tree(Graph& graph) {
  Walk walk(graph);
  walk.start_at_fixed();
  return walk.run();
}

int guess_from_odometry(Graph& graph) {
  Walk walk(graph);
  walk.start_at_fixed();
  walk.follow_ids();
  return walk.run();
}

void initialise_from_edges(Graph& graph) {
  const std::vector<double> blank = states(graph);
  guess_from_odometry(graph);
  const double odometry_cost = cost(graph);
  const std::vector<double> odometry = states(graph);
  restore(graph, blank);
  guess_from_spanning_tree(graph);
  if (odometry_cost <= cost(graph)) restore(graph, odometry);
}

}  // namespace locograph
