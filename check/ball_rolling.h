#pragma once
/// How far a ball rolls and how far its skin slips on the plane or round the bar that it is on.
///
///     SkinPath path;
///     path.add(skin_step(contact, pose_at(0.0), pose_at(0.5)));    // by the shortest turn
///     path.add(contact, {{0.5, 0.75, 1.0}, {pose_at(0.5), pose_at(0.75), pose_at(1.0)}}, pose_at);
///     if (path.slip_m() > limits::kHeld_m) std::cerr << "slides after " << path.way_m() << " m\n";
///
/// c is the centre, w the angular velocity of its link, n the normal, r the ball's radius: the skin
/// moves over the ground by c' - r w x n, nothing of that if it rolls without slip; that it spins
/// about n takes no part. On a plane these are vectors in the world. On a bar of radius R about the
/// axis a, with n at the angle phi about it and e = a x n, they are coordinates along the axis and
/// along the arc,
///
///   z' + r w . e   and   (R + r) phi' - r w . a
///
/// and their integrals are what has slipped. A step is exact where the link turns at a constant
/// rate about one axis and phi at a constant rate. Along a curve the error of the sum over steps is
/// of the second order in their length, with even powers only, so that steps and those of half the
/// length give it (Richardson): what is added is corrected by a third of their difference, and
/// pieces for which that is more than 1e-7 m are halved. What is left is of the fourth order: some
/// 1e-9 m for each piece, 1e-6 m for a plan.

#include <locograph/check/judged_stance.h>

#include <Eigen/Geometry>
#include <array>
#include <functional>

namespace locograph {

/// Between two poses of its link, by less than half a turn.
struct SkinStep {
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();  ///< in the world; on a bar axis, arc, 0
  double way_m = 0.0;                              ///< of the place that touches
};

SkinStep skin_step(const JudgedContact& ball, const Eigen::Isometry3d& from,
                   const Eigen::Isometry3d& to);

class SkinPath {
 public:
  /// Poses of the link at three fractions of a part of the curve, and in between.
  struct Part {
    std::array<double, 3> fractions;
    std::array<Eigen::Isometry3d, 3> poses;
  };
  using PoseAt = std::function<Eigen::Isometry3d(double fraction)>;

  void add(const SkinStep& step);
  void add(const JudgedContact& ball, const Part& part, const PoseAt& pose_at);

  /// Since it touched down.
  const Eigen::Vector3d& slip() const { return slip_; }
  double slip_m() const { return most_m_; }  ///< the most so far
  double way_m() const { return way_m_; }

 private:
  void add(const JudgedContact& ball, const Part& part, const PoseAt& pose_at, int halvings);

  Eigen::Vector3d slip_ = Eigen::Vector3d::Zero();
  double most_m_ = 0.0, way_m_ = 0.0;
};

}  // namespace locograph
