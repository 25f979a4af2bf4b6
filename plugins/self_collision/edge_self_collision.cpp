#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/self_collision/nearest_points.h>

namespace locograph {

template class TypedEdgePool<EdgeSelfCollision>;

EdgeSelfCollision::EdgeSelfCollision(const RobotParameter& robot, double margin, double weight)
    : margin_m(margin) {
  weights.setConstant(static_cast<Eigen::Index>(robot.self_collision.pairs.size()), weight);
}

namespace {

using Capsule = SelfCollisionShapes::Capsule;

struct Nearest {
  double distance;           ///< signed; where nothing is nearer, the limit that was asked for
  Eigen::Vector3d on_first;  ///< on the axes of the two capsules
  Eigen::Vector3d on_second;
  Eigen::Vector3d direction;  ///< unit, from the first to the second
};

/// Unit vector between the axes of two capsules; any normal to both where they meet.
Eigen::Vector3d direction_between(const SegmentPoints& points, const Capsule& a, const Capsule& b) {
  const Eigen::Vector3d way = points.on_second - points.on_first;
  constexpr double kMeet_m = 1e-12;
  if (const double length = way.norm(); length > kMeet_m) return way / length;
  const Eigen::Vector3d along = a.to - a.from, other = b.to - b.from;
  const Eigen::Vector3d normal = along.cross(other);
  if (normal.squaredNorm() > 1e-18) return normal.normalized();
  const Eigen::Vector3d axis = along.squaredNorm() > other.squaredNorm() ? along : other;
  if (axis.squaredNorm() < 1e-18) return Eigen::Vector3d::UnitZ();
  return axis.unitOrthogonal();
}

/// Calls f(number, pair) for the pairs with a weight whose bounds are nearer than `limit`.
template <class F>
void each_near_pair(const ConfigurationState& q, const Eigen::VectorXd& weights, double limit,
                    F&& f) {
  const SelfCollisionShapes& shapes = q.robot->self_collision;
  shapes.each_near_pair(q.bound_centres, limit, [&](int number) {
    if (weights[number] != 0.0) f(number, shapes.pairs[number]);
  });
}

/// The nearest capsules of two links that are nearer than `limit`, in the frame of the first link.
Nearest nearest(const ConfigurationState& q, const SelfCollisionShapes::Pair& pair, double limit) {
  const RobotParameter& robot = *q.robot;
  const SelfCollisionShapes& shapes = robot.self_collision;
  const RobotParameter::LinkBound& bound = robot.bounds[pair.first];
  const SelfCollisionShapes::OfBound& first = shapes.of_bound[pair.first];
  const SelfCollisionShapes::OfBound& second = shapes.of_bound[pair.second];
  const Eigen::Isometry3d& world_from_first = q.kinematics.world_from_link(bound.link);
  const Eigen::Isometry3d& world_from_second =
      q.kinematics.world_from_link(robot.bounds[pair.second].link);
  const Eigen::Matrix3d turn = world_from_first.linear().transpose() * world_from_second.linear();
  const Eigen::Vector3d shift = world_from_first.linear().transpose() *
                                (world_from_second.translation() - world_from_first.translation());

  Nearest best{limit, {}, {}, {}};
  for (int j = second.begin; j < second.end; ++j) {
    const Capsule& own = shapes.capsules[j];
    const Capsule b{turn * own.from + shift, turn * own.to + shift, own.radius};
    const Eigen::Vector3d middle = 0.5 * (b.from + b.to);
    const double half = 0.5 * (b.to - b.from).norm() + b.radius;
    if ((middle - bound.center).norm() - half - first.radius >= best.distance) continue;
    for (int i = first.begin; i < first.end; ++i) {
      const Capsule& a = shapes.capsules[i];
      // Most capsules of a covered shape are spheres, most of them far away.
      const double reach = half + a.radius + best.distance;
      if (a.from == a.to && (reach <= 0.0 || (middle - a.from).squaredNorm() >= reach * reach)) {
        continue;
      }
      const SegmentPoints points = nearest_points(a.from, a.to, b.from, b.to);
      const double distance = (points.on_second - points.on_first).norm() - a.radius - b.radius;
      if (distance >= best.distance) continue;
      best = {distance, points.on_first, points.on_second, direction_between(points, a, b)};
    }
  }
  return best;
}

/// row += d(direction · point)/dq for the axes in `support` from the `common`-th on.
void add_slope(const RobotState& kinematics, std::span<const int> support, std::size_t common,
               const Eigen::Vector3d& point, const Eigen::Vector3d& direction, double* row) {
  const Robot& robot = kinematics.robot();
  const Eigen::Vector3d moment = point.cross(direction);
  for (std::size_t k = common; k < support.size(); ++k) {
    const int i = support[k];
    const Eigen::Vector3d& along = kinematics.joint_axis(i);
    const Axis& axis = robot.axes()[static_cast<std::size_t>(i)];
    // a · ((p − o) × d) for an axis that turns, a · d for one that slides
    row[robot.base_tangent_size() + axis.active] +=
        axis.multiplier *
        (robot.joints()[static_cast<std::size_t>(axis.joint)].type == JointType::kPrismatic
             ? along.dot(direction)
             : along.dot(moment - kinematics.joint_origin(i).cross(direction)));
  }
}

/// row += scale * gradient of the distance. The nearest points move along with their links: how
/// they slide along the shapes does not matter to first order. What moves both links alike, base
/// and common axes, does not change it.
void add_gradient(const ConfigurationState& q, const SelfCollisionShapes::Pair& pair,
                  const Nearest& found, double scale, double* row) {
  const int a = q.robot->bounds[pair.first].link, b = q.robot->bounds[pair.second].link;
  const Eigen::Isometry3d& world_from_first = q.kinematics.world_from_link(a);
  const Eigen::Vector3d direction = world_from_first.linear() * (-scale * found.direction);
  const std::span<const int> first = q.model().support(a), second = q.model().support(b);
  std::size_t common = 0;
  while (common < std::min(first.size(), second.size()) && first[common] == second[common]) {
    ++common;
  }
  add_slope(q.kinematics, first, common, world_from_first * found.on_first, direction, row);
  add_slope(q.kinematics, second, common, world_from_first * found.on_second, -direction, row);
}

}  // namespace

void EdgeSelfCollision::error(const ConfigurationState& q, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), static_cast<long>(q.robot->self_collision.pairs.size()));
  e.setZero();
  each_near_pair(q, weights, margin_m, [&](int number, const SelfCollisionShapes::Pair& pair) {
    e[number] = margin_m - nearest(q, pair, margin_m).distance;
  });
}

void EdgeSelfCollision::jacobians(const ConfigurationState& q,
                                  JacobianRef<EdgeSelfCollision, 0> j) const {
  each_near_pair(q, weights, margin_m, [&](int number, const SelfCollisionShapes::Pair& pair) {
    const Nearest found = nearest(q, pair, margin_m);
    if (found.distance < margin_m) add_gradient(q, pair, found, -1.0, j.row(number).data());
  });
}

void find_near_pairs(const ConfigurationState& q, const Eigen::VectorXd& weights, double limit,
                     std::vector<NearPair>& near_pairs, std::vector<double>& gradients) {
  near_pairs.clear();
  gradients.clear();
  const std::size_t size = static_cast<std::size_t>(q.model().tangent_size());
  each_near_pair(q, weights, limit, [&](int number, const SelfCollisionShapes::Pair& pair) {
    const Nearest found = nearest(q, pair, limit);
    if (found.distance >= limit) return;
    near_pairs.push_back({number, found.distance});
    gradients.resize(gradients.size() + size, 0.0);
    add_gradient(q, pair, found, 1.0, gradients.data() + gradients.size() - size);
  });
}

RowLabel EdgeSelfCollision::row_label(int row, const VertexConfiguration& q) const {
  const SelfCollisionShapes::Pair& pair = q.robot->self_collision.pairs[row];
  const auto link = [&](int bound) {
    return q.robot->robot->links()[q.robot->bounds[bound].link].name;
  };
  return {link(pair.first) + " near " + link(pair.second), "m"};
}

}  // namespace locograph
