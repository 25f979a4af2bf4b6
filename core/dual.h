#pragma once
/// Dual numbers for exact derivatives: ceres::Jet where Ceres is installed, nothing otherwise.
///
/// Only the header <ceres/jet.h> is used, no Ceres library is linked. Where it is missing,
/// LOCOGRAPH_HAS_DUAL is 0 and edges without jacobians() are differentiated numerically.

#if defined(LOCOGRAPH_WITH_CERES_JET)
#include <ceres/jet.h>
#define LOCOGRAPH_HAS_DUAL 1
namespace locograph {
template <int N>
using Dual = ceres::Jet<double, N>;
}  // namespace locograph
#else
#define LOCOGRAPH_HAS_DUAL 0
#endif
