#pragma once
/// What the rows of edges on a robot are called (row_label.h).
///
///     RowLabel label = joint_row(robot, row, "limit");         // {"knee_pitch_1 limit", "rad"}

#include <locograph/core/row_label.h>
#include <locograph/plugins/configuration/vertex_configuration.h>

#include <string>

namespace locograph {

/// Of an active joint: its name and `what`; rad (m where it slides), then `per`: "/s^2".
RowLabel joint_row(const Robot& robot, int joint, const std::string& what,
                   const std::string& per = "");
/// The rows of a limit on every active joint, on the base's distance and on its angle.
RowLabel motion_row(const Robot& robot, int row, const std::string& what,
                    const std::string& per = "");
/// Of a coordinate of the tangent.
RowLabel tangent_row(const Robot& robot, int coordinate);
/// Of the collision sphere that a distance is measured from: its link; m.
RowLabel sphere_row(const RobotParameter& robot, int sphere, const std::string& what);
/// Of x y z [linear] and the rotation about them [angular].
RowLabel pose_row(int coordinate, const std::string& linear = "m",
                  const std::string& angular = "rad");

}  // namespace locograph
