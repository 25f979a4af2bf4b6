#include <locograph/types/slam3d/parameters.h>
#include <locograph/types/slam3d/planes_and_lines.h>

namespace locograph {
template class TypedVertexPool<VertexPlane>;
template class TypedVertexPool<VertexLine3D>;
template class TypedEdgePool<EdgeSE3Plane>;
template class TypedEdgePool<EdgeSE3PlaneCalib>;
template class TypedEdgePool<EdgePlane>;
template class TypedEdgePool<EdgeSE3Line3D>;

void VertexPlane::read(FieldReader& in) {
  Plane<double> plane;
  plane.read(in);
  store(plane, state.data());
  read_field(in, colour);
}
void VertexPlane::write(FieldWriter& out) const {
  write_field(out, state);
  write_field(out, colour);
}

void VertexLine3D::read(FieldReader& in) {
  Line3<double> line;
  line.read(in);
  store(line, state.data());
}

void EdgeSE3Line3D::bind(const Parameters& parameters) { parameters.get<OffsetSE3>(offset_number); }

void add_slam3d_plane_and_line_types(TypeRegistry& types) {
  types.add_vertex<VertexPlane>();
  types.add_vertex<VertexLine3D>();
  types.add_edge<EdgeSE3Plane>();
  types.add_edge<EdgeSE3PlaneCalib>();
  types.add_edge<EdgePlane>();
  types.add_edge<EdgeSE3Line3D>();
}

}  // namespace locograph
