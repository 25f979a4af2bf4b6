#include <locograph/plugins/configuration/robot_parameters.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr int kMostSpheresPerShape = 64;

void append(std::vector<SelfCollisionShapes::Capsule>& capsules, const CollisionShape& shape) {
  if (shape.type == ShapeType::kSphere || shape.type == ShapeType::kCapsule) {
    const double half = shape.type == ShapeType::kCapsule ? 0.5 * shape.length : 0.0;
    const Eigen::Vector3d along = half * shape.link_from_shape.linear().col(2);
    const Eigen::Vector3d middle = shape.link_from_shape.translation();
    capsules.push_back({middle - along, middle + along, shape.radius});
    return;
  }
  for (const CollisionSphere& sphere :
       covering_spheres(shape, kSelfOvershoot_m, kMostSpheresPerShape)) {
    capsules.push_back({sphere.center, sphere.center, sphere.radius});
  }
}

}  // namespace

SelfCollisionShapes::SelfCollisionShapes(const RobotParameter& parameter) {
  const Robot& robot = *parameter.robot;
  std::vector<int> bound_of_link(robot.links().size(), -1);
  for (const RobotParameter::LinkBound& bound : parameter.bounds) {
    bound_of_link[bound.link] = static_cast<int>(of_bound.size());
    OfBound own{0.0, static_cast<int>(capsules.size()), 0};
    for (const CollisionShape& shape : robot.links()[bound.link].collision) {
      append(capsules, shape);
    }
    own.end = static_cast<int>(capsules.size());
    for (int i = own.begin; i < own.end; ++i) {
      const Capsule& capsule = capsules[i];
      const double far =
          std::max((capsule.from - bound.center).norm(), (capsule.to - bound.center).norm());
      own.radius = std::max(own.radius, far + capsule.radius);
    }
    of_bound.push_back(own);
  }
  for (const auto& [first, second] : robot.self_collision_pairs()) {
    if (std::ranges::equal(robot.support(first), robot.support(second))) continue;
    const int a = bound_of_link[first], b = bound_of_link[second];
    if (a < 0 || b < 0) continue;
    pairs.push_back({a, b, of_bound[a].radius + of_bound[b].radius});
  }
}

}  // namespace locograph
