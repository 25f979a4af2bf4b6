#include <locograph/check/balance_along.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace locograph {
namespace {

constexpr double kFall = 10.0;  // of a margin, per metre

/// How far apart the farthest two corners are along the narrowest of both axes, halved; of a line,
/// half its length.
double half_size(const std::vector<Eigen::Vector2d>& area) {
  if (area.size() == 2) return std::max(1e-3, 0.5 * (area[1] - area[0]).norm());
  Eigen::Vector2d least = area.front(), most = area.front();
  for (const Eigen::Vector2d& corner : area) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  return std::max(1e-3, 0.5 * (most - least).minCoeff());
}

}  // namespace

BalanceAlong::BalanceAlong(CheckContext& context)
    : context_(context),
      rates_(context),
      sampler_(context.sampler),
      static_balance_("static_balance", "1", context.options.min_balance_margin, Worse::kLower,
                      context.vertices(), limits::kBalanceRounding),
      torque_limits_("torque_limits", "ratio", 1.0, Worse::kHigher, context.vertices(),
                     context.options.enforce_torque_limits
                         ? limits::kBalanceRounding
                         : std::numeric_limits<double>::infinity()) {}

void BalanceAlong::run() {
  if (!context_.robot.floating_base() || !(context_.robot.total_mass() > 0.0)) return;
  // At each vertex: the margins on the stances of the steps before and after it.
  std::vector<std::array<double, 2>> margins(context_.vertices(), {0.0, 0.0});
  for (std::size_t i = 0; i < context_.vertices(); ++i) {
    if (!context_.usable.vertices[i]) continue;
    const int vertex = int(i);
    const JudgedStance* before = i == 0 ? nullptr : context_.stance_from(vertex - 1);
    const JudgedStance* after = context_.stance_from(vertex);
    if (before != nullptr) margins[i][0] = judge(vertex, 0.0, {}, *before).margin;
    if (after == before)
      margins[i][1] = margins[i][0];
    else if (after != nullptr)
      margins[i][1] = judge(vertex, 0.0, {}, *after).margin;
  }
  for (std::size_t i = 0; i + 1 < context_.vertices(); ++i) {
    const JudgedStance* stance = context_.stance_from(int(i));
    if (stance == nullptr || !context_.usable.steps[i]) continue;
    context_.shapes->set_step(configuration_step(context_.robot, context_.motion.configurations[i],
                                                 context_.motion.configurations[i + 1]));
    run_half(int(i), Half::kFirst, *stance, margins[i][1]);
    run_half(int(i), Half::kSecond, *stance, margins[i + 1][0]);
  }
}

double BalanceAlong::steepest_fall() const { return std::max(kFall, 1.0 / smallest_half_m_); }

BalanceOptions BalanceAlong::options_for(const JudgedStance& stance, const LinkPoses& poses,
                                         std::vector<Contact>& contacts) {
  BalanceOptions options;
  options.enforce_torque_limits = context_.options.enforce_torque_limits;
  options.effort_scale = context_.options.effort_scale;
  for (const JudgedContact& judged : stance.contacts) {
    Contact contact = judged.contact;
    const Support support = support_of(judged, context_.world, poses);
    if (support.known) {
      contact.effector.friction = support.friction;
      // What is beyond the border of its surface bears nothing.
      if (support.outside_m > limits::kClosed_m) contact.bears_load = false;
    }
    options.areas.push_back(support.area);
    if (contact.effector.kind == ContactKind::kSurface && contact.bears_load) {
      const double half = support.area.empty()
                              ? std::min(contact.effector.half_x_m, contact.effector.half_y_m)
                              : half_size(support.area);
      smallest_half_m_ = std::min(smallest_half_m_, half);
    }
    contacts.push_back(std::move(contact));
  }
  return options;
}

BalanceAlong::Sample BalanceAlong::judge(int vertex, double fraction, std::optional<Half> half,
                                         const JudgedStance& stance) {
  context_.go_on("judging balance", vertex);
  sampler_.link_poses(vertex, fraction, poses_);
  const RobotState& state = sampler_.state();
  std::vector<Contact> contacts;
  BalanceOptions options = options_for(stance, poses_, contacts);
  if (context_.moves())
    options.motion = half ? rates_.at(vertex, fraction, *half, state) : rates_.at(vertex, state);
  // Of motions the least torques are told, at vertices; of a posture those of its wrenches.
  options.least_torques = !half && (!context_.single || !options.enforce_torque_limits);
  BalanceCertificate certificate =
      certify_balance(context_.robot, sampler_.configuration(), contacts, options);
  const double time_s = sampler_.time_s(vertex, fraction);
  bool torques = !half;
  if (!certificate.balanced && options.enforce_torque_limits) {
    // Is it balance that fails, or what joints can bear?
    options.enforce_torque_limits = false;
    options.least_torques = true;
    certificate = certify_balance(context_.robot, sampler_.configuration(), contacts, options);
    torques = true;
  }
  record(certificate, torques, vertex, time_s);
  Sample sample{fraction, certificate.margin, {}};
  const Eigen::Vector3d com = state.center_of_mass();
  const Eigen::Matrix3d base_from_world = poses_[0].linear().transpose();
  for (const JudgedContact& contact : stance.contacts)
    sample.arms.push_back(base_from_world * (touching_point(contact, poses_) - com));
  sample.arms.push_back(base_from_world.col(2));
  return sample;
}

void BalanceAlong::record(const BalanceCertificate& certificate, bool torques, int vertex,
                          double time_s) {
  const Eigen::Vector3d place = poses_[0].translation();
  const auto limiting = [&] { return certificate.limiting; };
  bool worst = static_balance_.add(certificate.margin, vertex, time_s, place, limiting);
  // A margin without wrenches that could be verified is no proof.
  if (!certificate.balanced && certificate.margin >= -limits::kBalanceRounding)
    worst = static_balance_.add(std::numeric_limits<double>::quiet_NaN(), vertex, time_s, place,
                                [] { return std::string("the wrenches could not be verified"); });
  if (worst || !worst_) worst_ = certificate;
  if (!certificate.balanced || !torques) return;
  torque_limits_.add(certificate.max_torque_ratio, vertex, time_s, place, [&] {
    return std::string(certificate.max_torque_ratio == 0.0 ? "no joint that is loaded has a limit"
                                                           : "");
  });
}

void BalanceAlong::run_half(int step, Half half, const JudgedStance& stance,
                            double margin_at_vertex) {
  const double begin = half == Half::kFirst ? 0.0 : 0.5;
  const Motion& motion = context_.motion;
  const ConfigurationStep change =
      configuration_step(context_.robot, motion.configurations[std::size_t(step)],
                         motion.configurations[std::size_t(step) + 1]);
  // Where the base and what hangs on it move as one, or wheels turn about their axles, contacts
  // stay where they are as seen from the centre of mass.
  LinkPoses from, to;
  sampler_.link_poses(step, begin, from);
  sampler_.link_poses(step, begin + 0.5, to);
  const double tilt =
      (from[0].linear().row(2) - to[0].linear().row(2)).norm() + 0.1 * change.base_angle_rad;
  const double path = context_.shapes->step_length_bound_in_base() + tilt;
  if (margin_at_vertex - path * steepest_fall() >= context_.options.min_balance_margin) return;
  const Sample first = judge(step, begin, half, stance);
  const Sample last = judge(step, begin + 0.5, half, stance);
  refine(step, half, stance, first, last);
}

void BalanceAlong::refine(int step, Half half, const JudgedStance& stance, const Sample& from,
                          const Sample& to) {
  double chord = 0.0;
  for (std::size_t i = 0; i < from.arms.size(); ++i)
    chord = std::max(chord, (from.arms[i] - to.arms[i]).norm());
  const double path = chord + 2.0 * context_.shapes->bend_in_base(to.fraction - from.fraction);
  if (path <= context_.options.balance_resolution_m || static_balance_.violated_at(step)) return;
  const double least = 0.5 * (from.margin + to.margin - path * steepest_fall());
  if (least >= context_.options.min_balance_margin) return;
  const double middle = 0.5 * (from.fraction + to.fraction);
  if (middle <= from.fraction || middle >= to.fraction) return;
  const Sample between = judge(step, middle, half, stance);
  refine(step, half, stance, from, between);
  refine(step, half, stance, between, to);
}

void BalanceAlong::report(std::vector<Violation>& violations) const {
  std::string why = "no stance is known";
  if (!(context_.robot.total_mass() > 0.0)) why = "no link has a mass";
  if (!context_.robot.floating_base()) why = "the base is fixed to the world";
  violations.push_back(static_balance_.result(why));
  violations.push_back(
      torque_limits_.result(static_balance_.empty() ? why : "nothing balances the robot"));
}

std::optional<double> BalanceAlong::min_margin() const {
  if (static_balance_.empty()) return std::nullopt;
  return static_balance_.worst();
}

std::optional<double> BalanceAlong::max_torque_ratio() const {
  if (torque_limits_.empty()) return std::nullopt;
  return torque_limits_.worst();
}

}  // namespace locograph
