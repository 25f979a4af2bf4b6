#include <locograph/apps/about_file.h>
#include <locograph/apps/record_json.h>
#include <locograph/planners/plan/record.h>

namespace locograph {

Json record_json(const PlanFile& file) {
  const Robot& robot = *file.plan.robot->robot;
  const Record record = about_file(file.name, [&] { return record_of(file.graph, file.plan); });
  const TrackingErrors errors = tracking_errors(robot, record);
  const WorstTorque torque = worst_torque(robot, record);
  Json json = {{"plan", nullptr}, {"plan_is_there", false}};
  if (!record.plan_file.empty()) {
    json["plan"] = record.plan_file.lexically_normal().string();
    std::error_code hidden;
    json["plan_is_there"] = std::filesystem::exists(record.plan_file, hidden);
  }
  json["duration_s"] = record.motion.time_s.back() - record.motion.time_s.front();
  json["plan_time_s"] = record.plan_time_s.back();
  json["max_base_error_m"] = errors.most_base_m;
  json["max_base_error_rad"] = errors.most_base_rad;
  json["max_joint_error_rad"] = errors.most_joint_rad;
  json["worst_joint"] = errors.worst_joint;
  json["max_torque_ratio"] = torque.ratio;
  json["worst_torque"] = torque.joint;
  return json;
}

}  // namespace locograph
