#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace locograph {
namespace {

constexpr double kLevelTolerance_m = 1e-3;
/// Of the base while it speeds up and brakes, at most; of the accelerations that a scenario allows
/// its wheels, a share.
constexpr double kAcceleration_m_s2 = 0.5, kShareOfLimit = 0.8;

/// A base pose on the path, in the plane.
struct DrivePoint {
  double x, y, heading;
};

DrivePoint path_point(const DriveTask& drive, double distance) {
  const double turned = drive.curvature_1_m * distance;
  if (std::abs(turned) < 1e-9) return {distance, 0.5 * turned * distance, turned};
  return {std::sin(turned) / drive.curvature_1_m, (1.0 - std::cos(turned)) / drive.curvature_1_m,
          turned};
}

/// Every wheel of the task on the plane z = 0.
Stance all_wheels(const Task& task) {
  Stance stance;
  for (const EndEffector& effector : task.end_effectors()) {
    if (effector.kind == ContactKind::kWheel) stance.contacts.push_back({.effector = effector});
  }
  return stance;
}

/// Time and speed at each of several places at equal distances: from rest to rest, at a constant
/// speed but for whole steps of constant acceleration at both ends.
struct Ramp {
  std::vector<double> time_s = {0.0}, speed_m_s = {0.0};

  Ramp(int steps, double step_m, double speed, double acceleration) {
    if (steps == 1) {  // one cubic: 1.5 times its mean speed half-way, 6 d / T^2 at its ends
      time_s.push_back(std::max(1.5 * step_m / speed, std::sqrt(6.0 * step_m / acceleration)));
      speed_m_s.push_back(0.0);
      return;
    }
    const double needed = std::ceil(speed * speed / (2.0 * acceleration * step_m));
    const int ramp = static_cast<int>(std::clamp(needed, 1.0, std::floor(0.5 * steps)));
    const double most = std::min(speed, std::sqrt(2.0 * acceleration * step_m * ramp));
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(std::min({i, steps - i, ramp})) / ramp;
      speed_m_s.push_back(most * std::sqrt(share));
      time_s.push_back(time_s.back() +
                       2.0 * step_m / (speed_m_s.back() + speed_m_s[speed_m_s.size() - 2]));
    }
  }
};

class WheeledDrive {
 public:
  WheeledDrive(const Task& task, const Stance& stance)
      : drive_(*task.drive),
        robot_(*task.robot->robot),
        motion_(robot_, stance),
        wheel_limit_rad_s2_(task.check.joint_acceleration_rad_s2) {
    stand_ = robot_.named_configuration(task.start_state);
    put_on_ground();
    steer();
  }

  /// As far as the job lets it: times, configurations and slopes.
  void drive(const JobControl& job, Motion& motion) {
    const int steps = drive_.configurations - 1;
    const double step_m = drive_.distance_m / steps;
    const Ramp ramp(steps, step_m, drive_.speed_m_s, acceleration());
    std::vector<Eigen::VectorXd>& all = motion.configurations;
    Eigen::VectorXd along = Eigen::VectorXd::Zero(robot_.tangent_size());  // for one unit of speed
    for (std::size_t i = 0; i < ramp.time_s.size(); ++i) {
      job.report_progress("rolling", i, ramp.time_s.size());
      if (job.termination.ended()) return;
      const DrivePoint at = path_point(drive_, step_m * static_cast<double>(i));
      Eigen::VectorXd q = stand_;
      q[0] = at.x;
      q[1] = at.y;
      q[5] = std::sin(0.5 * at.heading);
      q[6] = std::cos(0.5 * at.heading);
      if (i > 0) {
        motion_.roll(all.back(), q);
        const int joints = robot_.active_joint_count();
        along.tail(joints) = (q.tail(joints) - all.back().tail(joints)) / step_m;
      }
      along.head<6>() << std::cos(at.heading), std::sin(at.heading), 0.0, 0.0, 0.0,
          drive_.curvature_1_m;
      all.push_back(q);
      motion.time_s.push_back(ramp.time_s[i]);
      motion.slopes.push_back(ramp.speed_m_s[i] * along);
      motion.stance_from.push_back(0);
    }
  }

 private:
  /// Of the base, so that no wheel accelerates too much: one on the outside of an arc goes faster.
  double acceleration() {
    double most = kAcceleration_m_s2;
    for (int w = 0; w < motion_.wheels() && wheel_limit_rad_s2_ > 0.0; ++w) {
      const double way =
          std::max(1e-3, 1.0 - drive_.curvature_1_m * motion_.pose(stand_, w).centre.y());
      most = std::min(most,
                      kShareOfLimit * wheel_limit_rad_s2_ * motion_.wheel(w).wheel.radius_m / way);
    }
    return most;
  }

  void put_on_ground() {
    double lowest = 0.0, highest = 0.0;
    for (int w = 0; w < motion_.wheels(); ++w) {
      const double bottom = motion_.pose(stand_, w).centre.z() - motion_.wheel(w).wheel.radius_m;
      lowest = w == 0 ? bottom : std::min(lowest, bottom);
      highest = w == 0 ? bottom : std::max(highest, bottom);
    }
    if (highest - lowest > kLevelTolerance_m) {
      throw Error("the wheels do not stand on one level in the start state: " +
                      std::to_string(highest - lowest) + " m apart",
                  "less than " + std::to_string(kLevelTolerance_m) + " m");
    }
    stand_[2] -= 0.5 * (lowest + highest);
  }

  void steer() {
    for (int w = 0; w < motion_.wheels(); ++w) {
      const Eigen::Vector3d at = motion_.pose(stand_, w).centre;
      // Velocity of the wheel for one unit of base speed and the turning that goes with it.
      const Eigen::Vector3d velocity(1.0 - drive_.curvature_1_m * at.y(),
                                     drive_.curvature_1_m * at.x(), 0.0);
      if (!motion_.steer(stand_, w, velocity)) {
        throw Error("wheel " + motion_.wheel(w).wheel.name + " cannot be steered into the arc",
                    "an upright steering joint with enough range, or a smaller curvature");
      }
    }
  }

  const DriveTask& drive_;
  const Robot& robot_;
  WheelMotion motion_;
  double wheel_limit_rad_s2_;  // 0: none
  Eigen::VectorXd stand_;
};

}  // namespace

DrivePlan plan_wheeled_drive(const Task& task, const JobControl& job) {
  const Stopwatch watch;
  job.termination.validate();
  if (!task.drive) throw Error(task.scenario, 0, "the scenario has no drive", "<drive …/>");
  Motion motion;
  motion.stances = {all_wheels(task)};
  require_sound_stance(*task.robot->robot, motion.stances.front());
  WheeledDrive(task, motion.stances.front()).drive(job, motion);
  const bool whole =
      motion.configurations.size() == static_cast<std::size_t>(task.drive->configurations);
  DrivePlan plan{
      whole ? PlannerAnswer{PlannerStatus::kSolved, "planned"} : end_by(job.termination).value(),
      std::move(motion)};
  plan.statistics.total_s = watch.seconds();
  return plan;
}

}  // namespace locograph
