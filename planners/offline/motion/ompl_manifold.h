#pragma once
/// The manifold of a segment's closed contacts as OMPL takes it; not installed, as it includes
/// OMPL.
///
/// Coordinates of the ambient space: base position [m], the base's quaternion twice, so that a
/// small rotation is as long as its angle, and the joints; the constraint is the closure of the
/// contacts that are held, and the quaternion's norm. Samples have generators with a seed of their
/// own, and an interpolation that is stopped gives how far it got. All keep a reference to the
/// space.

#include <locograph/planners/offline/motion/segment_space.h>
#include <ompl/base/spaces/constraint/AtlasStateSpace.h>
#include <ompl/base/spaces/constraint/ProjectedStateSpace.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

namespace locograph {

using Waypoints = std::vector<Eigen::VectorXd>;

/// Between configurations that trees look at [m, rad].
inline constexpr double kTreeStep = 0.03;

/// Of the two quaternions of a rotation the one nearer to that of `near`, a configuration or
/// coordinates.
Eigen::VectorXd to_coordinates(const Eigen::VectorXd& q, const Eigen::VectorXd& near);
Eigen::Ref<Eigen::VectorXd> coordinates_of(ompl::base::State* state);
Eigen::VectorXd configuration_of(const ompl::base::State* state);

/// Steps along it are projected. Samples are scattered about what lies straight between two of the
/// waypoints, drawn each time from `way` as it is then, and brought to the contacts; every second
/// one also to where it is valid.
std::shared_ptr<ompl::base::ConstrainedStateSpace> projected_manifold(SegmentSpace& space,
                                                                      const Waypoints& way,
                                                                      std::uint64_t seed);
/// Made of charts. Every second sample is of a chart, the others as above.
std::shared_ptr<ompl::base::AtlasStateSpace> atlas_manifold(SegmentSpace& space,
                                                            const Waypoints& way,
                                                            std::uint64_t seed);

}  // namespace locograph
