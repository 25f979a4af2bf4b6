#pragma once
/// A camera of the scenario's robot, as its file tells it.
///
///     for (const ScenarioCamera& one : scenario.cameras) {
///       report(one.link + " carries " + one.camera.name);
///     }

#include <locograph/world/perception/depth_camera.h>

#include <string>

namespace locograph {

struct ScenarioCamera {
  DepthCamera camera;  ///< on link 0, which the file knows by its name only
  std::string link;
  int line = 0;  ///< of the file
};

}  // namespace locograph
