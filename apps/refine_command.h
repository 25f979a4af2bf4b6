#pragma once
/// `locograph refine PLAN.g2o -o OUT.g2o`: the online planner, walking along a plan.

#include <locograph/apps/command.h>

namespace locograph {

Command add_refine(OptionParser& app);

}  // namespace locograph
