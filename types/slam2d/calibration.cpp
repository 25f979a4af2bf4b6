#include <locograph/types/slam2d/calibration.h>

namespace locograph {
template class TypedVertexPool<VertexOdomDifferential>;
template class TypedEdgePool<EdgeSE2XYCalib>;
template class TypedEdgePool<EdgeSE2Calib>;
template class TypedEdgePool<EdgeSE2OdomDifferentialCalib>;

void add_slam2d_calibration_types(TypeRegistry& types) {
  types.add_vertex<VertexOdomDifferential>();
  types.add_edge<EdgeSE2XYCalib>();
  types.add_edge<EdgeSE2Calib>();
  types.add_edge<EdgeSE2OdomDifferentialCalib>();
}

}  // namespace locograph
