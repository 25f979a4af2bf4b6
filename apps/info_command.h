#pragma once
/// `locograph info FILE`: what is in a graph, robot, map or obstacles file.

#include <locograph/apps/command.h>

namespace locograph {

Command add_info(OptionParser& app);

}  // namespace locograph
