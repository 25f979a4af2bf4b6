#pragma once
/// PARAMS_SE3OFFSET: the pose of a sensor in the frame of the vertex that carries it; and
/// PARAMS_CAMERACALIB: the same with a pinhole camera behind it (fx fy cx cy [px]).

#include <locograph/core/parameters.h>
#include <locograph/types/slam3d/se3.h>

namespace locograph {

struct OffsetSE3 : Parameter {
  SE3<double> offset;  ///< carrier_from_sensor
  std::string_view tag() const override { return "PARAMS_SE3OFFSET"; }
  void read(FieldReader& in) override { offset.read(in); }
  void write(FieldWriter& out) const override { offset.write(out); }
};

struct CameraCalibration final : OffsetSE3 {
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;
  std::string_view tag() const override { return "PARAMS_CAMERACALIB"; }
  void read(FieldReader& in) override {
    offset.read(in);
    read_fields(in, std::tie(fx, fy, cx, cy));
    if (fx == 0.0 || fy == 0.0) in.fail("focal length of zero", "fx and fy other than zero");
  }
  void write(FieldWriter& out) const override {
    offset.write(out);
    for (const double value : {fx, fy, cx, cy}) out.number(value);
  }
};

}  // namespace locograph
