#include <locograph/types/slam2d/lines.h>

namespace locograph {
template class TypedVertexPool<VertexLine2D>;
template class TypedVertexPool<VertexSegment2D>;
template class TypedEdgePool<EdgeSE2Line2D>;
template class TypedEdgePool<EdgeLine2D>;
template class TypedEdgePool<EdgeLine2DPointXY>;
template class TypedEdgePool<EdgeSE2Segment2D>;
template class TypedEdgePool<EdgeSE2Segment2DLine>;
template class TypedEdgePool<EdgeSE2Segment2DPointLine>;

void add_slam2d_line_types(TypeRegistry& types) {
  types.add_vertex<VertexLine2D>();
  types.add_vertex<VertexSegment2D>();
  types.add_edge<EdgeSE2Line2D>();
  types.add_edge<EdgeLine2D>();
  types.add_edge<EdgeLine2DPointXY>();
  types.add_edge<EdgeSE2Segment2D>();
  types.add_edge<EdgeSE2Segment2DLine>();
  types.add_edge<EdgeSE2Segment2DPointLine>();
}

}  // namespace locograph
