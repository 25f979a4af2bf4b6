#include <locograph/planners/offline/motion/segment_space.h>
#include <locograph/robots/contact_kinds.h>
#include <locograph/robots/wheel.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kSomeFriction = 0.1;  // of what bears nothing, where its kind has none
/// Between configurations that were found with all of their margins, so much of them is asked for.
constexpr double kShareOfMargins = 0.5;
constexpr double kRowsTolerance = 1e-4;  // m, rad
constexpr double kJointRoom_rad = 1e-3, kSelfRoom_m = 1e-3;
/// Half-way configurations that are brought back may be so much further away than straight ones.
constexpr double kMostBent = 0.75;
/// What is further away than this is as good as anywhere; how far links move for each radian,
/// about; and steps that are never looked between.
constexpr double kMostRoom_m = 0.03, kReach_m = 0.6, kLeastStep = 0.008;
constexpr int kLiftSteps = 3;
constexpr double kAlmost = 0.006;  // m, rad
/// Of what swings, above what it leaves: rows that hold to kRowsTolerance keep it out of it.
constexpr double kOff_m = 2e-4;

TransitionOptions margins_between(const Segment& segment) {
  TransitionOptions options;
  options.joint_margin_rad =
      std::max(kRowsTolerance + kJointRoom_rad, segment.joint_margin_rad - kJointRoom_rad);
  for (double* margin :
       {&options.self_margin_m, &options.surface_margin_m, &options.obstacle_margin_m,
        &options.border_margin_m, &options.balance_margin_m, &options.torque_margin}) {
    *margin *= kShareOfMargins;
  }
  options.self_margin_m = std::max(options.self_margin_m, segment.self_margin_m - kSelfRoom_m);
  return options;
}

}  // namespace

Contact contact_in_air(const Robot& robot, const Contact& contact, const Eigen::Isometry3d& link,
                       bool with_axes) {
  const EndEffector& effector = contact.effector;
  Contact held = contact;
  held.position = link * effector.point;
  held.locked = false;
  held.bar.reset();
  if (with_axes && contact_kind_entry(effector.kind).holds_normal) {
    const Eigen::Matrix3d axes = link.linear() * axes_in_link(effector);
    held.normal = axes.col(2);
    held.forward = axes.col(0);
    return held;
  }
  // A wheel turns without its centre: what carries it is what is held.
  if (effector.kind == ContactKind::kWheel) {
    const Wheel wheel = wheel_of(robot, effector);
    held.effector.name = contact.name();
    held.effector.link = robot.links()[static_cast<std::size_t>(wheel.carrier)].name;
    held.effector.point = wheel.centre_in_carrier;
  }
  held.effector.kind = ContactKind::kPoint;
  held.effector.radius_m = 0.0;
  held.effector.friction = std::max(held.effector.friction, kSomeFriction);
  held.forward.reset();
  return held;
}

Eigen::Vector3d way_off(const Contact& contact, const Eigen::Isometry3d& link) {
  if (contact_kind_entry(contact.effector.kind).bar_touch != BarTouch::kGrasp) {
    return contact.normal.normalized();
  }
  return link.linear() * axes_in_link(contact.effector).col(2);
}

SegmentSpace::SegmentSpace(std::shared_ptr<const RobotParameter> robot, World world,
                           double lift_off_m)
    : state_(*robot->robot),
      solver_(robot, world),
      rows_(robot, std::move(world)),
      lift_off_m_(lift_off_m),
      contacts_(*robot->robot) {}

void SegmentSpace::leave_as_near(const Eigen::VectorXd& q, double margin_m) {
  rows_.leave_as_near(q, margin_m);
  solver_.leave_as_near(q, margin_m);
}

void SegmentSpace::set_segment(const Segment& segment) {
  segment_ = &segment;
  roll_from(segment.from.size() > 0 ? balls_at(segment.from) : HeldBalls(segment.held.size()));
  near_ = segment.left;
  near_.insert(near_.end(), segment.reached.begin(), segment.reached.end());
  rows_for_.reset();
  why_not_.clear();
  lifted_ = {segment.from};
  landing_ = {segment.to};
}

void SegmentSpace::roll_from(HeldBalls balls) {
  balls_ = std::move(balls);
  contacts_.set(segment_->held, balls_);
}

HeldBalls SegmentSpace::balls_at(const Eigen::VectorXd& q) {
  state_.update(q.data());
  return held_balls(state_, segment_->held, [](const Contact&) { return true; });
}

bool SegmentSpace::has_balls() const {
  return std::ranges::any_of(balls_, [](const auto& ball) { return ball.has_value(); });
}

bool SegmentSpace::project_end(Eigen::VectorXd& q) {
  std::vector<Contact> closed = segment_->held;
  closed.insert(closed.end(), segment_->reached.begin(), segment_->reached.end());
  HeldBalls balls = balls_;
  balls.resize(closed.size());
  contacts_.set(closed, balls);
  const bool found = contacts_.project(q);
  contacts_.set(segment_->held, balls_);
  return found;
}

std::vector<bool> SegmentSpace::what_is_near(const Eigen::VectorXd& q,
                                             std::span<const Contact> also) {
  std::vector<bool> result;
  state_.update(q.data());
  for (const Contact& contact : near_) {
    Eigen::Vector3d at =
        state_.world_from_link(robot().link_index(contact.effector.link)) * contact.effector.point;
    for (const Contact& other : also) {
      if (other.name() == contact.name()) at = other.position;
    }
    result.push_back(is_near(contact, at));
  }
  return result;
}

std::vector<Contact> SegmentSpace::chosen(const std::vector<bool>& which) const {
  std::vector<Contact> contacts;
  for (std::size_t i = 0; i < near_.size(); ++i) {
    if (which[i]) contacts.push_back(near_[i]);
  }
  return contacts;
}

void SegmentSpace::set_rows(bool swinging, const std::vector<bool>& which) {
  const std::pair<bool, std::vector<bool>> wanted{swinging, which};
  if (rows_for_ == wanted) return;
  rows_for_ = wanted;
  const std::vector<Contact> near = chosen(which);
  TransitionProblem problem;
  problem.closed = segment_->held;
  problem.rolled_from = balls_;
  problem.balance = segment_->balance;
  problem.torques = segment_->torques;
  problem.near = near;
  problem.near_m = swinging ? kOff_m : 0.25 * lift_off_m_;
  rows_.set_problem(problem, margins_between(*segment_));
}

const TransitionRows& SegmentSpace::rows_at(const Eigen::VectorXd& q, bool swinging) {
  set_rows(swinging, what_is_near(q, {}));
  rows_.evaluate(q);
  return rows_;
}

bool SegmentSpace::valid(const Eigen::VectorXd& q, bool swinging) {
  const TransitionRows::Row* worst = nullptr;
  room_m_ = kMostRoom_m;
  for (const TransitionRows::Row& row : rows_at(q, swinging).rows()) {
    if (row.kind == TransitionFailure::kSelf || row.kind == TransitionFailure::kSurface ||
        row.kind == TransitionFailure::kObstacle) {
      room_m_ = std::min(room_m_, row.value);
    }
    if (row.value < -kRowsTolerance && (worst == nullptr || row.value < worst->value)) worst = &row;
  }
  if (worst != nullptr) why_not_ = rows_.text(*worst);
  return worst == nullptr;
}

double SegmentSpace::distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  Eigen::VectorXd difference(robot().tangent_size());
  robot().difference(a.data(), b.data(), difference.data());
  return difference.norm();
}

Eigen::VectorXd SegmentSpace::half_way(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                       double fraction) const {
  Eigen::VectorXd q(a.size()), step(robot().tangent_size());
  robot().difference(a.data(), b.data(), step.data());
  step *= fraction;
  robot().integrate(a.data(), step.data(), q.data());
  return q;
}

bool SegmentSpace::valid_between(const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                                 double step_rad, bool swinging) {
  // Both are taken as they are: a start that is given may have no margins.
  valid(a, swinging);
  const double room_a = room_m_;
  valid(b, swinging);
  return room_between(a, room_a, b, room_m_, step_rad, swinging);
}

bool SegmentSpace::room_between(const Eigen::VectorXd& a, double room_a, const Eigen::VectorXd& b,
                                double room_b, double step_rad, bool swinging) {
  const double apart = distance(a, b);
  if (apart <= kLeastStep) return true;
  if (apart <= step_rad && apart * kReach_m <= std::max(0.0, room_a) + std::max(0.0, room_b)) {
    return true;
  }
  Eigen::VectorXd middle = half_way(a, b);
  if (!project(middle)) {
    why_not_ = "contacts do not close half-way";
    return false;
  }
  const double before = distance(a, middle), after = distance(middle, b);
  if (std::max(before, after) > kMostBent * apart) {
    why_not_ = "contacts close elsewhere half-way";
    return false;
  }
  if (!valid(middle, swinging)) return false;
  const double room = room_m_;
  return room_between(a, room_a, middle, room, step_rad, swinging) &&
         room_between(middle, room, b, room_b, step_rad, swinging);
}

double SegmentSpace::room_of(const Contact& contact, const Eigen::Isometry3d& world_from_link) {
  const std::vector<Contact> there = {contact_in_air(robot(), contact, world_from_link, false)};
  set_rows(true, what_is_near(segment_->from, there));
  return rows_.link_room(robot().link_index(contact.effector.link), world_from_link);
}

bool SegmentSpace::solve(const Eigen::VectorXd& start, std::span<const Contact> also,
                         Eigen::VectorXd& q) {
  std::vector<Contact> closed = segment_->held;
  closed.insert(closed.end(), also.begin(), also.end());
  TransitionProblem problem;
  problem.closed = closed;
  problem.rolled_from = balls_;
  problem.held = segment_->held;
  problem.balance = segment_->balance;
  problem.torques = segment_->torques;
  problem.start = start;
  problem.preferred = start;
  const std::vector<Contact> near = chosen(what_is_near(start, also));
  problem.near = near;
  TransitionOptions options;
  options.max_iterations = 25;
  options.joint_margin_rad = std::max(options.joint_margin_rad, segment_->joint_margin_rad);
  options.self_margin_m = std::max(options.self_margin_m, segment_->self_margin_m);
  TransitionResult result = solver_.solve(problem, options);
  q = std::move(result.configuration);
  if (result.success()) return true;
  // A little short of all margins is enough on the way.
  if (!also.empty() && result.amount > kAlmost) {
    why_not_ = std::move(result.reason);
    return false;
  }
  return project(q) && valid(q, true);
}

bool SegmentSpace::move_along(const Eigen::VectorXd& from, std::span<const Contact> contacts,
                              std::vector<Eigen::VectorXd>& way) {
  way = {from};
  std::vector<Eigen::Isometry3d> links;
  state_.update(from.data());
  for (const Contact& contact : contacts) {
    links.push_back(state_.world_from_link(robot().link_index(contact.effector.link)));
  }
  for (int step = 1; step <= kLiftSteps && !contacts.empty(); ++step) {
    std::vector<Contact> also;
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      also.push_back(contact_in_air(robot(), contacts[i], links[i], true));
      also.back().position += lift_off_m_ * step / kLiftSteps * way_off(contacts[i], links[i]);
    }
    Eigen::VectorXd q;
    if (!solve(way.back(), also, q)) return false;
    way.push_back(std::move(q));
  }
  return true;
}

bool SegmentSpace::lift_off() {
  if (!move_along(segment_->from, segment_->left, lifted_)) return false;
  if (!move_along(segment_->to, segment_->reached, landing_)) return false;
  std::reverse(landing_.begin(), landing_.end());
  return true;
}

}  // namespace locograph
