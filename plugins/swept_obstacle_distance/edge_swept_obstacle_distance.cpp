#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>

#include <algorithm>
#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeSweptObstacleDistance>;

EdgeSweptObstacleDistance::EdgeSweptObstacleDistance(const RobotParameter& robot, int number,
                                                     double margin, int sample_count, double weight)
    : world_number(number), margin_m(margin), samples(sample_count) {
  weights.setConstant(static_cast<Eigen::Index>(robot.spheres.size()), weight);
}

void EdgeSweptObstacleDistance::bind(const Parameters& parameters) {
  require_margin(kTag, margin_m);
  if (samples < 1 || samples > kMostSamples) {
    throw locograph::Error("number of samples " + std::to_string(samples),
                           "1 to " + std::to_string(kMostSamples));
  }
  world = parameters.get<WorldParameter>(world_number);
  require_fitting_robot(parameters, kTag, dimension(), [](const RobotParameter& p) {
    return static_cast<long>(p.spheres.size());
  });
}

namespace {

/// How an obstacle moves from one time to another.
struct ObstacleStep {
  Eigen::Vector3d shift;
  double turn;  ///< how far at most a point of it moves by the rotation [m]
};

ObstacleStep obstacle_step(const Obstacle& obstacle, double from_s, double to_s) {
  if (obstacle.motion.empty()) return {Eigen::Vector3d::Zero(), 0.0};
  const Eigen::Isometry3d from = obstacle.pose_at(from_s), to = obstacle.pose_at(to_s);
  double radius = 0.0;  // a sphere may turn as it likes
  if (obstacle.shape == Obstacle::Shape::kBox) radius = 0.5 * obstacle.size.norm();
  if (obstacle.shape == Obstacle::Shape::kCylinder) {
    radius = std::hypot(obstacle.size[0], 0.5 * obstacle.size[1]);
  }
  const double cosine = 0.5 * ((from.linear().transpose() * to.linear()).trace() - 1.0);
  return {to.translation() - from.translation(), radius * std::acos(std::clamp(cosine, -1.0, 1.0))};
}

/// Where a sphere lacks most of its distance.
struct Worst {
  double lack = 0.0;              ///< ≤ 0: nowhere
  double fraction = 0.0;          ///< of the way
  Eigen::Vector3d gradient;       ///< of the distance there
  Eigen::Vector3d padding_slope;  ///< d√(ρ² + h²) / d(c_b − c_a)
};

/// √(ρ² + h²) and its derivative, for a way relative to what is to be avoided.
struct Padding {
  double value;
  double to_last_sample;  ///< from the middle of the way
  Eigen::Vector3d slope;

  Padding(double rho, const Eigen::Vector3d& way, double turn, int samples) {
    const double length = way.norm(), half_gap = (length + turn) / (2.0 * samples);
    value = std::sqrt(rho * rho + half_gap * half_gap);
    to_last_sample = 0.5 * (length + turn) - half_gap;
    slope.setZero();
    if (length > 0.0) slope = half_gap / (2.0 * samples * value * length) * way;
  }
};

/// One step of the robot through the world.
class Step {
 public:
  Step(const EdgeSweptObstacleDistance& edge, const ConfigurationState& a,
       const ConfigurationState& b, const Bindings& bindings)
      : world_(bindings.get(edge.world_number, *edge.world).snapshot->distance()),
        margin_m_(edge.margin_m),
        samples_(edge.samples),
        a_(a),
        b_(b) {
    for (const Obstacle& obstacle : world_.obstacles) {
      if (!is_there(obstacle)) continue;
      const ObstacleStep step = obstacle_step(obstacle, a.time_s, b.time_s);
      world_moves_m_ = std::max(world_moves_m_, step.shift.norm() + step.turn);
    }
  }

  /// Calls f(sphere, worst) for every sphere that lacks distance somewhere.
  template <class F>
  void each_lacking_sphere(F&& f) const {
    const std::vector<RobotParameter::LinkBound>& bounds = a_.robot->bounds;
    for (std::size_t link = 0; link < bounds.size(); ++link) {
      if (is_far(bounds[link], a_.bound_centre(link), b_.bound_centre(link))) continue;
      for (int i = bounds[link].begin; i < bounds[link].end; ++i) {
        const Worst worst = worst_of(i);
        if (worst.lack > 0.0) f(i, worst);
      }
    }
  }

 private:
  double time_at(double fraction) const { return a_.time_s + fraction * (b_.time_s - a_.time_s); }
  bool is_there(const Obstacle& obstacle) const { return obstacle.is_there(a_.time_s, b_.time_s); }

  /// At any time a centre of the link's spheres is within radius − r of the point on the way of the
  /// bound's centre, and that is within half its length of its middle.
  bool is_far(const RobotParameter::LinkBound& bound, const Eigen::Vector3d& from,
              const Eigen::Vector3d& to) const {
    const double length = (to - from).norm();
    const auto reach_of = [&](double turn) {  // of a unit vector, at most
      const double half_gap = (length + turn * bound.radius + world_moves_m_) / (2.0 * samples_);
      return bound.radius + margin_m_ + half_gap + 0.5 * length + world_moves_m_;
    };
    constexpr double kMostTurn = 2.0;
    const Eigen::Vector3d middle = 0.5 * (from + to);
    const double time_s = time_at(0.5), distance = world_.distance(middle, time_s);
    double reach = reach_of(kMostTurn);
    if (distance <= reach || reach >= world_.max_distance()) {
      reach = reach_of(std::sqrt(0.5) * (b_.kinematics.world_from_link(bound.link).linear() -
                                         a_.kinematics.world_from_link(bound.link).linear())
                                            .norm());
      if (distance <= reach || reach >= world_.max_distance()) return false;
    }
    return std::ranges::none_of(world_.obstacles, [&](const Obstacle& obstacle) {
      return is_there(obstacle) && !obstacle.is_there(time_s) &&
             obstacle.sample_shape(middle, time_s).distance <= reach;
    });
  }

  Worst worst_of(int sphere) const {
    Worst worst;
    const double rho = a_.robot->spheres[sphere].radius + margin_m_;
    const Eigen::Vector3d& from = a_.sphere_centres[sphere];
    const Eigen::Vector3d way = b_.sphere_centres[sphere] - from;
    const Padding at_rest(rho, way, 0.0, samples_);
    if (world_.sees_map()) {
      const auto sample = [&](const Eigen::Vector3d& point, double) {
        return world_.sample_map(point);
      };
      try_samples(from, way, at_rest, worst, sample);
    }
    for (const Obstacle& obstacle : world_.obstacles) {
      if (!is_there(obstacle)) continue;
      const auto sample = [&](const Eigen::Vector3d& point, double fraction) {
        return obstacle.sample_shape(point, time_at(fraction));
      };
      if (obstacle.motion.empty()) {
        try_samples(from, way, at_rest, worst, sample);
      } else {
        const ObstacleStep step = obstacle_step(obstacle, a_.time_s, b_.time_s);
        try_samples(from, way, Padding(rho, way - step.shift, step.turn, samples_), worst, sample);
        const DistanceSample at_end = sample(b_.sphere_centres[sphere], 1.0);
        if (rho - at_end.distance > worst.lack) {
          worst = {rho - at_end.distance, 1.0, at_end.gradient, Eigen::Vector3d::Zero()};
        }
      }
    }
    return worst;
  }

  template <class Sample>
  void try_samples(const Eigen::Vector3d& from, const Eigen::Vector3d& way, const Padding& padding,
                   Worst& worst, Sample&& sample) const {
    // No sample can be nearer than that.
    const Eigen::Vector3d middle = from + 0.5 * way;
    const double nearest = sample(middle, 0.5).distance - padding.to_last_sample;
    if (padding.value - nearest <= worst.lack) return;
    for (int k = 0; k < samples_; ++k) {
      const double fraction = (k + 0.5) / samples_;
      const DistanceSample found = sample(Eigen::Vector3d(from + fraction * way), fraction);
      const double lack = padding.value - found.distance;
      if (lack > worst.lack) worst = {lack, fraction, found.gradient, padding.slope};
    }
  }

  const WorldDistance& world_;
  double margin_m_;
  int samples_;
  const ConfigurationState& a_;
  const ConfigurationState& b_;
  double world_moves_m_ = 0.0;
};

}  // namespace

void EdgeSweptObstacleDistance::error(const ConfigurationState& a, const ConfigurationState& b,
                                      Eigen::Ref<Eigen::VectorXd> e,
                                      const Bindings& bindings) const {
  require_same_robot(kTag, a.robot, b.robot);
  require_rows(kTag, e.size(), static_cast<long>(a.robot->spheres.size()));
  e.setZero();
  Step(*this, a, b, bindings).each_lacking_sphere([&](int i, const Worst& worst) {
    e[i] = worst.lack;
  });
}

void EdgeSweptObstacleDistance::jacobians(const ConfigurationState& a, const ConfigurationState& b,
                                          JacobianRef<EdgeSweptObstacleDistance, 0> ja,
                                          JacobianRef<EdgeSweptObstacleDistance, 1> jb,
                                          const Bindings& bindings) const {
  Step(*this, a, b, bindings).each_lacking_sphere([&](int i, const Worst& worst) {
    const int link = a.robot->spheres[i].link;
    const Eigen::Vector3d by_first = -(1.0 - worst.fraction) * worst.gradient - worst.padding_slope;
    const Eigen::Vector3d by_second = -worst.fraction * worst.gradient + worst.padding_slope;
    a.kinematics.add_point_gradient(link, a.sphere_centres[i], by_first, 1.0, ja.row(i).data());
    b.kinematics.add_point_gradient(link, b.sphere_centres[i], by_second, 1.0, jb.row(i).data());
  });
}

}  // namespace locograph
