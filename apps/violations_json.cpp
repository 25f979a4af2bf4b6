#include <locograph/apps/violations_json.h>
#include <locograph/core/violations.h>

#include <algorithm>
#include <cmath>

namespace locograph {

void add_violations(Json& json, Graph& graph) {
  constexpr std::size_t kMost = 20;
  const int constraints = constraint_count(graph);
  if (constraints == 0) return;
  const std::vector<ConstraintViolation> found = violations(graph);
  Json worst = Json::array();
  for (std::size_t i = 0; i < std::min(kMost, found.size()); ++i) {
    const ConstraintViolation& v = found[i];
    worst.push_back({{"constraint", v.tag},
                     {"line", v.line > 0 ? Json(v.line) : Json(nullptr)},
                     {"vertices", v.vertices},
                     {"row", v.row},
                     {"name", v.label.name},
                     {"amount", std::isfinite(v.amount) ? Json(v.amount) : Json(nullptr)},
                     {"unit", v.label.unit},
                     {"one_sided", v.one_sided},
                     {"text", v.text()}});
  }
  json["constraints"] = constraints;
  json["violated_rows"] = found.size();
  json["violations"] = worst;
}

}  // namespace locograph
