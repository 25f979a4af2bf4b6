#pragma once
/// Which pairs of links a robot without an SRDF cannot keep apart: those that overlap by
/// construction.
///
///     leave_out_overlapping(robot);
///     for (const auto& [first, second] : robot.left_out_pairs()) taken_on_trust(first, second);

#include <locograph/robots/robot.h>

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace locograph {

/// Joints that move between two links.
int joints_between(const Robot& robot, int first, int second);

/// Those of Robot::self_collision_pairs() that overlap in the neutral configuration and in more
/// than nine of ten of three hundred postures.
std::vector<std::pair<int, int>> always_overlapping_links(const Robot& robot);

/// Those of Robot::self_collision_pairs() with at most three joints between them that overlap, or
/// are nearer than 6 mm, as the robot stands, as a hip and the motor of the knee below it. Links
/// with more joints between them are a collision.
std::vector<std::pair<int, int>> overlapping_as_it_stands(const Robot& robot,
                                                          const Eigen::VectorXd& standing);

/// Takes both out of the pairs of a robot without an SRDF whose meshes are all there; the latter
/// where its shapes propose two or more end effectors: it stands on them with bent legs
/// (bent_legs.h).
void leave_out_overlapping(Robot& robot);

}  // namespace locograph
