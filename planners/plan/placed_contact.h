#pragma once
/// A contact of the robot and the place in the world where it is to be closed.
///
///     PlacedContact sole;
///     sole.contact = {.link = "l_sole", .half_x_m = 0.08, .half_y_m = 0.04, .mu = 0.6,
///                     .max_force_N = 1000.0};
///     sole.position = {0.0, 0.1, 0.0};
///     sole.forward = Eigen::Vector3d::UnitX();
///     require_sound_contacts(robot, {&sole, 1});
///
/// `contact` says where on the robot and what it bears (static_balance/contact_parameter.h): its
/// normal and forward are directions of the link, which the contact's axes are fixed in. The
/// contact is closed when point, normal and forward of the link are those of the world:
///
///     surface   all three; without `forward`, yaw about the normal is free
///     point     the point alone; the axes of its force are normal and forward of the world
///     rung      the point and the direction of the bar, normal × forward; turning round the bar is
///               free

#include <locograph/plugins/static_balance/contact_parameter.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

struct PlacedContact {
  ContactDescription contact;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, world
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();   ///< world, out of the surface, any length
  std::optional<Eigen::Vector3d> forward;              ///< world; a rung must have one
  bool bears_load = true;  ///< false: closed, but balance does not count on it
};

/// Of two vectors of any length [rad].
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Columns x, y, z: forward, across, normal. Without `forward`, any direction across the normal.
Eigen::Matrix3d world_axes(const PlacedContact& placed);

/// `contact` with the axes that its wrench has: those of a point in the world.
ContactDescription wrench_description(const PlacedContact& placed);

/// wrench_description() of the contacts that bear load.
std::vector<ContactDescription> loaded_contacts(std::span<const PlacedContact> contacts);

/// Throws Error, naming the contact, for none at all, none that bears load, an unknown link,
/// numbers that are not finite, a normal of length zero or along forward, a rung without forward,
/// and contacts that contradict each other: points fixed to each other in the robot whose places
/// are not as far apart, or whose normals are not at the same angle.
void require_sound_contacts(const Robot& robot, std::span<const PlacedContact> contacts);

/// Links that touch something at these contacts: those fixed to a contact's link, and those on the
/// next joint behind (a wheel on its fork).
std::vector<bool> touching_links(const Robot& robot, std::span<const PlacedContact> contacts);

}  // namespace locograph
