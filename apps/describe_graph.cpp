#include <locograph/apps/describe.h>
#include <locograph/apps/violations_json.h>
#include <locograph/core/connectivity.h>
#include <locograph/core/graph_file.h>

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

}  // namespace

Json describe_graph(const std::filesystem::path& path, const TypeRegistry& types) {
  ReadReport report;
  Graph graph = read_graph(path, types, {.lenient = true}, &report);
  if (graph.vertex_count() == 0 && !report.unknown.empty()) {
    throw Error(path.string(), 0,
                "no line is a known vertex or edge; the first: " + report.unknown.front(), "");
  }
  const std::vector<Component> parts = components(graph);
  Json json = {{"file", path.string()}, {"kind", "graph"}};
  json["vertices"] = vertices_json(graph);
  json["vertices_from_edges"] = report.vertices_from_edges;
  json["edges"] = edges_json(graph);
  std::map<std::string, int> parameters;
  for (const auto& [number, parameter] : graph.parameters().all()) {
    ++parameters[std::string(parameter->tag())];
  }
  json["parameters"] = parameters;
  json["connected_parts"] = parts.size();
  json["parts_held_in_place"] =
      std::count_if(parts.begin(), parts.end(), [](const Component& c) { return c.anchored; });
  json["indefinite_information"] = report.indefinite_information;
  if (report.indefinite_information > 0) {
    json["first_indefinite_line"] = report.first_indefinite_line;
  }
  add_violations(json, graph);
  if (json.contains("violations")) {
    for (Json& violation : json["violations"]) violation = std::string(violation["text"]);
  }
  json["unknown_lines"] = report.unknown.size();
  if (!report.unknown.empty()) json["first_unknown"] = report.unknown.front();
  return json;
}

}  // namespace locograph
