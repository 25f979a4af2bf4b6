#pragma once
/// The rays of what a contact can do to the robot, for linear programmes of balance.
///
///     const double weight_N = robot.total_mass() * standard_gravity().norm();
///     for (const BearingRay& ray : bearing_rays({contact}, 0.1, weight_N)) use(ray.force);

#include <locograph/robots/contact.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// A contact that bears, closed, and its area.
struct BearingContact {
  Contact contact;
  /// Corners of what of a surface contact lies on something, along the contact's axes [m]; none:
  /// its rectangle, or, where its yaw is free, what of it bears whatever the yaw.
  std::vector<Eigen::Vector2d> area = {};
  double least_N = 0.0;  ///< that it has to be pressed with, of a kind that is pressed
};

/// What a contact can do to the robot: a force on an edge of its friction pyramid at a corner of
/// its area, or a component of a grasp; in parts of the robot's weight.
struct BearingRay {
  Eigen::Vector3d at;     ///< m, world
  Eigen::Vector3d force;  ///< world; of a pyramid with 1 along the normal
  Eigen::Vector3d moment;
  double lower, upper;  ///< how much of it there may be
};

/// margin: the part of friction, areas and limits of force that is left unused.
std::vector<BearingRay> bearing_rays(const BearingContact& bearing, double margin, double weight_N);

/// The most that all rays of a contact add up to, in parts of the robot's weight; negative where
/// each has its own bounds only.
double most_of_rays(const Contact& contact, double margin, double weight_N);

/// The least that they have to add up to, likewise; 0 where nothing is asked for.
double least_of_rays(const BearingContact& bearing, double weight_N);

}  // namespace locograph
