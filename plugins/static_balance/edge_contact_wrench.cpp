#include <locograph/plugins/configuration/edge_fit.h>
#include <locograph/plugins/static_balance/edge_contact_wrench.h>

#include <cmath>

namespace locograph {

template class TypedEdgePool<EdgeContactWrench>;

namespace {

/// gradient · components + offset ≤ 0.
struct Row {
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double offset = 0.0;
};

/// f(row, limit) for all rows of a contact with the components w; the circular cone's is linear
/// where it stands.
template <class F>
void each_limit(const ContactParameter& contact, const double* w, F&& f) {
  const EndEffector& given = contact.contact.effector;
  int row = 0;
  const auto next = [&](const Row& limit) { f(row++, limit); };
  if (given.kind == ContactKind::kGrasp) {
    for (int c = 0; c < 5; ++c) {
      Row limit;
      limit.gradient[c] = w[c] < 0.0 ? -1.0 : 1.0;
      limit.offset = c < 3 ? -given.max_force_N : -given.max_moment_Nm;
      next(limit);
    }
    return;
  }
  Row pull, press;
  pull.gradient[2] = -1.0;
  press.gradient[2] = 1.0;
  press.offset = -given.max_force_N;
  next(pull);
  next(press);
  if (contact.friction.cone == FrictionCone::kCircle) {
    Row friction;
    const double tangential = std::hypot(w[0], w[1]);
    if (tangential > 0.0) friction.gradient.head<2>() << w[0] / tangential, w[1] / tangential;
    friction.gradient[2] = -given.friction;
    next(friction);
  }
  for (const Eigen::Vector2d& facet : contact.facets) {
    Row friction;
    friction.gradient.head<3>() << facet.x(), facet.y(), -contact.facet_mu;
    next(friction);
  }
  if (given.kind != ContactKind::kSurface) return;
  const double x = given.half_x_m, y = given.half_y_m, mu = contact.yaw_mu;
  for (const int axis : {4, 3}) {
    for (const double sign : {1.0, -1.0}) {
      Row pressure;
      pressure.gradient[axis] = sign;
      pressure.gradient[2] = axis == 4 ? -x : -y;
      next(pressure);
    }
  }
  for (const double side : {-1.0, 1.0}) {
    for (const double a : {1.0, -1.0}) {
      for (const double b : {1.0, -1.0}) {
        Row yaw;
        yaw.gradient << a * y, b * x, -mu * (x + y), side * a * mu, side * b * mu, side;
        next(yaw);
      }
    }
  }
}

/// Of a row of each_limit().
RowLabel limit_label(const ContactParameter& contact, int row) {
  if (contact.kind() == ContactKind::kGrasp) {
    return row < 3 ? RowLabel{"force", "N"} : RowLabel{"moment", "N m"};
  }
  const int yaw_rows = 8, pressure_rows = 4;
  const int from_end = contact.limit_rows() - row;
  const bool surface = contact.kind() == ContactKind::kSurface;
  if (surface && from_end <= yaw_rows) return {"yaw moment", "N m"};
  if (surface && from_end <= yaw_rows + pressure_rows) return {"centre of pressure", "N m"};
  if (row < 2) return {row == 0 ? "pull" : "normal force", "N"};
  return {"friction", "N"};
}

int rows_of(const ContactList& contacts) {
  int rows = 0;
  for (const auto& contact : contacts) rows += contact->limit_rows();
  return rows;
}

/// f(row of the edge, first component of the contact, components, limit, value) for all rows.
template <class F>
void each_row(const WrenchesState& wrenches, F&& f) {
  int begin = 0, first = 0;
  for (const auto& contact : *wrenches.contacts) {
    const int count = static_cast<int>(contact->components().size());
    const double* w = wrenches.components.data() + first;
    each_limit(*contact, w, [&](int row, const Row& limit) {
      double value = limit.offset;
      for (int c = 0; c < count; ++c) value += limit.gradient[c] * w[c];
      f(begin + row, first, count, limit, value);
    });
    begin += contact->limit_rows();
    first += count;
  }
}

}  // namespace

EdgeContactWrench::EdgeContactWrench(const ContactList& contacts, double weight) {
  weights.setConstant(rows_of(contacts), weight);
}

void EdgeContactWrench::error(const WrenchesState& wrenches, Eigen::Ref<Eigen::VectorXd> e) const {
  require_rows(kTag, e.size(), rows_of(*wrenches.contacts));
  each_row(wrenches,
           [&](int row, int, int, const Row&, double value) { e[row] = std::max(0.0, value); });
}

void EdgeContactWrench::jacobians(const WrenchesState& wrenches,
                                  JacobianRef<EdgeContactWrench, 0> j) const {
  each_row(wrenches, [&](int row, int first, int count, const Row& limit, double value) {
    if (value <= 0.0) return;
    for (int c = 0; c < count; ++c) j(row, first + c) = limit.gradient[c];
  });
}

RowLabel EdgeContactWrench::row_label(int row, const VertexWrenches& wrenches) const {
  for (const auto& contact : *wrenches.contacts) {
    if (row < contact->limit_rows()) {
      RowLabel label = limit_label(*contact, row);
      label.name = contact->contact.name() + " " + label.name;
      return label;
    }
    row -= contact->limit_rows();
  }
  return {};
}

}  // namespace locograph
