#include <locograph/planners/offline/drive/wheel_motion.h>
#include <locograph/planners/offline/drive/wheeled_drive.h>
#include <locograph/planners/offline/drive/wheeled_plan.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <cmath>

namespace locograph {
namespace {

constexpr double kLevelTolerance_m = 1e-3, kGround_m = 0.0;

/// A base pose on the path, in the plane.
struct PathPoint {
  double x, y, heading;
};

PathPoint path_point(const DriveTask& drive, double distance) {
  const double turned = drive.curvature_1_m * distance;
  if (std::abs(turned) < 1e-9) return {distance, 0.5 * turned * distance, turned};
  return {std::sin(turned) / drive.curvature_1_m, (1.0 - std::cos(turned)) / drive.curvature_1_m,
          turned};
}

/// Every wheel of the scenario on the plane z = 0.
Stance all_wheels(const Scenario& scenario) {
  Stance stance;
  for (const EndEffector& effector : scenario.end_effectors) {
    if (effector.kind == ContactKind::kWheel) stance.contacts.push_back({.effector = effector});
  }
  return stance;
}

class WheeledDrive {
 public:
  WheeledDrive(const Scenario& scenario, const Robot& robot, const Stance& stance)
      : drive_(*scenario.drive), motion_(robot, stance) {
    stand_ = robot.named_configuration(scenario.start_state);
    put_on_ground();
    steer();
  }

  /// As far as the job lets it.
  std::vector<Eigen::VectorXd> configurations(const JobControl& job) {
    std::vector<Eigen::VectorXd> all;
    const std::size_t count = static_cast<std::size_t>(drive_.configurations);
    for (int i = 0; i < drive_.configurations; ++i) {
      if (!job.go_on("rolling", all.size(), count)) break;
      const double distance = drive_.distance_m * i / (drive_.configurations - 1);
      const PathPoint at = path_point(drive_, distance);
      Eigen::VectorXd q = stand_;
      q[0] = at.x;
      q[1] = at.y;
      q[5] = std::sin(0.5 * at.heading);
      q[6] = std::cos(0.5 * at.heading);
      if (i > 0) motion_.roll(all.back(), q);
      all.push_back(q);
    }
    return all;
  }

 private:
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
  WheelMotion motion_;
  Eigen::VectorXd stand_;
};

}  // namespace

Graph plan_wheeled_drive(const Scenario& scenario) {
  return *plan_wheeled_drive(scenario, JobControl());
}

std::optional<Graph> plan_wheeled_drive(const Scenario& scenario, const JobControl& job) {
  if (!scenario.drive) throw Error(scenario.source, 0, "the scenario has no drive", "<drive …/>");
  Graph graph;
  const auto robot =
      std::make_shared<const RobotParameter>(scenario.urdf, scenario.srdf, scenario.robot);
  require_camera_links(scenario, *robot->robot);
  graph.parameters().set(kRobotNumber, robot);
  // Where the scenario names what there is to stand on, that is all there is, as in world_of().
  const bool on_ground = scenario.surfaces.empty() && scenario.scanned.empty();
  graph.parameters().set(kWorldNumber, std::make_shared<const WorldParameter>(
                                           scenario.map, scenario.obstacles,
                                           on_ground ? std::optional(kGround_m) : std::nullopt));
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = scenario.source;
  graph.parameters().set(kScenarioNumber, origin);

  const DriveTask& drive = *scenario.drive;
  Motion motion;
  motion.stances = {all_wheels(scenario)};
  require_sound_stance(*robot->robot, motion.stances.front());
  motion.configurations =
      WheeledDrive(scenario, *robot->robot, motion.stances.front()).configurations(job);
  if (motion.configurations.size() < static_cast<std::size_t>(drive.configurations)) return {};
  for (int i = 0; i < drive.configurations; ++i) {
    motion.time_s.push_back(drive.distance_m / drive.speed_m_s * i / (drive.configurations - 1));
    motion.stance_from.push_back(0);
  }
  if (!add_wheeled_plan(graph, motion, {}, job)) return {};
  return graph;
}

}  // namespace locograph
