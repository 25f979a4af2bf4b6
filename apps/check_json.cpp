#include <locograph/apps/check_json.h>

#include <cmath>

namespace locograph {
namespace {

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : "; ") + item;
  return text;
}

}  // namespace

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number_json(const std::optional<double>& value) {
  return value ? number_json(*value) : Json(nullptr);
}

Json violation_json(const Violation& v) {
  Json json = {{"constraint", v.constraint},
               {"judged", v.judged},
               {"violated", v.violated},
               {"worst", v.judged ? number_json(v.worst) : Json(nullptr)},
               {"unit", v.unit},
               {"limit", number_json(v.limit)},
               {"what", v.what}};
  if (!v.judged) json["why"] = v.why_not;
  return json;
}

Json violations_json(const CheckReport& report, const VertexIds& ids) {
  Json all = Json::array();
  for (const Violation& v : report.violations) {
    Json json = violation_json(v);
    json["at_vertex"] = v.judged ? Json(ids(v.at_vertex)) : Json(nullptr);
    json["count"] = v.count;
    json["time"] = v.time_s;
    json["at_point"] = {v.at_point.x(), v.at_point.y(), v.at_point.z()};
    all.push_back(std::move(json));
  }
  return all;
}

Json check_json(const CheckReport& report, const VertexIds& ids) {
  return {{"feasible", report.feasible},
          {"configurations", report.configurations},
          {"violations", violations_json(report, ids)},
          {"min_clearance_m", number_json(report.min_clearance_m)},
          {"min_self_clearance_m", number_json(report.min_self_clearance_m)},
          {"min_balance_margin", number_json(report.min_balance_margin)},
          {"max_torque_ratio", number_json(report.max_torque_ratio)},
          {"max_velocity_ratio", number_json(report.max_velocity_ratio)},
          {"max_contact_error_m", number_json(report.max_contact_error_m)},
          {"trusted", report.trusted}};
}

std::string check_text(const CheckReport& report, const VertexIds& ids) {
  std::string text;
  for (const Violation& v : report.violations) {
    if (!v.judged || !v.violated) continue;
    text += "violated: " + v.constraint + ", worst " + short_number(v.worst) + " " + v.unit +
            " (limit " + short_number(v.limit) + ") at vertex " + std::to_string(ids(v.at_vertex)) +
            ", " + counted(v.count, "vertex", "vertices") + (v.what.empty() ? "" : ": " + v.what) +
            '\n';
  }
  for (const Violation& v : report.violations) {
    if (!v.judged) text += "not judged: " + v.constraint + ", because " + v.why_not + '\n';
  }
  const auto told = [&](const char* what, const std::optional<double>& value, const char* unit,
                        double scale = 1.0) {
    if (value) text += what + short_number(scale * *value) + unit;
  };
  told("clearance ", report.min_clearance_m, " m\n");
  told("to itself ", report.min_self_clearance_m, " m\n");
  told("velocities up to ", report.max_velocity_ratio, " % of their limits\n", 100.0);
  told("contacts within ", report.max_contact_error_m, " m\n");
  told("balanced with a margin of ", report.min_balance_margin, "\n");
  told("torques up to ", report.max_torque_ratio, " % of their limits hold the robot\n", 100.0);
  if (!report.trusted.empty()) text += "on trust: " + list(report.trusted) + '\n';
  return text;
}

}  // namespace locograph
