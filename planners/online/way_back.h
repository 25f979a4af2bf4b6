#pragma once
/// How a robot on legs that is off its plan comes back to it.
///
///     WayBack way(online_plan);
///     way.begin(window, was);       // the window leads back, and is what is planned
///     window.move_to(executed);     // later: what enters is on its contacts as they are now
///     if (way.end() == entered) way.add(entered);
///     way.go_on(window);
///
/// What it is off gets less as 1 - 10 t^3 + 15 t^4 - 6 t^5 within 1.6 s, so that it begins and ends
/// without another velocity or acceleration, each configuration on its contacts. It is back before
/// contacts change, or, where that is too soon, before the next one closes; if there is not enough
/// time until then the plan is slowed down. Wheels that stand do not turn on the ground. Balls have
/// rolled elsewhere then, by tenths of a millimetre: as long as they are held it stays beside its
/// plan by as much, and goes over to it without a jump once they are lifted. Ends of limbs that
/// swing keep away from what they have touched, or will. Wrenches are those of led_wrenches.h.

#include <locograph/planners/online/plan_wheels.h>
#include <locograph/planners/online/window.h>
#include <locograph/planners/posture/contact_projection.h>

#include <Eigen/Core>

namespace locograph {

/// What a radian of the base and of a joint counts as, where ways are compared [m].
inline constexpr double kTurn_m = 0.5, kJoint_m = 0.3;

/// How long a robot that is off by this tangent takes at least to come back, so that it asks for
/// 0.15 m/s² at most [s]: of 10 t^3 - 15 t^4 + 6 t^5 the second derivative is at most 5.8.
double least_time_back(const Robot& robot, const Eigen::VectorXd& off);

class WayBack {
 public:
  /// The plan must outlive it.
  explicit WayBack(OnlinePlan& plan) : plan_(plan), contacts_(plan.robot()) {}

  /// The executed configuration, which was another one, has become what was measured.
  void begin(const Window& window, const Eigen::VectorXd& was);
  /// Index after the last configuration that was led back; 0: none.
  int end() const { return end_; }
  /// The configuration end(), which is as planned.
  void add(int index);
  /// The configurations that have entered the window are the plan from now on, if they were led.
  void go_on(const Window& window);

 private:
  int back_at(int executed) const;
  int closes_next(int index) const;
  void set_contacts(int index, int beside);
  bool close_contacts(int index, int beside, Eigen::VectorXd& q);
  void close(int index, const Eigen::VectorXd& planned, double lifted);
  void lift(int index, const Eigen::VectorXd& planned, double share);
  void close_before(const Window& window);
  Eigen::VectorXd least_off(int index, int from);
  void follow(const Window& window, int first, int back);

  OnlinePlan& plan_;
  ContactProjection contacts_;
  PlanWheels wheels_;
  int end_ = 0;
  /// What the last configuration is off where it was planned, and how fast that changes.
  Eigen::VectorXd off_, off_rate_;
};

}  // namespace locograph
