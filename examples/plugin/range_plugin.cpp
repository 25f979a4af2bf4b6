// A plug-in: ranges to beacons, measured by an antenna that reads too long by an unknown amount.
//
//     locograph optimize beacons.g2o --plugin ./range.so -o out.g2o

#include <locograph/core/plugin.h>
#include <locograph/types/slam2d/vertices.h>

namespace example {

using namespace locograph;

/// PARAMS_ANTENNA: where the antenna sits on the robot, x y [m].
struct Antenna : Parameter {
  Eigen::Vector2d robot_from_antenna = Eigen::Vector2d::Zero();
  std::string_view tag() const override { return "PARAMS_ANTENNA"; }
  void read(FieldReader& in) override { read_field(in, robot_from_antenna); }
  void write(FieldWriter& out) const override { write_field(out, robot_from_antenna); }
};

/// VERTEX_RANGE_BIAS: what every range is too long by [m]. Tangent: added.
struct VertexRangeBias : Vertex<1, 1> {
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
LOCOGRAPH_REGISTER_VERTEX("VERTEX_RANGE_BIAS", VertexRangeBias)

/// EDGE_BIASED_RANGE: range from the antenna to a point. Fields: number of the PARAMS_ANTENNA,
/// range [m]. Error (1): predicted − measured distance [m].
struct EdgeBiasedRange : Edge<1, VertexSE2, VertexXY, VertexRangeBias> {
  int antenna_number = 0;
  double range_m = 0.0;
  Eigen::Vector2d antenna = Eigen::Vector2d::Zero();
  auto fields() { return std::tie(antenna_number, range_m); }
  void bind(const Parameters& parameters) {
    antenna = parameters.get<Antenna>(antenna_number)->robot_from_antenna;
  }

  template <class T>
  void error(const SE2<T>& robot, const Eigen::Matrix<T, 2, 1>& point, const T& bias,
             Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    const Eigen::Matrix<T, 2, 1> from = robot * Eigen::Matrix<T, 2, 1>(antenna.cast<T>());
    e[0] = (point - from).norm() + bias - T(range_m);
  }
};
LOCOGRAPH_REGISTER_EDGE("EDGE_BIASED_RANGE", EdgeBiasedRange)

void register_types(TypeRegistry& types) {
  types.add_parameter<Antenna>("PARAMS_ANTENNA");
  types.add_vertex<VertexRangeBias>();
  types.add_edge<EdgeBiasedRange>();
}

}  // namespace example

LOCOGRAPH_PLUGIN(example::register_types)
