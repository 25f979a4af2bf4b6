#pragma once
/// `locograph check PLAN.g2o`: the independent feasibility check.

#include <locograph/apps/command.h>

namespace locograph {

Command add_check(OptionParser& app);

}  // namespace locograph
