#pragma once
/// Start values that are off by a metre and a radian, the same for the same seed.
///
///     perturb(graph, 1);

#include <locograph/core/graph.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/slam3d/edges.h>

#include <Eigen/Geometry>
#include <random>

namespace locograph {

/// Moves every pose that is not fixed, in its own frame: each coordinate of the translation by a
/// normal deviate of 1 m, the heading, or in space the angle about a random axis, by one of 1 rad.
inline void perturb(Graph& graph, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
    if (!graph.vertex_alive(slot) || graph.vertex_record(slot).fixed) continue;
    double* state = graph.state(slot);
    const bool planar = graph.state_size(slot) == 3;
    for (int i = 0; i < (planar ? 2 : 3); ++i) state[i] += normal(engine);
    if (planar) {
      state[2] = wrap_angle(state[2] + normal(engine));
    } else {
      const Eigen::Vector3d axis(normal(engine), normal(engine), normal(engine));
      Eigen::Map<Eigen::Quaterniond> rotation(state + 3);
      rotation = rotation * Eigen::AngleAxisd(normal(engine), axis.normalized());
    }
  }
}

}  // namespace locograph
