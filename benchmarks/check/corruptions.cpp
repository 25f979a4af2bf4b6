#include "check/corruptions.h"

#include <locograph/check/limits.h>
#include <locograph/robots/robot_state.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace locograph::test {
namespace {

using Random = std::mt19937_64;
using Eigen::Vector3d;

/// How far beyond a tolerance a lie goes.
constexpr double kBeyond = 1.5;

double uniform(Random& random, double low, double high) {
  return low + (high - low) * 0x1.0p-53 * static_cast<double>(random() >> 11);
}

std::size_t any_below(Random& random, std::size_t count) {
  return std::min(count - 1,
                  static_cast<std::size_t>(uniform(random, 0.0, 1.0) * static_cast<double>(count)));
}

Vector3d any_direction(Random& random) {
  for (;;) {
    const Vector3d v(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0),
                     uniform(random, -1.0, 1.0));
    const double length = v.norm();
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

std::size_t vertices(const Honest& honest) { return honest.motion.configurations.size(); }

/// The balance programme is what takes longest; few lies need it.
Lie lie_about(const Honest& honest, std::vector<std::string> breaks, bool balance = false) {
  Lie lie{honest.motion, std::nullopt, honest.options, std::move(breaks)};
  lie.options.certify_only_if_rest_holds = !balance;
  return lie;
}

const Stance& stance_at(const Motion& motion, std::size_t vertex) {
  return motion.stances[static_cast<std::size_t>(motion.stance_from[vertex])];
}

bool has_wheels(const Honest& honest) {
  for (const Stance& stance : honest.motion.stances)
    for (const Contact& contact : stance.contacts)
      if (contact.effector.kind == ContactKind::kWheel) return true;
  return false;
}

bool is_ball(const EndEffector& effector) {
  return effector.kind == ContactKind::kPoint && effector.radius_m > 0.0;
}

/// A contact that does not roll, at a vertex; null: there is none.
const Contact* held_contact(const Motion& motion, std::size_t vertex, Random& random) {
  std::vector<const Contact*> held;
  for (const Contact& contact : stance_at(motion, vertex).contacts)
    if (contact.effector.kind != ContactKind::kWheel && !is_ball(contact.effector))
      held.push_back(&contact);
  return held.empty() ? nullptr : held[any_below(random, held.size())];
}

/// How far a contact is from its place at a vertex; of what rolls, along its normal.
Vector3d open_by(const Honest& honest, std::size_t vertex, const Contact& contact) {
  RobotState state(*honest.robot);
  Eigen::VectorXd q = honest.motion.configurations[vertex];
  q.segment<4>(3).normalize();
  state.update(q.data());
  const EndEffector& effector = contact.effector;
  const int link = honest.robot->link_index(effector.link);
  const Vector3d normal = contact.normal.normalized();
  Vector3d at = state.world_from_link(link) * effector.point;
  if (effector.kind == ContactKind::kPoint) at -= effector.radius_m * normal;
  if (is_ball(effector)) return normal * normal.dot(at - contact.position);
  if (effector.kind != ContactKind::kWheel) return at - contact.position;
  const Vector3d axle = state.world_from_link(link).linear() *
                        honest.robot
                            ->joints()[static_cast<std::size_t>(
                                honest.robot->links()[static_cast<std::size_t>(link)].parent_joint)]
                            .axis;
  at -= effector.radius_m * (normal - axle * axle.dot(normal)).normalized();
  return normal * normal.dot(at - contact.position);
}

/// The way of the base along the motion.
double way_m(const Motion& motion) {
  double way = 0.0;
  for (std::size_t i = 1; i < motion.configurations.size(); ++i)
    way += (motion.configurations[i].head<3>() - motion.configurations[i - 1].head<3>()).norm();
  return way;
}

// The place of the robot ------------------------------------------------------------------------

std::optional<Lie> shift_base(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"contact_position"});
  const std::size_t vertex = any_below(random, vertices(honest));
  const Contact* held = held_contact(honest.motion, vertex, random);
  const Contact& contact =
      held != nullptr ? *held : stance_at(honest.motion, vertex).contacts.front();
  const Vector3d direction = held != nullptr ? any_direction(random) : contact.normal.normalized();
  lie.motion.configurations[vertex].head<3>() +=
      kBeyond * limits::kClosed_m * direction - open_by(honest, vertex, contact);
  return lie;
}

std::optional<Lie> tilt_base(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"contact_orientation", "contact_position"});
  Eigen::VectorXd& q = lie.motion.configurations[any_below(random, vertices(honest))];
  const double heading = uniform(random, -EIGEN_PI, EIGEN_PI);
  // An honest contact may be off by the whole tolerance the other way.
  const Eigen::AngleAxisd tilt((1.0 + kBeyond) * limits::kClosed_rad,
                               Vector3d(std::cos(heading), std::sin(heading), 0.0));
  q.segment<4>(3) =
      (Eigen::Quaterniond(tilt) * Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(3)))).coeffs();
  return lie;
}

std::optional<Lie> jump(const Honest& honest, Random& random) {
  if (vertices(honest) < 2) return std::nullopt;
  Lie lie = lie_about(honest, {"contact_position", "lateral_slip", "longitudinal_slip",
                               "contact_motion", "step_size"});
  const std::size_t from = 1 + any_below(random, vertices(honest) - 1);
  const double heading = uniform(random, -EIGEN_PI, EIGEN_PI);
  const Vector3d far =
      uniform(random, 0.05, 100.0) * Vector3d(std::cos(heading), std::sin(heading), 0.0);
  for (std::size_t i = from; i < vertices(honest); ++i)
    lie.motion.configurations[i].head<3>() += far;
  return lie;
}

std::optional<Lie> float_in_the_air(const Honest& honest, Random& random) {
  if (honest.world.surfaces.empty()) return std::nullopt;
  Lie lie = lie_about(honest, {"contact_on_surface", "contact_claims"});
  const double up = random() % 2 == 0 ? kBeyond * limits::kClosed_m : uniform(random, 0.001, 50.0);
  for (Eigen::VectorXd& q : lie.motion.configurations) q[2] += up;
  for (Stance& stance : lie.motion.stances)
    for (Contact& contact : stance.contacts) contact.position.z() += up;
  return lie;
}

std::optional<Lie> beyond_joint_limit(const Honest& honest, Random& random) {
  std::vector<int> limited;
  for (int i = 0; i < honest.robot->active_joint_count(); ++i)
    if (std::isfinite(honest.robot->active_joint(i).upper)) limited.push_back(i);
  if (limited.empty()) return std::nullopt;
  Lie lie = lie_about(honest, {"joint_limits"});
  const int i = limited[any_below(random, limited.size())];
  const Joint& joint = honest.robot->active_joint(i);
  const double beyond = kBeyond * honest.options.joint_tolerance_rad;
  lie.motion.configurations[any_below(random, vertices(honest))]
                           [honest.robot->base_configuration_size() + i] =
      random() % 2 == 0 ? joint.upper + beyond : joint.lower - beyond;
  return lie;
}

std::optional<Lie> into_itself(const Honest& honest, Random& random) {
  const Judge judge(honest.robot, World{});
  RobotState state(*honest.robot);
  const std::size_t vertex = any_below(random, vertices(honest));
  for (int tries = 0; tries < 20; ++tries) {
    const int i = static_cast<int>(
        any_below(random, static_cast<std::size_t>(honest.robot->active_joint_count())));
    const Joint& joint = honest.robot->active_joint(i);
    if (!std::isfinite(joint.upper)) continue;
    Eigen::VectorXd q = honest.motion.configurations[vertex];
    q[honest.robot->base_configuration_size() + i] = uniform(random, joint.lower, joint.upper);
    state.update(q.data());
    if (judge.self_distance_m(state) > -1e-3) continue;
    Lie lie = lie_about(honest, {"self_collision"});
    lie.motion.configurations[vertex] = q;
    return lie;
  }
  return std::nullopt;
}

std::optional<Lie> quaternion_stretched(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"base_orientation"});
  lie.motion.configurations[any_below(random, vertices(honest))].segment<4>(3) *=
      1.0 + (1.0 + kBeyond) * honest.options.quaternion_tolerance;
  return lie;
}

std::optional<Lie> no_number(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"not_finite"});
  Eigen::VectorXd& q = lie.motion.configurations[any_below(random, vertices(honest))];
  q[static_cast<Eigen::Index>(any_below(random, static_cast<std::size_t>(q.size())))] =
      random() % 2 == 0 ? std::numeric_limits<double>::quiet_NaN()
                        : std::numeric_limits<double>::infinity();
  return lie;
}

// What it stands on -----------------------------------------------------------------------------

std::optional<Lie> slide_contact(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"contact_position"});
  const std::size_t vertex = any_below(random, vertices(honest));
  const Contact* held = held_contact(honest.motion, vertex, random);
  if (held == nullptr) return std::nullopt;
  Stance& stance = lie.motion.stances[static_cast<std::size_t>(honest.motion.stance_from[vertex])];
  for (Contact& contact : stance.contacts)
    if (contact.name() == held->name())
      contact.position +=
          open_by(honest, vertex, contact) + kBeyond * limits::kClosed_m * any_direction(random);
  return lie;
}

/// The robot goes sideways a little with every step, and so do the places of its contacts.
std::optional<Lie> slide_and_relabel(const Honest& honest, Random& random) {
  if (vertices(honest) < 2 || has_wheels(honest)) return std::nullopt;
  Lie lie = lie_about(honest, {"contact_relabelled", "contact_motion"});
  const double heading = uniform(random, -EIGEN_PI, EIGEN_PI);
  const Vector3d step = kBeyond * limits::kHeld_m / static_cast<double>(vertices(honest) - 1) *
                        Vector3d(std::cos(heading), std::sin(heading), 0.0);
  lie.motion.stances.clear();
  for (std::size_t i = 0; i < vertices(honest); ++i) {
    const Vector3d moved = static_cast<double>(i) * step;
    lie.motion.configurations[i].head<3>() += moved;
    lie.motion.stances.push_back(stance_at(honest.motion, i));
    for (Contact& contact : lie.motion.stances.back().contacts) contact.position += moved;
    lie.motion.stance_from[i] = static_cast<int>(i);
  }
  return lie;
}

std::optional<Lie> no_stance(const Honest& honest, Random& random) {
  Lie lie = lie_about(honest, {"stance"});
  if (random() % 4 == 0) {
    lie.motion.stance_from.clear();
  } else {
    lie.motion.stance_from[any_below(random, vertices(honest))] = -1;
  }
  return lie;
}

/// All contacts but the one farthest from the centre of mass.
std::optional<Lie> drop_contacts(const Honest& honest, Random&) {
  RobotState state(*honest.robot);
  state.update(honest.motion.configurations.front().data());
  const Vector3d com = state.center_of_mass();
  const auto far = [&](const Contact& contact) {
    const Eigen::Isometry3d& pose =
        state.world_from_link(honest.robot->link_index(contact.effector.link));
    const Vector3d apart = pose * contact.effector.point - com;
    return std::hypot(apart.x(), apart.y()) -
           std::hypot(contact.effector.half_x_m, contact.effector.half_y_m);
  };
  Lie lie = lie_about(honest, {"static_balance"}, true);
  Stance& stance = lie.motion.stances[static_cast<std::size_t>(honest.motion.stance_from.front())];
  const Contact farthest =
      *std::max_element(stance.contacts.begin(), stance.contacts.end(),
                        [&](const Contact& a, const Contact& b) { return far(a) < far(b); });
  // A rung holds a moment; a contact that is not upright needs a second one anyway.
  if (farthest.effector.kind == ContactKind::kGrasp || far(farthest) < 0.01) return std::nullopt;
  stance.contacts = {farthest};
  stance.contacts.front().bears_load = true;
  return lie;
}

std::optional<Lie> claim(const Honest& honest, Random& random,
                         bool (*change)(EndEffector& effector)) {
  if (honest.options.known.empty()) return std::nullopt;
  Lie lie = lie_about(honest, {"contact_claims"});
  Stance& stance = lie.motion.stances[any_below(random, lie.motion.stances.size())];
  const auto used = [&](int s) { return s == static_cast<int>(&stance - &lie.motion.stances[0]); };
  if (std::none_of(lie.motion.stance_from.begin(), lie.motion.stance_from.end(), used))
    return std::nullopt;
  Contact& contact = stance.contacts[any_below(random, stance.contacts.size())];
  if (!change(contact.effector)) return std::nullopt;
  return lie;
}

std::optional<Lie> larger_sole(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    effector.half_x_m *= kBeyond;
    return effector.kind == ContactKind::kSurface;
  });
}
std::optional<Lie> more_friction(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    effector.friction *= kBeyond;
    return effector.kind != ContactKind::kGrasp;
  });
}
std::optional<Lie> more_force(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    effector.max_force_N *= kBeyond;
    return true;
  });
}
std::optional<Lie> another_kind(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    if (effector.kind == ContactKind::kPoint || effector.kind == ContactKind::kWheel) return false;
    effector.kind = ContactKind::kPoint;
    return true;
  });
}
std::optional<Lie> another_name(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    effector.name += "_other";
    return true;
  });
}
std::optional<Lie> larger_wheel(const Honest& honest, Random& random) {
  return claim(honest, random, [](EndEffector& effector) {
    effector.radius_m += kBeyond * limits::kClosed_m;
    return effector.kind == ContactKind::kWheel;
  });
}

// Wheels ----------------------------------------------------------------------------------------

/// Along and across the way in fine steps: more than a wheel may slip in total.
std::optional<Lie> slip(const Honest& honest, Random& random, bool lateral) {
  if (vertices(honest) < 2 || !has_wheels(honest)) return std::nullopt;
  Lie lie = lie_about(honest, {lateral ? "lateral_slip" : "longitudinal_slip"});
  const Vector3d heading =
      (honest.motion.configurations[1].head<3>() - honest.motion.configurations[0].head<3>());
  if (heading.norm() < 1e-6) return std::nullopt;
  const Vector3d along = heading.normalized();
  const Vector3d direction = lateral ? Vector3d::UnitZ().cross(along) : along;
  const double total = kBeyond * (limits::kSlip_m + limits::kSlipShare * way_m(honest.motion));
  const double sign = random() % 2 == 0 ? 1.0 : -1.0;
  // Evenly all the way along, or within the first step.
  const bool at_once = random() % 2 == 0;
  for (std::size_t i = 1; i < vertices(honest); ++i) {
    const double part =
        at_once ? 1.0 : static_cast<double>(i) / static_cast<double>(vertices(honest) - 1);
    lie.motion.configurations[i].head<3>() += sign * part * total * direction;
  }
  return lie;
}
std::optional<Lie> slip_sideways(const Honest& honest, Random& random) {
  return slip(honest, random, true);
}
std::optional<Lie> slip_forward(const Honest& honest, Random& random) {
  return slip(honest, random, false);
}

std::optional<Lie> block_a_wheel(const Honest& honest, Random& random) {
  if (vertices(honest) < 2 || !has_wheels(honest) || way_m(honest.motion) < 0.02)
    return std::nullopt;
  std::vector<int> joints;
  for (const Contact& contact : honest.motion.stances.front().contacts) {
    if (contact.effector.kind != ContactKind::kWheel) continue;
    const Link& link =
        honest.robot
            ->links()[static_cast<std::size_t>(honest.robot->link_index(contact.effector.link))];
    const int joint = honest.robot->joints()[static_cast<std::size_t>(link.parent_joint)].index;
    if (joint >= 0) joints.push_back(honest.robot->base_configuration_size() + joint);
  }
  if (joints.empty()) return std::nullopt;
  Lie lie = lie_about(honest, {"longitudinal_slip"});
  const int joint = joints[any_below(random, joints.size())];
  for (Eigen::VectorXd& q : lie.motion.configurations)
    q[joint] = honest.motion.configurations.front()[joint];
  return lie;
}

/// From some vertex on, the joint that carries a ball's link is turned: as little as its skin slips
/// by too much.
std::optional<Lie> slide_a_ball(const Honest& honest, Random& random) {
  if (vertices(honest) < 2) return std::nullopt;
  const std::size_t from = 1 + any_below(random, vertices(honest) - 1);
  const Stance& before = stance_at(honest.motion, from - 1);
  const auto ball = std::ranges::find_if(
      before.contacts, [](const Contact& contact) { return is_ball(contact.effector); });
  if (ball == before.contacts.end()) return std::nullopt;
  const int link = honest.robot->link_index(ball->effector.link);
  const std::vector<int> support(honest.robot->support(link).begin(),
                                 honest.robot->support(link).end());
  if (support.empty()) return std::nullopt;
  RobotState state(*honest.robot);
  state.update(honest.motion.configurations[from].data());
  const Vector3d normal = ball->normal.normalized();
  const Vector3d touching =
      state.world_from_link(link) * ball->effector.point - ball->effector.radius_m * normal;
  const Vector3d moves =
      state.joint_axis(support.back()).cross(touching - state.joint_origin(support.back()));
  const double slides = (moves - normal * normal.dot(moves)).norm();
  if (slides < 0.02) return std::nullopt;
  Lie lie = lie_about(honest, {"contact_motion"});
  const int joint = honest.robot->axes()[static_cast<std::size_t>(support.back())].active;
  for (std::size_t i = from; i < vertices(honest); ++i)
    lie.motion.configurations[i][7 + joint] += 2.0 * kBeyond * limits::kHeld_m / slides;
  return lie;
}

std::optional<Lie> call_a_wheel_locked(const Honest& honest, Random& random) {
  if (vertices(honest) < 2 || !has_wheels(honest) || way_m(honest.motion) < 0.02)
    return std::nullopt;
  Lie lie = lie_about(honest, {"contact_turn", "contact_motion"});
  std::vector<Contact>& contacts = lie.motion.stances.front().contacts;
  Contact& wheel = contacts[any_below(random, contacts.size())];
  if (wheel.effector.kind != ContactKind::kWheel) return std::nullopt;
  wheel.locked = true;
  return lie;
}

// Time ------------------------------------------------------------------------------------------

/// The same way in another time.
void compress(Motion& motion, double factor) {
  for (double& time : motion.time_s) time *= factor;
  for (Eigen::VectorXd& slope : motion.slopes) slope /= factor;
}

bool moves(const Honest& honest) { return vertices(honest) > 1 && !honest.motion.stances_only; }

std::optional<Lie> compress_time(const Honest& honest, Random&) {
  if (vertices(honest) < 2 || honest.motion.stances_only) return std::nullopt;
  double fastest = 0.0;
  const Robot& robot = *honest.robot;
  Eigen::VectorXd step(robot.tangent_size());
  for (std::size_t i = 0; i + 1 < vertices(honest); ++i) {
    robot.difference(honest.motion.configurations[i].data(),
                     honest.motion.configurations[i + 1].data(), step.data());
    const double duration = honest.motion.time_s[i + 1] - honest.motion.time_s[i];
    for (int k = 0; k < robot.active_joint_count(); ++k) {
      const double limit = robot.active_joint(k).max_velocity;
      if (!std::isfinite(limit) || limit <= 0.0) continue;
      fastest = std::max(fastest, std::abs(step[robot.base_tangent_size() + k]) / duration / limit);
    }
  }
  if (fastest < 1e-9) return std::nullopt;
  Lie lie = lie_about(honest, {"velocity_limits"});
  compress(lie.motion, fastest / kBeyond);
  return lie;
}

std::optional<Lie> hurry_the_base(const Honest& honest, Random&) {
  const double limit = honest.options.base_linear_m_s;
  if (vertices(honest) < 2 || !(limit > 0.0) || way_m(honest.motion) < 0.01) return std::nullopt;
  double fastest = 0.0;
  for (std::size_t i = 1; i < vertices(honest); ++i)
    fastest = std::max(fastest, (honest.motion.configurations[i].head<3>() -
                                 honest.motion.configurations[i - 1].head<3>())
                                        .norm() /
                                    (honest.motion.time_s[i] - honest.motion.time_s[i - 1]));
  Lie lie = lie_about(honest, {"base_velocity"});
  compress(lie.motion, fastest / (kBeyond * limit));
  return lie;
}

std::optional<Lie> turn_back_time(const Honest& honest, Random& random) {
  if (vertices(honest) < 2 || honest.motion.stances_only) return std::nullopt;
  Lie lie = lie_about(honest, {"time_order"});
  const std::size_t i = any_below(random, vertices(honest) - 1);
  std::swap(lie.motion.time_s[i], lie.motion.time_s[i + 1]);
  return lie;
}

// What is in the way ----------------------------------------------------------------------------

/// A plate of 2 mm where a link is on the way from one vertex to the next, across that way.
std::optional<Lie> thin_obstacle(const Honest& honest, Random& random) {
  const Robot& robot = *honest.robot;
  std::vector<int> links;
  const std::size_t vertex = any_below(random, vertices(honest));
  const std::vector<bool> touching =
      touching_links(robot, stance_at(honest.motion, vertex).contacts);
  for (std::size_t i = 0; i < robot.links().size(); ++i)
    if (!robot.links()[i].collision.empty() && !touching[i]) links.push_back(static_cast<int>(i));
  if (links.empty()) return std::nullopt;
  const Link& link =
      robot.links()[static_cast<std::size_t>(links[any_below(random, links.size())])];
  const CollisionShape& shape = link.collision[any_below(random, link.collision.size())];
  if (shape.type == ShapeType::kMesh) return std::nullopt;  // its frame may be outside of it
  Eigen::VectorXd q = honest.motion.configurations[vertex];
  Vector3d across = any_direction(random);
  if (vertex + 1 < vertices(honest)) {
    const Eigen::VectorXd& next = honest.motion.configurations[vertex + 1];
    MotionCurve(robot, honest.motion).step(static_cast<int>(vertex)).configuration(0.5, q);
    const Vector3d way = next.head<3>() - honest.motion.configurations[vertex].head<3>();
    if (way.norm() > 1e-3) across = way.normalized();
  }
  RobotState state(robot);
  q.segment<4>(3).normalize();
  state.update(q.data());
  Obstacle plate;
  plate.name = "plate";
  plate.size = {0.002, 0.05, 0.05};
  plate.world_from_obstacle = state.world_from_link(shape.link) * shape.link_from_shape;
  plate.world_from_obstacle.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), across).toRotationMatrix();
  Lie lie = lie_about(honest, {"obstacle_distance"});
  lie.world = honest.world;
  lie.world->obstacles.push_back(plate);
  return lie;
}

/// Something comes where the robot stands at the end.
std::optional<Lie> obstacle_afterwards(const Honest& honest, Random& random) {
  std::optional<Lie> lie = thin_obstacle(honest, random);
  if (!lie || vertices(honest) > 1) return std::nullopt;
  Obstacle& plate = lie->world->obstacles.back();
  const KeyFrame arrives{honest.motion.time_s.back() + 5.0, plate.world_from_obstacle};
  plate.world_from_obstacle.translation().z() += 20.0;
  plate.motion = {arrives};
  lie->options.until_s = arrives.time_s + 1.0;
  return lie;
}

// What lies between the vertices, before and after them ------------------------------------------

/// The curve is faster at a vertex than a joint may be; the vertices are the same.
std::optional<Lie> dash_between(const Honest& honest, Random& random) {
  if (!moves(honest) || vertices(honest) < 3) return std::nullopt;
  const Robot& robot = *honest.robot;
  std::vector<int> limited;
  for (int i = 0; i < robot.active_joint_count(); ++i)
    if (std::isfinite(robot.active_joint(i).max_velocity)) limited.push_back(i);
  if (limited.empty()) return std::nullopt;
  Lie lie = lie_about(honest, {"velocity_limits"});
  const MotionCurve curve(robot, honest.motion);
  lie.motion = part_of(curve, 0, static_cast<int>(vertices(honest)) - 1);
  const int joint = limited[any_below(random, limited.size())];
  lie.motion
      .slopes[1 + any_below(random, vertices(honest) - 2)][robot.base_tangent_size() + joint] =
      kBeyond * robot.active_joint(joint).max_velocity;
  return lie;
}

/// A joint swings beyond its limit between two vertices that are within.
std::optional<Lie> swing_beyond_limit(const Honest& honest, Random& random) {
  if (!moves(honest)) return std::nullopt;
  const Robot& robot = *honest.robot;
  const MotionCurve curve(robot, honest.motion);
  const std::size_t i = any_below(random, vertices(honest) - 1);
  const double h = honest.motion.time_s[i + 1] - honest.motion.time_s[i];
  for (int tries = 0; tries < 20; ++tries) {
    const int k =
        static_cast<int>(any_below(random, static_cast<std::size_t>(robot.active_joint_count())));
    const Joint& joint = robot.active_joint(k);
    if (joint.type == JointType::kContinuous || !std::isfinite(joint.upper)) continue;
    Lie lie = lie_about(honest, {"joint_limits"});
    lie.motion = part_of(curve, 0, static_cast<int>(vertices(honest)) - 1);
    const int at = robot.base_configuration_size() + k, slope = robot.base_tangent_size() + k;
    const double room = joint.upper - honest.motion.configurations[i][at];
    // Half-way the slopes m and -m lift it by m h / 4.
    const double m = 4.0 * (room + 0.01) / h;
    lie.motion.slopes[i][slope] = m;
    lie.motion.slopes[i + 1][slope] = -m;
    const double below =
        honest.motion.configurations[i + 1][at] - honest.motion.configurations[i][at];
    if (below < -0.01) continue;
    return lie;
  }
  return std::nullopt;
}

/// The motion stops being told while the robot is on its way.
std::optional<Lie> end_on_the_way(const Honest& honest, Random& random) {
  if (!moves(honest) || vertices(honest) < 3) return std::nullopt;
  const MotionCurve curve(*honest.robot, honest.motion);
  const int last = 1 + static_cast<int>(any_below(random, vertices(honest) - 2));
  if (curve.slope(last).lpNorm<Eigen::Infinity>() < kBeyond * limits::kAtRest) return std::nullopt;
  Lie lie = lie_about(honest, {"end_at_rest"});
  lie.motion = random() % 2 == 0 ? part_of(curve, 0, last)
                                 : part_of(curve, last, static_cast<int>(vertices(honest)) - 1);
  return lie;
}

std::optional<Lie> begin_before_time(const Honest& honest, Random& random) {
  if (!moves(honest)) return std::nullopt;
  Lie lie = lie_about(honest, {"time_order"});
  const double earlier_s = honest.motion.time_s.front() + uniform(random, 0.01, 100.0);
  for (double& time : lie.motion.time_s) time -= earlier_s;
  return lie;
}

/// Something passes through the robot before the plan begins.
std::optional<Lie> obstacle_before(const Honest& honest, Random& random) {
  if (!moves(honest)) return std::nullopt;
  Honest parked = honest;
  parked.motion = {};
  parked.motion.time_s = {0.0};
  parked.motion.configurations = {honest.motion.configurations.front()};
  parked.motion.stances = honest.motion.stances;
  parked.motion.stance_from = {honest.motion.stance_from.front()};
  std::optional<Lie> lie = thin_obstacle(parked, random);
  if (!lie) return std::nullopt;
  Obstacle& plate = lie->world->obstacles.back();
  const KeyFrame there{5.0, plate.world_from_obstacle};
  plate.world_from_obstacle.translation().z() += 20.0;
  plate.motion = {there, {10.0, plate.world_from_obstacle}};
  lie->motion = honest.motion;
  for (double& time : lie->motion.time_s) time += 1000.0;
  return lie;
}

/// A slab of some millimetres lies on what a contact touches.
std::optional<Lie> stand_in_a_slab(const Honest& honest, Random& random) {
  const std::size_t vertex = any_below(random, vertices(honest));
  const std::vector<Contact>& contacts = stance_at(honest.motion, vertex).contacts;
  const Contact& contact = contacts[any_below(random, contacts.size())];
  if (contact.effector.kind == ContactKind::kGrasp) return std::nullopt;
  const Link& link =
      honest.robot
          ->links()[static_cast<std::size_t>(honest.robot->link_index(contact.effector.link))];
  if (link.collision.empty()) return std::nullopt;
  Eigen::VectorXd q = honest.motion.configurations[vertex];
  q.segment<4>(3).normalize();
  RobotState state(*honest.robot);
  state.update(q.data());
  const Vector3d normal = contact.normal.normalized();
  Vector3d at = contact.position;
  if (contact.effector.kind == ContactKind::kWheel) {
    at = state.world_from_link(honest.robot->link_index(contact.effector.link)) *
         contact.effector.point;
    at -= normal * normal.dot(at - contact.position);
  }
  Lie lie = lie_about(honest, {"obstacle_distance"});
  lie.world = honest.world;
  Obstacle slab;
  slab.name = "slab";
  const double height = uniform(random, 0.002, 0.0118);
  slab.size = {0.2, 0.2, height};
  slab.world_from_obstacle.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
  slab.world_from_obstacle.translation() = at + 0.5 * height * normal;
  lie.world->obstacles.push_back(slab);
  return lie;
}

/// The ground ends before the farthest contact does.
std::optional<Lie> ground_ends(const Honest& honest, Random& random) {
  if (honest.world.surfaces.size() != 1 || !honest.options.surfaces_known) return std::nullopt;
  const std::size_t vertex = any_below(random, vertices(honest));
  RobotState state(*honest.robot);
  Eigen::VectorXd q = honest.motion.configurations[vertex];
  state.update(q.data());
  const std::vector<Contact>& contacts = stance_at(honest.motion, vertex).contacts;
  const Contact& contact = contacts[any_below(random, contacts.size())];
  const Vector3d at = state.world_from_link(honest.robot->link_index(contact.effector.link)) *
                      contact.effector.point;
  const double size = std::hypot(contact.effector.half_x_m, contact.effector.half_y_m);
  Lie lie = lie_about(honest, {"contact_on_surface"});
  lie.world = honest.world;
  Surface& surface = lie.world->surfaces.front();
  constexpr double kHalf_m = 20.0;
  surface.half_x_m = surface.half_y_m = kHalf_m;
  surface.world_from_surface.translation().x() = at.x() + size + kHalf_m + 0.01;
  return lie;
}

}  // namespace

const std::vector<Corruption>& corruptions() {
  static const std::vector<Corruption> all = {
      {"shift_base", shift_base},
      {"tilt_base", tilt_base},
      {"jump", jump},
      {"float_in_the_air", float_in_the_air},
      {"beyond_joint_limit", beyond_joint_limit},
      {"into_itself", into_itself},
      {"quaternion_stretched", quaternion_stretched},
      {"no_number", no_number},
      {"slide_contact", slide_contact},
      {"slide_and_relabel", slide_and_relabel},
      {"no_stance", no_stance},
      {"drop_contacts", drop_contacts},
      {"larger_sole", larger_sole},
      {"more_friction", more_friction},
      {"more_force", more_force},
      {"another_kind", another_kind},
      {"another_name", another_name},
      {"larger_wheel", larger_wheel},
      {"slip_sideways", slip_sideways},
      {"slip_forward", slip_forward},
      {"block_a_wheel", block_a_wheel},
      {"slide_a_ball", slide_a_ball},
      {"call_a_wheel_locked", call_a_wheel_locked},
      {"compress_time", compress_time},
      {"hurry_the_base", hurry_the_base},
      {"turn_back_time", turn_back_time},
      {"thin_obstacle", thin_obstacle},
      {"obstacle_afterwards", obstacle_afterwards},
      {"dash_between", dash_between},
      {"swing_beyond_limit", swing_beyond_limit},
      {"end_on_the_way", end_on_the_way},
      {"begin_before_time", begin_before_time},
      {"obstacle_before", obstacle_before},
      {"stand_in_a_slab", stand_in_a_slab},
      {"ground_ends", ground_ends},
  };
  return all;
}

Verdict judge_lie(const Honest& honest, const Judge& judge, const Lie& lie) {
  std::optional<Judge> other;
  if (lie.world) other.emplace(honest.robot, *lie.world);
  const CheckReport report = (other ? *other : judge).check(lie.motion, lie.options);
  Verdict verdict;
  verdict.refused = !report.feasible;
  for (const Violation& violation : report.violations) {
    if (!violation.violated) continue;
    verdict.violated += (verdict.violated.empty() ? "" : ", ") + violation.constraint;
    verdict.by_name = verdict.by_name || std::find(lie.breaks.begin(), lie.breaks.end(),
                                                   violation.constraint) != lie.breaks.end();
  }
  return verdict;
}

}  // namespace locograph::test
