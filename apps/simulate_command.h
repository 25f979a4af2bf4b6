#pragma once
/// `locograph simulate PLAN.g2o`: a plan carried out in the physics engine, under a torque
/// controller.

#include <locograph/apps/command.h>

namespace locograph {

Command add_simulate(OptionParser& app);

}  // namespace locograph
