#include <locograph/apps/check_json.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace locograph {
namespace {

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : "; ") + item;
  return text;
}

/// "joint_limits, worst 0.1 rad (limit 0 rad) at vertex 7"
std::string judged_text(const Violation& v, const VertexIds& ids) {
  const std::string unit = v.unit == "1" ? "" : ' ' + v.unit;
  const std::string worst =
      std::isfinite(v.worst) ? short_number(v.worst) + unit : std::string(kBeyondMeasure);
  return v.constraint + ", worst " + worst + " (limit " + short_number(v.limit) + unit +
         ") at vertex " + std::to_string(ids(v.at_vertex));
}

/// A line for each reason why something was not judged.
std::string not_judged_text(const CheckReport& report) {
  std::vector<std::pair<std::string, std::string>> by_reason;
  for (const Violation& v : report.violations) {
    if (v.judged) continue;
    const auto found = std::find_if(by_reason.begin(), by_reason.end(),
                                    [&v](const auto& group) { return group.first == v.why_not; });
    if (found == by_reason.end()) {
      by_reason.emplace_back(v.why_not, v.constraint);
    } else {
      found->second += ", " + v.constraint;
    }
  }
  std::string text;
  for (const auto& [reason, constraints] : by_reason) {
    text += "not judged: " + constraints + ", because " + reason + '\n';
  }
  return text;
}

std::string holding_text(const CheckReport& report, const VertexIds& ids, bool all) {
  std::string lines;
  long count = 0;
  for (const Violation& v : report.violations) {
    if (!v.judged || v.violated) continue;
    ++count;
    lines += "holds: " + judged_text(v, ids) + '\n';
  }
  if (all || count == 0) return lines;
  return counted(count, "constraint holds", "constraints hold") + " (--all lists each)\n";
}

/// How far a ball rolled, or slipped, at most; nothing without balls.
std::optional<double> most_of_balls(const CheckReport& report, double BallRolling::*figure) {
  if (report.ball_rolling.empty()) return std::nullopt;
  return std::ranges::max(report.ball_rolling, {}, figure).*figure;
}

/// How close to the limits: one line.
std::string extremes_text(const CheckReport& report) {
  std::string text;
  const auto told = [&text](const char* what, const std::optional<double>& value, const char* unit,
                            double scale = 1.0) {
    if (!value || !std::isfinite(*value)) return;
    text += (text.empty() ? "" : ", ") + (what + short_number(scale * *value)) + unit;
  };
  told("clearance ", report.min_clearance_m, " m");
  told("to itself ", report.min_self_clearance_m, " m");
  told("velocities up to ", report.max_velocity_ratio, " % of their limits", 100.0);
  told("contacts within ", report.max_contact_error_m, " m");
  told("balanced with a margin of ", report.min_balance_margin, "");
  told("torques up to ", report.max_torque_ratio, " % of their limits", 100.0);
  return text.empty() ? "" : text + '\n';
}

/// How far each ball rolled: a line.
std::string balls_text(const CheckReport& report) {
  std::string text;
  for (const BallRolling& ball : report.ball_rolling)
    text += (text.empty() ? "balls rolled: " : ", ") + ball.end_effector + ' ' +
            short_number(ball.way_m) + " m, slipping by " + short_number(ball.slip_m) + " m";
  return text.empty() ? "" : text + '\n';
}

std::string shares_text(const Robustness& least) {
  std::string text;
  const auto told = [&text](const char* what, const std::optional<double>& value, double scale,
                            const char* unit) {
    if (value) text += (text.empty() ? "" : ", ") + (what + short_number(scale * *value)) + unit;
  };
  told("friction may shrink by ", least.friction, 100.0, " %");
  told("contact areas by ", least.area, 100.0, " %");
  told("torques by ", least.torque, 100.0, " %");
  told("pushed by ", least.push_N, 1.0, " N");
  told("loaded with ", least.mass, 100.0, " % of its mass");
  return text;
}

/// A line, and one for each stance where all are asked for.
std::string robustness_text(const RobustnessReport& report, const VertexIds& ids, bool all) {
  std::string text = "holds until " + shares_text(report.least) + " (" +
                     short_number(report.processor_s) + " s)\n";
  for (const RobustnessReport::OfStance& one : report.by_stance) {
    if (!all) break;
    text += "  vertex " + std::to_string(ids(one.first_vertex)) + " to " +
            std::to_string(ids(one.last_vertex)) + ": " + shares_text(one.least) + '\n';
  }
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

namespace {

Json shares_json(const Robustness& least) {
  return {{"friction", number_json(least.friction)},
          {"area", number_json(least.area)},
          {"torque", number_json(least.torque)},
          {"push_N", number_json(least.push_N)},
          {"mass", number_json(least.mass)}};
}

Json robustness_json(const RobustnessReport& report, const VertexIds& ids) {
  Json json = shares_json(report.least);
  json["by_stance"] = Json::array();
  for (const RobustnessReport::OfStance& one : report.by_stance) {
    Json stance = shares_json(one.least);
    stance["from_vertex"] = ids(one.first_vertex);
    stance["to_vertex"] = ids(one.last_vertex);
    stance["from_s"] = one.from_s;
    stance["until_s"] = one.until_s;
    json["by_stance"].push_back(std::move(stance));
  }
  json["processor_s"] = report.processor_s;
  return json;
}

Json balls_json(const CheckReport& report) {
  Json balls = Json::array();
  for (const BallRolling& ball : report.ball_rolling)
    balls.push_back({{"end_effector", ball.end_effector},
                     {"rolling_m", number_json(ball.way_m)},
                     {"slip_m", number_json(ball.slip_m)}});
  return balls;
}

}  // namespace

Json check_json(const CheckReport& report, const VertexIds& ids) {
  const auto& ends = report.ends;
  Json json = {{"feasible", report.feasible},
               {"configurations", report.configurations},
               {"violations", violations_json(report, ids)},
               {"min_clearance_m", number_json(report.min_clearance_m)},
               {"min_self_clearance_m", number_json(report.min_self_clearance_m)},
               {"min_balance_margin", number_json(report.min_balance_margin)},
               {"max_torque_ratio", number_json(report.max_torque_ratio)},
               {"max_velocity_ratio", number_json(report.max_velocity_ratio)},
               {"max_contact_error_m", number_json(report.max_contact_error_m)},
               {"max_ball_rolling_m", number_json(most_of_balls(report, &BallRolling::way_m))},
               {"max_ball_slip_m", number_json(most_of_balls(report, &BallRolling::slip_m))},
               {"balls", balls_json(report)},
               {"start", ends ? Json(ends->starts()) : Json(nullptr)},
               {"goals_reached", ends ? Json(ends->goals_reached) : Json(nullptr)},
               {"goals", ends ? Json(ends->goals) : Json(nullptr)},
               {"trusted", report.trusted}};
  if (report.robustness) json["robustness"] = robustness_json(*report.robustness, ids);
  return json;
}

std::string check_text(const CheckReport& report, const VertexIds& ids, bool all) {
  std::string text;
  for (const Violation* v : report.violated()) {
    text += "violated: " + judged_text(*v, ids) + ", " + counted(v->count, "vertex", "vertices") +
            (v->what.empty() ? "" : ": " + v->what) + '\n';
  }
  text += not_judged_text(report) + holding_text(report, ids, all) + extremes_text(report) +
          balls_text(report);
  if (report.robustness) text += robustness_text(*report.robustness, ids, all);
  if (!report.trusted.empty()) text += "on trust: " + list(report.trusted) + '\n';
  return text;
}

}  // namespace locograph
