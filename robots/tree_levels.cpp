#include <locograph/common/level_table.h>
#include <locograph/robots/tree_kernels.h>

namespace locograph {

const TreeKernels& tree_kernels_at(const std::string& level) {
  return at_level<TreeKernels>(LOCOGRAPH_LEVEL_TABLE(tree_kernels), level);
}

const TreeKernels& tree_kernels() {
  static const TreeKernels& chosen = tree_kernels_at(simd_level());
  return chosen;
}

}  // namespace locograph
