#pragma once
/// Judges the wrenches that a motion states: whether they are what bears the robot at its vertices,
/// can be borne by their contacts, and go over from one vertex to the next as fast as forces may.
///
///     WrenchCheck wrenches(context);
///     wrenches.run();
///     wrenches.report(report.violations);
///
/// One constraint, plan_wrenches, whose value is the largest of these ratios to what is allowed;
/// its text says which. W is the robot's weight.
///
///   missing      a motion that states wrenches states them at every vertex, at each contact of the
///                stance that it is left in; finite (else infinite)
///   left over    of what gravity and inertia ask of the base, (force / W, moment / (W 1 m)) in
///                norm: 1e-3. The curve's acceleration may jump at a vertex: the wrenches fit any
///                that is between those at the end of the step before and at the beginning of the
///                one after; at rest counts as the step before a whole motion begins, and after it
///                ends. Torques are those of the acceleration that fits best
///   jumps        what is asked of the base before and after a vertex differs by 0.05 W at most, as
///                above in norm
///   changes      how fast the force of each contact goes from vertex to vertex, in the world:
///                2.5 W per second; nothing of plans of stances, which have no time
///   opens        a contact that closes or opens carries nothing at the vertex where it does: of
///                what is stated there 1e-3 W and W 1 m; in "changes" it counts as nothing
///   cone         Coulomb's own of points and wheels, |f_t| <= mu f_z. Of a surface contact: of
///                forces at the corners of what of it lies on surfaces and bars, so that the centre
///                of pressure and yaw are judged, too, the former to 0.1 mm beside the line where a
///                bar touches; where a simple way of sharing out fails, by a linear programme in
///                inscribed pyramids of 32 sides. What is outside by more than 1e-6 W of pressing
///                force is 1 and that share of W more
///   limits       pressing force, components of grasps, and torques where they are enforced
///
/// Friction and areas are those of where the contact bears (bearing_at()). Where a part of a motion
/// goes on beyond it nobody knows how it accelerates: what is left over and jumps is not judged
/// there; and where it begins on the way of a ball, cones of points are judged to 1e-4 W.

#include <locograph/check/check_context.h>
#include <locograph/check/loaded_contact.h>
#include <locograph/check/violation_tally.h>
#include <locograph/robots/dynamics.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// Of a wrench at a contact that bears in an area, about its point along its axes: the share of
/// the weight by which it would have to be pressed more, evenly at the corners, to be in the cones
/// there; 0: it is.
double outside_cones(const EndEffector& surface, const std::vector<Eigen::Vector2d>& area,
                     const Eigen::Matrix<double, 6, 1>& wrench, double weight_N);

class WrenchCheck {
 public:
  explicit WrenchCheck(CheckContext& context);

  void run();
  void report(std::vector<Violation>& violations) const;

 private:
  using Wrench = Eigen::Matrix<double, 6, 1>;
  /// What inverse dynamics asks for on both sides of a vertex.
  struct Demand {
    Eigen::VectorXd before, after;
  };

  bool goes_on_beyond(int vertex) const;
  void judge_vertex(int vertex);
  void judge_changes(int vertex);
  Demand demand_at(int vertex);
  void judge_balance(int vertex, const std::vector<LoadedContact>& contacts,
                     const StanceWrenches& wrenches);
  void judge_contact(int vertex, const JudgedBearing& bearing, const Wrench& wrench);
  void add(int vertex, double ratio, const std::string& what);
  bool states_at(int vertex) const;
  std::string why_not() const;

  CheckContext& context_;
  MotionSampler sampler_;
  std::optional<RobotDynamics> dynamics_;  // of what has a mass
  double weight_;
  LinkPoses poses_;
  /// Of each contact of the stance that a vertex is left in, in the world.
  std::vector<std::vector<Eigen::Vector3d>> forces_;
  ViolationTally wrenches_;
};

}  // namespace locograph
