#pragma once
/// The axes of a contact on a surface.
///
///     const Eigen::Matrix3d axes = surface_axes("contact of l_sole", normal, forward);
///
/// Columns: z is the normal, out of the surface; x is `forward` made normal to it; y completes
/// them. The lengths of both do not matter.

#include <Eigen/Core>
#include <string>

namespace locograph {

/// Throws Error, in the name of the contact, if one of the directions is zero or not finite, or if
/// they are parallel.
Eigen::Matrix3d surface_axes(const std::string& contact, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& forward);

}  // namespace locograph
