// A plug-in whose Eigen aligns differently: compiled with other definitions, see CMakeLists.txt.

#include <locograph/core/plugin.h>

static void register_types(locograph::TypeRegistry&) {}
LOCOGRAPH_PLUGIN(register_types)
