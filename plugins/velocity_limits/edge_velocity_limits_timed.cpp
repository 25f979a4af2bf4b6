#include <locograph/plugins/velocity_limits/edge_velocity_limits_timed.h>

namespace locograph {

template class TypedEdgePool<EdgeVelocityLimitsTimed>;
template class TypedEdgePool<EdgeVelocityLimitsTimedSigned>;

}  // namespace locograph
