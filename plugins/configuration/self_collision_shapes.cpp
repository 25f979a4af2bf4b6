#include <locograph/plugins/configuration/robot_parameters.h>
#include <locograph/robots/covering_capsules.h>

#include <algorithm>
#include <limits>

namespace locograph {

SelfCollisionShapes::SelfCollisionShapes(const RobotParameter& parameter) {
  const Robot& robot = *parameter.robot;
  const std::vector<CollisionCapsule> of_links =
      covering_capsules(robot, {.max_overshoot_m = kSelfOvershoot_m});
  std::vector<int> bound_of_link(robot.links().size(), -1);
  for (const RobotParameter::LinkBound& bound : parameter.bounds) {
    bound_of_link[bound.link] = static_cast<int>(of_bound.size());
    OfBound own{0.0, static_cast<int>(capsules.size()), 0};
    for (const CollisionCapsule& c : of_links) {
      if (c.link == bound.link)
        capsules.push_back({c.capsule.from, c.capsule.to, c.capsule.radius});
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
  std::vector<int> place_of(of_bound.size(), -1);
  for (const Pair& pair : pairs) {
    if (place_of[pair.first] < 0) {
      place_of[pair.first] = static_cast<int>(by_first.size());
      by_first.push_back({pair.first, pair.second, pair.second, {}, {}});
    }
    PairsOf& of = by_first[place_of[pair.first]];
    of.begin = std::min(of.begin, pair.second);
    of.end = std::max(of.end, pair.second + 1);
  }
  for (PairsOf& of : by_first) {
    of.reach.assign(of.end - of.begin, -std::numeric_limits<double>::infinity());
    of.number.assign(of.end - of.begin, -1);
  }
  for (int number = 0; number < static_cast<int>(pairs.size()); ++number) {
    const Pair& pair = pairs[number];
    PairsOf& of = by_first[place_of[pair.first]];
    of.reach[pair.second - of.begin] = pair.reach;
    of.number[pair.second - of.begin] = number;
  }
}

}  // namespace locograph
