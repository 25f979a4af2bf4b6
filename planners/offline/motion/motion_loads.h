#pragma once
/// What contacts bear along a segment: the least wrenches (balance/least_wrenches.h),
/// and how fast they change.
///
///     MotionLoads loads(robot);
///     const std::optional<SegmentLoads> found = loads.along(counted, effort_scale,
///     as_motion(way)); if (found && found->fastest <= kFastestLoad) use(found->wrenches);
///
/// contacts: of one stance, less the execution margin (balance/margin_contacts.h). effort_scale: of
/// the URDF's efforts; 0: no torque limits. Nothing: no wrenches hold.

#include <locograph/check/motion.h>
#include <locograph/robots/bearing_rays.h>
#include <locograph/robots/dynamics.h>

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace locograph {

/// Of the force of a contact, in weights of the robot per second: what the judge allows, less what
/// forces change by where `optimize` moves configurations by 0.1 mm.
inline constexpr double kFastestLoad = 2.2;

struct SegmentLoads {
  std::vector<StanceWrenches> wrenches;  ///< of each configuration
  std::vector<double> rates;             ///< from each to the next, change of the force that
                                         ///< changes most [weights per second]
  double fastest = 0.0;                  ///< change of a contact's force [weights per second]
};

/// A robot that stands while forces go over, a contact's by at most kFastestLoad.
struct Dwell {
  Eigen::VectorXd configuration;
  int stance = 0;                     ///< of Motion::stances
  StanceWrenches from = {}, to = {};  ///< at its contacts; both empty: not known
  double begin_s = 0.0;
  double least_s = 0.0;  ///< that it stands
};

class MotionLoads {
 public:
  explicit MotionLoads(const Robot& robot);

  /// From rest to rest, in one stance. Where accelerations jump their mean counts.
  std::optional<SegmentLoads> along(std::span<const BearingContact> contacts, double effort_scale,
                                    const Motion& motion);
  /// The largest change of a contact's force [weights].
  double change(const StanceWrenches& from, const StanceWrenches& to) const;
  /// Appends it to a motion, but for its end. Returns how long it takes [s].
  double append(const Dwell& dwell, Motion& motion) const;

 private:
  const Robot& robot_;
  RobotState state_;
  RobotDynamics dynamics_;
  Eigen::VectorXd still_, asked_;
};

}  // namespace locograph
