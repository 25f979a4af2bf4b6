#pragma once
/// `locograph plot`: a diagram of what another command found.

#include <locograph/apps/command.h>

namespace locograph {

Command add_plot(OptionParser& app);

}  // namespace locograph
