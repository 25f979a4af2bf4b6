#include <locograph/check/moving_shapes.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

// Does the shape look the same at every position of the joint above its link?
bool spins_in_place(const CollisionShape& shape, const Joint& joint) {
  if (joint.type != JointType::kRevolute && joint.type != JointType::kContinuous) return false;
  constexpr double kOnAxis = 1e-9;
  if (shape.link_from_shape.translation().cross(joint.axis).norm() > kOnAxis) return false;
  if (shape.type == ShapeType::kSphere) return true;
  if (shape.type != ShapeType::kCapsule && shape.type != ShapeType::kCylinder) return false;
  const Eigen::Vector3d axis = shape.link_from_shape.linear().col(2);
  return axis.cross(joint.axis).norm() <= kOnAxis;
}

double travel(const Robot& robot, const Joint& joint, const Axis* axis) {
  if (joint.type != JointType::kPrismatic) return 0.0;
  if (axis == nullptr) return std::abs(joint.frozen_position);
  const Joint& leader = robot.active_joint(axis->active);
  return std::max(std::abs(axis->multiplier * leader.lower + axis->offset),
                  std::abs(axis->multiplier * leader.upper + axis->offset));
}

// Null for a joint that stands still.
const Axis* axis_of_joint(const Robot& robot, int joint) {
  const auto found = std::find_if(robot.axes().begin(), robot.axes().end(),
                                  [joint](const Axis& axis) { return axis.joint == joint; });
  return found == robot.axes().end() ? nullptr : &*found;
}

}  // namespace

MovingShapes::MovingShapes(const Robot& robot) {
  for (const Link& link : robot.links())
    for (const CollisionShape& shape : link.collision) add(robot, shape);
  moves_shapes_.assign(std::size_t(robot.active_joint_count()), false);
  for (const Shape& shape : shapes_)
    for (const Mover& mover : shape.movers) moves_shapes_[std::size_t(mover.active)] = true;
  for (const auto& [first, second] : robot.self_collision_pairs())
    for (Shape& shape : shapes_)
      if (shape.link == first || shape.link == second) shape.in_self_pair = true;
  in_world_.resize(shapes_.size());
  in_base_.resize(shapes_.size());
}

void MovingShapes::add(const Robot& robot, const CollisionShape& collision) {
  const int above = robot.links()[std::size_t(collision.link)].parent_joint;
  int carrier = collision.link;
  Eigen::Isometry3d carrier_from_shape = collision.link_from_shape;
  if (above >= 0 && spins_in_place(collision, robot.joints()[std::size_t(above)])) {
    const Joint& joint = robot.joints()[std::size_t(above)];
    carrier = joint.parent_link;
    carrier_from_shape = joint.parent_from_joint * collision.link_from_shape;
  }
  Shape shape{.link = collision.link,
              .carrier = carrier,
              .carrier_from_shape = carrier_from_shape,
              .geometry = link_solid(robot, collision),
              .end_1 = {},
              .end_2 = {},
              .movers = {}};
  const ConvexShape& geometry = shape.geometry;
  shape.end_1 = carrier_from_shape * (geometry.center() + geometry.bounding_axis());
  shape.end_2 = carrier_from_shape * (geometry.center() - geometry.bounding_axis());
  if (!geometry.is_swept_sphere()) shape.loose_radius = geometry.bounding_capsule_radius();

  double reach = std::max(shape.end_1.norm(), shape.end_2.norm()) + shape.loose_radius;
  for (int link = carrier; robot.links()[std::size_t(link)].parent_joint >= 0;) {
    const int index = robot.links()[std::size_t(link)].parent_joint;
    const Joint& joint = robot.joints()[std::size_t(index)];
    const Axis* axis = axis_of_joint(robot, index);
    if (axis != nullptr) {
      shape.movers.push_back(
          {axis->active, std::abs(axis->multiplier), joint.type == JointType::kPrismatic, reach});
    }
    reach += joint.parent_from_joint.translation().norm() + travel(robot, joint, axis);
    link = joint.parent_link;
  }
  std::reverse(shape.movers.begin(), shape.movers.end());
  shape.base_reach = reach;
  shapes_.push_back(std::move(shape));
}

MovingShapes::Bound MovingShapes::bound(const Shape& shape, const StepBounds& step, bool in_world) {
  Bound bound;
  double turned = 0.0;  // by the base and the joints above
  const auto turn = [&](double angle, double bend, double reach) {
    bound.length += angle * reach;
    bound.second_derivative += (angle * (angle + 2.0 * turned) + bend) * reach;
    turned += angle;
  };
  const auto slide = [&](double distance, double bend) {
    bound.length += distance;
    bound.second_derivative += 2.0 * turned * distance + bend;
  };
  if (in_world) {
    slide(step.base_distance_m, step.base_bend_m);
    turn(step.base_angle_rad, step.base_bend_rad, shape.base_reach);
  }
  for (const Mover& mover : shape.movers) {
    const double change = mover.rate * step.joints[mover.active];
    const double bend = mover.rate * step.joint_bends[mover.active];
    if (mover.prismatic)
      slide(change, bend);
    else
      turn(change, bend, mover.reach);
  }
  return bound;
}

void MovingShapes::set_step(const StepBounds& step) {
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    in_world_[i] = bound(shapes_[i], step, true);
    in_base_[i] = bound(shapes_[i], step, false);
  }
}

double MovingShapes::step_length_bound() const {
  double longest = 0.0;
  for (const Bound& bound : in_world_) longest = std::max(longest, bound.length);
  return longest;
}

double MovingShapes::path(const Shape& shape, const Bound& bound, const Eigen::Isometry3d& from,
                          const Eigen::Isometry3d& to, double fraction) {
  const Eigen::Matrix3d turned = to.linear() - from.linear();
  const Eigen::Vector3d moved = to.translation() - from.translation();
  const Eigen::Vector3d chord_1 = turned * shape.end_1 + moved;
  const Eigen::Vector3d chord_2 = turned * shape.end_2 + moved;
  // |R1 - R0|_F = 2 sqrt(2) sin(angle / 2), and 2 sin(angle / 2) is the chord of a unit vector.
  const double chord = std::max(chord_1.norm(), chord_2.norm()) +
                       shape.loose_radius * turned.norm() / std::sqrt(2.0);
  const double bend = bound.second_derivative * fraction * fraction;
  return std::min(std::sqrt(chord * chord + bend * bend / 12.0), bound.length * fraction);
}

double MovingShapes::bend(double fraction) const {
  double largest = 0.0;
  for (const Bound& bound : in_world_) largest = std::max(largest, bound.second_derivative);
  return largest * fraction * fraction / 8.0;
}

double MovingShapes::step_length_bound_in_base() const {
  double longest = 0.0;
  for (const Bound& bound : in_base_) longest = std::max(longest, bound.length);
  return longest;
}

double MovingShapes::bend_in_base(double fraction) const {
  double largest = 0.0;
  for (const Bound& bound : in_base_) largest = std::max(largest, bound.second_derivative);
  return largest * fraction * fraction / std::sqrt(12.0);
}

double MovingShapes::path_bound(std::span<const Eigen::Isometry3d> from,
                                std::span<const Eigen::Isometry3d> to, double fraction,
                                const std::vector<bool>* links) const {
  double longest = 0.0;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (links != nullptr && !(*links)[std::size_t(shapes_[i].link)]) continue;
    const std::size_t link = std::size_t(shapes_[i].carrier);
    longest = std::max(longest, path(shapes_[i], in_world_[i], from[link], to[link], fraction));
  }
  return longest;
}

double MovingShapes::relative_path_bound(std::span<const Eigen::Isometry3d> from,
                                         std::span<const Eigen::Isometry3d> to,
                                         double fraction) const {
  const Eigen::Isometry3d base_from_world_0 = from[0].inverse(),
                          base_from_world_1 = to[0].inverse();
  double longest = 0.0, second = 0.0;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    if (!shapes_[i].in_self_pair || in_base_[i].length == 0.0) continue;
    const std::size_t link = std::size_t(shapes_[i].carrier);
    const double length = path(shapes_[i], in_base_[i], base_from_world_0 * from[link],
                               base_from_world_1 * to[link], fraction);
    if (length > longest) {
      second = longest;
      longest = length;
    } else {
      second = std::max(second, length);
    }
  }
  return longest + second;
}

}  // namespace locograph
