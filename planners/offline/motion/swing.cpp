#include <locograph/planners/offline/motion/swing.h>

#include <algorithm>

namespace locograph {
namespace {

/// Moves along normals take so much of a segment.
constexpr double kEnds = 0.3;

/// 0 before `begin`, 1 after `end`, smooth between.
double rise(double t, double begin, double end) {
  const double x = std::clamp((t - begin) / (end - begin), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// 0 at 0, 1 after `end`, at once: nothing grazes the ground.
double lift(double t, double end) {
  const double x = std::clamp(t / end, 0.0, 1.0);
  return x * (2.0 - x);
}

/// How far over it is, of 1.
double way_over(double t, const ArcOptions& options) {
  return options.climb_first ? rise(t, 0.35, 0.8) : rise(t, 0.15, 0.85);
}

/// Along which a contact leaves its place; zero where there is none.
Eigen::Vector3d off(const Contact* at, const Eigen::Isometry3d& link) {
  return at != nullptr ? way_off(*at, link) : Eigen::Vector3d::Zero();
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, const Eigen::Vector3d& by) {
  Eigen::Isometry3d result = pose;
  result.translation() += by;
  return result;
}

}  // namespace

/// Horizontal, from the higher of both towards the lower one; towards the robot where they lie one
/// above the other.
Eigen::Vector3d Swing::away(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
  constexpr double kAbove_m = 0.03;
  Eigen::Vector3d way = b.z() > a.z() ? a - b : b - a;
  way.z() = 0.0;
  if (way.norm() < kAbove_m) {
    way = base - 0.5 * (a + b);
    way.z() = 0.0;
  }
  return way.stableNormalized();
}

void Swing::add_places(const Robot& robot, double t, const ArcOptions& options,
                       std::vector<Contact>& places) const {
  const auto add = [&](const Contact& contact, const Eigen::Isometry3d& pose, bool with_axes) {
    places.push_back(contact_in_air(robot, contact, pose, with_axes));
  };
  if (!follows_arc(options)) {
    // Height along the normal only, and nothing in between.
    if (left != nullptr && t <= kEnds) {
      const double up = options.height_m * lift(t, kEnds);
      add(*left, moved(from, up * off(left, from)), options.with_axes);
    }
    if (reached != nullptr && t >= 1.0 - kEnds) {
      const double up = options.height_m * lift(1.0 - t, kEnds);
      add(*reached, moved(to, up * off(reached, to)), options.with_axes);
    }
    return;
  }
  Contact between = contact();
  const double over = way_over(t, options);
  const Eigen::Vector3d normal = (1.0 - over) * off(left, from) + over * off(reached, to);
  if (normal.norm() > 1e-3) between.normal = normal.normalized();
  add(between, pose(t, options), options.with_axes);
}

bool Swing::follows_arc(const ArcOptions& options) const {
  const bool both = left != nullptr && reached != nullptr;
  return !options.ends_only &&
         (both || options.climb_first || options.away_m != 0.0 || options.up_m != 0.0);
}

Eigen::Isometry3d Swing::pose(double t, const ArcOptions& options) const {
  const Eigen::Vector3d climbing = (reached != nullptr ? *reached : *left).normal.normalized();
  const Eigen::Vector3d point = contact().effector.point;
  const Eigen::Vector3d a = from * point, b = to * point;
  const double over = way_over(t, options);
  const double lifted = lift(t, 0.35), high = lift(1.0 - t, 0.35);
  // What is higher at the end is climbed first, what is lower comes down last.
  double climb = climbing.dot(b - a);
  if (!options.climb_first && climb < 0.0) climb = 0.0;
  const Eigen::Vector3d across = b - a - climb * climbing;
  const double climbed =
      climb > 0.0 ? rise(t, 0.0, options.climb_first ? 0.4 : 0.6) : rise(t, 0.6, 1.0);
  const double bulge = rise(t, 0.0, 0.35) * rise(1.0 - t, 0.0, 0.35);
  const Eigen::Vector3d at =
      a + over * across + climbed * climb * climbing +
      bulge * (options.away_m * away(a, b) + options.up_m * Eigen::Vector3d::UnitZ()) +
      options.height_m * ((1.0 - over) * lifted * off(left, from) + over * high * off(reached, to));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::Quaterniond(from.linear())
                      .slerp(over, Eigen::Quaterniond(to.linear()))
                      .toRotationMatrix();
  pose.translation() = at - pose.linear() * point;
  return pose;
}

std::vector<Swing> swings_of(SegmentSpace& space) {
  const Segment& segment = space.segment();
  std::vector<Swing> swings;
  for (const Contact& contact : segment.left) swings.emplace_back().left = &contact;
  for (const Contact& contact : segment.reached) {
    const auto found = std::find_if(swings.begin(), swings.end(), [&](const Swing& swing) {
      return swing.left != nullptr && swing.left->name() == contact.name();
    });
    if (found != swings.end()) {
      found->reached = &contact;
    } else {
      swings.emplace_back().reached = &contact;
    }
  }
  RobotState from(space.robot()), to(space.robot());
  from.update(segment.from.data());
  to.update(segment.to.data());
  for (Swing& swing : swings) {
    const Contact& contact = swing.left != nullptr ? *swing.left : *swing.reached;
    const int link = space.robot().link_index(contact.effector.link);
    swing.from = from.world_from_link(link);
    swing.to = to.world_from_link(link);
    swing.base = 0.5 * (segment.from.head<3>() + segment.to.head<3>());
  }
  return swings;
}

}  // namespace locograph
