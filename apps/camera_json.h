#pragma once
/// A depth camera, as `info` and the results of commands tell it.
///
///     json["cameras"].push_back(camera_json(camera, robot.links()[camera.link].name));

#include <locograph/apps/output.h>
#include <locograph/world/perception/depth_camera.h>

#include <string>

namespace locograph {

/// Place and directions in the link's frame.
Json camera_json(const DepthCamera& camera, const std::string& link);

}  // namespace locograph
