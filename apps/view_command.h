#pragma once
/// `locograph view`: a plan, a pose graph or a robot as one self-contained page.

#include <locograph/apps/command.h>

namespace locograph {

Command add_view(OptionParser& app);

}  // namespace locograph
