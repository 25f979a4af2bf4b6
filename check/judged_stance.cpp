#include <locograph/check/bar_contact.h>
#include <locograph/check/judged_kind.h>
#include <locograph/check/judged_stance.h>
#include <locograph/check/limits.h>
#include <locograph/robots/kinematic_tree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace locograph {
namespace {

using Polygon = std::vector<Eigen::Vector2d>;

std::string amounts(const char* what, double claimed, double known) {
  char text[96];
  std::snprintf(text, sizeof text, " has %s %.4g, known: %.4g", what, claimed, known);
  return text;
}

constexpr double kRounding = 1e-9;

/// What a contact is other than is known; nothing if all is well.
std::string other_claim(const EndEffector& claimed, const EndEffector& known) {
  if (claimed.kind != known.kind)
    return " is a " + contact_kind_name(claimed.kind) + ", known: a " +
           contact_kind_name(known.kind);
  if (claimed.link != known.link) return " is on " + claimed.link + ", known: on " + known.link;
  const double apart = (claimed.point - known.point).norm();
  if (!(apart <= kRounding)) return amounts("a place that is off by (m)", apart, 0.0);
  if (known.kind == ContactKind::kSurface || known.kind == ContactKind::kGrasp) {
    const double turned = Eigen::Matrix3d(axes_in_link(claimed) - axes_in_link(known)).norm();
    if (!(turned <= kRounding)) return amounts("axes that are off by", turned, 0.0);
  }
  if (!(std::abs(claimed.radius_m - known.radius_m) <= kRounding))
    return amounts("radius", claimed.radius_m, known.radius_m);
  return "";
}

/// What a contact claims beyond what is known; nothing if all is well.
std::string excess_claim(const EndEffector& claimed, const EndEffector& known) {
  const auto more = [](double a, double b) { return !(a <= b * (1.0 + kRounding)); };
  if (known.kind == ContactKind::kSurface) {
    if (more(claimed.half_x_m, known.half_x_m))
      return amounts("half_x", claimed.half_x_m, known.half_x_m);
    if (more(claimed.half_y_m, known.half_y_m))
      return amounts("half_y", claimed.half_y_m, known.half_y_m);
  }
  if (known.kind != ContactKind::kGrasp && more(claimed.friction, known.friction))
    return amounts("friction", claimed.friction, known.friction);
  if (more(claimed.max_force_N, known.max_force_N))
    return amounts("max_force", claimed.max_force_N, known.max_force_N);
  if (known.kind == ContactKind::kGrasp && more(claimed.max_moment_Nm, known.max_moment_Nm))
    return amounts("max_moment", claimed.max_moment_Nm, known.max_moment_Nm);
  return "";
}

/// Up to rounding, the contact is where the other one is. A direction that only one of them holds
/// is another claim.
bool is_at(const Contact& contact, const Contact& place) {
  const auto same = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return (a - b).norm() <= kRounding;
  };
  return same(contact.position, place.position) &&
         same(contact.normal.stableNormalized(), place.normal.stableNormalized()) &&
         contact.forward.has_value() == place.forward.has_value() &&
         (!place.forward ||
          same(contact.forward->stableNormalized(), place.forward->stableNormalized()));
}

/// The part of a convex polygon where n . x <= d. Sutherland and Hodgman, Reentrant polygon
/// clipping, 1974.
Polygon clip(const Polygon& polygon, const Eigen::Vector2d& n, double d) {
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
    const double here = n.dot(from) - d, there = n.dot(to) - d;
    if (here <= 0.0) inside.push_back(from);
    if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0))
      inside.push_back(from + (to - from) * (here / (here - there)));
  }
  return inside;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * std::abs(twice);
}

const std::string& name_of(const EndEffector& effector) {
  return effector.name.empty() ? effector.link : effector.name;
}

double outside_border(const Surface& surface, const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = surface.world_from_surface.inverse() * point;
  return std::hypot(std::max(0.0, std::abs(local.x()) - surface.half_x_m),
                    std::max(0.0, std::abs(local.y()) - surface.half_y_m));
}

/// The part of the sole on a surface, in the sole's axes.
Polygon sole_on(const Surface& surface, const EndEffector& sole, const Eigen::Isometry3d& pose) {
  Polygon area = {{sole.half_x_m, sole.half_y_m},
                  {-sole.half_x_m, sole.half_y_m},
                  {-sole.half_x_m, -sole.half_y_m},
                  {sole.half_x_m, -sole.half_y_m}};
  const Eigen::Matrix3d axes = pose.linear() * axes_in_link(sole);
  const Eigen::Vector3d centre =
      surface.world_from_surface.inverse() * Eigen::Vector3d(pose * sole.point);
  const double half[] = {surface.half_x_m, surface.half_y_m};
  for (int axis = 0; axis < 2; ++axis) {
    if (std::isinf(half[axis])) continue;
    const Eigen::Vector3d out = surface.world_from_surface.linear().col(axis);
    const Eigen::Vector2d across(out.dot(axes.col(0)), out.dot(axes.col(1)));
    area = clip(area, across, half[axis] - centre[axis]);
    area = clip(area, -across, half[axis] + centre[axis]);
  }
  return area;
}

/// Something of the contact's area is over the surface, as exactly as a contact is closed.
bool is_over(const JudgedContact& contact, const Surface& surface,
             std::span<const Eigen::Isometry3d> poses) {
  const EndEffector& effector = contact.contact.effector;
  if (effector.kind != ContactKind::kSurface)
    return outside_border(surface, touching_point(contact, poses)) <= limits::kClosed_m;
  Surface wider = surface;
  wider.half_x_m += limits::kClosed_m;
  wider.half_y_m += limits::kClosed_m;
  return !sole_on(wider, effector, poses[std::size_t(contact.link)]).empty();
}

/// The body of an end effector and the bodies below it, as the fingers of a hand. The root's body
/// carries everything: it alone touches.
std::vector<int> links_of(const Robot& robot, int body) {
  const std::vector<int>& body_of = robot.tree().body_of_link;
  std::set<int> bodies = {body};
  for (const Joint& joint : robot.joints())
    if (body != 0 && body_of[std::size_t(joint.parent_link)] == body)
      bodies.insert(body_of[std::size_t(joint.child_link)]);
  std::vector<int> links;
  for (std::size_t link = 0; link < body_of.size(); ++link)
    if (bodies.contains(body_of[link])) links.push_back(int(link));
  return links;
}

void place_on_surfaces(const World& world, JudgedContact& judged) {
  for (std::size_t s = 0; s < world.surfaces.size(); ++s) {
    const Eigen::Isometry3d& pose = world.surfaces[s].world_from_surface;
    if (angle_between(judged.normal, pose.linear().col(2)) > limits::kClosed_rad) continue;
    const double off = std::abs(
        (judged.contact.position - pose.translation()).dot(Eigen::Vector3d(pose.linear().col(2))));
    judged.off_surface_m = std::min(judged.off_surface_m, off);
    if (off <= limits::kClosed_m) judged.surfaces.push_back(int(s));
  }
}

void place(const World& world, JudgedContact& judged) {
  if (!has_places(world)) return;
  judged.off_surface_m = std::numeric_limits<double>::infinity();
  if (!judged.is_grasp()) place_on_surfaces(world, judged);
  for (std::size_t b = 0; b < world.bars.size(); ++b) {
    const double off = off_bar_m(judged.contact, world.bars[b]);
    judged.off_surface_m = std::min(judged.off_surface_m, off);
    if (off <= limits::kClosed_m) judged.bars.push_back(int(b));
  }
}

/// The bar that a ball rolls round: none where it touched down on a surface.
std::optional<Bar> bar_to_roll_round(const World& world, const JudgedContact& ball) {
  const Eigen::Vector3d& place = ball.contact.position;
  if (std::ranges::any_of(ball.surfaces, [&](int s) {
        return outside_border(world.surfaces[std::size_t(s)], place) <= limits::kClosed_m;
      }))
    return std::nullopt;
  const Bar* nearest = nullptr;
  for (const int b : ball.bars) {
    const Bar& bar = world.bars[std::size_t(b)];
    if (nearest == nullptr || beyond_ends_m(bar, place) < beyond_ends_m(*nearest, place))
      nearest = &bar;
  }
  if (nearest == nullptr) return std::nullopt;
  return *nearest;
}

/// What a ball rolls round is what the world has there, whatever the contact says.
bool claims_another_bar(const World& world, const JudgedContact& judged) {
  if (!judged.contact.bar || !has_places(world)) return false;
  const double claimed_m = judged.contact.bar->radius_m;
  return std::ranges::none_of(judged.bars, [&](int b) {
    return std::abs(world.bars[std::size_t(b)].radius_m - claimed_m) <= limits::kClosed_m;
  });
}

std::string another_bar(const JudgedContact& judged) {
  char text[96];
  std::snprintf(text, sizeof text, " claims a bar of radius %.4g m, the world has %s there",
                judged.contact.bar->radius_m, judged.bars.empty() ? "none" : "another");
  return text;
}

Eigen::Vector3d centre_of(const JudgedContact& contact,
                          std::span<const Eigen::Isometry3d> world_from_link) {
  return world_from_link[std::size_t(contact.link)] * contact.contact.effector.point;
}

/// From the axis of a bar to a point, across it.
Eigen::Vector3d from_axis(const Bar& bar, const Eigen::Vector3d& point) {
  const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
  const Eigen::Vector3d off = point - bar.from;
  return off - axis * axis.dot(off);
}

/// Of what a ball is on, where it is; of all others, of the contact.
Eigen::Vector3d normal_at(const JudgedContact& contact,
                          std::span<const Eigen::Isometry3d> world_from_link) {
  if (!contact.rolls_round) return contact.normal;
  const Eigen::Vector3d out = from_axis(*contact.rolls_round, centre_of(contact, world_from_link));
  return out.norm() < 1e-9 ? contact.normal : out.normalized();
}

/// Of a ball to what it rolls on; negative: it is in it.
double height_of_ball(const JudgedContact& ball,
                      std::span<const Eigen::Isometry3d> world_from_link) {
  const Eigen::Vector3d centre = centre_of(ball, world_from_link);
  const double radius = ball.contact.effector.radius_m;
  if (!ball.rolls_round) return ball.normal.dot(centre - ball.contact.position) - radius;
  return from_axis(*ball.rolls_round, centre).norm() - ball.rolls_round->radius_m - radius;
}

}  // namespace

JudgedStance::JudgedStance(const Robot& robot, const World& world, const Stance& stance,
                           std::span<const EndEffector> known, std::span<const Contact> places) {
  require_sound_stance(robot, stance);
  const std::vector<int>& body_of = robot.tree().body_of_link;
  const auto body = [&](const std::string& link) {
    return body_of[std::size_t(robot.link_index(link))];
  };
  Stance taken = stance;
  std::set<const EndEffector*> used;
  for (Contact& contact : taken.contacts) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const EndEffector& effector) {
      return name_of(effector) == contact.name();
    });
    if (found != known.end()) {
      if (!used.insert(&*found).second) other.push_back(contact.name() + " touches twice");
      const std::string is_other = other_claim(contact.effector, *found);
      const std::string more = is_other.empty() ? excess_claim(contact.effector, *found) : "";
      if (!is_other.empty()) other.push_back(contact.name() + is_other);
      if (!more.empty()) larger.push_back(contact.name() + more);
      if (is_other.empty()) contact.effector = *found;
      continue;
    }
    // A known end effector does not become another one by another name.
    const auto alias = std::find_if(known.begin(), known.end(), [&](const EndEffector& effector) {
      return body(effector.link) == body(contact.effector.link);
    });
    if (alias != known.end())
      other.push_back(contact.name() + " is on the body that is known as " + name_of(*alias));
    else if (!known.empty())
      other.push_back(contact.name() + " is no end effector that is known");
    else
      unknown.push_back(contact.name());
  }
  if (!places.empty()) {
    for (const Contact& contact : stance.contacts) {
      if (std::none_of(places.begin(), places.end(), [&](const Contact& place) {
            return place.name() == contact.name() && is_at(contact, place);
          }))
        other.push_back(contact.name() + " is at a place that is not known");
    }
  }
  touching.assign(robot.links().size(), false);
  for (const Contact& contact : taken.contacts) {
    require_judged_kind(contact.effector);
    JudgedContact judged;
    judged.contact = contact;
    judged.link = robot.link_index(contact.effector.link);
    judged.body = robot.tree().body_of_link[std::size_t(judged.link)];
    judged.normal = contact.normal.stableNormalized();
    judged.links = links_of(robot, judged.body);
    for (const int link : judged.links) touching[std::size_t(link)] = true;
    if (judged.is_wheel()) {
      const int above = robot.links()[std::size_t(judged.link)].parent_joint;
      const Joint& joint = robot.joints()[std::size_t(above)];
      judged.axle = joint.axis;
      judged.wheel_joint = joint.index;
    }
    place(world, judged);
    if (judged.is_ball()) judged.rolls_round = bar_to_roll_round(world, judged);
    if (claims_another_bar(world, judged)) larger.push_back(contact.name() + another_bar(judged));
    contacts.push_back(std::move(judged));
  }
}

std::vector<CollisionWorld::Touch> JudgedStance::touches(
    const World& world, std::span<const Eigen::Isometry3d> poses) const {
  std::vector<CollisionWorld::Touch> touches;
  for (const JudgedContact& contact : contacts) {
    CollisionWorld::Touch touch;
    const Contact now = contact_at(contact, poses);
    touch.position = contact.is_wheel() ? touching_point(contact, poses) : now.position;
    touch.normal = now.normal.stableNormalized();
    touch.bars = contact.bars;
    touch.links = contact.links;
    std::vector<int> beside;
    for (const int s : contact.surfaces) {
      const bool under = is_over(contact, world.surfaces[std::size_t(s)], poses);
      (under ? touch.surfaces : beside).push_back(s);
    }
    const EndEffector& effector = contact.contact.effector;
    touch.reach_m = std::max(touch.reach_m, std::hypot(effector.half_x_m, effector.half_y_m));
    // A wheel touches its plane, wherever its own height is.
    if (contact.is_wheel())
      touch.position -=
          contact.normal * contact.normal.dot(touch.position - contact.contact.position);
    touches.push_back(touch);
    if (beside.empty()) continue;
    touch.surfaces = std::move(beside);
    touch.bars.clear();
    touch.barely = true;
    touches.push_back(std::move(touch));
  }
  return touches;
}

Contact contact_at(const JudgedContact& judged,
                   std::span<const Eigen::Isometry3d> world_from_link) {
  Contact contact = judged.contact;
  if (!judged.is_ball()) return contact;
  const Eigen::Vector3d down = touching_point(judged, world_from_link);
  const double height = height_of_ball(judged, world_from_link);
  const Eigen::Vector3d normal = normal_at(judged, world_from_link);
  contact.position = down - height * normal;
  if (!judged.rolls_round) return contact;
  const Bar& bar = *judged.rolls_round;
  const Eigen::Vector3d axis = (bar.to - bar.from).normalized();
  const double angle = std::atan2(axis.dot(judged.normal.cross(normal)), judged.normal.dot(normal));
  contact.forward = Eigen::AngleAxisd(angle, axis) * Eigen::Vector3d(axes_in_world(contact).col(0));
  contact.normal = normal;
  return contact;
}

Eigen::Vector3d touching_point(const JudgedContact& contact,
                               std::span<const Eigen::Isometry3d> world_from_link) {
  const Eigen::Isometry3d& pose = world_from_link[std::size_t(contact.link)];
  const EndEffector& effector = contact.contact.effector;
  const Eigen::Vector3d point = pose * effector.point;
  if (effector.kind == ContactKind::kPoint)
    return point - effector.radius_m * normal_at(contact, world_from_link);
  if (!contact.is_wheel()) return point;
  const Eigen::Vector3d axle = pose.linear() * contact.axle;
  const Eigen::Vector3d up = contact.normal - axle * axle.dot(contact.normal);
  const double length = up.norm();
  if (length < 1e-12) return point;
  return point - up * (effector.radius_m / length);
}

ContactError closure_error(const JudgedContact& judged,
                           std::span<const Eigen::Isometry3d> world_from_link) {
  const Contact& contact = judged.contact;
  const EndEffector& effector = contact.effector;
  const Eigen::Isometry3d& pose = world_from_link[std::size_t(judged.link)];
  const Eigen::Vector3d touching = touching_point(judged, world_from_link);
  if (judged.is_wheel()) {
    const double along = (pose.linear() * judged.axle).dot(judged.normal);
    const Eigen::Vector3d off = touching - contact.position;
    return {contact.locked ? off.norm() : std::abs(off.dot(judged.normal)),
            std::asin(std::min(1.0, std::abs(along)))};
  }
  if (judged.is_ball()) return {std::abs(height_of_ball(judged, world_from_link)), 0.0, false};
  ContactError error{(touching - contact.position).norm(), 0.0};
  const Eigen::Vector3d normal = pose.linear() * effector.normal;
  const Eigen::Vector3d forward = pose.linear() * effector.forward;
  switch (effector.kind) {
    case ContactKind::kSurface:
      error.angle_rad = angle_between(normal, contact.normal);
      if (!contact.forward) break;
      [[fallthrough]];
    case ContactKind::kGrasp:
      error.angle_rad =
          std::max(error.angle_rad,
                   angle_between(normal.cross(forward), contact.normal.cross(*contact.forward)));
      break;
    default:
      error.holds_direction = false;
  }
  return error;
}

Support support_of(const JudgedContact& judged, const World& world,
                   std::span<const Eigen::Isometry3d> world_from_link) {
  const EndEffector& effector = judged.contact.effector;
  const Eigen::Isometry3d& pose = world_from_link[std::size_t(judged.link)];
  Support support;
  support.known = judged.is_placed();
  support.friction = effector.friction;
  if (!support.known) return support;
  support.outside_m = std::numeric_limits<double>::infinity();
  double friction = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d point = touching_point(judged, world_from_link);
  const auto lies_on = [&](double outside, double own_friction, const Polygon& area) {
    support.outside_m = std::min(support.outside_m, outside);
    support.area.insert(support.area.end(), area.begin(), area.end());
    // A border is as exact as a contact is closed.
    if (outside > limits::kClosed_m) return;
    friction = std::min(friction, own_friction > 0.0 ? own_friction : effector.friction);
  };
  for (const int s : judged.surfaces) {
    if (judged.rolls_round) break;
    const Surface& surface = world.surfaces[std::size_t(s)];
    double outside = outside_border(surface, point);
    Polygon area;
    if (effector.kind == ContactKind::kSurface) {
      area = sole_on(surface, effector, pose);
      constexpr double kNoArea_m2 = 1e-8;
      if (!(area_of(area) > kNoArea_m2)) area.clear();
      outside = area.empty() ? std::max(outside, limits::kHeld_m) : 0.0;
    }
    lies_on(outside, surface.friction, area);
  }
  for (const int b : judged.bars) {
    const Bar& bar = world.bars[std::size_t(b)];
    // It rolls off those that cross the one that it rolls round.
    if (judged.is_ball() && (!judged.rolls_round || std::abs(from_axis(bar, point).norm() -
                                                             bar.radius_m) > limits::kHeld_m))
      continue;
    if (effector.kind == ContactKind::kSurface) {
      const SoleOnBar sole = sole_on_bar(bar, judged.contact, pose);
      lies_on(sole.outside_m, bar.friction, sole.line);
    } else {
      lies_on(beyond_ends_m(bar, point), bar.friction, {});
    }
  }
  if (std::isfinite(friction)) support.friction = friction;
  return support;
}

JudgedBearing bearing_at(const JudgedContact& judged, const World& world,
                         std::span<const Eigen::Isometry3d> world_from_link) {
  JudgedBearing bearing{contact_at(judged, world_from_link), {}};
  Support support = support_of(judged, world, world_from_link);
  bearing.area = std::move(support.area);
  if (!support.known) return bearing;
  bearing.contact.effector.friction = support.friction;
  if (support.outside_m > limits::kClosed_m) bearing.contact.bears_load = false;
  return bearing;
}

bool same_effector(const JudgedContact& a, const JudgedContact& b) {
  const EndEffector &first = a.contact.effector, &second = b.contact.effector;
  return a.link == b.link && first.kind == second.kind &&
         (first.point - second.point).norm() <= 1e-9;
}

const JudgedContact* contact_of(const JudgedStance& stance, const JudgedContact& contact) {
  const auto found = std::ranges::find_if(
      stance.contacts, [&](const JudgedContact& other) { return same_effector(contact, other); });
  return found == stance.contacts.end() ? nullptr : &*found;
}

}  // namespace locograph
