#include <locograph/plugins/configuration/row_labels.h>

namespace locograph {

RowLabel joint_row(const Robot& robot, int joint, const std::string& what, const std::string& per) {
  const Joint& one = robot.active_joint(joint);
  return {one.name + (what.empty() ? "" : " ") + what,
          (one.type == JointType::kPrismatic ? "m" : "rad") + per};
}

RowLabel motion_row(const Robot& robot, int row, const std::string& what, const std::string& per) {
  const int joints = robot.active_joint_count();
  if (row < joints) return joint_row(robot, row, what, per);
  return row == joints ? RowLabel{"base linear " + what, "m" + per}
                       : RowLabel{"base angular " + what, "rad" + per};
}

RowLabel tangent_row(const Robot& robot, int coordinate) {
  const int base = robot.base_tangent_size();
  if (coordinate >= base) return joint_row(robot, coordinate - base, "");
  RowLabel label = pose_row(coordinate);
  label.name = "base " + label.name;
  return label;
}

RowLabel sphere_row(const RobotParameter& robot, int sphere, const std::string& what) {
  return {robot.robot->links()[robot.spheres[sphere].link].name + " " + what, "m"};
}

RowLabel pose_row(int coordinate, const std::string& linear, const std::string& angular) {
  const std::string axis(1, "xyz"[coordinate % 3]);
  return coordinate < 3 ? RowLabel{axis, linear} : RowLabel{"about " + axis, angular};
}

}  // namespace locograph
