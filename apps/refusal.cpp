#include <locograph/apps/about_file.h>
#include <locograph/apps/refusal.h>
#include <locograph/apps/robot_files.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/task/task.h>

#include <memory>

namespace locograph {
namespace {

void load_as_posture_does(const std::filesystem::path& urdf) {
  const auto robot = std::make_shared<const RobotParameter>(urdf, srdf_beside(urdf),
                                                            RobotOptions{.lenient_srdf = true});
  about_file(urdf.string(), [&] { return PostureSolver(robot, posture_world(World{})); });
}

void load_as_plan_does(const std::filesystem::path& file) {
  const Scenario scenario = load_scenario(file.string(), data_folder());
  if (scenario.drive) {
    task_of(scenario);
  } else {
    started_task(scenario);
  }
}

}  // namespace

std::optional<Error> refusal_of(const std::string& kind, const std::filesystem::path& file) {
  try {
    if (kind == "robot") load_as_posture_does(file);
    if (kind == "scenario") load_as_plan_does(file);
  } catch (const Error& error) {
    return error;
  }
  return std::nullopt;
}

}  // namespace locograph
