#include <locograph/types/slam2d/calibration.h>
#include <locograph/types/standard_types.h>

namespace locograph {

void add_slam2d_calibration_types(TypeRegistry& types) {
  types.add_vertex<VertexOdomDifferential>();
  types.add_edge<EdgeSE2XYCalib>();
  types.add_edge<EdgeSE2Calib>();
  types.add_edge<EdgeSE2OdomDifferentialCalib>();
}

}  // namespace locograph
