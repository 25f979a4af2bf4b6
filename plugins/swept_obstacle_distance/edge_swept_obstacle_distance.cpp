#include <locograph/plugins/configuration/near_spheres.h>
#include <locograph/plugins/swept_obstacle_distance/edge_swept_obstacle_distance.h>

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr double kFar = std::numeric_limits<double>::infinity();

/// How an obstacle moves from one time to another.
struct ObstacleStep {
  bool moves = false;
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  double turn = 0.0;  ///< how far at most a point of it moves by the rotation [m]
};

ObstacleStep obstacle_step(const Obstacle& obstacle, double from_s, double to_s) {
  if (obstacle.motion.empty()) return {};
  const Eigen::Isometry3d from = obstacle.pose_at(from_s), to = obstacle.pose_at(to_s);
  double radius = 0.0;  // a sphere may turn as it likes
  if (obstacle.shape == Obstacle::Shape::kBox) radius = 0.5 * obstacle.size.norm();
  if (obstacle.shape == Obstacle::Shape::kCylinder) {
    radius = std::hypot(obstacle.size[0], 0.5 * obstacle.size[1]);
  }
  const double cosine = 0.5 * ((from.linear().transpose() * to.linear()).trace() - 1.0);
  return {true, to.translation() - from.translation(),
          radius * std::acos(std::clamp(cosine, -1.0, 1.0))};
}

/// Where a sphere lacks most of its distance.
struct Worst {
  double lack;                    ///< 0: nowhere
  double fraction;                ///< of the way
  Eigen::Vector3d gradient;       ///< of the distance there
  Eigen::Vector3d padding_slope;  ///< d√(ρ² + h²) / d(c_b − c_a)
};

/// √(ρ² + h²), for a way relative to what is to be avoided.
struct Padding {
  Eigen::Vector3d way;
  double length, half_gap, value;
  double to_last_sample;  ///< from the middle of the way

  Padding() = default;
  Padding(double rho, const Eigen::Vector3d& relative_way, double turn, int samples)
      : way(relative_way), length(way.norm()), half_gap((length + turn) / (2.0 * samples)) {
    value = std::sqrt(rho * rho + half_gap * half_gap);
    to_last_sample = 0.5 * (length + turn) - half_gap;
  }

  /// Its derivative by the way.
  Eigen::Vector3d slope(int samples) const {
    if (length == 0.0) return Eigen::Vector3d::Zero();
    return half_gap / (2.0 * samples * value * length) * way;
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
    Spheres near;
    const auto look_at = [&] {
      find_worst(near);
      for (int i = 0; i < near.count; ++i) {
        if (near.worst[i].lack > 0.0) f(near.of[i].number, near.worst[i]);
      }
      near.count = 0;
    };
    in_parts(0, static_cast<int>(bounds.size()), [&](int begin, int end) {
      PointBuffer middles;
      for (int i = begin; i < end; ++i) {
        middles.set(i - begin, 0.5 * (a_.bound_centre(i) + b_.bound_centre(i)));
      }
      double distances[PointBuffer::kMost];
      world_.distances(middles.first(end - begin), time_at(0.5), distances);
      for (int link = begin; link < end; ++link) {
        if (is_far(link, distances[link - begin])) continue;
        for (int i = bounds[link].begin; i < bounds[link].end; ++i) {
          add(i, near);
          if (near.count == PointBuffer::kMost) look_at();
        }
      }
    });
    if (near.count > 0) look_at();
  }

 private:
  double time_at(double fraction) const { return a_.time_s + fraction * (b_.time_s - a_.time_s); }
  bool is_there(const Obstacle& obstacle) const { return obstacle.is_there(a_.time_s, b_.time_s); }

  /// Spheres that are looked at together.
  struct Spheres {
    struct OnWay {
      int number;
      double rho;
      Eigen::Vector3d from, way;
      Padding at_rest;
    };
    int count = 0;
    OnWay of[PointBuffer::kMost];
    Worst worst[PointBuffer::kMost];
    PointBuffer middles;
  };

  void add(int number, Spheres& spheres) const {
    const Eigen::Vector3d from = a_.sphere_centre(number), way = b_.sphere_centre(number) - from;
    const double rho = a_.robot->spheres[static_cast<std::size_t>(number)].radius + margin_m_;
    spheres.middles.set(spheres.count, from + 0.5 * way);
    spheres.worst[spheres.count].lack = 0.0;
    spheres.of[spheres.count++] = {number, rho, from, way, Padding(rho, way, 0.0, samples_)};
  }

  /// Given the distance of the middle of its bound's way. At any time a centre
  /// of the link's spheres is within radius − r of the point on the way of the bound's centre, and
  /// that is within half its length of its middle.
  bool is_far(int link, double distance) const {
    const RobotParameter::LinkBound& bound = a_.robot->bounds[static_cast<std::size_t>(link)];
    const Eigen::Vector3d from = a_.bound_centre(link), to = b_.bound_centre(link);
    const double length = (to - from).norm();
    const auto reach_of = [&](double turn) {  // of a unit vector, at most
      const double half_gap = (length + turn * bound.radius + world_moves_m_) / (2.0 * samples_);
      return bound.radius + margin_m_ + half_gap + 0.5 * length + world_moves_m_;
    };
    constexpr double kMostTurn = 2.0;
    double reach = reach_of(kMostTurn);
    if (distance <= reach || reach >= world_.max_distance()) {
      reach = reach_of(std::sqrt(0.5) * (b_.kinematics.world_from_link(bound.link).linear() -
                                         a_.kinematics.world_from_link(bound.link).linear())
                                            .norm());
      if (distance <= reach || reach >= world_.max_distance()) return false;
    }
    const Eigen::Vector3d middle = 0.5 * (from + to);
    const double time_s = time_at(0.5);
    return std::ranges::none_of(world_.obstacles, [&](const Obstacle& obstacle) {
      return is_there(obstacle) && !obstacle.is_there(time_s) &&
             obstacle.sample_shape(middle, time_s).distance <= reach;
    });
  }

  void find_worst(Spheres& spheres) const {
    if (world_.sees_map()) find_worst(spheres, ObstacleStep(), OfMap{*this});
    for (const Obstacle& obstacle : world_.obstacles) {
      if (!is_there(obstacle)) continue;
      const OfObstacle thing{*this, obstacle};
      find_worst(spheres, obstacle_step(obstacle, a_.time_s, b_.time_s), thing);
      if (!obstacle.motion.empty()) look_at_end(spheres, thing);
    }
  }

  /// The map or one of the obstacles, at a fraction of the way: distances of points, and the
  /// gradient at one.
  struct OfMap {
    const Step& step;

    void distances(const PointList& points, double, double* found) const {
      std::fill_n(found, points.count, kFar);
      step.world_.lower_to_map(points, found);
    }
    Eigen::Vector3d gradient(const Eigen::Vector3d& point, double) const {
      return step.world_.sample_map(point).gradient;
    }
  };
  struct OfObstacle {
    const Step& step;
    const Obstacle& obstacle;

    void distances(const PointList& points, double fraction, double* found) const {
      std::fill_n(found, points.count, kFar);
      obstacle.lower_to_shape(points, step.time_at(fraction), found);
    }
    Eigen::Vector3d gradient(const Eigen::Vector3d& point, double fraction) const {
      return obstacle.sample_shape(point, step.time_at(fraction)).gradient;
    }
  };

  template <class Thing>
  void find_worst(Spheres& spheres, const ObstacleStep& step, const Thing& thing) const {
    struct Near {
      int i;
      bool worse;
      Padding padding;
    };
    double distances[PointBuffer::kMost];
    thing.distances(spheres.middles.first(spheres.count), 0.5, distances);
    Near near[PointBuffer::kMost];
    int count = 0;
    for (int i = 0; i < spheres.count; ++i) {
      const Spheres::OnWay& sphere = spheres.of[i];
      Padding padding = sphere.at_rest;
      if (step.moves) padding = {sphere.rho, sphere.way - step.shift, step.turn, samples_};
      // No sample can be nearer than that.
      const double nearest = distances[i] - padding.to_last_sample;
      if (padding.value - nearest > spheres.worst[i].lack) near[count++] = {i, false, padding};
    }
    for (int k = 0; k < samples_ && count > 0; ++k) {
      const double fraction = (k + 0.5) / samples_;
      PointBuffer points;
      for (int n = 0; n < count; ++n) {
        const Spheres::OnWay& sphere = spheres.of[near[n].i];
        points.set(n, sphere.from + fraction * sphere.way);
      }
      thing.distances(points.first(count), fraction, distances);
      for (int n = 0; n < count; ++n) {
        Worst& own = spheres.worst[near[n].i];
        const double lack = near[n].padding.value - distances[n];
        if (lack <= own.lack) continue;
        own.lack = lack;
        own.fraction = fraction;
        near[n].worse = true;
      }
    }
    for (int n = 0; n < count; ++n) {
      if (!near[n].worse) continue;
      const Spheres::OnWay& sphere = spheres.of[near[n].i];
      Worst& own = spheres.worst[near[n].i];
      own.gradient = thing.gradient(sphere.from + own.fraction * sphere.way, own.fraction);
      own.padding_slope = near[n].padding.slope(samples_);
    }
  }

  /// A thing that moves is seen where the step ends, too.
  void look_at_end(Spheres& spheres, const OfObstacle& thing) const {
    PointBuffer ends;
    for (int i = 0; i < spheres.count; ++i) ends.set(i, b_.sphere_centre(spheres.of[i].number));
    double distances[PointBuffer::kMost];
    thing.distances(ends.first(spheres.count), 1.0, distances);
    for (int i = 0; i < spheres.count; ++i) {
      const double lack = spheres.of[i].rho - distances[i];
      if (lack <= spheres.worst[i].lack) continue;
      spheres.worst[i] = {lack, 1.0, thing.gradient(b_.sphere_centre(spheres.of[i].number), 1.0),
                          Eigen::Vector3d::Zero()};
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
    a.kinematics.add_point_gradient(link, a.sphere_centre(i), by_first, 1.0, ja.row(i).data());
    b.kinematics.add_point_gradient(link, b.sphere_centre(i), by_second, 1.0, jb.row(i).data());
  });
}

}  // namespace locograph
