#include "core/toy_types.h"

namespace locograph {

template class TypedEdgePool<test::ToyRange<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyRange<test::Derivatives::kDual>>;
template class TypedEdgePool<test::ToyRange<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToyMoments<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyMoments<test::Derivatives::kDual>>;
template class TypedEdgePool<test::ToyMoments<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToyView<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyView<test::Derivatives::kDual>>;
template class TypedEdgePool<test::ToyView<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToyReach<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyReach<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToyMeet<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyMeet<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToyCarry<test::Derivatives::kByHand>>;
template class TypedEdgePool<test::ToyCarry<test::Derivatives::kNumeric>>;
template class TypedEdgePool<test::ToySignal>;
template class TypedEdgePool<test::ToyPosture>;

}  // namespace locograph
