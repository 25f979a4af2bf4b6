#include <locograph/planners/offline/motion/ompl_manifold.h>
#include <ompl/base/Constraint.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/constraint/AtlasChart.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace locograph {
namespace {

namespace ob = ompl::base;

// Where they are among the coordinates.
constexpr int kQuaternionCoordinate = 3, kJointCoordinate = 7;
constexpr double kQuaternionScale = 2.0;
constexpr double kClosedForTrees = 1e-6;  // m, rad
constexpr double kRoomForBase_m = 1.0;    // around both ends
constexpr double kRoomForEndlessJoint_rad = std::numbers::pi;

// Charts, see AtlasStateSpace. Half of the samples lie further out than where charts are valid.
constexpr double kChartRadius = 0.8;
constexpr double kChartDistance = 0.15;  // to the manifold
constexpr double kChartAngle = std::numbers::pi / 6.0;
constexpr double kChartExploration = 0.75;
constexpr int kChartDraws = 50;

Eigen::VectorXd to_configuration(const Eigen::Ref<const Eigen::VectorXd>& x) {
  Eigen::VectorXd q = x;
  q.segment<4>(kQuaternionCoordinate).normalize();
  return q;
}

Eigen::Ref<const Eigen::VectorXd> fixed_coordinates(const ob::State* state) {
  return *state->as<ob::ConstrainedStateSpace::StateType>();
}

/// Closure of the contacts, and of the quaternion's norm.
class ClosureConstraint : public ob::Constraint {
 public:
  explicit ClosureConstraint(SegmentSpace& space)
      : ob::Constraint(static_cast<unsigned>(space.robot().configuration_size()),
                       static_cast<unsigned>(space.closure_rows() + 1), kClosedForTrees),
        space_(space) {}

  void function(const Eigen::Ref<const Eigen::VectorXd>& x,
                Eigen::Ref<Eigen::VectorXd> out) const override {
    space_.closure(to_configuration(x), error_);
    out.head(error_.size()) = error_;
    out[error_.size()] = unit_row(x);
  }

  /// Of the tangent's (v, omega), dp = R v and dq = 1/2 q omega, so that for a quaternion of norm 1
  /// omega = 2 G(q)^T dq with the columns of G = q i, q j, q k.
  void jacobian(const Eigen::Ref<const Eigen::VectorXd>& x,
                Eigen::Ref<Eigen::MatrixXd> out) const override {
    const Eigen::VectorXd q = to_configuration(x);
    space_.closure(q, error_, tangent_);
    const Eigen::Index rows = error_.size();
    const Eigen::Quaterniond base(q.data() + kQuaternionCoordinate);
    const Eigen::Vector3d v = base.vec();
    const double w = base.w();
    Eigen::Matrix<double, 4, 3> axes;  // of x y z w
    axes << w, -v.z(), v.y(), v.z(), w, -v.x(), -v.y(), v.x(), w, -v.x(), -v.y(), -v.z();
    out.topLeftCorner(rows, 3) = tangent_.leftCols<3>() * base.toRotationMatrix().transpose();
    out.block(0, kQuaternionCoordinate, rows, 4) = 2.0 /
                                                   x.segment<4>(kQuaternionCoordinate).norm() *
                                                   tangent_.middleCols<3>(3) * axes.transpose();
    out.topRightCorner(rows, out.cols() - kJointCoordinate) =
        tangent_.rightCols(out.cols() - kJointCoordinate);
    out.row(rows).setZero();
    out.row(rows).segment<4>(kQuaternionCoordinate) =
        2.0 / (kQuaternionScale * kQuaternionScale) * x.segment<4>(kQuaternionCoordinate);
  }

  bool project(Eigen::Ref<Eigen::VectorXd> x) const override {
    Eigen::VectorXd q = to_configuration(x);
    if (!space_.project(q)) return false;
    x = to_coordinates(q, x);
    return true;
  }

 private:
  static double unit_row(const Eigen::Ref<const Eigen::VectorXd>& x) {
    return x.segment<4>(kQuaternionCoordinate).squaredNorm() /
               (kQuaternionScale * kQuaternionScale) -
           1.0;
  }

  SegmentSpace& space_;
  mutable Eigen::VectorXd error_;
  mutable Eigen::MatrixXd tangent_;
};

ob::StateSpacePtr ambient_space(const SegmentSpace& space) {
  const Robot& robot = space.robot();
  const int size = robot.configuration_size();
  auto ambient = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(size));
  ob::RealVectorBounds bounds(static_cast<unsigned>(size));
  for (int i = 0; i < size; ++i) {
    const auto [least, most] = std::minmax(space.from()[i], space.to()[i]);
    const auto at = static_cast<std::size_t>(i);
    if (i < kQuaternionCoordinate) {
      bounds.low[at] = least - kRoomForBase_m;
      bounds.high[at] = most + kRoomForBase_m;
    } else if (i < kJointCoordinate) {
      bounds.low[at] = -1.5 * kQuaternionScale;
      bounds.high[at] = 1.5 * kQuaternionScale;
    } else {
      const Joint& joint = robot.active_joint(i - kJointCoordinate);
      bounds.low[at] = std::max(joint.lower, least - kRoomForEndlessJoint_rad);
      bounds.high[at] = std::min(joint.upper, most + kRoomForEndlessJoint_rad);
    }
  }
  ambient->setBounds(bounds);
  return ambient;
}

/// OMPL's own samplers draw from generators that one global one seeds. These have seeds of their
/// own.
class SamplerOfOurs : public ob::StateSampler {
 public:
  SamplerOfOurs(const ob::StateSpace* space, std::uint64_t seed) : ob::StateSampler(space) {
    rng_.setLocalSeed(static_cast<std::uint_fast32_t>(seed));
  }
  void sampleUniformNear(ob::State* state, const ob::State*, double) override {
    sampleUniform(state);
  }
  void sampleGaussian(ob::State* state, const ob::State*, double) override { sampleUniform(state); }
};

/// Configurations scattered about what lies straight between two waypoints, more or less, brought
/// to the contacts; every second one also to where it is valid.
class ScatteredSampler : public SamplerOfOurs {
 public:
  ScatteredSampler(const ob::StateSpace* space, SegmentSpace& segment, const Waypoints& way,
                   std::uint64_t seed)
      : SamplerOfOurs(space, seed), segment_(segment), way_(way) {}

  void sampleUniform(ob::State* state) override {
    const Robot& robot = segment_.robot();
    const double most = way_.size() > 2 ? kMostAboutWay : kMostAboutEnds;
    Eigen::VectorXd q, step(robot.tangent_size());
    for (int draw = 0; draw < kDraws; ++draw) {
      const double spread = most * std::pow(2.0, -rng_.uniformReal(0.0, kHalvings));
      for (double& part : step) part = rng_.gaussian(0.0, spread);
      step.head<6>() *= kSpreadOfBase;
      const Eigen::VectorXd& one = waypoint();
      q = segment_.half_way(one, waypoint(), rng_.uniform01());
      robot.integrate(q.data(), step.data(), q.data());
      for (int i = 0; i < robot.active_joint_count(); ++i) {
        const Joint& joint = robot.active_joint(i);
        q[kJointCoordinate + i] = std::clamp(q[kJointCoordinate + i], joint.lower, joint.upper);
      }
      const bool to_be_valid = rng_.uniformBool();
      if (to_be_valid ? segment_.solve(Eigen::VectorXd(q), {}, q) : segment_.project(q)) break;
      q = segment_.to();
    }
    coordinates_of(state) = to_coordinates(q, segment_.from());
  }

 private:
  const Eigen::VectorXd& waypoint() {
    return way_[static_cast<std::size_t>(rng_.uniformInt(0, static_cast<int>(way_.size()) - 1))];
  }

  static constexpr int kDraws = 8;
  static constexpr double kMostAboutEnds = 1.2, kMostAboutWay = 0.05;  // rad, m
  static constexpr double kHalvings = 4.0;
  static constexpr double kSpreadOfBase = 0.3;

  SegmentSpace& segment_;
  const Waypoints& way_;
};

/// A manifold in which an interpolation that is stopped gives how far it got; OMPL's own gives
/// where it began, and a tree gets the same state again.
template <class Manifold>
class SteppedSpace : public Manifold {
 public:
  SteppedSpace(const ob::StateSpacePtr& ambient, const ob::ConstraintPtr& constraint)
      : Manifold(ambient, constraint) {}

  void interpolate(const ob::State* from, const ob::State* to, double fraction,
                   ob::State* state) const override {
    std::vector<ob::State*> way;
    ob::State* const there = this->allocState();
    coordinates_of(there) =
        (1.0 - fraction) * fixed_coordinates(from) + fraction * fixed_coordinates(to);
    if (this->constraint_->project(there)) this->discreteGeodesic(from, there, false, &way);
    this->copyState(state, way.empty() ? from : way.back());
    for (ob::State* const one : way) this->freeState(one);
    this->freeState(there);
  }
  ob::StateSamplerPtr allocStateSampler() const override {
    return this->allocDefaultStateSampler();
  }
};

class ProjectedSpace : public SteppedSpace<ob::ProjectedStateSpace> {
 public:
  ProjectedSpace(SegmentSpace& segment, const Waypoints& way, std::uint64_t seed)
      : SteppedSpace(ambient_space(segment), std::make_shared<ClosureConstraint>(segment)),
        segment_(segment),
        way_(way),
        seed_(seed) {}
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<ScatteredSampler>(this, segment_, way_, seed_);
  }

 private:
  SegmentSpace& segment_;
  const Waypoints& way_;
  std::uint64_t seed_;
};

class AtlasSpace : public SteppedSpace<ob::AtlasStateSpace> {
 public:
  AtlasSpace(SegmentSpace& segment, const Waypoints& way, std::uint64_t seed)
      : SteppedSpace(ambient_space(segment), std::make_shared<ClosureConstraint>(segment)),
        segment_(segment),
        way_(way),
        seed_(seed) {
    setDelta(kTreeStep);
    setEpsilon(kChartDistance);
    setAlpha(kChartAngle);
    setRho(kChartRadius);
    setExploration(kChartExploration);
  }
  ob::StateSamplerPtr allocDefaultStateSampler() const override {
    return std::make_shared<Sampler>(this, segment_, way_, seed_);
  }

 private:
  /// Every second sample as of ob::AtlasStateSampler, which keeps its generator to itself. In a
  /// ball of twenty dimensions nearly all is out of balance, so that these alone get nowhere.
  class Sampler : public ScatteredSampler {
   public:
    Sampler(const AtlasSpace* space, SegmentSpace& segment, const Waypoints& way,
            std::uint64_t seed)
        : ScatteredSampler(space, segment, way, seed), atlas_(*space) {}

    void sampleUniform(ob::State* state) override {
      const auto* const on_atlas = state->as<StateType>();
      if (rng_.uniformBool()) {
        ScatteredSampler::sampleUniform(state);
        on_atlas->setChart(atlas_.owningChart(on_atlas));
        return;
      }
      const auto parts = static_cast<Eigen::Index>(atlas_.getManifoldDimension());
      Eigen::VectorXd u(parts);
      const Eigen::Ref<Eigen::VectorXd> x = coordinates_of(state);
      ob::AtlasChart* chart = nullptr;
      bool drawn = false;
      for (int draw = 0; draw < kChartDraws && !drawn; ++draw) {
        const int count = static_cast<int>(atlas_.charts_.size());
        chart = atlas_.charts_[static_cast<std::size_t>(rng_.uniformInt(0, count - 1))];
        for (double& part : u) part = rng_.gaussian01();
        u *= atlas_.getRho_s() * std::pow(rng_.uniform01(), 1.0 / static_cast<double>(parts)) /
             u.norm();
        drawn = chart->inPolytope(u) && chart->psi(u, x);
      }
      if (!drawn) {
        atlas_.copyState(state, chart->getOrigin());
        return;
      }
      chart->psiInverse(x, u);
      chart->borderCheck(u);
      on_atlas->setChart(atlas_.owningChart(on_atlas));
    }

   private:
    const AtlasSpace& atlas_;
  };

  SegmentSpace& segment_;
  const Waypoints& way_;
  std::uint64_t seed_;
};

}  // namespace

Eigen::VectorXd to_coordinates(const Eigen::VectorXd& q, const Eigen::VectorXd& near) {
  Eigen::VectorXd x = q;
  auto quaternion = x.segment<4>(kQuaternionCoordinate);
  quaternion *= quaternion.dot(near.segment<4>(kQuaternionCoordinate)) < 0.0 ? -kQuaternionScale
                                                                             : kQuaternionScale;
  return x;
}

Eigen::Ref<Eigen::VectorXd> coordinates_of(ob::State* state) {
  return *state->as<ob::ConstrainedStateSpace::StateType>();
}

Eigen::VectorXd configuration_of(const ob::State* state) {
  return to_configuration(fixed_coordinates(state));
}

std::shared_ptr<ob::ConstrainedStateSpace> projected_manifold(SegmentSpace& space,
                                                              const Waypoints& way,
                                                              std::uint64_t seed) {
  return std::make_shared<ProjectedSpace>(space, way, seed);
}

std::shared_ptr<ob::AtlasStateSpace> atlas_manifold(SegmentSpace& space, const Waypoints& way,
                                                    std::uint64_t seed) {
  return std::make_shared<AtlasSpace>(space, way, seed);
}

}  // namespace locograph
