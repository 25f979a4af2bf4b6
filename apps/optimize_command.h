#pragma once
/// `locograph optimize IN.g2o [-o OUT.g2o] …`: optimises any graph file.

#include <locograph/apps/command.h>

namespace locograph {

Command add_optimize(OptionParser& app);

}  // namespace locograph
