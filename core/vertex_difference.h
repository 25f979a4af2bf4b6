#pragma once
/// The difference of two states of a vertex, a ⊟ b, for types without an ominus() of their own: by
/// solving b ⊞ d = a with Gauss-Newton and differences, which serves every type whose ⊞ is smooth.

#include <locograph/core/scratch.h>

#include <cstddef>
#include <functional>

namespace locograph::detail {

std::size_t ominus_scratch_bytes(int dimension, int state_size);

/// out = state ⊞ step of one vertex. out holds the state's numbers before.
using Plus = std::function<void(const double* state, const double* step, double* out)>;
/// d = a ⊟ b of one vertex.
using Minus = std::function<void(const double* a, const double* b, double* d)>;

/// d = a ⊟ b with ⊞ alone; not a number where there is none.
void solve_ominus(int dimension, int state_size, const Plus& plus, const double* a, const double* b,
                  double* d, Scratch& scratch);

/// ∂((a ⊞ δ) ⊟ b)/∂δ at zero by central differences, dimension × dimension, by column.
void ominus_jacobian(int dimension, int state_size, const Plus& plus, const Minus& minus,
                     const double* a, const double* b, double* jacobian, Scratch& scratch);

}  // namespace locograph::detail
