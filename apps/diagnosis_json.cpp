#include <locograph/apps/diagnosis_json.h>

namespace locograph {

Json diagnosis_json(const Diagnosis& diagnosis, const Graph& graph) {
  const auto id = [&graph](int slot) { return graph.vertex_record(slot).id; };
  Json parts = Json::array();
  for (const Diagnosis::Part& part : diagnosis.parts) {
    Json loosest = Json::array();
    for (const Diagnosis::LooseVertex& loose : part.loosest) {
      loosest.push_back({{"vertex", id(loose.vertex)}, {"share", loose.share}});
    }
    parts.push_back({{"first_vertex", id(part.component.first)},
                     {"vertices", part.component.vertices},
                     {"held", part.component.anchored},
                     {"free_directions", part.free_directions},
                     {"loosest", loosest}});
  }
  Json not_finite = Json::array(), information = Json::array(), jacobians = Json::array();
  for (const EdgeId edge : diagnosis.not_finite) not_finite.push_back(edge_text(graph, edge));
  for (const Diagnosis::BadInformation& bad : diagnosis.information) {
    information.push_back({{"edge", edge_text(graph, bad.edge)},
                           {"line", graph.edge_record(bad.edge.slot).line},
                           {"smallest_eigenvalue", bad.smallest_eigenvalue}});
  }
  for (const Diagnosis::WrongJacobian& wrong : diagnosis.jacobians) {
    jacobians.push_back({{"edge", edge_text(graph, wrong.edge)},
                         {"vertex", id(graph.edge_vertices(wrong.edge.slot)[wrong.slot])},
                         {"difference", wrong.difference}});
  }
  return {{"healthy", diagnosis.healthy()},
          {"complete", diagnosis.complete},
          {"free_directions", diagnosis.free_directions()},
          {"parts", parts},
          {"errors_not_finite", not_finite},
          {"information_not_positive", information},
          {"wrong_jacobians", jacobians}};
}

}  // namespace locograph
