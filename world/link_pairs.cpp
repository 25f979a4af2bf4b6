#include <locograph/common/error.h>
#include <locograph/common/thread_pool.h>
#include <locograph/common/uniform.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/robots/robot_state.h>
#include <locograph/world/gjk.h>
#include <locograph/world/link_pairs.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

namespace locograph {
namespace {

constexpr int kSamplesPerChunk = 50;
constexpr int kDecisions = 40;    // LinkPairOptions::stop_when_decided, on the way
constexpr double kNear_m = 1e-5;  // of distances between hulls

struct PlacedSolid {
  ConvexShape shape;
  Eigen::Isometry3d link_from_shape;
};

/// Whether one joint that moves is between the links, and otherwise only fixed joints of links that
/// have no shapes.
bool are_adjacent(const Robot& robot, int first, int second) {
  for (const auto& [above, below] : {std::pair(first, second), std::pair(second, first)}) {
    int moving = 0;
    for (int link = below; link != above;) {
      const int joint = robot.links()[static_cast<std::size_t>(link)].parent_joint;
      if (joint < 0) break;
      const Joint& between = robot.joints()[static_cast<std::size_t>(joint)];
      moving += between.type == JointType::kFixed ? 0 : 1;
      link = between.parent_link;
      if (link == above) {
        if (moving == 1) return true;
      } else if (!robot.links()[static_cast<std::size_t>(link)].collision.empty()) {
        break;
      }
    }
  }
  return false;
}

std::vector<LinkPair> movable_pairs(const Robot& robot) {
  const std::set<std::pair<int, int>> on(robot.self_collision_pairs().begin(),
                                         robot.self_collision_pairs().end());
  const std::vector<int>& body_of = robot.tree().body_of_link;
  std::vector<LinkPair> pairs;
  const int links = static_cast<int>(robot.links().size());
  for (int a = 0; a < links; ++a) {
    if (robot.links()[static_cast<std::size_t>(a)].collision.empty()) continue;
    for (int b = a + 1; b < links; ++b) {
      if (robot.links()[static_cast<std::size_t>(b)].collision.empty()) continue;
      if (body_of[static_cast<std::size_t>(a)] == body_of[static_cast<std::size_t>(b)]) continue;
      pairs.push_back({a, b, on.contains({a, b}), are_adjacent(robot, a, b), 0, 0});
    }
  }
  return pairs;
}

Eigen::VectorXd random_posture(const Robot& robot, std::mt19937_64& random) {
  Eigen::VectorXd q = robot.neutral_configuration();
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    const Joint& joint = robot.active_joint(i);
    const bool turns = joint.type == JointType::kContinuous;
    q[robot.base_configuration_size() + i] = uniform(
        random, turns ? -std::numbers::pi : joint.lower, turns ? std::numbers::pi : joint.upper);
  }
  return q;
}

/// The exact shapes of all links.
class Solids {
 public:
  explicit Solids(const Robot& robot) {
    for (const Link& link : robot.links()) {
      std::vector<PlacedSolid>& of_link = of_links_.emplace_back();
      for (const CollisionShape& shape : link.collision) {
        of_link.push_back({link_solid(robot, shape), shape.link_from_shape});
      }
    }
  }

  /// As shape_distance(), but not how deep hulls are in each other.
  static double distance(const ConvexShape& a, const Eigen::Isometry3d& world_from_a,
                         const ConvexShape& b, const Eigen::Isometry3d& world_from_b) {
    const auto is_hull = [](const ConvexShape& s) { return s.type() == ConvexShape::Type::kHull; };
    if (!is_hull(a) && !is_hull(b))
      return shape_distance(a, world_from_a, b, world_from_b).distance;
    const auto support = [](const ConvexShape& shape, const Eigen::Isometry3d& pose) {
      return [&shape, &pose](const Eigen::Vector3d& n) -> Eigen::Vector3d {
        return pose * shape.support(pose.linear().transpose() * n);
      };
    };
    Eigen::Vector3d between = world_from_a * a.center() - world_from_b * b.center();
    if (between.norm() < 1e-9) between = Eigen::Vector3d::UnitX();
    const GjkResult gjk =
        gjk_distance(support(a, world_from_a), support(b, world_from_b), between, kNear_m);
    return gjk.distance > 0.0 ? gjk.distance : -1.0;
  }

  /// How far apart two links are, at most `most`; below 0 where they overlap.
  double gap(const RobotState& state, int first, int second, double most) const {
    double least = most;
    for (const PlacedSolid& a : of_links_[static_cast<std::size_t>(first)]) {
      const Eigen::Isometry3d world_from_a = state.world_from_link(first) * a.link_from_shape;
      const Eigen::Vector3d centre = world_from_a * a.shape.center();
      for (const PlacedSolid& b : of_links_[static_cast<std::size_t>(second)]) {
        const Eigen::Isometry3d world_from_b = state.world_from_link(second) * b.link_from_shape;
        const double reach = a.shape.bounding_radius() + b.shape.bounding_radius() + most;
        if ((world_from_b * b.shape.center() - centre).squaredNorm() >= reach * reach) continue;
        if (capsule_distance(a.shape, world_from_a, b.shape, world_from_b) >= least) continue;
        least = std::min(least, distance(a.shape, world_from_a, b.shape, world_from_b));
        if (least < 0.0) return least;
      }
    }
    return least;
  }

 private:
  std::vector<std::vector<PlacedSolid>> of_links_;
};

}  // namespace

LinkPairs sample_link_pairs(const Robot& robot, const LinkPairOptions& options) {
  if (options.samples < 1) {
    throw Error(std::to_string(options.samples) + " samples", "one or more");
  }
  const Solids solids(robot);
  LinkPairs found{options.samples, movable_pairs(robot)};
  if (!options.only.empty()) {
    std::erase_if(found.pairs, [&](const LinkPair& pair) {
      return std::ranges::find(options.only, std::pair(pair.first, pair.second)) ==
             options.only.end();
    });
  }
  std::vector<std::size_t> counted(found.pairs.size());
  std::iota(counted.begin(), counted.end(), std::size_t{0});
  std::mutex mutex;
  ThreadPool threads(options.threads);
  const int chunks = (options.samples + kSamplesPerChunk - 1) / kSamplesPerChunk;
  const int at_once = options.stop_when_decided ? std::max(1, chunks / kDecisions) : chunks;
  for (int begin = 0; begin < chunks; begin += at_once) {
    threads.run(std::min(at_once, chunks - begin), [&](int part) {
      const int chunk = begin + part;
      std::seed_seq seed{static_cast<std::uint32_t>(options.seed),
                         static_cast<std::uint32_t>(options.seed >> 32),
                         static_cast<std::uint32_t>(chunk)};
      std::mt19937_64 random(seed);
      RobotState state(robot);
      std::vector<int> meets(counted.size(), 0), near(counted.size(), 0);
      const int last = std::min(options.samples, (chunk + 1) * kSamplesPerChunk);
      for (int sample = chunk * kSamplesPerChunk; sample < last; ++sample) {
        state.update(random_posture(robot, random).data());
        for (std::size_t p = 0; p < counted.size(); ++p) {
          const LinkPair& pair = found.pairs[counted[p]];
          const double gap_m = solids.gap(state, pair.first, pair.second, options.near_m);
          meets[p] += gap_m < 0.0 ? 1 : 0;
          near[p] += gap_m < options.near_m ? 1 : 0;
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t p = 0; p < counted.size(); ++p) {
        found.pairs[counted[p]].meets += meets[p];
        found.pairs[counted[p]].near += near[p];
      }
    });
    if (!options.stop_when_decided) continue;
    const int drawn = std::min(options.samples, (begin + at_once) * kSamplesPerChunk);
    std::erase_if(counted, [&](std::size_t p) {
      const LinkPair& pair = found.pairs[p];
      return std::max(pair.meets, pair.near) > 0 && drawn - pair.meets > 0.1 * options.samples;
    });
  }
  return found;
}

std::vector<std::pair<int, int>> overlapping_links(const Robot& robot,
                                                   const Eigen::VectorXd& configuration,
                                                   double within_m) {
  const Solids solids(robot);
  RobotState state(robot);
  state.update(configuration.data());
  std::vector<std::pair<int, int>> overlapping;
  for (const auto& [first, second] : robot.self_collision_pairs()) {
    if (solids.gap(state, first, second, within_m) < within_m)
      overlapping.emplace_back(first, second);
  }
  return overlapping;
}

}  // namespace locograph
