#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

namespace locograph {

void EdgeSE2::jacobians(const SE2<double>& a, const SE2<double>& b, JacobianRef<EdgeSE2, 0> ja,
                        JacobianRef<EdgeSE2, 1> jb) const {
  // e_xy = R(−θz) (R(−θa) (b − a) − z); the derivative of R(−θa) is a quarter turn back.
  const double angle = a.angle() + measurement.angle();
  const double c = std::cos(angle), s = std::sin(angle);
  const Eigen::Vector2d d = b.translation() - a.translation();
  jb << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
  ja << -c, -s, c * d[1] - s * d[0], s, -c, -s * d[1] - c * d[0], 0.0, 0.0, -1.0;
}

void add_slam2d_types(TypeRegistry& types) {
  types.add_parameter<OffsetSE2>("PARAMS_SE2OFFSET");
  types.add_vertex<VertexSE2>();
  types.add_vertex<VertexXY>();
  types.add_edge<EdgeSE2>();
  types.add_edge<EdgeSE2XY>();
  types.add_edge<EdgeBearingSE2XY>();
  types.add_edge<EdgePriorSE2>();
  types.add_edge<EdgePriorSE2XY>();
  types.add_edge<EdgePointXY>();
  types.add_edge<EdgeSE2Offset>();
  types.add_edge<EdgeSE2XYOffset>();
}

}  // namespace locograph
