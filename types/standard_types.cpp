#include <locograph/core/dense_prior.h>
#include <locograph/types/bundle/bundle.h>
#include <locograph/types/slam2d/slam2d.h>
#include <locograph/types/slam3d/slam3d.h>
#include <locograph/types/standard_types.h>

namespace locograph {

TypeRegistry standard_types() {
  TypeRegistry types;
  add_slam2d_types(types);
  add_slam3d_types(types);
  add_bundle_types(types);
  types.add_edge_pool<DensePriorPool>();
  return types;
}

}  // namespace locograph
