#pragma once
/// PARAMS_SE3OFFSET: the pose of a sensor in the frame of the vertex that carries it; and
/// PARAMS_CAMERACALIB: the same with a pinhole camera behind it (fx fy cx cy [px]);
/// PARAMS_STEREOCAMERACALIB: with a second camera, a baseline [m] to its right.

#include <locograph/core/parameters.h>
#include <locograph/types/slam3d/se3.h>

namespace locograph {

struct OffsetSE3 : Parameter {
  SE3<double> offset;  ///< carrier_from_sensor
  std::string_view tag() const override { return "PARAMS_SE3OFFSET"; }
  void read(FieldReader& in) override { offset.read(in); }
  void write(FieldWriter& out) const override { offset.write(out); }
};

struct CameraCalibration : OffsetSE3 {
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

/// Serves wherever a CameraCalibration does.
struct StereoCameraCalibration final : CameraCalibration {
  double baseline_m = 0.075;
  std::string_view tag() const override { return "PARAMS_STEREOCAMERACALIB"; }
  void read(FieldReader& in) override {
    CameraCalibration::read(in);
    baseline_m = in.number();
  }
  void write(FieldWriter& out) const override {
    CameraCalibration::write(out);
    out.number(baseline_m);
  }
};

}  // namespace locograph
