#pragma once
/// `locograph list types|solvers|kernels|robots|scenarios`: what there is, one name per line.

#include <locograph/apps/command.h>

namespace locograph {

Command add_list(OptionParser& app);

}  // namespace locograph
