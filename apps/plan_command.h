#pragma once
/// `locograph plan SCENARIO -o PLAN.g2o`: the offline planner.

#include <locograph/apps/command.h>

namespace locograph {

Command add_plan(OptionParser& app);

}  // namespace locograph
