#include <locograph/planners/online/window_check.h>
#include <locograph/plugins/contact/edge_contact.h>
#include <locograph/plugins/joint_limits/edge_joint_limits.h>
#include <locograph/plugins/obstacle_distance/edge_obstacle_distance.h>
#include <locograph/plugins/rolling/edge_rolling.h>
#include <locograph/plugins/velocity_limits/edge_velocity_limits.h>

#include <cmath>

namespace locograph {
namespace {

// What may be left of an error when a constraint counts as held; the feasibility checker allows
// several times as much.
constexpr double kContact_m = 5e-4, kTilt = 5e-3, kSlip_m = 1.5e-3, kVelocity = 1e-3;

/// How much of error row r of an edge is allowed; negative: the edge is no constraint.
class Allowance {
 public:
  Allowance(const EdgePool& pool, int index) {
    if (pool.type() == typeid(EdgeObstacleDistance)) {
      set("obstacle_distance", "m", typed<EdgeObstacleDistance>(pool, index).margin_m);
    } else if (pool.type() == typeid(EdgeJointLimits)) {
      set("joint_limits", "rad", typed<EdgeJointLimits>(pool, index).margin);
    } else if (pool.type() == typeid(EdgeVelocityLimits)) {
      set("velocity_limits", "rad", kVelocity);
    } else if (pool.type() == typeid(EdgeContact)) {
      set("contact", "m", kContact_m);
      odd_ = kTilt;
    } else if (pool.type() == typeid(EdgeRolling)) {
      set("rolling", "m", kSlip_m);
    }
  }
  double of_row(int r) const { return (r & 1) != 0 && odd_ >= 0.0 ? odd_ : all_; }
  bool constrains() const { return all_ >= 0.0; }
  const char* name() const { return name_; }
  const char* unit() const { return unit_; }

 private:
  template <class E>
  static const E& typed(const EdgePool& pool, int index) {
    return static_cast<const TypedEdgePool<E>&>(pool).edges[index];
  }
  void set(const char* name, const char* unit, double allowed) {
    name_ = name;
    unit_ = unit;
    all_ = allowed;
  }

  const char* name_ = "";
  const char* unit_ = "";
  double all_ = -1.0, odd_ = -1.0;
};

}  // namespace

WindowViolation check_window(Workspace& workspace, std::vector<ViolatedEdge>& violated) {
  violated.clear();
  WindowViolation result;
  double most = 0.0;
  std::vector<double> error;
  const Problem& problem = workspace.problem();
  for (std::size_t p = 0; p < problem.edges().size(); ++p) {
    const EdgePool& pool = *problem.graph().edge_pools()[p];
    for (std::size_t k = 0; k < problem.edges()[p].edges.size(); ++k) {
      const int index = problem.edges()[p].edges[k];
      const Allowance allowance(pool, index);
      if (!allowance.constrains()) break;
      error.resize(pool.dimension(index));
      workspace.error(static_cast<int>(p), static_cast<int>(k), error.data());
      bool edge_violated = false;
      for (std::size_t r = 0; r < error.size(); ++r) {
        const double allowed = allowance.of_row(static_cast<int>(r));
        const double excess = std::abs(error[r]) - allowed;
        if (excess <= 1e-9) continue;
        edge_violated = true;
        const double relative = excess / std::max(allowed, 1e-3);
        if (relative <= most) continue;
        most = relative;
        result = {allowance.name(), excess, allowance.unit(),
                  std::as_const(pool).vertices(index).front()};
      }
      if (edge_violated) violated.push_back({static_cast<int>(p), static_cast<int>(k)});
    }
  }
  return result;
}

}  // namespace locograph
