#include <locograph/planners/posture/transition_rows.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/plugins/surface_distance/place_rows.h>
#include <locograph/robots/kinematic_tree.h>
#include <locograph/world/bent_legs.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/link_solid.h>
#include <locograph/world/obstacle_way.h>
#include <locograph/world/proposed_effectors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace locograph {
namespace {

/// What is further away than this beyond its margin has no row: a step is too short to get there.
constexpr double kBand_m = 0.03, kBandJoint_rad = 0.5, kBandSurface_m = 0.1;
/// Between places of a moving obstacle: what lies in between is nearer by less than the margin.
constexpr double kAlong_m = 0.016;
/// An effort that is exceeded by all of itself counts as so many metres.
constexpr double kTorqueUnit_m = 0.1;
/// How much more rows of links that touch something else near a place count: their margin is as
/// much less than that of others.
constexpr double kBesideScale = 20.0;
/// Likewise of borders, which a ball may roll to.
constexpr double kBorderScale = 10.0;
constexpr double kOnPlace_m = 1e-4;
/// Links that are near each other where leave_as_near() looks keep so much of their distance.
constexpr double kOfNear = 0.8;

/// How far a point is from the border of a surface or a bar, along each of its axes, and that axis.
struct BorderRooms {
  struct Room {
    double value;
    Eigen::Vector3d inwards;
  };
  std::array<Room, 2> rooms;
  int count = 0;

  void add(double half_m, const Eigen::Vector3d& axis, double at_m) {
    if (std::isinf(half_m)) return;
    rooms[static_cast<std::size_t>(count++)] = {half_m - std::abs(at_m),
                                                at_m < 0.0 ? axis : Eigen::Vector3d(-axis)};
  }
  BorderRooms(const Surface& surface, const Eigen::Vector3d& point) {
    const Eigen::Isometry3d& pose = surface.world_from_surface;
    const Eigen::Vector3d off = point - pose.translation();
    add(surface.half_x_m, pose.linear().col(0), off.dot(pose.linear().col(0)));
    add(surface.half_y_m, pose.linear().col(1), off.dot(pose.linear().col(1)));
  }
  BorderRooms(const Bar& bar, const Eigen::Vector3d& point) {
    const Eigen::Vector3d way = 0.5 * (bar.to - bar.from), axis = way.normalized();
    add(way.norm(), axis, axis.dot(point - bar.from - way));
  }
  double least() const {
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < count; ++i) {
      least = std::min(least, rooms[static_cast<std::size_t>(i)].value);
    }
    return least;
  }
};

BorderRooms border_rooms(const TouchablePlaces& places, int place, const Eigen::Vector3d& point) {
  return places.is_surface(place) ? BorderRooms(places.surface(place), point)
                                  : BorderRooms(places.bar(place), point);
}

/// Configurations that the robot is meant for: those of its SRDF, or else as it stands by its
/// shapes.
std::vector<Eigen::VectorXd> example_configurations(const Robot& robot) {
  std::vector<Eigen::VectorXd> examples = {robot.neutral_configuration()};
  for (const std::string& name : robot.configuration_names()) {
    examples.push_back(robot.named_configuration(name));
  }
  if (examples.size() > 1 || !robot.missing_meshes().empty()) return examples;
  if (const auto effectors = proposed_effectors(robot); !effectors.empty())
    examples.push_back(bent_legs(robot, effectors));
  return examples;
}

}  // namespace

TransitionRows::TransitionRows(std::shared_ptr<const RobotParameter> robot, World world)
    : robot_(std::move(robot)),
      relations_(std::make_shared<const TouchablePlaces>(robot_, world)),
      size_(robot_->robot->tangent_size()),
      state_(robot_) {
  const Robot& model = *robot_->robot;
  if (!model.floating_base()) {
    throw Error("stances of a robot with a fixed base", "a floating base");
  }
  state_.kinematics.require_mass();
  anything_in_the_way_ = world.map || !world.obstacles.empty();
  if (anything_in_the_way_) {
    DistanceFieldOptions options;
    options.max_distance_m = 0.3;
    // What moves is in the way wherever it gets to.
    World still = world;
    still.obstacles.clear();
    for (const Obstacle& obstacle : world.obstacles) {
      const std::vector<Obstacle> along = all_along(obstacle, kAlong_m);
      still.obstacles.insert(still.obstacles.end(), along.begin(), along.end());
    }
    in_the_way_ = distance_view(still, options);
  }
  pair_weights_ =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(robot_->self_collision.pairs.size()));
  find_coarse_pairs();
}

/// Pairs whose covering capsules are too near in one of these where their exact shapes are apart
/// are compared by those shapes.
void TransitionRows::find_coarse_pairs() {
  const Robot& model = robot();
  const auto shapes_of = [&](int bound) {
    return LinkShapes(model, robot_->bounds[static_cast<std::size_t>(bound)].link);
  };
  constexpr double kTooNear_m = 5e-3;
  for (const Eigen::VectorXd& q : example_configurations(model)) {
    state_.update(q.data());
    find_near_pairs(state_, pair_weights_, kTooNear_m, near_, near_gradients_);
    for (const NearPair& found : near_) {
      const SelfCollisionShapes::Pair& pair =
          robot_->self_collision.pairs[static_cast<std::size_t>(found.pair)];
      CoarsePair coarse{found.pair, shapes_of(pair.first), shapes_of(pair.second)};
      if (exact_distance(coarse, kTooNear_m).distance < 0.0) continue;
      pair_weights_[found.pair] = 0.0;
      coarse_.push_back(std::move(coarse));
    }
  }
}

ShapeDistance TransitionRows::exact_distance(const CoarsePair& coarse, double limit) const {
  const SelfCollisionShapes::Pair& pair =
      robot_->self_collision.pairs[static_cast<std::size_t>(coarse.pair)];
  const auto pose = [&](int bound) -> const Eigen::Isometry3d& {
    return state_.kinematics.world_from_link(robot_->bounds[static_cast<std::size_t>(bound)].link);
  };
  ShapeDistance best;
  best.distance = limit;
  for (std::size_t i = 0; i < coarse.first.shapes.size(); ++i) {
    for (std::size_t j = 0; j < coarse.second.shapes.size(); ++j) {
      const ConvexShape &a = coarse.first.shapes[i], &b = coarse.second.shapes[j];
      const Eigen::Isometry3d pose_a = pose(pair.first) * coarse.first.link_from_shape[i];
      const Eigen::Isometry3d pose_b = pose(pair.second) * coarse.second.link_from_shape[j];
      const double apart = (pose_a * a.center() - pose_b * b.center()).norm();
      if (apart - a.bounding_radius() - b.bounding_radius() >= best.distance) continue;
      const ShapeDistance found = shape_distance(a, pose_a, b, pose_b);
      if (found.distance < best.distance) best = found;
    }
  }
  return best;
}

void TransitionRows::set_problem(const TransitionProblem& problem,
                                 const TransitionOptions& options) {
  options_ = options;
  balance_ = problem.balance;
  torques_ = problem.torques;
  exact_pairs_ = problem.exact_pairs;
  if (balance_ != nullptr) {
    balance_margin_m_ = std::min(options.balance_margin_m, 0.25 * balance_->width_m);
  }
  closures_.clear();
  rolling_.clear();
  contact_names_.clear();
  contact_of_row_.clear();
  contact_links_.clear();
  const std::size_t bounds = robot_->bounds.size();
  relations_.set_contacts(problem.closed, problem.held, problem.near, problem.near_m);
  relations_.set_places_known(problem.places_known);
  exempt_.assign(bounds, false);
  const auto exempt = [&](const Contact& contact) {
    const std::vector<bool> links = touching_links(robot(), {&contact, 1});
    for (std::size_t b = 0; b < bounds; ++b) {
      if (links[static_cast<std::size_t>(robot_->bounds[b].link)]) exempt_[b] = true;
    }
  };
  for (const Contact& contact : problem.closed) {
    const int number = static_cast<int>(closures_.size());
    const std::size_t k = closures_.size();
    if (k < problem.rolled_from.size() && problem.rolled_from[k]) {
      closures_.emplace_back(robot(), contact, *problem.rolled_from[k]);
      find_borders(contact);
    } else {
      closures_.emplace_back(robot(), contact);
    }
    contact_names_.push_back(contact.name());
    contact_links_.push_back(closures_.back().link());
    for (int i = 0; i < closures_.back().rows(); ++i) contact_of_row_.push_back(number);
    exempt(contact);
  }
  // TransitionProblem::near
  for (const Contact& contact : problem.near) exempt(contact);
  closure_.resize(static_cast<Eigen::Index>(contact_of_row_.size()));
}

/// Of the places that the ball of the contact touched down on, the one it is furthest inside.
void TransitionRows::find_borders(const Contact& contact) {
  const TouchablePlaces& places = relations_.places();
  double most = -kOnPlace_m;
  std::optional<int> found;
  for (const int place : places.tree().touching(box_around(contact.position, kOnPlace_m))) {
    if (places.is_solid(place) || places.is_surface(place) == contact.bar.has_value()) continue;
    if (places.is_surface(place)) {
      const Eigen::Isometry3d& pose = places.surface(place).world_from_surface;
      const Eigen::Vector3d normal = pose.linear().col(2);
      if (!(normal.dot(contact.normal) > 0.0)) continue;
      if (std::abs(normal.dot(contact.position - pose.translation())) > kOnPlace_m) continue;
    }
    const double room = border_rooms(places, place, contact.position).least();
    if (!(room > most)) continue;
    most = room;
    found = place;
  }
  if (!found) return;
  // Half as far inside as it touched down, if that is less.
  const double margin_m = std::min(options_.border_margin_m, 0.5 * std::max(0.0, most));
  rolling_.push_back(
      {static_cast<int>(closures_.size()) - 1, *found, contact.effector.point, margin_m});
}

void TransitionRows::closure_at(const Eigen::VectorXd& q, Eigen::VectorXd& error) {
  state_.kinematics.update(q.data());
  error.resize(closure_.size());
  Eigen::Index row = 0;
  for (const ContactClosure& closure : closures_) {
    closure.error(state_.kinematics, error.data() + row);
    row += closure.rows();
  }
}

void TransitionRows::evaluate(const Eigen::VectorXd& q) {
  state_.update(q.data());
  closure_jacobian_.assign(static_cast<std::size_t>(closure_.size() * size_), 0.0);
  Eigen::Index row = 0;
  for (const ContactClosure& closure : closures_) {
    closure.error(state_.kinematics, closure_.data() + row);
    closure.add_jacobian(state_.kinematics, closure_jacobian_.data() + row * size_, size_);
    row += closure.rows();
  }
  rows_.clear();
  gradients_.clear();
  add_joints();
  add_borders();
  if (balance_ != nullptr) add_balance();
  if (torques_ != nullptr) add_torques();
  add_self();
  add_places();
  if (anything_in_the_way_) add_obstacles();
}

double* TransitionRows::add(TransitionFailure kind, int first, int second, double value) {
  rows_.push_back({kind, first, second, value});
  gradients_.resize(gradients_.size() + static_cast<std::size_t>(size_), 0.0);
  return gradients_.data() + gradients_.size() - static_cast<std::size_t>(size_);
}

void TransitionRows::add_joints() {
  const int base = robot().base_tangent_size();
  for (int i = 0; i < robot().active_joint_count(); ++i) {
    const Joint& joint = robot().active_joint(i);
    const double x = state_.joint(i);
    const double margin =
        std::min(options_.joint_margin_rad, 0.25 * std::max(0.0, joint.upper - joint.lower));
    if (const double below = x - joint.lower - margin; below < kBandJoint_rad) {
      add(TransitionFailure::kJoint, i, 0, below)[base + i] = 1.0;
    }
    if (const double above = joint.upper - x - margin; above < kBandJoint_rad) {
      add(TransitionFailure::kJoint, i, 1, above)[base + i] = -1.0;
    }
  }
}

void TransitionRows::add_borders() {
  for (const RollingOn& ball : rolling_) {
    const int link = closures_[static_cast<std::size_t>(ball.closure)].link();
    const Eigen::Vector3d centre = state_.kinematics.world_from_link(link) * ball.point_in_link;
    const BorderRooms borders = border_rooms(relations_.places(), ball.place, centre);
    for (int i = 0; i < borders.count; ++i) {
      const BorderRooms::Room& room = borders.rooms[static_cast<std::size_t>(i)];
      const double value = room.value - ball.margin_m;
      if (value >= kBand_m) continue;
      double* row = add(TransitionFailure::kBorder, ball.closure, ball.place, kBorderScale * value);
      state_.kinematics.add_point_gradient(link, centre, room.inwards, kBorderScale, row);
    }
  }
}

void TransitionRows::add_balance() {
  const Eigen::Vector3d com = state_.kinematics.center_of_mass();
  for (std::size_t s = 0; s < balance_->sides.size(); ++s) {
    const BalanceRegion::Side& side = balance_->sides[s];
    const double value = side.offset_m - side.normal.dot(com.head<2>()) - balance_margin_m_;
    double* row = add(TransitionFailure::kBalance, static_cast<int>(s), 0, value);
    state_.kinematics.add_center_of_mass_gradient({side.normal.x(), side.normal.y(), 0.0}, -1.0,
                                                  row);
  }
}

void TransitionRows::add_torques() {
  const double share = torques_->solve(state_.kinematics, torque_gradient_);
  // Nothing balances here: the rows of the polygon say where to.
  if (!std::isfinite(share)) return;
  const double value = kTorqueUnit_m * (1.0 - options_.torque_margin - share);
  double* row = add(TransitionFailure::kTorque, torques_->heaviest_joint(), 0, value);
  for (int i = 0; i < size_; ++i) row[i] = -kTorqueUnit_m * torque_gradient_[i];
}

void TransitionRows::leave_as_near(const Eigen::VectorXd& q, double margin_m) {
  most_apart_m_.resize(0);
  TransitionOptions options;
  options.self_margin_m = margin_m;
  set_problem({}, options);
  evaluate(q);
  const std::vector<SelfCollisionShapes::Pair>& pairs = robot_->self_collision.pairs;
  Eigen::VectorXd most = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(pairs.size()),
                                                   std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const Row& row : rows_) {
      if (row.kind != TransitionFailure::kSelf || row.value >= 0.0) continue;
      if (row.first != pairs[i].first || row.second != pairs[i].second) continue;
      most[static_cast<Eigen::Index>(i)] =
          std::max(TransitionOptions().self_margin_m, kOfNear * (row.value + margin_m));
    }
  }
  most_apart_m_ = std::move(most);
}

double TransitionRows::self_margin_m(int pair) const {
  return most_apart_m_.size() == 0 ? options_.self_margin_m
                                   : std::min(options_.self_margin_m, most_apart_m_[pair]);
}

void TransitionRows::add_self() {
  find_near_pairs(state_, pair_weights_, options_.self_margin_m + kBand_m, near_, near_gradients_);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const SelfCollisionShapes::Pair& pair =
        robot_->self_collision.pairs[static_cast<std::size_t>(near_[i].pair)];
    double* row = add(TransitionFailure::kSelf, pair.first, pair.second,
                      near_[i].distance_m - self_margin_m(near_[i].pair));
    std::copy_n(near_gradients_.data() + i * static_cast<std::size_t>(size_), size_, row);
  }
  if (!exact_pairs_) return;
  const double limit = options_.self_margin_m + kBand_m;
  for (const CoarsePair& coarse : coarse_) {
    const SelfCollisionShapes::Pair& pair =
        robot_->self_collision.pairs[static_cast<std::size_t>(coarse.pair)];
    const Eigen::Vector3d between = state_.bound_centre(static_cast<std::size_t>(pair.first)) -
                                    state_.bound_centre(static_cast<std::size_t>(pair.second));
    if (between.norm() >= pair.reach + limit) continue;
    const int a = robot_->bounds[static_cast<std::size_t>(pair.first)].link;
    const int b = robot_->bounds[static_cast<std::size_t>(pair.second)].link;
    const ShapeDistance best = exact_distance(coarse, limit);
    if (best.distance >= limit) continue;
    Eigen::Vector3d apart = best.on_first - best.on_second;
    if (best.distance < 0.0) apart = -apart;
    if (!(apart.norm() > 1e-9)) apart = between;
    const Eigen::Vector3d direction = apart.normalized();
    double* row = add(TransitionFailure::kSelf, pair.first, pair.second,
                      best.distance - self_margin_m(coarse.pair));
    state_.kinematics.add_point_gradient(a, best.on_first, direction, 1.0, row);
    state_.kinematics.add_point_gradient(b, best.on_second, direction, -1.0, row);
  }
}

void TransitionRows::add_places() {
  const PlaceBands bands{options_.surface_margin_m, kBandSurface_m, kBand_m};
  const std::vector<int>& near =
      relations_.near(reach_of(state_, options_.surface_margin_m + kBandSurface_m));
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
      const std::optional<PlaceRow> found = place_row(state_, relations_, near[i], i, b, bands);
      if (!found) continue;
      const double scale = relations_.is_beside(i, b) ? kBesideScale : 1.0;
      double* row =
          add(TransitionFailure::kSurface, static_cast<int>(b), near[i], scale * found->value);
      state_.kinematics.add_point_gradient(robot_->bounds[b].link, found->point, found->gradient,
                                           scale, row);
    }
  }
}

double TransitionRows::link_room(int link, const Eigen::Isometry3d& world_from_link) {
  constexpr double kAround_m = 0.5;
  const std::vector<int>& body_of = robot().tree().body_of_link;
  const TouchablePlaces& places = relations_.places();
  const std::vector<int>& near =
      relations_.near(box_around(world_from_link.translation(), kAround_m));
  const Eigen::Isometry3d own = state_.kinematics.world_from_link(link).inverse();
  double room = kBandSurface_m;
  for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    if (body_of[static_cast<std::size_t>(bound.link)] != body_of[static_cast<std::size_t>(link)]) {
      continue;
    }
    const Eigen::Isometry3d pose =
        world_from_link * (own * state_.kinematics.world_from_link(bound.link));
    const Eigen::Vector3d centre = pose * bound.center;
    for (std::size_t i = 0; i < near.size(); ++i) {
      const PlaceRelations::Relation relation = relations_.relation(i, b);
      if (relation == PlaceRelations::Relation::kNone) continue;
      if (relation == PlaceRelations::Relation::kTouches) {
        const auto depth = places.depth(near[i], static_cast<int>(b), pose, room);
        if (depth) room = std::min(room, depth->value + relations_.deepest_m(i, b));
        continue;
      }
      if (places.is_far(near[i], centre, bound.radius, room)) continue;
      for (int k = bound.begin; k < bound.end; ++k) {
        const CollisionSphere& sphere = robot_->spheres[static_cast<std::size_t>(k)];
        room = std::min(room, places.distance(near[i], pose * sphere.center, sphere.radius).value);
      }
    }
  }
  return room;
}

void TransitionRows::add_obstacles() {
  const double limit = options_.obstacle_margin_m + kBandSurface_m;
  for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
    if (exempt_[b]) continue;
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    if (in_the_way_.distance(state_.bound_centre(b), 0.0) - bound.radius >= limit) continue;
    double least = limit;
    DistanceSample worst;
    int nearest = -1;
    for (int i = bound.begin; i < bound.end; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const DistanceSample found = in_the_way_.sample(state_.sphere_centre(k), 0.0);
      if (found.distance - robot_->spheres[k].radius >= least) continue;
      least = found.distance - robot_->spheres[k].radius;
      worst = found;
      nearest = i;
    }
    if (nearest < 0) continue;
    double* row = add(TransitionFailure::kObstacle, static_cast<int>(b), 0,
                      least - options_.obstacle_margin_m);
    state_.kinematics.add_point_gradient(bound.link, state_.sphere_centre(nearest), worst.gradient,
                                         1.0, row);
  }
}

std::pair<int, int> TransitionRows::links(const Row& row) const {
  const auto link = [&](int bound) { return robot_->bounds[static_cast<std::size_t>(bound)].link; };
  switch (row.kind) {
    case TransitionFailure::kSelf:
      return {link(row.first), link(row.second)};
    case TransitionFailure::kSurface:
    case TransitionFailure::kObstacle:
      return {link(row.first), -1};
    case TransitionFailure::kBorder:
      return {contact_links_[static_cast<std::size_t>(row.first)], -1};
    default:
      return {-1, -1};
  }
}

int TransitionRows::contact_link(int closure_row) const {
  return contact_links_[static_cast<std::size_t>(
      contact_of_row_[static_cast<std::size_t>(closure_row)])];
}

const std::string& TransitionRows::contact_name(int closure_row) const {
  return contact_names_[static_cast<std::size_t>(
      contact_of_row_[static_cast<std::size_t>(closure_row)])];
}

std::string TransitionRows::text(const Row& row) const {
  const auto [first, second] = links(row);
  const auto name = [&](int link) { return robot().links()[static_cast<std::size_t>(link)].name; };
  switch (row.kind) {
    case TransitionFailure::kJoint:
      return "joint " + robot().active_joint(row.first).name + " at its limit";
    case TransitionFailure::kSelf:
      return name(first) + " in " + name(second);
    case TransitionFailure::kSurface:
      return name(first) + " in " + relations_.places().name(row.second);
    case TransitionFailure::kObstacle:
      return name(first) + " in an obstacle";
    case TransitionFailure::kBalance:
      return "the centre of mass outside what the contacts balance";
    case TransitionFailure::kBorder:
      return "ball of " + contact_names_[static_cast<std::size_t>(row.first)] +
             " over the border of " + relations_.places().name(row.second);
    case TransitionFailure::kTorque:
      return "torque of " + robot().active_joint(row.first).name;
    default:
      return "";
  }
}

}  // namespace locograph
