#include <locograph/core/graph.h>
#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>

#include <algorithm>

namespace locograph {

template class TypedEdgePool<EdgeContactWrench>;

namespace {

int rows_of(const ContactList& contacts) {
  int rows = 0;
  for (const auto& contact : contacts) rows += contact->cone->rows();
  return rows;
}

/// f(row of the edge, first component of the contact, components, limit, value) for all rows.
template <class F>
void each_row(const WrenchesState& wrenches, F&& f) {
  int begin = 0, first = 0;
  for (const auto& contact : *wrenches.contacts) {
    const int count = static_cast<int>(contact->cone->components().size());
    const double* w = wrenches.components.data() + first;
    for (int row = 0; row < contact->cone->rows(); ++row) {
      const WrenchRow limit = contact->cone->row(row, w);
      double value = limit.offset;
      for (int c = 0; c < count; ++c) value += limit.gradient[c] * w[c];
      f(begin + row, first, count, limit, value);
    }
    begin += contact->cone->rows();
    first += count;
  }
}

}  // namespace

EdgeContactWrench::EdgeContactWrench(const ContactList& contacts, double weight) {
  weights.setConstant(rows_of(contacts), weight);
}

void EdgeContactWrench::check(const Graph& graph) const {
  const VertexWrenches& wrenches = graph.vertex(VertexId<VertexWrenches>{vertices[0]});
  require_rows(kTag, dimension(), rows_of(*wrenches.contacts));
}

void EdgeContactWrench::error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), rows_of(*wrenches.contacts));
  each_row(wrenches, [&](int row, int, int, const WrenchRow&, double value) {
    e[row] = std::max(0.0, value);
  });
}

void EdgeContactWrench::jacobians(const WrenchesState& wrenches,
                                  JacobianRef<EdgeContactWrench, 0> j) const {
  each_row(wrenches, [&](int row, int first, int count, const WrenchRow& limit, double value) {
    if (value <= 0.0) return;
    for (int c = 0; c < count; ++c) j(row, first + c) = limit.gradient[c];
  });
}

RowLabel EdgeContactWrench::row_label(int row, const VertexWrenches& wrenches) const {
  for (const auto& contact : *wrenches.contacts) {
    if (row < contact->cone->rows()) {
      const ContactRowLabel label = contact->cone->label(row);
      return {contact->contact.name() + " " + label.name, label.unit};
    }
    row -= contact->cone->rows();
  }
  return {};
}

}  // namespace locograph
