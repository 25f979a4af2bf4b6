#pragma once
/// Refines a plan at its own pace and tells a page about every cycle (doc/scene_format.md).
///
///     LiveServer server(port, page, [&](LiveChannel& channel) { live_refine(job, channel); });

#include <locograph/apps/live_server.h>
#include <locograph/apps/refine_perception.h>

#include <string>
#include <vector>

namespace locograph {

struct LiveJob {
  std::string plan, map, obstacles;  ///< files; map and obstacles as `refine` takes them
  int horizon = 20;
  double speed = 1.0;                ///< 2: twice as fast as the plan's time stamps say
  std::vector<std::string> plugins;  ///< as graph_types()
  PerceptionChoice perception = {};  ///< as `refine` takes it
};

/// Returns when the plan is at its end or the channel is closed. Bad input goes to the channel as
/// the reason of the end.
void live_refine(const LiveJob& job, LiveChannel& channel);

}  // namespace locograph
