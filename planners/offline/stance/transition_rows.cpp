#include <locograph/planners/offline/stance/transition_rows.h>
#include <locograph/plugins/self_collision/edge_self_collision.h>
#include <locograph/world/distance_view.h>
#include <locograph/world/link_solid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

/// What is further away than this beyond its margin has no row: a step is too short to get there.
constexpr double kBand_m = 0.03, kBandJoint_rad = 0.5, kBandSurface_m = 0.1;
/// An effort that is exceeded by all of itself counts as so many metres.
constexpr double kTorqueUnit_m = 0.1;
/// As the judge: links that touch are exempt from what lies below the plane of their contact, so
/// far away.
constexpr double kTouchedReach_m = 0.3, kBelow_m = 1e-3, kSamePlane_m = 1e-4, kSamePlane_rad = 1e-3;
/// So deep below a plate a sphere is still above it; deeper, it is below.
constexpr double kPlateDepth_m = 0.15, kPlateDepthShare = 0.3;

bool in_plane(const Surface& surface, const Contact& contact, const Eigen::Vector3d& normal) {
  const Eigen::Isometry3d& pose = surface.world_from_surface;
  const Eigen::Vector3d own = pose.linear().col(2);
  return angle_between(own, normal) <= kSamePlane_rad &&
         std::abs(own.dot(contact.position - pose.translation())) <= kSamePlane_m;
}

bool below_contact(const Surface& surface, const Contact& contact, const Eigen::Vector3d& normal) {
  if (std::isinf(surface.half_x_m) || std::isinf(surface.half_y_m)) return false;
  for (const double x : {surface.half_x_m, -surface.half_x_m}) {
    for (const double y : {surface.half_y_m, -surface.half_y_m}) {
      const Eigen::Vector3d corner = surface.world_from_surface * Eigen::Vector3d(x, y, 0.0);
      if (normal.dot(corner - contact.position) > kBelow_m) return false;
    }
  }
  const Eigen::Vector3d local = surface.world_from_surface.inverse() * contact.position;
  return std::abs(local.x()) - surface.half_x_m <= kTouchedReach_m &&
         std::abs(local.y()) - surface.half_y_m <= kTouchedReach_m &&
         std::abs(local.z()) <= kTouchedReach_m;
}

bool on_bar(const Bar& bar, const Contact& contact) {
  const Eigen::Vector3d along = (bar.to - bar.from).normalized();
  const Eigen::Vector3d off = contact.position - bar.from;
  return (off - along * along.dot(off)).norm() <= bar.radius_m + kBelow_m;
}

}  // namespace

TransitionRows::TransitionRows(std::shared_ptr<const RobotParameter> robot, World world)
    : robot_(std::move(robot)),
      world_(std::move(world)),
      size_(robot_->robot->tangent_size()),
      state_(robot_) {
  const Robot& model = *robot_->robot;
  if (!model.floating_base()) {
    throw Error("stances of a robot with a fixed base", "a floating base");
  }
  state_.kinematics.require_mass();
  anything_in_the_way_ = world_.map || !world_.obstacles.empty();
  if (anything_in_the_way_) {
    DistanceFieldOptions options;
    options.max_distance_m = 0.3;
    in_the_way_ = distance_view(world_, options);
  }
  for (const Surface& surface : world_.surfaces) {
    const bool endless = std::isinf(surface.half_x_m) && std::isinf(surface.half_y_m);
    const double half = std::min(surface.half_x_m, surface.half_y_m);
    plates_.push_back({surface.name, surface.world_from_surface.inverse(), surface.half_x_m,
                       surface.half_y_m, std::min(kPlateDepth_m, kPlateDepthShare * half),
                       endless});
  }
  pair_weights_ =
      Eigen::VectorXd::Ones(static_cast<Eigen::Index>(robot_->self_collision.pairs.size()));
  find_coarse_pairs();
}

/// Pairs whose covering capsules are too near in a named configuration where their exact shapes are
/// apart are compared by those shapes.
void TransitionRows::find_coarse_pairs() {
  const Robot& model = robot();
  std::vector<Eigen::VectorXd> examples = {model.neutral_configuration()};
  for (const std::string& name : model.configuration_names()) {
    examples.push_back(model.named_configuration(name));
  }
  constexpr double kTooNear_m = 5e-3;
  for (const Eigen::VectorXd& q : examples) {
    state_.update(q.data());
    find_near_pairs(state_, pair_weights_, kTooNear_m, near_, near_gradients_);
    for (const NearPair& found : near_) {
      const SelfCollisionShapes::Pair& pair =
          robot_->self_collision.pairs[static_cast<std::size_t>(found.pair)];
      CoarsePair coarse{found.pair, solid_of(pair.first), solid_of(pair.second)};
      if (exact_distance(coarse, kTooNear_m).distance < 0.0) continue;
      pair_weights_[found.pair] = 0.0;
      coarse_.push_back(std::move(coarse));
    }
  }
}

TransitionRows::Solid TransitionRows::solid_of(int bound) const {
  const Robot& model = *robot_->robot;
  Solid solid;
  const int link = robot_->bounds[static_cast<std::size_t>(bound)].link;
  for (const CollisionShape& shape : model.links()[static_cast<std::size_t>(link)].collision) {
    solid.shapes.push_back(link_solid(model, shape));
    solid.link_from_shape.push_back(shape.link_from_shape);
  }
  return solid;
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
  if (balance_ != nullptr) {
    balance_margin_m_ = std::min(options.balance_margin_m, 0.25 * balance_->width_m);
  }
  closures_.clear();
  contact_names_.clear();
  contact_of_row_.clear();
  contact_links_.clear();
  const std::size_t bounds = robot_->bounds.size();
  touched_.assign((world_.surfaces.size() + world_.bars.size()) * bounds, false);
  exempt_.assign(bounds, false);
  for (const Contact& contact : problem.closed) {
    const int number = static_cast<int>(closures_.size());
    closures_.emplace_back(robot(), contact);
    contact_names_.push_back(contact.name());
    contact_links_.push_back(closures_.back().link());
    for (int i = 0; i < closures_.back().rows(); ++i) contact_of_row_.push_back(number);
    const std::vector<bool> links = touching_links(robot(), {&contact, 1});
    const Eigen::Vector3d normal = contact.normal.normalized();
    for (std::size_t b = 0; b < bounds; ++b) {
      if (!links[static_cast<std::size_t>(robot_->bounds[b].link)]) continue;
      exempt_[b] = true;
      for (std::size_t s = 0; s < world_.surfaces.size(); ++s) {
        const Surface& surface = world_.surfaces[s];
        if (in_plane(surface, contact, normal) || below_contact(surface, contact, normal)) {
          touched_[s * bounds + b] = true;
        }
      }
      for (std::size_t s = 0; s < world_.bars.size(); ++s) {
        if (on_bar(world_.bars[s], contact)) {
          touched_[(world_.surfaces.size() + s) * bounds + b] = true;
        }
      }
    }
  }
  closure_.resize(static_cast<Eigen::Index>(contact_of_row_.size()));
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
  if (balance_ != nullptr) add_balance();
  if (torques_ != nullptr) add_torques();
  add_self();
  add_plates();
  add_bars();
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

void TransitionRows::add_self() {
  find_near_pairs(state_, pair_weights_, options_.self_margin_m + kBand_m, near_, near_gradients_);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const SelfCollisionShapes::Pair& pair =
        robot_->self_collision.pairs[static_cast<std::size_t>(near_[i].pair)];
    double* row = add(TransitionFailure::kSelf, pair.first, pair.second,
                      near_[i].distance_m - options_.self_margin_m);
    std::copy_n(near_gradients_.data() + i * static_cast<std::size_t>(size_), size_, row);
  }
  const double limit = options_.self_margin_m + kBand_m;
  for (const CoarsePair& coarse : coarse_) {
    const SelfCollisionShapes::Pair& pair =
        robot_->self_collision.pairs[static_cast<std::size_t>(coarse.pair)];
    const Eigen::Vector3d between = state_.bound_centres[static_cast<std::size_t>(pair.first)] -
                                    state_.bound_centres[static_cast<std::size_t>(pair.second)];
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
                      best.distance - options_.self_margin_m);
    state_.kinematics.add_point_gradient(a, best.on_first, direction, 1.0, row);
    state_.kinematics.add_point_gradient(b, best.on_second, direction, -1.0, row);
  }
}

TransitionRows::Distance TransitionRows::to_plate(const Plate& plate, const Eigen::Vector3d& centre,
                                                  double radius) const {
  const Eigen::Vector3d local = plate.surface_from_world * centre;
  if (plate.endless) return {local.z() - radius, Eigen::Vector3d::UnitZ()};
  const auto beyond = [](double x, double half) {
    return x > half ? x - half : (x < -half ? x + half : 0.0);
  };
  Eigen::Vector3d way(beyond(local.x(), plate.half_x_m), beyond(local.y(), plate.half_y_m),
                      local.z());
  if (way.x() == 0.0 && way.y() == 0.0) {
    if (local.z() >= -plate.depth_m) return {local.z() - radius, Eigen::Vector3d::UnitZ()};
    return {-local.z() - radius, -Eigen::Vector3d::UnitZ()};
  }
  const double length = way.norm();
  return {length - radius, way / length};
}

void TransitionRows::add_plates() {
  const double limit = options_.surface_margin_m + kBandSurface_m;
  for (std::size_t s = 0; s < plates_.size(); ++s) {
    const Plate& plate = plates_[s];
    for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
      const RobotParameter::LinkBound& bound = robot_->bounds[b];
      if (touches(static_cast<int>(s), static_cast<int>(b))) continue;
      const Distance whole = to_plate(plate, state_.bound_centres[b], 0.0);
      if (std::abs(whole.value) - bound.radius >= limit && (!plate.endless || whole.value > 0.0)) {
        continue;
      }
      Distance worst{limit, {}};
      int nearest = -1;
      for (int i = bound.begin; i < bound.end; ++i) {
        const CollisionSphere& sphere = robot_->spheres[static_cast<std::size_t>(i)];
        const Distance found =
            to_plate(plate, state_.sphere_centres[static_cast<std::size_t>(i)], sphere.radius);
        if (found.value >= worst.value) continue;
        worst = found;
        nearest = i;
      }
      if (nearest < 0) continue;
      double* row = add(TransitionFailure::kSurface, static_cast<int>(b), static_cast<int>(s),
                        worst.value - options_.surface_margin_m);
      state_.kinematics.add_point_gradient(
          bound.link, state_.sphere_centres[static_cast<std::size_t>(nearest)],
          plate.surface_from_world.linear().transpose() * worst.gradient, 1.0, row);
    }
  }
}

void TransitionRows::add_bars() {
  const double limit = options_.surface_margin_m + kBandSurface_m;
  for (std::size_t s = 0; s < world_.bars.size(); ++s) {
    const Bar& bar = world_.bars[s];
    const int surface = static_cast<int>(world_.surfaces.size() + s);
    const Eigen::Vector3d way = bar.to - bar.from;
    const double squared = way.squaredNorm();
    const auto off_axis = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
      const double along = std::clamp((point - bar.from).dot(way) / squared, 0.0, 1.0);
      return point - bar.from - along * way;
    };
    for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
      const RobotParameter::LinkBound& bound = robot_->bounds[b];
      if (touches(surface, static_cast<int>(b))) continue;
      if (off_axis(state_.bound_centres[b]).norm() - bar.radius_m - bound.radius >= limit) continue;
      double least = limit;
      int nearest = -1;
      for (int i = bound.begin; i < bound.end; ++i) {
        const std::size_t k = static_cast<std::size_t>(i);
        const double found =
            off_axis(state_.sphere_centres[k]).norm() - bar.radius_m - robot_->spheres[k].radius;
        if (found >= least) continue;
        least = found;
        nearest = i;
      }
      if (nearest < 0) continue;
      const Eigen::Vector3d& centre = state_.sphere_centres[static_cast<std::size_t>(nearest)];
      double* row = add(TransitionFailure::kSurface, static_cast<int>(b), surface,
                        least - options_.surface_margin_m);
      state_.kinematics.add_point_gradient(bound.link, centre, off_axis(centre).stableNormalized(),
                                           1.0, row);
    }
  }
}

void TransitionRows::add_obstacles() {
  const double limit = options_.obstacle_margin_m + kBandSurface_m;
  for (std::size_t b = 0; b < robot_->bounds.size(); ++b) {
    if (exempt_[b]) continue;
    const RobotParameter::LinkBound& bound = robot_->bounds[b];
    if (in_the_way_.distance(state_.bound_centres[b], 0.0) - bound.radius >= limit) continue;
    double least = limit;
    DistanceSample worst;
    int nearest = -1;
    for (int i = bound.begin; i < bound.end; ++i) {
      const std::size_t k = static_cast<std::size_t>(i);
      const DistanceSample found = in_the_way_.sample(state_.sphere_centres[k], 0.0);
      if (found.distance - robot_->spheres[k].radius >= least) continue;
      least = found.distance - robot_->spheres[k].radius;
      worst = found;
      nearest = i;
    }
    if (nearest < 0) continue;
    double* row = add(TransitionFailure::kObstacle, static_cast<int>(b), 0,
                      least - options_.obstacle_margin_m);
    state_.kinematics.add_point_gradient(bound.link,
                                         state_.sphere_centres[static_cast<std::size_t>(nearest)],
                                         worst.gradient, 1.0, row);
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
    case TransitionFailure::kSurface: {
      const std::size_t s = static_cast<std::size_t>(row.second);
      return name(first) + " in " +
             (s < plates_.size() ? plates_[s].name : world_.bars[s - plates_.size()].name);
    }
    case TransitionFailure::kObstacle:
      return name(first) + " in an obstacle";
    case TransitionFailure::kBalance:
      return "the centre of mass outside what the contacts balance";
    case TransitionFailure::kTorque:
      return "torque of " + robot().active_joint(row.first).name;
    default:
      return "";
  }
}

}  // namespace locograph
