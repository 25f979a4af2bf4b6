#pragma once
/// EDGE_DURATION: what a time step costs.
///
///     EDGE_DURATION id  weight
///
///     for (const auto& step : steps) graph.add_edge(EdgeDuration(10.0), step);   // 10 per second
///
/// Error (1): √Δt [√s], so that the cost Ω e² = Ω Δt is a weight per second, and the cost of all
/// steps the weight times the duration of the plan: dividing a step in two changes nothing, nor
/// does it pay to make steps equal. (An error Δt would cost Ω Σ Δt².)

#include <locograph/core/typed_edge_pool.h>
#include <locograph/plugins/time_step/vertex_time_step.h>

namespace locograph {

struct EdgeDuration : Edge<1, VertexTimeStep> {
  static constexpr std::string_view kTag = "EDGE_DURATION";
  static constexpr std::string_view kUnit = "s^0.5";

  EdgeDuration() = default;
  explicit EdgeDuration(double weight_per_s) { information(0, 0) = weight_per_s; }

  void error(double step_s, Eigen::Ref<Eigen::Matrix<double, 1, 1>> e) const {
    e[0] = std::sqrt(step_s);
  }
  void jacobians(double step_s, JacobianRef<EdgeDuration, 0> j) const {
    j(0, 0) = 0.5 * std::sqrt(step_s);
  }
};
LOCOGRAPH_REGISTER_EDGE(EdgeDuration::kTag, EdgeDuration)
extern template class TypedEdgePool<EdgeDuration>;

}  // namespace locograph
