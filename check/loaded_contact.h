#pragma once
/// Where a contact bears in a configuration, for all that works out balance.
///
///     LoadedContact sole = loaded_contact(state, contact);
///     for (const Eigen::Vector2d& corner : corners_of(*sole.effector, area)) use(sole, corner);

#include <locograph/robots/contact.h>
#include <locograph/robots/robot_state.h>
#include <locograph/robots/statics.h>

#include <Eigen/Core>
#include <vector>

namespace locograph {

/// A contact's axes and point in the world. Keeps pointers to the contact.
struct LoadedContact {
  const Contact* given;
  const EndEffector* effector;
  int link;
  Eigen::Matrix3d axes;
  Eigen::Vector3d point;

  /// Force and moment about the point `at`, both along the contact's axes, `at` from its point.
  PointWrench applied(const RobotState& state, const Eigen::Vector3d& at,
                      const Eigen::Matrix<double, 6, 1>& wrench) const {
    return {.link = link,
            .point = state.world_from_link(link).inverse() * (point + axes * at),
            .force = axes * wrench.head<3>(),
            .moment = axes * wrench.tail<3>()};
  }
};

/// The axes of surfaces and rungs are those of the end effector, those of points and wheels the
/// contact's in the world; a ball bears at its lowest point, a wheel at that of its disc.
LoadedContact loaded_contact(const RobotState& state, const Contact& contact);

/// Of the area, or where there is none of the whole rectangle.
std::vector<Eigen::Vector2d> corners_of(const EndEffector& effector,
                                        const std::vector<Eigen::Vector2d>& area);

}  // namespace locograph
