#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/kernels.h>

#include <algorithm>

namespace locograph {

/// The segment of a front starts with the right-hand sides of its pivots, then come the rows under
/// them: what its children have left to subtract, and its parent takes it from there.
void BlockCholesky::forward(int s, const double* right_hand_side) const {
  double* own = vectors_.data() + s_.vector_begin[s];
  double* next = own;
  for (int c = s_.first[s]; c < s_.first[s + 1]; ++c) {
    const int old = s_.old_of_new[c];
    next = std::copy_n(right_hand_side + pattern_.scalar_begin[old], pattern_.dimension[old], next);
  }
  std::fill(next, own + s_.leading[s], 0.0);
  for (int k = s_.child_begin[s]; k < s_.child_begin[s + 1]; ++k) {
    const int child = s_.child[k];
    kernels_.front.add_rows(
        own, vectors_.data() + s_.vector_begin[child] + kernels_.padded(s_.width[child]),
        s_.run.data() + s_.run_begin[child], s_.run.data() + s_.run_end[child]);
  }
  kernels_.panel.forward(factor_.data() + s_.panel_begin[s], s_.leading[s], s_.leading[s],
                         s_.width[s], own, true);
}

/// The rows under the pivots come from the parent, which is solved by now.
void BlockCholesky::backward(int s, double* x) const {
  double* own = vectors_.data() + s_.vector_begin[s];
  if (s_.parent[s] != -1) {
    const double* from = vectors_.data() + s_.vector_begin[s_.parent[s]];
    double* to = own + kernels_.padded(s_.width[s]);
    for (std::int64_t r = s_.run_begin[s]; r < s_.run_end[s]; ++r) {
      const FrontRun& run = s_.run[r];
      std::copy_n(from + run.to, run.length, to + run.from);
    }
  }
  kernels_.panel.backward(factor_.data() + s_.panel_begin[s], s_.leading[s], s_.leading[s],
                          s_.width[s], own, true);
  const double* next = own;
  for (int c = s_.first[s]; c < s_.first[s + 1]; ++c) {
    const int old = s_.old_of_new[c];
    std::copy_n(next, pattern_.dimension[old], x + pattern_.scalar_begin[old]);
    next += pattern_.dimension[old];
  }
}

void BlockCholesky::solve(const double* right_hand_side, double* x) const {
  const int items = s_.items();
  runner_.run(s_.upwards, threads_, [&](int item, const ItemRunner::Crew&) {
    for (int s = s_.item_begin[item]; s < s_.item_begin[item + 1]; ++s) forward(s, right_hand_side);
  });
  runner_.run(s_.downwards, threads_, [&](int reversed, const ItemRunner::Crew&) {
    const int item = items - 1 - reversed;
    for (int s = s_.item_begin[item + 1] - 1; s >= s_.item_begin[item]; --s) backward(s, x);
  });
}

}  // namespace locograph
