#include <locograph/check/balance_worker.h>
#include <locograph/check/limits.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

constexpr double kFall = 10.0;  // of a margin, per metre
/// What is nearer than this to the least margin or the largest ratio is worked out exactly: more
/// than what a tally counts as equal.
constexpr double kNear = 1e-6;
constexpr int kTries = 4;  // wrenches found nearby
/// Long steps are looked at so often, as what inertia asks for bends within them.
constexpr double kLookEvery_s = 0.05;
constexpr int kMostPieces = 64;

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

bool BalanceFinding::verified() const {
  return certificate.balanced || !(certificate.margin >= -limits::kBalanceRounding);
}

void BalanceFindings::Extremes::add(const BalanceFinding& finding) {
  margin = std::min(margin, finding.certificate.margin);
  if (finding.torques && finding.certificate.balanced)
    torque_ratio = std::max(torque_ratio, finding.certificate.max_torque_ratio);
}

BalanceWorker::BalanceWorker(CheckContext& context)
    : context_(context), sampler_(context.curve), nearby_(context.robot) {
  if (context.shapes != nullptr) shapes_ = *context.shapes;
}

void BalanceWorker::begin(const BalanceFindings& found) {
  prove_nearby_ = found.prove_nearby;
  known_ = found.known;
  near_.clear();
}

void BalanceWorker::judge_vertices(std::size_t first, std::size_t last, BalanceFindings& found) {
  begin(found);
  // Those found already come last: tried after the newest.
  if (last < found.at_vertices.size())
    for (const BalanceFinding& finding : found.at_vertices[last]) near_.push_back(&finding);
  if (first > 0)
    for (const BalanceFinding& finding : found.at_vertices[first - 1]) near_.push_back(&finding);
  for (std::size_t i = first; i < last; ++i) {
    if (!context_.usable.vertices[i]) continue;
    const int vertex = static_cast<int>(i);
    smallest_half_m_ = found.half_m[i];
    const JudgedStance* before = i == 0 ? nullptr : context_.stance_from(vertex - 1);
    const JudgedStance* after = context_.stance_from(vertex);
    std::array<double, 2>& margins = found.margins[i];
    BalanceFindings::List* findings = &found.at_vertices[i];
    StanceWrenches* wrenches = context_.options.on_balance ? &found.wrenches[i] : nullptr;
    const bool arrives = i > 0 && context_.usable.steps[i - 1], goes_on = context_.usable.steps[i];
    const bool last_of_part =
        i + 1 == context_.vertices() && arrives && !context_.options.ends_at_rest;
    // As the step before ends, as the one after begins, and at rest where there is none.
    const Spot at_rest{.vertex = vertex, .at_rest = true, .stance = after};
    const Spot end{.vertex = vertex - 1, .fraction = 1.0, .stance = before};
    if (before != nullptr && (arrives || before != after)) {
      margins[0] = judge(arrives ? end : Spot{.vertex = vertex, .at_rest = true, .stance = before},
                         findings);
    }
    if (after != nullptr) {
      Spot begin = goes_on ? Spot{.vertex = vertex, .stance = after} : at_rest;
      if (last_of_part) begin = Spot{.vertex = vertex - 1, .fraction = 1.0, .stance = after};
      const bool again = last_of_part && before == after;
      if (!again || wrenches != nullptr) margins[1] = judge(begin, findings, wrenches);
      if (i == 0 && goes_on && context_.options.starts_at_rest) judge(at_rest, findings);
    }
    if (before == after && !arrives) margins[0] = margins[1];
    found.half_m[i] = smallest_half_m_;
  }
}

void BalanceWorker::judge_steps(std::size_t first, std::size_t last, BalanceFindings& found) {
  begin(found);
  for (std::size_t i = first; i < last; ++i) {
    const JudgedStance* stance = context_.stance_from(static_cast<int>(i));
    for (const std::size_t vertex : {i + 1, i})
      for (const BalanceFinding& finding : found.at_vertices[vertex]) near_.push_back(&finding);
    if (stance == nullptr || !context_.usable.steps[i]) continue;
    findings_ = &found.in_steps[i];
    smallest_half_m_ = found.smallest_half_m;
    violated_ = std::ranges::any_of(
        found.at_vertices[i], [&](const BalanceFinding& finding) { return violates(finding); });
    judge_step({.vertex = static_cast<int>(i), .stance = stance}, found.margins[i][1],
               found.margins[i + 1][0]);
  }
}

bool BalanceWorker::violates(const BalanceFinding& finding) const {
  return !finding.verified() ||
         !(context_.options.min_balance_margin - finding.certificate.margin <=
           limits::kBalanceRounding);
}

double BalanceWorker::steepest_fall() const { return std::max(kFall, 1.0 / smallest_half_m_); }

/// And the contacts, where the poses are.
BalanceOptions BalanceWorker::options_for(const Spot& spot) {
  BalanceOptions options;
  options.enforce_torque_limits = context_.options.enforce_torque_limits;
  options.effort_scale = context_.options.effort_scale;
  contacts_.clear();
  for (const JudgedContact& judged : spot.stance->contacts) {
    JudgedBearing bearing = bearing_at(judged, context_.world, poses_);
    const EndEffector& effector = bearing.contact.effector;
    if (effector.kind == ContactKind::kSurface && bearing.contact.bears_load) {
      const double half = bearing.area.empty() ? std::min(effector.half_x_m, effector.half_y_m)
                                               : half_size(bearing.area);
      smallest_half_m_ = std::min(smallest_half_m_, half);
    }
    options.areas.push_back(std::move(bearing.area));
    contacts_.push_back(std::move(bearing.contact));
  }
  if (!spot.at_rest) {
    context_.curve.step(spot.vertex).at(spot.fraction, point_);
    options.motion = BalanceMotion{point_.velocity, point_.acceleration};
  }
  return options;
}

double BalanceWorker::judge(const Spot& spot, BalanceFindings::List* findings,
                            StanceWrenches* wrenches) {
  context_.begin_work("judging balance", spot.vertex);
  sampler_.link_poses(spot.vertex, spot.fraction, poses_);
  BalanceOptions options = options_for(spot);
  bool torques = spot.at_rest || spot.fraction == 0.0 || spot.fraction == 1.0;
  // Of motions the least torques are told, at vertices; of a posture those of its wrenches.
  options.least_torques = torques && (!context_.single || !options.enforce_torque_limits);
  if (prove_nearby_ && !context_.single) {
    BalanceBounds bounds = prove(spot, options);
    const bool told = enough_is_known_of_torques(bounds);
    if (told && enough_is_known_of_margin(bounds)) {
      if (wrenches != nullptr) *wrenches = std::move(bounds.wrenches);
      return bounds.margin_at_least;
    }
    if (told) torques = false;
  }
  BalanceFinding found = programme(spot, options, torques);
  const double margin = found.certificate.margin;
  if (wrenches != nullptr) *wrenches = found.certificate.wrenches;
  known_.add(found);
  violated_ = violated_ || violates(found);
  findings->push_back(std::move(found));
  near_.push_back(&findings->back());
  return margin;
}

bool BalanceWorker::enough_is_known_of_margin(const BalanceBounds& bounds) const {
  return bounds.margin_at_least >=
         std::max({0.0, context_.options.min_balance_margin, known_.margin + kNear});
}

bool BalanceWorker::enough_is_known_of_torques(const BalanceBounds& bounds) const {
  double most = known_.torque_ratio - kNear;
  if (context_.options.enforce_torque_limits) most = std::min(most, 1.0);
  return bounds.torque_ratio_at_most <= most;
}

BalanceBounds BalanceWorker::prove(const Spot& spot, const BalanceOptions& options) {
  BalanceBounds bounds;
  if (!options.least_torques)
    bounds.torque_ratio_at_most = -std::numeric_limits<double>::infinity();
  int tries = 0;
  for (auto near = near_.rbegin(); near != near_.rend() && tries < kTries; ++near) {
    if ((*near)->stance != spot.stance) continue;
    ++tries;
    BalanceBounds some = nearby_.prove(sampler_.state(), contacts_, options, (*near)->certificate);
    if (some.margin_at_least > bounds.margin_at_least) {
      bounds.margin_at_least = some.margin_at_least;
      bounds.wrenches = std::move(some.wrenches);
    }
    bounds.torque_ratio_at_most = std::min(bounds.torque_ratio_at_most, some.torque_ratio_at_most);
    if (enough_is_known_of_margin(bounds) && enough_is_known_of_torques(bounds)) break;
  }
  return bounds;
}

BalanceFinding BalanceWorker::programme(const Spot& spot, BalanceOptions options, bool torques) {
  BalanceCertificate certificate =
      certify_balance(context_.robot, sampler_.configuration(), contacts_, options);
  if (!certificate.balanced && options.enforce_torque_limits) {
    // Is it balance that fails, or what joints can bear?
    options.enforce_torque_limits = false;
    options.least_torques = true;
    certificate = certify_balance(context_.robot, sampler_.configuration(), contacts_, options);
    torques = true;
  }
  return {.certificate = std::move(certificate),
          .stance = spot.stance,
          .vertex = spot.fraction == 1.0 ? spot.vertex + 1 : spot.vertex,
          .time_s = context_.curve.time_s(spot.vertex, spot.fraction),
          .place = poses_[0].translation(),
          .torques = torques};
}

std::vector<Eigen::Vector3d> BalanceWorker::arms(const Spot& spot) {
  sampler_.link_poses(spot.vertex, spot.fraction, poses_);
  std::vector<Eigen::Vector3d> arms;
  const Eigen::Vector3d com = sampler_.state().center_of_mass();
  const Eigen::Matrix3d base_from_world = poses_[0].linear().transpose();
  for (const JudgedContact& contact : spot.stance->contacts)
    arms.push_back(base_from_world * (touching_point(contact, poses_) - com));
  for (const JudgedContact& contact : spot.stance->contacts)
    if (contact.rolls_round) arms.push_back(base_from_world * contact_at(contact, poses_).normal);
  arms.push_back(base_from_world.col(2));
  return arms;
}

BalanceWorker::Sample BalanceWorker::sample(const Spot& spot) {
  const double margin = judge(spot, findings_);
  return {spot.fraction, margin, arms(spot)};
}

void BalanceWorker::judge_step(const Spot& begin, double margin_from, double margin_to) {
  const CurveStep step = context_.curve.step(begin.vertex);
  const StepBounds bounds = step.bounds();
  shapes_->set_step(bounds);
  const int pieces = std::clamp(
      static_cast<int>(std::min(std::ceil(step.duration_s() / kLookEvery_s), 1e6)), 1, kMostPieces);
  Spot end = begin;
  end.fraction = 1.0;
  // Where the base and what hangs on it move as one, or wheels turn about their axles, contacts
  // stay where they are as seen from the centre of mass.
  LinkPoses from, to;
  sampler_.link_poses(begin.vertex, 0.0, from);
  sampler_.link_poses(begin.vertex, 1.0, to);
  const double tilt = (from[0].linear().row(2) - to[0].linear().row(2)).norm() +
                      0.1 * bounds.base_angle_rad + 0.25 * bounds.base_bend_rad;
  double rolled = 0.0;
  for (const JudgedContact& contact : begin.stance->contacts)
    if (contact.rolls_round)
      rolled = std::max(rolled,
                        (contact_at(contact, from).normal - contact_at(contact, to).normal).norm());
  const double path = shapes_->step_length_bound_in_base() + tilt + rolled;
  const double enough = context_.options.min_balance_margin + path * steepest_fall();
  if (pieces == 1 && std::min(margin_from, margin_to) >= enough) return;
  Sample here{0.0, margin_from, arms(begin)};
  for (int piece = 1; piece <= pieces; ++piece) {
    Spot spot = begin;
    spot.fraction = static_cast<double>(piece) / pieces;
    Sample there = piece == pieces ? Sample{1.0, margin_to, arms(end)} : sample(spot);
    refine(begin, here, there);
    here = std::move(there);
  }
}

void BalanceWorker::refine(const Spot& begin, const Sample& from, const Sample& to) {
  double chord = 0.0;
  for (std::size_t i = 0; i < from.arms.size(); ++i)
    chord = std::max(chord, (from.arms[i] - to.arms[i]).norm());
  const double path = chord + 2.0 * shapes_->bend_in_base(to.fraction - from.fraction);
  if (path <= context_.options.balance_resolution_m || violated_) return;
  if (0.5 * (from.margin + to.margin - path * steepest_fall()) >=
      context_.options.min_balance_margin)
    return;
  Spot spot = begin;
  spot.fraction = 0.5 * (from.fraction + to.fraction);
  if (spot.fraction <= from.fraction || spot.fraction >= to.fraction) return;
  const Sample between = sample(spot);
  refine(begin, from, between);
  refine(begin, between, to);
}

}  // namespace locograph
