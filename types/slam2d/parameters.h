#pragma once
/// PARAMS_SE2OFFSET: the pose of a sensor in the frame of the vertex that carries it (x y θ).

#include <locograph/core/parameters.h>
#include <locograph/types/slam2d/se2.h>

namespace locograph {

struct OffsetSE2 : Parameter {
  SE2<double> offset;
  std::string_view tag() const override { return "PARAMS_SE2OFFSET"; }
  void read(FieldReader& in) override { offset.read(in); }
  void write(FieldWriter& out) const override { offset.write(out); }
};

}  // namespace locograph
