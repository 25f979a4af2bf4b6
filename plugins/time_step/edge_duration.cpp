#include <locograph/plugins/time_step/edge_duration.h>

namespace locograph {

template class TypedEdgePool<EdgeDuration>;

}  // namespace locograph
