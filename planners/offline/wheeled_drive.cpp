#include <locograph/planners/offline/wheeled_drive.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/wheel_motion.h>

#include <cmath>

namespace locograph {
namespace {

constexpr double kLevelTolerance_m = 1e-3;

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

class WheeledDrive {
 public:
  WheeledDrive(const Scenario& scenario, const Robot& robot, const WheelsParameter& wheels)
      : drive_(*scenario.drive), wheels_(wheels), motion_(robot, wheels) {
    stand_ = robot.named_configuration(scenario.start_state);
    put_on_ground();
    steer();
  }

  std::vector<Eigen::VectorXd> configurations() {
    std::vector<Eigen::VectorXd> all;
    for (int i = 0; i < drive_.configurations; ++i) {
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
    for (std::size_t w = 0; w < wheels_.wheels.size(); ++w) {
      const double bottom =
          motion_.pose(stand_, static_cast<int>(w)).centre.z() - wheels_.wheels[w].radius_m;
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
    for (std::size_t w = 0; w < wheels_.wheels.size(); ++w) {
      const Eigen::Vector3d at = motion_.pose(stand_, static_cast<int>(w)).centre;
      // Velocity of the wheel for one unit of base speed and the turning that goes with it.
      const Eigen::Vector2d velocity(1.0 - drive_.curvature_1_m * at.y(),
                                     drive_.curvature_1_m * at.x());
      if (!motion_.steer(stand_, static_cast<int>(w), velocity)) {
        throw Error("wheel " + wheels_.wheels[w].link_name + " cannot be steered into the arc",
                    "an upright steering joint with enough range, or a smaller curvature");
      }
    }
  }

  const DriveTask& drive_;
  const WheelsParameter& wheels_;
  WheelMotion motion_;
  Eigen::VectorXd stand_;
};

}  // namespace

Graph plan_wheeled_drive(const Scenario& scenario) {
  if (!scenario.drive) throw Error(scenario.source, 0, "the scenario has no drive", "<drive …/>");
  Graph graph;
  const auto robot =
      std::make_shared<const RobotParameter>(scenario.urdf, scenario.srdf, scenario.robot);
  std::vector<Wheel> named;
  for (const Scenario::NamedWheel& wheel : scenario.wheels) {
    named.emplace_back();
    named.back().link_name = wheel.link;
    named.back().radius_m = wheel.radius_m;
  }
  const auto wheels =
      std::make_shared<const WheelsParameter>(*robot->robot, kRobotNumber, std::move(named));
  graph.parameters().set(kRobotNumber, robot);
  graph.parameters().set(kWheelsNumber, wheels);
  graph.parameters().set(kWorldNumber,
                         std::make_shared<const WorldParameter>(scenario.map, scenario.obstacles));
  const auto origin = std::make_shared<ScenarioParameter>();
  origin->scenario = scenario.source;
  graph.parameters().set(kScenarioNumber, origin);

  const DriveTask& drive = *scenario.drive;
  const std::vector<Eigen::VectorXd> configurations =
      WheeledDrive(scenario, *robot->robot, *wheels).configurations();
  std::vector<double> times;
  for (int i = 0; i < drive.configurations; ++i) {
    times.push_back(drive.distance_m / drive.speed_m_s * i / (drive.configurations - 1));
  }
  add_wheeled_plan(graph, times, configurations);
  return graph;
}

}  // namespace locograph
