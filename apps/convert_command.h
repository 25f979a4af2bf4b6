#pragma once
/// `locograph convert`: a plan as a graph (.g2o), a table (.csv) or JSON (.json).

#include <locograph/apps/command.h>

namespace locograph {

Command add_convert(OptionParser& app);

}  // namespace locograph
