#include <locograph/plugins/time_step/edge_time_step_limits.h>

namespace locograph {

template class TypedEdgePool<EdgeTimeStepLimits>;
template class TypedEdgePool<EdgeTimeStepLimitsSigned>;

}  // namespace locograph
