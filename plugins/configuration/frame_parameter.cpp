#include <locograph/plugins/configuration/frame_parameter.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

namespace locograph {

SavedPose::SavedPose(const Eigen::Isometry3d& pose)
    : position(pose.translation()), rotation(Eigen::Quaterniond(pose.linear()).normalized()) {
  // A comparison that NaN fails, too.
  if (!(pose.matrix().allFinite() &&
        (rotation.toRotationMatrix() - pose.linear()).cwiseAbs().maxCoeff() < 1e-6)) {
    throw Error("a pose that is not finite or not a rotation and a translation", "a rigid pose");
  }
}

void SavedPose::read(FieldReader& in) {
  Eigen::VectorXd numbers(7);
  for (Eigen::Index i = 0; i < 7; ++i) numbers[i] = in.number();
  read_quaternion(in, numbers);
  position = numbers.head<3>();
  rotation.coeffs() = numbers.tail<4>();
}

void SavedPose::write(FieldWriter& out) const {
  for (const double value : position) out.number(value);
  for (const double value : rotation.coeffs()) out.number(value);
}

FrameParameter::FrameParameter(const Robot& robot, int number, std::string name,
                               const Eigen::Isometry3d& pose)
    : robot_number(number),
      link_name(std::move(name)),
      link_from_frame(pose),
      link(robot.link_index(link_name)),
      pose_in_link_(link_from_frame.isometry()) {}

void FrameParameter::read(FieldReader& in) {
  robot_number = in.integer();
  link_name = in.word();
  link = in.parameters()->get<RobotParameter>(robot_number)->robot->link_index(link_name);
  link_from_frame.read(in);
  pose_in_link_ = link_from_frame.isometry();
}

void FrameParameter::write(FieldWriter& out) const {
  out.integer(robot_number);
  out.word(link_name);
  link_from_frame.write(out);
}

}  // namespace locograph
