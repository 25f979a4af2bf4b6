/// Planar pose graphs solved after every pose: what an update costs.
///
///     incremental_benchmark [--every N] [FILE.g2o…]      # default: intel and manhattan
///
/// `whole`: the whole graph so far is compiled and optimised. `window`: the last 100 poses are free
/// and the rest is held, but the whole graph is optimised when a loop closes, that is when a pose
/// is measured against one outside the window. Prints one JSON object; times in seconds by update,
/// compiling included.

#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line.h"
#include "pose_graph_files.h"

namespace locograph {
namespace {

constexpr int kWindow = 100;

struct Updates {
  std::vector<double> seconds;
  int whole = 0;  ///< updates of the whole graph
  double chi2 = 0.0;
};

class Replay {
 public:
  explicit Replay(const Graph& map) : map_(map), edges_of_(map.vertex_slots()) {
    for (const EdgeSE2& edge : map.edges_of<EdgeSE2>()) {
      edges_of_[std::max(edge.vertices[0], edge.vertices[1])].push_back(&edge);
    }
  }

  Updates run(bool window, int every) {
    Updates updates;
    Graph graph;
    Problem problem;
    Workspace workspace;
    Optimiser optimiser(OptimiserOptions{});
    const auto solver = make_linear_solver("auto");
    bool closed = false;
    for (int slot = 0; slot < map_.vertex_slots(); ++slot) {
      closed = add(graph, slot) || closed;
      if (slot == 0 || (slot % every != 0 && slot + 1 != map_.vertex_slots())) continue;
      const Stopwatch watch;
      if (window && !closed && slot + 1 != map_.vertex_slots()) {
        std::vector<int> last;
        for (int v = std::max(0, slot - kWindow + 1); v <= slot; ++v) last.push_back(v);
        problem.compile(graph, last);
      } else {
        problem.compile(graph);
        ++updates.whole;
      }
      closed = false;
      workspace.allocate(problem);
      workspace.load_state();
      optimiser.start(workspace, *solver);
      while (optimiser.iterate()) {
      }
      workspace.store_state();
      updates.seconds.push_back(watch.seconds());
    }
    updates.chi2 = optimiser.result().final.chi2;
    std::sort(updates.seconds.begin(), updates.seconds.end());
    return updates;
  }

 private:
  /// Whether the pose closes a loop. Slots of the two graphs are the same.
  bool add(Graph& graph, int slot) const {
    const auto pose = [](int s) { return VertexId<VertexSE2>{s}; };
    VertexSE2 vertex = map_.vertex(pose(slot));
    for (const EdgeSE2* edge : edges_of_[slot]) {
      if (edge->vertices[0] != slot - 1 || edge->vertices[1] != slot) continue;
      vertex = VertexSE2(edge->predict_second(graph.vertex(pose(slot - 1)).pose()));
    }
    graph.add_vertex(map_.vertex_record(slot).id, vertex);
    if (slot == 0) graph.set_fixed(0, true);
    bool closes = false;
    for (const EdgeSE2* edge : edges_of_[slot]) {
      graph.add_edge(*edge, pose(edge->vertices[0]), pose(edge->vertices[1]));
      closes = closes || std::min(edge->vertices[0], edge->vertices[1]) <= slot - kWindow;
    }
    return closes;
  }

  const Graph& map_;
  std::vector<std::vector<const EdgeSE2*>> edges_of_;
};

void report(const std::string& name, const Updates& updates, bool last) {
  const std::size_t n = updates.seconds.size();
  double total = 0.0;
  for (const double s : updates.seconds) total += s;
  std::printf(
      "    \"%s\": {\"updates\": %zu, \"of_the_whole\": %d, \"median\": %.6g, \"p99\": %.6g, "
      "\"slowest\": %.6g, \"total\": %.6g, \"final_chi2\": %.10g}%s\n",
      name.c_str(), n, updates.whole, updates.seconds[n / 2], updates.seconds[n * 99 / 100],
      updates.seconds.back(), total, updates.chi2, last ? "" : ",");
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  using namespace locograph;
  std::vector<std::filesystem::path> files = {pose_graph_file("intel"),
                                              pose_graph_file("manhattan")};
  int every = 1;
  OptionParser app("Pose graphs solved after every pose", "incremental_benchmark");
  app.add_option("FILE", files, "Planar pose graphs (.g2o); default: intel and manhattan");
  app.add_option("--every", every, "Poses between two solutions").positive();
  return run_benchmark(app, argc, argv, [&] {
    std::printf("{\n");
    for (std::size_t i = 0; i < files.size(); ++i) {
      const Graph map = read_graph(files[i], standard_types());
      Replay replay(map);
      std::printf("  \"%s\": {\n", files[i].c_str());
      report("whole", replay.run(false, every), false);
      report("window", replay.run(true, every), true);
      std::printf("  }%s\n", i + 1 < files.size() ? "," : "");
    }
    std::printf("}\n");
  });
}
