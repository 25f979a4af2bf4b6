#include <locograph/common/level_table.h>
#include <locograph/core/row_kernels.h>

namespace locograph {

const RowKernels& row_kernels_at(const std::string& level) {
  return at_level<RowKernels>(LOCOGRAPH_LEVEL_TABLE(row_kernels), level);
}

const RowKernels& row_kernels() {
  static const RowKernels& chosen = row_kernels_at(simd_level());
  return chosen;
}

}  // namespace locograph
