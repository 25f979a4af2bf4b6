#pragma once
/// What plans leave unused and where end effectors are off their skin, as commands tell it.
///
///     json["execution_margin"] = margin_json(scenario.margin);
///     text += margin_text(scenario.margin);

#include <locograph/apps/output.h>
#include <locograph/planners/task/skin_frames.h>
#include <locograph/plugins/configuration/execution_margin.h>

#include <string>
#include <vector>

namespace locograph {

inline Json margin_json(const ExecutionMargin& margin) {
  return {{"friction", margin.friction},
          {"area", margin.area},
          {"torque", margin.torque},
          {"joint_rad", margin.joint_rad},
          {"self_distance_m", margin.self_distance_m},
          {"least_force", margin.least_force},
          {"dwell_s", margin.dwell_s}};
}

inline Json off_skin_json(const std::vector<SkinFrame>& off_skin) {
  Json all = Json::array();
  for (const SkinFrame& off : off_skin) {
    all.push_back({{"end_effector", off.end_effector},
                   {"link", off.link},
                   {"beyond_m", off.beyond_m},
                   {"snapped", off.snapped}});
  }
  return all;
}

/// In one line.
inline std::string margin_text(const ExecutionMargin& margin) {
  if (margin == ExecutionMargin::none()) return "no execution margin\n";
  return "execution margin: friction " + short_number(margin.friction) + ", areas " +
         short_number(margin.area) + ", torques " + short_number(margin.torque) + ", " +
         short_number(margin.joint_rad) + " rad to joint limits, " +
         short_number(margin.self_distance_m) + " m between links, each contact pressed by " +
         short_number(margin.least_force) + " of the weight, dwell " +
         short_number(margin.dwell_s) + " s\n";
}

}  // namespace locograph
