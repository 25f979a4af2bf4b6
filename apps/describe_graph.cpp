#include <locograph/apps/about_file.h>
#include <locograph/apps/describe.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/margin_json.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/record_json.h>
#include <locograph/apps/violations_json.h>
#include <locograph/core/connectivity.h>
#include <locograph/core/graph_file.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/types/bundle/bal_file.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <map>

namespace locograph {
namespace {

Json vertices_json(const Graph& graph) {
  std::map<std::string, int> counts;
  int fixed = 0, lowest = std::numeric_limits<int>::max(), highest = 0, dimension = 0;
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (!graph.vertex_alive(v)) continue;
    const Graph::VertexRecord& record = graph.vertex_record(v);
    ++counts[graph.vertex_tag(v)];
    fixed += record.fixed ? 1 : 0;
    dimension += graph.dimension(v);
    lowest = std::min(lowest, record.id);
    highest = std::max(highest, record.id);
  }
  Json json = {{"count", graph.vertex_count()}, {"by_tag", counts}, {"fixed", fixed}};
  if (graph.vertex_count() > 0) json["ids"] = {lowest, highest};
  json["dimension"] = dimension;
  return json;
}

Json edges_json(const Graph& graph) {
  Json json = {{"count", graph.edge_count()}, {"by_tag", Json::object()}};
  for (const auto& pool : graph.edge_pools()) {
    double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
    Eigen::MatrixXd last;
    for (int i = 0; i < pool->size(); ++i) {
      const Eigen::MatrixXd information = pool->information(i);
      if (information.rows() == last.rows() && information == last) continue;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information,
                                                                  Eigen::EigenvaluesOnly);
      smallest = std::min(smallest, solver.eigenvalues().minCoeff());
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
      last = information;
    }
    if (pool->size() == 0) continue;
    json["by_tag"][pool->tag()] = {{"count", pool->size()},
                                   {"smallest_information_eigenvalue", smallest},
                                   {"largest_information_eigenvalue", largest}};
  }
  return json;
}

/// What there is in a graph, whichever file it comes from.
Json content_json(const Graph& graph) {
  const std::vector<Component> parts = components(graph);
  std::map<std::string, int> parameters;
  for (const auto& [number, parameter] : graph.parameters().all()) {
    ++parameters[std::string(parameter->tag())];
  }
  return {{"vertices", vertices_json(graph)},
          {"edges", edges_json(graph)},
          {"parameters", parameters},
          {"connected_parts", parts.size()},
          {"parts_held_in_place", std::count_if(parts.begin(), parts.end(),
                                                [](const Component& c) { return c.anchored; })}};
}

}  // namespace

Json describe_bal(const std::filesystem::path& path) {
  const Graph graph = read_bal(path);
  Json json = {{"file", path.string()}, {"kind", "bundle adjustment"}};
  Json content = content_json(graph);
  const Json& counts = content["vertices"]["by_tag"];
  json["cameras"] = counts.value("VERTEX_CAMERA_BAL", 0);
  json["points"] = counts.value("VERTEX_TRACKXYZ", 0);
  json["observations"] = content["edges"]["count"];
  json["dimension"] = content["vertices"]["dimension"];
  json["connected_parts"] = content["connected_parts"];
  return json;
}

Json describe_graph(const std::filesystem::path& path, const TypeRegistry& types) {
  ReadReport report;
  Progress progress("reading " + path.string());
  Graph graph = read_input_graph(
      path.string(), types,
      {.lenient = true, .progress = [&progress](double read) { progress.show(read); }}, &report);
  if (graph.vertex_count() == 0 && !report.unknown.empty()) {
    throw Error(path.string(), 0,
                "no line is a known vertex or edge; the first: " + report.unknown.front(), "");
  }
  const auto plan = graph.parameters().find<PlanParameter>();
  const bool recorded = plan && plan->recorded;
  Json json = {{"file", path.string()}, {"kind", recorded ? "record" : "graph"}};
  json.update(content_json(graph));
  if (plan) json["execution_margin"] = margin_json(plan->margin);
  json["vertices_from_edges"] = report.vertices_from_edges;
  json["indefinite_information"] = report.indefinite_information;
  if (report.indefinite_information > 0) {
    json["first_indefinite_line"] = report.first_indefinite_line;
  }
  about_file(path.string(), [&] { add_violations(json, graph); });
  if (json.contains("violations")) {
    for (Json& violation : json["violations"]) violation = std::string(violation["text"]);
  }
  // Where it is whole: what it says as a plan is asked last.
  if (recorded && report.unknown.empty()) {
    json["record"] = record_json(plan_in(std::move(graph), path.string()));
  }
  json["unknown_lines"] = report.unknown.size();
  if (!report.unknown.empty()) json["first_unknown"] = report.unknown.front();
  return json;
}

}  // namespace locograph
