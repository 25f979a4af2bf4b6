#include <locograph/core/constraint.h>

namespace locograph {

void constrain_error(const ConstraintRow* rows, bool one_sided, int n, double* e) {
  for (int r = 0; r < n; ++r) {
    e[r] = rows[r].scale * (e[r] + rows[r].shift);
    if (one_sided && e[r] < 0.0) e[r] = 0.0;
  }
}

void constrain_jacobian(const ConstraintRow* rows, bool one_sided, int n, int d, const double* e,
                        double* jacobian, bool by_row, bool hinged) {
  for (int r = 0; r < n; ++r) {
    const bool zero = e[r] == 0.0, inside = one_sided && zero;
    if (hinged ? zero : !inside && rows[r].scale == 1.0) continue;
    for (int c = 0; c < d; ++c) {
      double& entry = jacobian[by_row ? r * d + c : c * n + r];
      entry = inside ? 0.0 : entry * rows[r].scale;
    }
  }
}

}  // namespace locograph
