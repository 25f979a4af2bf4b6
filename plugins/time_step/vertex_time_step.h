#pragma once
/// VERTEX_TIME_STEP: the time from one configuration of a plan to the next, as an unknown.
///
///     VERTEX_TIME_STEP id step                                          (s)
///
///     auto step = graph.add_vertex(100, VertexTimeStep(0.1));
///     graph.add_edge(EdgeDuration(1.0), step);
///     graph.add_edge(EdgeVelocityLimitsTimed(robot, 1.0, 0.0, 0.0, 1e4), from, to, step);
///
/// State: Δt > 0. Tangent (1): its logarithm, Δt ⊞ d = Δt exp(d). Every step of an optimiser leaves
/// Δt positive, so that Δq/Δt and Δq/Δt² exist at every trial; with an additive step only limits
/// could see to that, and limits give way by a little before they push back. Steps are relative: a
/// step of 1 ms and one of 1 s are equally easy to change by a tenth.
///
/// Edges on time steps do not read the time stamps of the configurations.

#include <locograph/core/vertex.h>

#include <cmath>
#include <string>

namespace locograph {

struct VertexTimeStep : Vertex<1, 1> {
  static constexpr bool kFlat = true;  // logarithms add

  template <class T>
  using View = T;
  template <class T>
  static T view(const T* s) {
    return s[0];
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    using std::exp;
    out[0] = s[0] * exp(d[0]);
  }
  static void ominus(const double* a, const double* b, double* d) { d[0] = std::log(a[0] / b[0]); }

  VertexTimeStep() { state[0] = 1.0; }
  /// Throws Error unless seconds > 0.
  explicit VertexTimeStep(double seconds) {
    if (!positive(seconds)) {
      throw Error("a time step of " + std::to_string(seconds) + " s", "more than 0 s");
    }
    state[0] = seconds;
  }
  double seconds() const { return state[0]; }

  void read(FieldReader& in) {
    state[0] = in.number();
    if (!positive(state[0])) {
      in.fail("a time step of " + std::to_string(state[0]) + " s", "more than 0 s");
    }
  }

 private:
  static bool positive(double seconds) { return seconds > 0.0 && std::isfinite(seconds); }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_TIME_STEP", VertexTimeStep)

}  // namespace locograph
