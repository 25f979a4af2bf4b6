#include <locograph/solvers/kernels.h>
#include <locograph/solvers/pcg_block_jacobi.h>
#include <locograph/solvers/pcg_iteration.h>

#include <algorithm>

namespace locograph {

void BlockJacobi::analyse(const BlockPattern& pattern) {
  pattern_ = &pattern;
  const int n = pattern.size();
  place_.assign(1, 0);
  widest_ = 0;
  for (const int d : pattern.dimension) {
    place_.push_back(place_.back() + std::int64_t{d} * d);
    widest_ = std::max(widest_, d);
  }
  blocks_.resize(place_.back());
  const auto differs = [&](int d) { return d != widest_; };
  const bool same = std::none_of(pattern.dimension.begin(), pattern.dimension.end(), differs);
  kernel_ = &kernels().pcg(same ? widest_ : 0);
  task_begin_ = task_beginnings(n);
  const std::size_t tasks = task_begin_.size() - 1;
  failed_.resize(tasks);
  work_.resize(tasks * widest_ * widest_);
}

void BlockJacobi::load(const double* values, const double* damping) {
  const BlockPattern& p = *pattern_;
  for (int c = 0; c < p.size(); ++c) {
    const int n = p.dimension[c];
    double* block = blocks_.data() + place_[c];
    std::copy_n(values + p.value_offset[p.column_begin[c + 1] - 1], n * n, block);
    for (int i = 0; i < n; ++i) block[i * n + i] += damping[p.scalar_begin[c] + i];
  }
}

int BlockJacobi::invert_range(int begin, int end, double* work) {
  const DenseKernels& dense = kernels().dense;
  for (int c = begin; c < end; ++c) {
    const int n = pattern_->dimension[c];
    double* block = blocks_.data() + place_[c];
    std::copy_n(block, n * n, work);
    if (dense.cholesky_in_place(work, n, n, n) >= 0) return c;
    std::fill_n(block, n * n, 0.0);
    for (int j = 0; j < n; ++j) {
      block[j * n + j] = 1.0;
      dense.solve_lower(work, n, n, block + j * n);
      dense.solve_lower_transposed(work, n, n, block + j * n);
    }
  }
  return -1;
}

int BlockJacobi::invert(ThreadPool* threads) {
  const int tasks = static_cast<int>(task_begin_.size()) - 1;
  run_chunks(threads, tasks, [&](int t) {
    failed_[t] = invert_range(task_begin_[t], task_begin_[t + 1],
                              work_.data() + static_cast<std::ptrdiff_t>(t) * widest_ * widest_);
  });
  for (const int failed : failed_) {
    if (failed >= 0) return failed;
  }
  return -1;
}

void BlockJacobi::apply(const double* r, double* z, ThreadPool* threads) const {
  const BlockPattern& p = *pattern_;
  const PcgKernels& own = *kernel_;
  run_chunks(threads, static_cast<int>(task_begin_.size()) - 1, [&](int t) {
    for (int c = task_begin_[t]; c < task_begin_[t + 1]; ++c) {
      const int n = p.dimension[c], at = p.scalar_begin[c];
      const double* block = blocks_.data() + place_[c];
      own.multiply(block, n, r + at, z + at);
    }
  });
}

}  // namespace locograph
