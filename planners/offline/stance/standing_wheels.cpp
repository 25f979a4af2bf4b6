#include <locograph/planners/offline/stance/standing_wheels.h>
#include <locograph/robots/wheel.h>

namespace locograph {
namespace {

struct StandingWheel {
  std::size_t effector;
  Wheel wheel;
};

std::vector<StandingWheel> wheels_that_turn(const Task& task) {
  std::vector<StandingWheel> wheels;
  for (std::size_t e = 0; e < task.end_effectors().size(); ++e) {
    if (task.end_effectors()[e].kind != ContactKind::kWheel) continue;
    Wheel wheel = wheel_of(*task.robot->robot, task.end_effectors()[e]);
    if (wheel.joint >= 0) wheels.push_back({e, std::move(wheel)});
  }
  return wheels;
}

}  // namespace

void hold_wheels(const StanceSpace& space, StancePath& path, std::size_t first) {
  const Robot& robot = *space.task().robot->robot;
  const std::vector<StandingWheel> wheels = wheels_that_turn(space.task());
  if (wheels.empty()) return;
  RobotState before(robot), after(robot);
  for (std::size_t i = first; i < path.footings.size(); ++i) {
    before.update(path.configurations[i - 1].data());
    after.update(path.configurations[i].data());
    for (const auto& [effector, wheel] : wheels) {
      const int held = path.footings[i - 1][effector];
      if (held == kFree) continue;
      const Eigen::Vector3d normal = space.place(held).bearing.contact.normal.stableNormalized();
      const int joint = robot.base_configuration_size() + wheel.joint;
      path.configurations[i][joint] =
          held_wheel_joint(path.configurations[i - 1][joint], carrier_pitch(before, wheel, normal),
                           carrier_pitch(after, wheel, normal));
    }
  }
}

}  // namespace locograph
