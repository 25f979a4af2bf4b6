#pragma once
/// PARAMS_FRAME: a frame fixed to a link of a robot: a sole, a palm, the rim of a cup.
///
///     PARAMS_FRAME 3 0 ankle2_1  0 0 -0.1  0 0 0 1
///     PARAMS_FRAME number robot link  x y z qx qy qz qw
///
///     auto sole = std::make_shared<const FrameParameter>(model, 0, "ankle2_1", link_from_sole);
///     graph.parameters().set(3, sole);
///
/// Fields: number of the robot, name of the link, the frame's pose in it [m]. Contacts and tasks
/// name the frame by its number.

#include <locograph/core/parameters.h>
#include <locograph/robots/robot_state.h>

#include <Eigen/Geometry>
#include <string>

namespace locograph {

/// A pose in a line of a file: `x y z qx qy qz qw`, the quaternion normalised as it is read. What
/// was written is read back with the same bits.
struct SavedPose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  SavedPose() = default;
  /// Throws Error unless it is finite and its linear part a rotation.
  explicit SavedPose(const Eigen::Isometry3d& pose);
  Eigen::Isometry3d isometry() const { return Eigen::Translation3d(position) * rotation; }

  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};

struct FrameParameter final : Parameter {
  int robot_number = 0;
  std::string link_name;
  SavedPose link_from_frame;
  int link = -1;

  FrameParameter() = default;
  /// Throws Error for a robot without such a link.
  FrameParameter(const Robot& robot, int robot_number, std::string link_name,
                 const Eigen::Isometry3d& link_from_frame = Eigen::Isometry3d::Identity());

  Eigen::Isometry3d world_from_frame(const RobotState& state) const {
    return state.world_from_link(link) * pose_in_link_;
  }

  std::string_view tag() const override { return "PARAMS_FRAME"; }
  void read(FieldReader& in) override;
  void write(FieldWriter& out) const override;

 private:
  Eigen::Isometry3d pose_in_link_ = Eigen::Isometry3d::Identity();
};

}  // namespace locograph
