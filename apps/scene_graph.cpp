#include <locograph/apps/gauge.h>
#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/vertices.h>
#include <locograph/types/slam3d/vertices.h>

#include <cmath>

namespace locograph {
namespace {

enum class Kind { kPose2, kPose3, kPoint2, kPoint3, kOther };

Kind kind_of(const Graph& graph, int slot) {
  const std::type_index type = graph.vertex_pools()[graph.vertex_record(slot).pool]->type();
  if (type == typeid(VertexSE2)) return Kind::kPose2;
  if (type == typeid(VertexSE3)) return Kind::kPose3;
  if (type == typeid(VertexXY)) return Kind::kPoint2;
  if (type == typeid(VertexPointXYZ)) return Kind::kPoint3;
  return Kind::kOther;
}

/// Slots of the poses and of the points, in the file's order.
struct Slots {
  std::vector<int> poses, points;
  int dimension = 2;
};

Slots slots_of(const Graph& graph) {
  Slots slots;
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot)) continue;
    const Kind kind = kind_of(graph, slot);
    if (kind == Kind::kPose2 || kind == Kind::kPose3) slots.poses.push_back(slot);
    if (kind == Kind::kPoint2 || kind == Kind::kPoint3) slots.points.push_back(slot);
    if (kind == Kind::kPose3 || kind == Kind::kPoint3) slots.dimension = 3;
  }
  return slots;
}

std::string packed_poses(const Graph& graph, const Slots& slots) {
  std::vector<float> numbers;
  for (const int slot : slots.poses) {
    const double* s = graph.state(slot);
    if (kind_of(graph, slot) == Kind::kPose3) {
      for (int i = 0; i < 7; ++i) numbers.push_back(static_cast<float>(s[i]));
    } else {
      for (const double value :
           {s[0], s[1], 0.0, 0.0, 0.0, std::sin(0.5 * s[2]), std::cos(0.5 * s[2])}) {
        numbers.push_back(static_cast<float>(value));
      }
    }
  }
  return packed_floats(numbers);
}

std::string packed_points(const Graph& graph, const Slots& slots) {
  std::vector<float> numbers;
  for (const int slot : slots.points) {
    const double* s = graph.state(slot);
    const bool spatial = kind_of(graph, slot) == Kind::kPoint3;
    for (const double value : {s[0], s[1], spatial ? s[2] : 0.0}) {
      numbers.push_back(static_cast<float>(value));
    }
  }
  return packed_floats(numbers);
}

/// Between two poses; what else an edge may connect is not drawn.
std::string packed_edges(const Graph& graph, const Slots& slots) {
  std::vector<int> number(static_cast<std::size_t>(graph.vertex_slots()), -1);
  for (std::size_t i = 0; i < slots.poses.size(); ++i) {
    number[static_cast<std::size_t>(slots.poses[i])] = static_cast<int>(i);
  }
  std::vector<std::int32_t> edges;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!graph.edge_alive(slot)) continue;
    const std::span<const int> ends = graph.edge_vertices(slot);
    if (ends.size() != 2 || number[ends[0]] < 0 || number[ends[1]] < 0) continue;
    edges.push_back(number[ends[0]]);
    edges.push_back(number[ends[1]]);
  }
  return packed_ints(edges);
}

}  // namespace

Json pose_graph_scene(Graph graph, const std::string& file, const SceneOptions& options) {
  const Slots slots = slots_of(graph);
  if (slots.poses.empty()) {
    throw Error(file, 0, "nothing to show: neither a plan nor poses",
                "VERTEX_CONFIGURATION, VERTEX_SE2 or VERTEX_SE3:QUAT lines");
  }
  Json drawn = {{"dimension", slots.dimension}};
  if (options.optimize) {
    const std::string before = packed_poses(graph, slots);
    const Gauge gauge = hold_gauge(graph, file, options.lenient);
    const OptimiserResult result = optimise(graph, OptimiserOptions(), *make_linear_solver("auto"));
    gauge.release(graph);
    if (!result.converged) print_warning(file + ": not converged: " + result.reason_text());
    drawn["vertices"] = packed_poses(graph, slots);
    drawn["before"] = before;
    drawn["chi2"] = {result.initial.chi2, result.final.chi2};
  } else {
    drawn["vertices"] = packed_poses(graph, slots);
  }
  drawn["edges"] = packed_edges(graph, slots);
  if (!slots.points.empty()) drawn["points"] = packed_points(graph, slots);
  return {{"version", 1},
          {"kind", "pose_graph"},
          {"title", std::filesystem::path(file).filename().string()},
          {"graph", std::move(drawn)}};
}

}  // namespace locograph
