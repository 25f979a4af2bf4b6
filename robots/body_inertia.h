#pragma once
/// Mass, centre of mass and inertia of the moving bodies of a robot, links joined by fixed and
/// frozen joints taken together.
///
///     const std::vector<locograph::BodyInertia> bodies = locograph::body_inertias(robot);
///     double trunk_kg = bodies[0].mass;                    // numbered as in robot.tree().bodies
///
/// Errors, with the file and the line of an <inertial> or <link>, if the equations of motion have
/// no solution: a joint that moves no mass, or that only turns a body about an axis through all of
/// its mass, and whose mimic joints do no more; a body with a principal moment of inertia below
/// zero. The root of a fixed base does not move and is not looked at.
///
/// Published models have bodies whose largest moment is above the sum of the other two, which no
/// body has: the URDF's warnings say so, and planning takes them as they are.

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <span>
#include <vector>

namespace locograph {

struct BodyInertia {
  double mass = 0.0;                                  ///< kg
  Eigen::Vector3d com = Eigen::Vector3d::Zero();      ///< m, body frame; 0 if there is no mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< kg m^2, about com, along the body axes
};

/// Whether a body can have this inertia [kg m^2, about its centre of mass], up to what printing it
/// in a few digits does to it.
bool is_inertia_of_a_body(const Eigen::Matrix3d& inertia);

/// Throws Error for a body that does not have it. Asked of whole bodies: models break it in their
/// cameras and covers, too, which does not matter once these are part of a trunk.
void require_solid_bodies(const Robot& robot, std::span<const BodyInertia> bodies);

std::vector<BodyInertia> body_inertias(const Robot& robot);
/// The same where mass and inertia of each link are those of the URDF times its factor; no factors:
/// as they are. Throws Error also for another count of factors than of links, and for one that is
/// not above 0.
std::vector<BodyInertia> body_inertias(const Robot& robot, std::span<const double> link_factors);

}  // namespace locograph
