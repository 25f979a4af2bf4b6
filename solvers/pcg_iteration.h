#pragma once
/// Preconditioned conjugate gradients (Hestenes & Stiefel 1952; Saad 2003, algorithm 9.1) for any
/// product and preconditioner, without allocation.
///
///     const auto times_a = [&](const double* v, double* out) {
///       product.apply(values, damping, v, out, threads);       // out = A v
///     };
///     const auto divide = [&](const double* v, double* out) {
///       preconditioner.apply(v, out, threads);                 // out = M⁻¹ v
///     };
///     PcgIteration iteration;
///     iteration.resize(n);
///     iteration.solve(options, threads, b, x, times_a, divide);
///
/// It starts from x = 0, so the residual of whatever iterate it ends with is orthogonal to that
/// iterate: the decrease hᵀ(Dh − g) that Levenberg-Marquardt predicts for a step h is exact also
/// for a step that is not. Sums are taken over chunks of fixed size: the same bits for any number
/// of threads.

#include <locograph/common/thread_pool.h>
#include <locograph/solvers/pcg_options.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace locograph {

/// task(chunk) for all chunks, on the threads there are.
template <class Task>
void run_chunks(ThreadPool* threads, int count, Task&& task) {
  if (threads != nullptr) {
    threads->run(count, task);
  } else {
    for (int i = 0; i < count; ++i) task(i);
  }
}

/// Where tasks over n rows begin, and n: 64 of them, fewer where each would get less than 16 rows.
inline std::vector<int> task_beginnings(int n) {
  const int tasks = std::clamp(n / 16, 1, 64);
  std::vector<int> begin;
  for (int t = 0; t <= tasks; ++t) {
    begin.push_back(static_cast<int>(std::int64_t{n} * t / tasks));
  }
  return begin;
}

class PcgIteration {
 public:
  void resize(int n) {
    n_ = n;
    chunks_ = (n + kChunk - 1) / kChunk;
    for (std::vector<double>* v : {&residual_, &direction_, &product_, &preconditioned_}) {
      v->resize(n);
    }
    partial_.resize(chunks_);
  }

  /// x may be b. Returns the number of products made.
  template <class Apply, class Precondition>
  int solve(const PcgOptions& options, ThreadPool* threads, const double* b, double* x,
            Apply&& apply, Precondition&& precondition) {
    double* r = residual_.data();
    double* p = direction_.data();
    double* q = product_.data();
    double* z = preconditioned_.data();
    std::copy(b, b + n_, r);
    std::fill(x, x + n_, 0.0);
    precondition(r, z);
    double rz = dot(threads, r, z);
    relative_residual_ = rz > 0.0 ? 1.0 : 0.0;
    const double goal = rz * options.relative_tolerance * options.relative_tolerance;
    const double start = rz;
    std::copy(z, z + n_, p);
    int iteration = 0;
    while (rz > goal && iteration < options.max_iterations) {
      apply(p, q);
      ++iteration;
      const double curvature = dot(threads, p, q);
      // Rounding at the end of a long solve, or a matrix that is not positive definite.
      if (!(curvature > 0.0)) break;
      const double alpha = rz / curvature;
      each(threads, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
          x[i] += alpha * p[i];
          r[i] -= alpha * q[i];
        }
      });
      precondition(r, z);
      const double next = dot(threads, r, z);
      if (!std::isfinite(next)) break;
      const double beta = next / rz;
      rz = next;
      each(threads, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) p[i] = z[i] + beta * p[i];
      });
    }
    relative_residual_ = start > 0.0 ? std::sqrt(std::max(rz, 0.0) / start) : 0.0;
    return iteration;
  }

  /// √(rᵀM⁻¹r) at the end of the last solve, over its first value.
  double relative_residual() const { return relative_residual_; }

 private:
  static constexpr int kChunk = 4096;

  template <class Body>
  void each(ThreadPool* threads, Body&& body) {
    run_chunks(threads, chunks_, [&](int c) { body(c * kChunk, std::min(n_, (c + 1) * kChunk)); });
  }
  double dot(ThreadPool* threads, const double* a, const double* b) {
    run_chunks(threads, chunks_, [&](int c) {
      double sum = 0.0;
      const int end = std::min(n_, (c + 1) * kChunk);
      for (int i = c * kChunk; i < end; ++i) sum += a[i] * b[i];
      partial_[c] = sum;
    });
    double sum = 0.0;
    for (const double part : partial_) sum += part;
    return sum;
  }

  int n_ = 0, chunks_ = 0;
  double relative_residual_ = 0.0;
  std::vector<double> residual_, direction_, product_, preconditioned_, partial_;
};

}  // namespace locograph
