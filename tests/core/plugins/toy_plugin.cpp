// A good plug-in: a parameter, a vertex and an edge that also takes vertices of the standard types.

#include <locograph/core/plugin.h>
#include <locograph/types/slam2d/vertices.h>

namespace toy {

/// Metres in a unit of range.
struct Unit : locograph::Parameter {
  double metres = 1.0;
  std::string_view tag() const override { return "PARAMS_TOY_UNIT"; }
  void read(locograph::FieldReader& in) override {
    metres = in.number();
    if (metres <= 0.0) in.fail("a unit of " + std::to_string(metres), "metres > 0");
  }
  void write(locograph::FieldWriter& out) const override { out.number(metres); }
};

/// What every range is too long by.
struct VertexBias : locograph::Vertex<1, 1> {
  template <class T>
  using View = T;
  template <class T>
  static T view(const T* s) {
    return s[0];
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    out[0] = s[0] + d[0];
  }
};
LOCOGRAPH_REGISTER_VERTEX("VERTEX_TOY_BIAS", VertexBias)

struct EdgeRange : locograph::Edge<1, locograph::VertexSE2, locograph::VertexXY, VertexBias> {
  int unit_number = 0;
  double range = 0.0;
  double metres = 1.0;
  auto fields() { return std::tie(unit_number, range); }
  void bind(const locograph::Parameters& parameters) {
    metres = parameters.get<Unit>(unit_number)->metres;
  }
  template <class T>
  void error(const locograph::SE2<T>& pose, const Eigen::Matrix<T, 2, 1>& point, const T& bias,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    e[0] = (point - pose.translation()).norm() + bias - T(metres * range);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_TOY_RANGE", EdgeRange)

}  // namespace toy

static void register_types(locograph::TypeRegistry& types) {
  types.add_parameter<toy::Unit>("PARAMS_TOY_UNIT");
  types.add_vertex<toy::VertexBias>();
  types.add_edge<toy::EdgeRange>();
}
LOCOGRAPH_PLUGIN(register_types)
