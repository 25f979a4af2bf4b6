#pragma once
/// VERTEX_WRENCHES: the wrenches at all contacts that bear a configuration.
///
///     VERTEX_WRENCHES id n contact_1 … contact_n  components…           (N, N m)
///
///     auto w = graph.add_vertex(9, VertexWrenches(graph.parameters(), {4, 5, 7}));
///     graph.add_edge(EdgeBalance(1.0, 1.0), configuration, w);
///     graph.set_eliminate(w.slot, true);
///
/// State and tangent: the free components of each contact's wrench one after the other, as
/// PARAMS_CONTACT lists them for its kind. One vertex holds all wrenches of a configuration since a
/// Schur complement eliminates vertices that share no edge: with it marked, what is solved has the
/// configurations' blocks alone.

#include <locograph/core/vertex.h>
#include <locograph/plugins/configuration/contact_parameter.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace locograph {

class Graph;

/// Wrenches with the contacts they act at.
struct WrenchesState {
  std::shared_ptr<const ContactList> contacts;
  Eigen::VectorXd components;
};

struct VertexWrenches : Vertex<Eigen::Dynamic, Eigen::Dynamic> {
  using Derived = WrenchesState;
  static constexpr bool kFlat = true;

  std::vector<int> contact_numbers;
  std::shared_ptr<const ContactList> contacts;

  VertexWrenches() = default;
  /// All components zero. Throws Error for unknown contacts, one named twice, one that bears no
  /// load, contacts of different robots, or none.
  VertexWrenches(const Parameters& parameters, std::vector<int> contact_numbers);

  int dimension() const { return static_cast<int>(state.size()); }
  void oplus(const double* s, const double* d, double* out) const {
    for (Eigen::Index i = 0; i < state.size(); ++i) out[i] = s[i] + d[i];
  }
  void ominus(const double* a, const double* b, double* d) const {
    for (Eigen::Index i = 0; i < state.size(); ++i) d[i] = a[i] - b[i];
  }
  Derived make_derived() const;
  void derive(const double* s, Derived& derived) const {
    if (derived.contacts != contacts) derived.contacts = contacts;
    std::copy_n(s, derived.components.size(), derived.components.data());
  }

  void read(FieldReader& in);
  void write(FieldWriter& out) const;
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_WRENCHES", VertexWrenches)

/// Marks every VERTEX_WRENCHES for elimination (files do not keep the mark); returns how many.
int mark_wrenches_for_elimination(Graph& graph);

}  // namespace locograph
