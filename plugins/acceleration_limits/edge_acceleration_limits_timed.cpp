#include <locograph/plugins/acceleration_limits/edge_acceleration_limits_timed.h>

namespace locograph {

template class TypedEdgePool<EdgeAccelerationLimitsTimed>;
template class TypedEdgePool<EdgeAccelerationLimitsTimedSigned>;
template class TypedEdgePool<EdgeRestAccelerationLimitsTimed>;
template class TypedEdgePool<EdgeRestAccelerationLimitsTimedSigned>;

}  // namespace locograph
