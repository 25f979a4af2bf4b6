#include <locograph/check/balance_certificate.h>
#include <locograph/check/limits.h>
#include <locograph/check/nearby_balance.h>
#include <locograph/check/robustness.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <ctime>
#include <numbers>

namespace locograph {
namespace {

constexpr int kBisections = 10, kDirections = 16;
constexpr double kMoment_s = 0.05;
/// Of what shrinks something is left: contacts and efforts are sound.
constexpr double kMostShare = 0.999, kMostMass = 1.0, kMostPush = 1.0;
constexpr int kMostPieces = 64;

/// What is changed: 0 friction, 1 area, 2 torque, 3 mass, from 4 on pushes.
enum Change { kFriction, kArea, kTorque, kMass, kPush };
constexpr int kChanges = kPush + kDirections;

double processor_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// A stance that is held in a row.
struct Stretch {
  int first = 0, last = 0;
  const JudgedStance* stance = nullptr;
};

struct Moment {
  int vertex = 0;
  double fraction = 0.0;
  bool at_rest = false;
};

class StretchWorker {
 public:
  explicit StretchWorker(CheckContext& context)
      : context_(context),
        sampler_(context.curve),
        nearby_(context.robot),
        weight_N_(context.robot.total_mass() * standard_gravity().norm()),
        has_torque_(context.options.enforce_torque_limits &&
                    context.robot.active_joint_count() > 0) {}

  Robustness least_of(const Stretch& stretch) {
    stance_ = stretch.stance;
    has_friction_ = has_area_ = false;
    for (const JudgedContact& contact : stance_->contacts) {
      if (!contact.contact.bears_load) continue;
      has_friction_ = has_friction_ || !contact.is_grasp();
      has_area_ = has_area_ || contact.contact.effector.kind == ContactKind::kSurface;
    }
    least_ = {kMostShare, kMostShare, kMostShare, kMostMass, kMostPush};
    for (std::optional<BalanceCertificate>& known : known_) known.reset();
    for (const Moment& moment : moments_of(stretch)) judge(moment);
    Robustness told;
    if (has_friction_) told.friction = least_[kFriction];
    if (has_area_) told.area = least_[kArea];
    if (has_torque_) told.torque = least_[kTorque];
    told.mass = least_[kMass];
    told.push_N = least_[kPush] * weight_N_;
    return told;
  }

 private:
  std::vector<Moment> moments_of(const Stretch& stretch) const {
    std::vector<Moment> moments;
    const bool moves = !context_.motion.stances_only;
    const int end = int(context_.vertices()) - 1;
    for (int vertex = stretch.first; vertex <= stretch.last; ++vertex) {
      const auto number = std::size_t(vertex);
      if (!context_.usable.vertices[number]) continue;
      const bool arrives = vertex > stretch.first && moves && context_.usable.steps[number - 1];
      const bool goes_on = vertex < stretch.last && moves && context_.usable.steps[number];
      const bool rests = (vertex == 0 && context_.options.starts_at_rest) ||
                         (vertex == end && context_.options.ends_at_rest);
      if (rests || (!arrives && !goes_on)) moments.push_back({vertex, 0.0, true});
      if (arrives) moments.push_back({vertex - 1, 1.0});
      if (!goes_on) continue;
      const double seconds = context_.curve.step(vertex).duration_s();
      const int pieces =
          std::clamp(int(std::min(std::ceil(seconds / kMoment_s), 1e6)), 1, kMostPieces);
      for (int piece = 0; piece < pieces; ++piece)
        moments.push_back({vertex, double(piece) / pieces});
    }
    return moments;
  }

  void judge(const Moment& moment) {
    context_.begin_work("judging robustness", moment.vertex);
    sampler_.link_poses(moment.vertex, moment.fraction, poses_);
    motion_.reset();
    if (!moment.at_rest) {
      CurvePoint point;
      context_.curve.step(moment.vertex).at(moment.fraction, point);
      motion_ = BalanceMotion{point.velocity, point.acceleration};
    }
    bearing_.clear();
    for (const JudgedContact& contact : stance_->contacts)
      bearing_.push_back(bearing_at(contact, context_.world, poses_));
    bool as_is = false;  // it is known to hold unchanged
    for (int change = 0; change < kChanges; ++change) {
      if (change == kFriction && !has_friction_) continue;
      if (change == kArea && !has_area_) continue;
      if (change == kTorque && !has_torque_) continue;
      double& least = least_[std::size_t(std::min(change, int(kPush)))];
      if (least == 0.0) continue;
      if (holds(change, least)) {
        // More mass may balance what falls without it; less of the others does not.
        if (change != kMass) {
          as_is = true;
        } else if (!as_is && !holds(kMass, 0.0)) {
          least = 0.0;
        }
        continue;
      }
      double low = 0.0, high = least;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + high);
        (holds(change, middle) ? low : high) = middle;
      }
      // Not even as it is: the first half would have held, had anything.
      least = low;
    }
  }

  bool holds(int change, double amount) {
    BalanceOptions options = changed(change, amount);
    std::optional<BalanceCertificate>& known = known_[std::size_t(change)];
    if (known && nearby_.prove(sampler_.state(), contacts_, options, *known).margin_at_least >= 0.0)
      return true;
    BalanceCertificate found =
        certify_balance(context_.robot, sampler_.configuration(), contacts_, options);
    if (!found.balanced) return false;
    known = std::move(found);
    return true;
  }

  /// And the contacts.
  BalanceOptions changed(int change, double amount) {
    BalanceOptions options;
    options.enforce_torque_limits = context_.options.enforce_torque_limits;
    options.effort_scale = context_.options.effort_scale;
    options.least_violation = false;
    options.motion = motion_;
    contacts_.clear();
    for (std::size_t k = 0; k < bearing_.size(); ++k) {
      JudgedBearing bearing = bearing_[k];
      if (change == kArea && bearing.contact.effector.kind == ContactKind::kSurface) {
        JudgedContact smaller = stance_->contacts[k];
        smaller.contact.effector.half_x_m *= 1.0 - amount;
        smaller.contact.effector.half_y_m *= 1.0 - amount;
        bearing = bearing_at(smaller, context_.world, poses_);
      }
      if (change == kFriction) bearing.contact.effector.friction *= 1.0 - amount;
      options.areas.push_back(std::move(bearing.area));
      contacts_.push_back(std::move(bearing.contact));
    }
    if (change == kTorque) options.effort_scale *= 1.0 - amount;
    const Eigen::Isometry3d& root = poses_[std::size_t(context_.robot.root_link())];
    if (change == kMass) {
      PointWrench load{.link = context_.robot.root_link()};
      load.force = amount * context_.robot.total_mass() *
                   (standard_gravity() - root.linear() * acceleration_of_base());
      options.loads.push_back(load);
    }
    if (change >= kPush) {
      const double angle = 2.0 * std::numbers::pi * (change - kPush) / kDirections;
      PointWrench push{.link = context_.robot.root_link()};
      push.point = root.inverse() * sampler_.state().center_of_mass();
      push.force = amount * weight_N_ * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0);
      options.loads.push_back(push);
    }
    return options;
  }

  /// Of its origin, along the base's axes.
  Eigen::Vector3d acceleration_of_base() const {
    if (!motion_) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d linear = motion_->velocity.head<3>(),
                          angular = motion_->velocity.segment<3>(3);
    return motion_->acceleration.head<3>() + angular.cross(linear);
  }

  CheckContext& context_;
  MotionSampler sampler_;
  NearbyBalance nearby_;
  double weight_N_;
  bool has_torque_;
  const JudgedStance* stance_ = nullptr;
  bool has_friction_ = false, has_area_ = false;
  std::array<double, kPush + 1> least_{};
  std::array<std::optional<BalanceCertificate>, kChanges> known_;
  // Of the moment.
  LinkPoses poses_;
  std::optional<BalanceMotion> motion_;
  std::vector<JudgedBearing> bearing_;
  std::vector<Contact> contacts_;
};

std::vector<Stretch> stretches_of(const CheckContext& context) {
  std::vector<Stretch> stretches;
  const int vertices = int(context.vertices());
  for (int vertex = 0; vertex < vertices; ++vertex) {
    const JudgedStance* stance = context.stance_from(vertex);
    if (!stretches.empty() && stretches.back().last == vertex &&
        stretches.back().stance == stance) {
      stretches.back().last = std::min(vertex + 1, vertices - 1);
    } else if (stance != nullptr) {
      stretches.push_back({vertex, std::min(vertex + 1, vertices - 1), stance});
    }
  }
  return stretches;
}

void take_least(std::optional<double>& least, const std::optional<double>& other) {
  if (other) least = std::min(least.value_or(*other), *other);
}

}  // namespace

std::optional<RobustnessReport> robustness_of(CheckContext& context, ThreadPool& threads) {
  if (!context.robot.floating_base() || !(context.robot.total_mass() > 0.0)) return std::nullopt;
  const std::vector<Stretch> stretches = stretches_of(context);
  if (stretches.empty()) return std::nullopt;
  RobustnessReport report;
  report.by_stance.resize(stretches.size());
  std::vector<double> spent(std::size_t(threads.size()), 0.0);
  std::atomic<std::size_t> next{0};
  threads.run(threads.size(), [&](int thread) {
    const double begin_s = processor_s();
    StretchWorker worker(context);
    for (std::size_t i; (i = next++) < stretches.size();) {
      const Stretch& stretch = stretches[i];
      report.by_stance[i] = {.stance = int(stretch.stance - context.stances.data()),
                             .first_vertex = stretch.first,
                             .last_vertex = stretch.last,
                             .from_s = context.motion.time_s[std::size_t(stretch.first)],
                             .until_s = context.motion.time_s[std::size_t(stretch.last)],
                             .least = worker.least_of(stretch)};
    }
    spent[std::size_t(thread)] = processor_s() - begin_s;
  });
  for (const RobustnessReport::OfStance& one : report.by_stance) {
    take_least(report.least.friction, one.least.friction);
    take_least(report.least.area, one.least.area);
    take_least(report.least.torque, one.least.torque);
    take_least(report.least.push_N, one.least.push_N);
    take_least(report.least.mass, one.least.mass);
  }
  for (const double seconds : spent) report.processor_s += seconds;
  return report;
}

}  // namespace locograph
