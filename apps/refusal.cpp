#include <locograph/apps/about_file.h>
#include <locograph/apps/refusal.h>
#include <locograph/apps/robot_files.h>
#include <locograph/planners/offline/stance/started_task.h>
#include <locograph/planners/posture/posture_solver.h>
#include <locograph/planners/task/task.h>

#include <memory>

namespace locograph {
namespace {

constexpr double kMost_s = 10.0;

void load_as_posture_does(const std::filesystem::path& urdf) {
  const auto robot = std::make_shared<const RobotParameter>(urdf, srdf_beside(urdf),
                                                            RobotOptions{.lenient_srdf = true});
  about_file(urdf.string(), [&] { return PostureSolver(robot, posture_world(World{})); });
}

std::vector<SkinFrame> load_as_plan_does(const std::filesystem::path& file) {
  const Scenario scenario = load_scenario(file.string(), data_folder());
  const Deadline deadline = Deadline::after(kMost_s);
  if (scenario.drive) return task_of(scenario, deadline).off_skin;
  return started_task(scenario, {}, deadline).task.off_skin;
}

}  // namespace

Loading load_as_others_do(const std::string& kind, const std::filesystem::path& file) {
  Loading loading;
  try {
    if (kind == "robot") load_as_posture_does(file);
    if (kind == "scenario") loading.off_skin = load_as_plan_does(file);
  } catch (const Error& error) {
    loading.refused = error;
  } catch (const OutOfTime&) {
    // Left open.
  }
  return loading;
}

}  // namespace locograph
