#pragma once
/// `locograph posture`: a balanced, collision-free configuration for given contacts.

#include <locograph/apps/command.h>

namespace locograph {

Command add_posture(OptionParser& app);

}  // namespace locograph
