#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/scalar_matrix.h>

#include <algorithm>

namespace locograph {

ScalarMatrix::ScalarMatrix(const BlockPattern& pattern) : size(pattern.scalar_size()) {
  begin.assign(1, 0);
  for (int c = 0; c < pattern.size(); ++c) {
    for (int j = 0; j < pattern.dimension[c]; ++j) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int r = pattern.row[k], first = pattern.scalar_begin[r];
        const int rows = r == c ? j + 1 : pattern.dimension[r];
        for (int i = 0; i < rows; ++i) row.push_back(first + i);
      }
      begin.push_back(static_cast<int>(row.size()));
    }
  }
  value.resize(row.size());
}

void ScalarMatrix::set(const BlockPattern& pattern, const double* values, const double* damping) {
  double* next = value.data();
  for (int c = 0; c < pattern.size(); ++c) {
    for (int j = 0; j < pattern.dimension[c]; ++j) {
      for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
        const int r = pattern.row[k], height = pattern.dimension[r];
        next = std::copy_n(values + pattern.value_offset[k] + j * height, r == c ? j + 1 : height,
                           next);
      }
      next[-1] += damping[pattern.scalar_begin[c] + j];
    }
  }
}

int find_failed_row(const BlockPattern& pattern, const double* values, const double* damping) {
  BlockCholesky solver;
  solver.analyse(pattern);
  solver.factorise(values, damping);
  return solver.failed_row();
}

}  // namespace locograph
