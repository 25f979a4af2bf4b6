#include <locograph/check/dense_programme.h>
#include <locograph/check/limits.h>
#include <locograph/check/wrench_check.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

namespace locograph {
namespace {

constexpr double kBeyond = std::numeric_limits<double>::infinity();
constexpr int kSides = 32;
/// Where a ball has rolled to before a part of a motion begins, and its normal there, is known that
/// well only.
constexpr double kRoundingOfParts = 1e-4;

std::string told(const std::string& who, const char* format, double number) {
  char text[96];
  std::snprintf(text, sizeof text, format, number);
  return who + text;
}

/// How a pressing force at `centre` is shared out among the corners of a rectangle, as between four
/// neighbours, or among the ends of a line; none: it is not inside, or there are others.
std::vector<double> shares_of(const EndEffector& surface, const std::vector<Eigen::Vector2d>& area,
                              const Eigen::Vector2d& centre) {
  if (area.size() == 2) {
    const Eigen::Vector2d way = area[1] - area[0], from = centre - area[0];
    const double along = from.dot(way) / way.squaredNorm();
    const double aside = std::abs(way.x() * from.y() - way.y() * from.x()) / way.norm();
    if (!(along >= 0.0 && along <= 1.0 && aside <= limits::kBalanceRounding)) return {};
    return {1.0 - along, along};
  }
  const double x = centre.x() / surface.half_x_m, y = centre.y() / surface.half_y_m;
  if (!area.empty() || !(std::abs(x) <= 1.0 && std::abs(y) <= 1.0)) return {};
  std::vector<double> shares;
  for (const Eigen::Vector2d& corner : corners_of(surface, {}))
    shares.push_back(0.25 * (1.0 + x * std::copysign(1.0, corner.x())) *
                     (1.0 + y * std::copysign(1.0, corner.y())));
  return shares;
}

/// Forces at the corners, in true cones, that add up to the wrench: what is tangential in
/// proportion to what presses, and what is left of the moment about the normal by forces across the
/// way from the centre of pressure. False: these are not in the cones, others may be.
bool simply_in_cones(const EndEffector& surface, const std::vector<Eigen::Vector2d>& area,
                     const Eigen::Matrix<double, 6, 1>& wrench) {
  const double pressing = wrench[2];
  if (!(pressing > 0.0)) return false;
  const Eigen::Vector2d tangential = wrench.head<2>();
  const Eigen::Vector2d centre(-wrench[4] / pressing, wrench[3] / pressing);
  const std::vector<double> shares = shares_of(surface, area, centre);
  if (shares.empty()) return false;
  const std::vector<Eigen::Vector2d> corners = corners_of(surface, area);
  const double yaw = wrench[5] - (centre.x() * tangential.y() - centre.y() * tangential.x());
  double spread = 0.0;
  for (std::size_t i = 0; i < shares.size(); ++i)
    spread += shares[i] * (corners[i] - centre).squaredNorm();
  if (!(spread > 0.0)) return false;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const Eigen::Vector2d arm = corners[i] - centre, across(-arm.y(), arm.x());
    if (!((tangential + yaw / spread * across).norm() <= surface.friction * pressing)) return false;
  }
  return true;
}

/// Where a bar touches a sole is known as exactly as contacts close: of a wrench in a line that is
/// no further aside, in the line.
Eigen::Matrix<double, 6, 1> moved_into(const std::vector<Eigen::Vector2d>& area,
                                       Eigen::Matrix<double, 6, 1> wrench) {
  if (area.size() != 2 || !(wrench[2] > 0.0)) return wrench;
  const Eigen::Vector2d way = (area[1] - area[0]).normalized(), across(-way.y(), way.x());
  const Eigen::Vector2d centre(-wrench[4] / wrench[2], wrench[3] / wrench[2]);
  const double aside = across.dot(centre - area[0]);
  if (!(std::abs(aside) <= limits::kClosed_m)) return wrench;
  wrench[3] -= wrench[2] * aside * across.y();
  wrench[4] += wrench[2] * aside * across.x();
  return wrench;
}

/// A point, in a cone: by how much of the weight it would have to be pressed more.
double outside_cone(double friction, const Eigen::Vector3d& force, double weight_N) {
  return std::max({0.0, force.head<2>().norm() / friction - force.z(), -force.z()}) / weight_N;
}

double as_ratio(double used, double outside, double rounding = limits::kBalanceRounding) {
  if (outside > rounding || std::isnan(outside)) return 1.0 + outside;
  return std::min(1.0, used);
}

}  // namespace

double outside_cones(const EndEffector& surface, const std::vector<Eigen::Vector2d>& area,
                     const Eigen::Matrix<double, 6, 1>& stated, double weight_N) {
  const Eigen::Matrix<double, 6, 1> wrench = moved_into(area, stated);
  if (simply_in_cones(surface, area, wrench)) return 0.0;
  const std::vector<Eigen::Vector2d> corners = corners_of(surface, area);
  const auto count = static_cast<Eigen::Index>(corners.size());
  // The first column presses all corners alike by the weight.
  DenseProgramme programme(6, 1 + kSides * count);
  programme.objective[0] = 1.0;
  const double step = 2.0 * std::numbers::pi / kSides;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d at(corners[std::size_t(i)].x(), corners[std::size_t(i)].y(), 0.0);
    const auto force_at = [&](const Eigen::Vector3d& force) {
      Eigen::Matrix<double, 6, 1> effect;
      effect << force, at.cross(force);
      return effect;
    };
    programme.matrix.col(0) -= force_at(Eigen::Vector3d::UnitZ()) / double(count);
    for (int k = 0; k < kSides; ++k) {
      const Eigen::Vector3d ray(surface.friction * std::cos(k * step),
                                surface.friction * std::sin(k * step), 1.0);
      programme.matrix.col(1 + kSides * i + k) = force_at(ray);
    }
  }
  programme.lower = programme.upper = wrench / weight_N;
  const std::optional<DenseSolution> solution = solve(programme);
  return solution ? solution->x[0] : kBeyond;
}

WrenchCheck::WrenchCheck(CheckContext& context)
    : context_(context),
      sampler_(context.curve),
      weight_(context.robot.total_mass() * standard_gravity().norm()),
      forces_(context.vertices()),
      wrenches_("plan_wrenches", "ratio", 1.0, Worse::kHigher, context.vertices(),
                limits::kBalanceRounding) {}

std::string WrenchCheck::why_not() const {
  if (!context_.robot.floating_base()) return "the base is fixed to the world";
  if (!(weight_ > 0.0)) return "no link has a mass";
  if (context_.motion.wrenches.empty()) return "no wrenches are stated";
  return "";
}

bool WrenchCheck::goes_on_beyond(int vertex) const {
  return (vertex == 0 && !context_.options.starts_at_rest) ||
         (vertex + 1 == static_cast<int>(context_.vertices()) && !context_.options.ends_at_rest);
}

void WrenchCheck::run() {
  if (!why_not().empty()) return;
  dynamics_.emplace(context_.robot);
  for (std::size_t i = 0; i < context_.vertices(); ++i) {
    const int vertex = static_cast<int>(i);
    context_.begin_work("judging wrenches", vertex);
    if (context_.stance_from(vertex) == nullptr || !context_.usable.vertices[i]) continue;
    judge_vertex(vertex);
    if (i > 0 && context_.usable.steps[i - 1]) judge_changes(vertex - 1);
  }
}

void WrenchCheck::add(int vertex, double ratio, const std::string& what) {
  wrenches_.add(ratio, vertex, context_.motion.time_s[std::size_t(vertex)], Eigen::Vector3d::Zero(),
                [&] { return what; });
}

bool WrenchCheck::states_at(int vertex) const {
  return !forces_[static_cast<std::size_t>(vertex)].empty();
}

void WrenchCheck::judge_vertex(int vertex) {
  const JudgedStance& stance = *context_.stance_from(vertex);
  const StanceWrenches& wrenches = context_.motion.wrenches[static_cast<std::size_t>(vertex)];
  if (wrenches.size() != stance.contacts.size()) {
    add(vertex, kBeyond,
        wrenches.empty() ? "none are stated, or not of each contact that bears it"
                         : "they are stated at other contacts than it has");
    return;
  }
  if (!std::ranges::all_of(wrenches, [](const Wrench& wrench) { return wrench.allFinite(); })) {
    add(vertex, kBeyond, "they are not finite");
    return;
  }
  sampler_.link_poses(vertex, 0.0, poses_);
  const JudgedStance* before = vertex > 0 ? context_.stance_from(vertex - 1) : nullptr;
  std::vector<JudgedBearing> bearing;
  std::vector<LoadedContact> loaded;
  bearing.reserve(wrenches.size());
  std::vector<Eigen::Vector3d>& forces = forces_[static_cast<std::size_t>(vertex)];
  for (std::size_t k = 0; k < wrenches.size(); ++k) {
    const JudgedContact& contact = stance.contacts[k];
    bearing.push_back(bearing_at(contact, context_.world, poses_));
    loaded.push_back(loaded_contact(sampler_.state(), bearing.back().contact));
    const bool closes = before != nullptr && contact_of(*before, contact) == nullptr;
    forces.emplace_back(closes ? Eigen::Vector3d::Zero().eval()
                               : Eigen::Vector3d(loaded.back().axes * wrenches[k].head<3>()));
    if (closes || !bearing.back().contact.bears_load) {
      const double carried =
          std::max(wrenches[k].head<3>().norm(), wrenches[k].tail<3>().norm()) / weight_;
      add(vertex, carried / limits::kWrenchLeftOver,
          told(contact.name(),
               closes ? " carries %.4g of the weight where it closes"
                      : " carries %.4g of the weight and bears nothing there",
               carried));
    } else {
      judge_contact(vertex, bearing.back(), wrenches[k]);
    }
  }
  if (!goes_on_beyond(vertex)) judge_balance(vertex, loaded, wrenches);
}

WrenchCheck::Demand WrenchCheck::demand_at(int vertex) {
  const auto number = static_cast<std::size_t>(vertex);
  const int size = context_.robot.tangent_size();
  const auto of = [&](const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration) {
    Eigen::VectorXd demand(size);
    dynamics_->inverse_dynamics(sampler_.state(), velocity, acceleration, {}, demand);
    return demand;
  };
  const auto on_curve = [&](int step, double fraction) {
    CurvePoint point;
    context_.curve.step(step).at(fraction, point);
    return of(point.velocity, point.acceleration);
  };
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(size);
  Demand demand;
  demand.before = vertex > 0 && context_.usable.steps[number - 1] ? on_curve(vertex - 1, 1.0)
                                                                  : of(still, still);
  demand.after = context_.usable.steps[number] ? on_curve(vertex, 0.0) : of(still, still);
  return demand;
}

void WrenchCheck::judge_balance(int vertex, const std::vector<LoadedContact>& contacts,
                                const StanceWrenches& wrenches) {
  const auto [before, after] = demand_at(vertex);
  Eigen::VectorXd borne = Eigen::VectorXd::Zero(context_.robot.tangent_size());
  for (std::size_t k = 0; k < contacts.size(); ++k)
    add_wrench_torques(sampler_.state(),
                       contacts[k].applied(sampler_.state(), Eigen::Vector3d::Zero(), wrenches[k]),
                       1.0, borne);
  const Eigen::VectorXd jump = after - before;
  const double length = jump.head<6>().squaredNorm();
  const double jumps = std::sqrt(length) / weight_;
  add(vertex, jumps / limits::kForceJump,
      told("", "forces would have to jump by %.4g of the weight", jumps));
  const double share =
      length > 0.0 ? std::clamp((borne - before).head<6>().dot(jump.head<6>()) / length, 0.0, 1.0)
                   : 0.0;
  const Eigen::VectorXd torques = before + share * jump - borne;
  const double left_over = torques.head<6>().norm() / weight_;
  add(vertex, left_over / limits::kWrenchLeftOver,
      told("", "%.4g of the weight is left over", left_over));
  if (!context_.options.enforce_torque_limits) return;
  double most = 0.0;
  std::string joint_name;
  for (int i = 0; i < context_.robot.active_joint_count(); ++i) {
    const Joint& joint = context_.robot.active_joint(i);
    const double limit = context_.options.effort_scale * joint.max_effort;
    if (!(limit > 0.0) || std::isinf(limit)) continue;
    const double ratio = std::abs(torques[context_.robot.base_tangent_size() + i]) / limit;
    if (ratio <= most) continue;
    most = ratio;
    joint_name = joint.name;
  }
  add(vertex, most, "torque of " + joint_name);
}

void WrenchCheck::judge_contact(int vertex, const JudgedBearing& bearing, const Wrench& wrench) {
  const Contact& contact = bearing.contact;
  const EndEffector& effector = contact.effector;
  const std::string& name = contact.name();
  if (effector.kind == ContactKind::kGrasp) {
    for (const int component : {0, 1, 2, 3, 4, 5}) {
      // It bears no moment about its bar.
      const double limit = component < 3    ? effector.max_force_N
                           : component == 4 ? 0.0
                                            : effector.max_moment_Nm;
      const double amount = std::abs(wrench[component]);
      const double ratio = limit > 0.0 ? amount / limit : as_ratio(0.0, amount / weight_);
      add(vertex, ratio, "limit of " + name);
    }
    return;
  }
  const double pressing = wrench[2];
  add(vertex, pressing / effector.max_force_N, "force limit of " + name);
  const double used =
      pressing > 0.0 ? wrench.head<2>().norm() / (effector.friction * pressing) : 0.0;
  double outside = 0.0;
  if (effector.kind == ContactKind::kSurface) {
    if (wrench.norm() > limits::kBalanceRounding * weight_)
      outside = outside_cones(effector, bearing.area, wrench, weight_);
  } else {
    outside = std::max(outside_cone(effector.friction, wrench.head<3>(), weight_),
                       wrench.tail<3>().norm() / weight_);
  }
  const bool part = !context_.options.starts_at_rest && effector.kind == ContactKind::kPoint;
  add(vertex, as_ratio(used, outside, part ? kRoundingOfParts : limits::kBalanceRounding),
      (effector.kind == ContactKind::kSurface ? "friction or area of " : "friction of ") + name);
}

void WrenchCheck::judge_changes(int vertex) {
  if (!states_at(vertex) || !states_at(vertex + 1)) return;
  const JudgedStance &here = *context_.stance_from(vertex),
                     &there = *context_.stance_from(vertex + 1);
  const auto number = static_cast<std::size_t>(vertex);
  const double seconds = context_.motion.time_s[number + 1] - context_.motion.time_s[number];
  for (std::size_t k = 0; k < here.contacts.size(); ++k) {
    const JudgedContact* same = contact_of(there, here.contacts[k]);
    Eigen::Vector3d change = -forces_[number][k];
    if (same != nullptr)
      change += forces_[number + 1][static_cast<std::size_t>(same - there.contacts.data())];
    const double rate = change.norm() / (weight_ * seconds);
    add(vertex, rate / limits::kForceRate,
        told(here.contacts[k].name(), " changes by %.4g weights per second", rate));
  }
}

void WrenchCheck::report(std::vector<Violation>& violations) const {
  const std::string why = why_not();
  violations.push_back(wrenches_.result(why.empty() ? "no stance is known" : why));
}

}  // namespace locograph
