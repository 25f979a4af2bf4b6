#pragma once
/// How much a wheel slips on its plane along the way.
///
///     WheelSlip slip;
///     slip.add(wheel_step(contact, poses_before, poses));  // for each sample
///     if (slip.lateral_m() > limits::kSlip_m)
///       std::cerr << "slips sideways by " << slip.lateral_m() << " m\n";
///
/// a is the axle, n the plane's normal, c the centre, u the direction in the disc that is nearest
/// to n, so that c - r u touches. The wheel's material there moves by s = dc + w x (-r u) while the
/// wheel turns by w in the world, whichever joints turn it: nothing if it rolls without slip. The
/// part of s along a, in the plane, is lateral slip, that along the heading h = a x n is
/// longitudinal. Directions are those in the middle between two samples: exact to second order in
/// what happens between these; the wheel must turn by less than half a turn.
///
/// Slip is summed up in two ways, so that neither goes away by steering: along the wheel's own
/// directions, which turn with it, and in the world. The way is what the wheel rolls: where its
/// centre's way along the heading and r times its spin differ, the shorter one.

#include <locograph/check/judged_stance.h>

#include <Eigen/Geometry>
#include <deque>
#include <span>

namespace locograph {

/// What a wheel does between two samples.
struct WheelStep {
  double lateral_m = 0.0, longitudinal_m = 0.0;  ///< slip, with signs
  double way_m = 0.0;
  Eigen::Vector3d across = Eigen::Vector3d::Zero(), heading = Eigen::Vector3d::Zero();  ///< world
};

/// Nothing moves where the axle is normal to the plane.
WheelStep wheel_step(const JudgedContact& wheel, std::span<const Eigen::Isometry3d> from,
                     std::span<const Eigen::Isometry3d> to);

/// The largest change of a number within any stretch of a way.
class StretchRange {
 public:
  explicit StretchRange(double stretch_m) : stretch_m_(stretch_m) {}
  /// way_m does not decrease.
  void add(double way_m, double value);
  double largest() const { return largest_; }

 private:
  struct Entry {
    double way_m, value;
  };
  double stretch_m_, largest_ = 0.0;
  std::deque<Entry> falling_, rising_;  // candidates for the highest and the lowest value
};

class WheelSlip {
 public:
  WheelSlip();
  void add(const WheelStep& step);

  /// The largest so far, as much as counts against limits::kSlip_m: that of any stretch, and that
  /// in total in proportion to what is allowed in total.
  double lateral_m() const { return lateral_.worst; }
  double longitudinal_m() const { return longitudinal_.worst; }
  double way_m() const { return way_m_; }

 private:
  struct Direction {
    StretchRange range;
    double total = 0.0, worst = 0.0;
    void add(double slip, double in_world, double way);
  };
  Direction lateral_, longitudinal_;
  Eigen::Vector3d in_world_ = Eigen::Vector3d::Zero();
  double way_m_ = 0.0;
};

}  // namespace locograph
