#include <locograph/common/error.h>
#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/dense_solver.h>
#include <locograph/solvers/schur_solver.h>

#include <algorithm>
#include <utility>

namespace locograph {

SchurSolver::SchurSolver(Reduced reduced, const PcgOptions& pcg)
    : wanted_(reduced), chosen_(reduced), pcg_options_(pcg) {
  pcg.validate();
}

std::string SchurSolver::name() const {
  switch (analysed_ ? chosen_ : wanted_) {
    case Reduced::kDense:
      return "schur-dense";
    case Reduced::kSparse:
      return "schur-sparse";
    case Reduced::kPcg:
      return "schur-pcg";
    case Reduced::kAutomatic:
      break;
  }
  return "schur";
}

void SchurSolver::use_threads(ThreadPool* threads) {
  threads_ = threads;
  if (solver_) solver_->use_threads(threads);
}

void SchurSolver::analyse(const BlockPattern& pattern) {
  if (analysed_ && pattern == pattern_) return;
  analysed_ = false;
  pattern_ = pattern;
  structure_.build(pattern_, wanted_ != Reduced::kPcg);
  choose();
  factor_.resize(structure_.factor_size());
  failed_in_chunk_.resize(chunks());
  eliminated_part_.resize(pattern_.scalar_size() - pattern_.scalar_begin[pattern_.kept]);
  if (chosen_ == Reduced::kPcg) {
    product_.analyse(structure_.reduced());
    preconditioner_.analyse(structure_.reduced());
    iteration_.resize(structure_.reduced().scalar_size());
  } else {
    reduced_.resize(structure_.reduced().values());
    no_damping_.assign(structure_.reduced().scalar_size(), 0.0);
  }
  analysed_ = true;
}

void SchurSolver::choose() {
  // What a multiply-add costs relative to one of the sparse factorisation, and products that an
  // iterative solve makes: orders of magnitude, so that the choice is right where it matters.
  constexpr double kDenseUnit = 0.5, kProductUnit = 1.5, kProducts = 200.0;
  const double n = structure_.reduced().scalar_size();
  const double dense = kDenseUnit * n * n * n / 6.0;
  const double kept_values = structure_.reduced().values();
  const double pcg = kProducts * kProductUnit * 2.0 *
                     (static_cast<double>(structure_.factor_size()) + kept_values);
  chosen_ = wanted_;
  solver_.reset();
  double reduced_cost = wanted_ == Reduced::kPcg ? pcg : dense;
  if (wanted_ == Reduced::kDense) {
    solver_ = std::make_unique<DenseSolver>();
  } else if (wanted_ == Reduced::kSparse || wanted_ == Reduced::kAutomatic) {
    auto sparse = std::make_unique<BlockCholesky>();
    sparse->use_threads(threads_);
    sparse->analyse(structure_.reduced());
    reduced_cost = sparse->multiply_adds();
    chosen_ = Reduced::kSparse;
    solver_ = std::move(sparse);
    if (wanted_ == Reduced::kAutomatic && pcg < 0.2 * std::min(reduced_cost, dense)) {
      chosen_ = Reduced::kPcg;
      reduced_cost = pcg;
      solver_.reset();
      structure_.build(pattern_, false);
    } else if (wanted_ == Reduced::kAutomatic && dense < reduced_cost) {
      chosen_ = Reduced::kDense;
      reduced_cost = dense;
      solver_ = std::make_unique<DenseSolver>();
    }
  }
  if (solver_) {
    solver_->use_threads(threads_);
    solver_->analyse(structure_.reduced());
  }
  cost_ = structure_.cost() + reduced_cost;
}

template <class F>
void SchurSolver::each_column(F&& f) const {
  run_chunks(threads_, chunks(), [&](int chunk) {
    const int end = std::min(structure_.eliminated(), (chunk + 1) * kChunk);
    for (int p = chunk * kChunk; p < end; ++p) f(p);
  });
}

bool SchurSolver::eliminate_column(int p, const double* values, const double* damping) {
  return structure_.kernels(p).eliminate(structure_.column(p, factor_.data()),
                                         values + structure_.value_begin(p),
                                         damping + structure_.scalar_begin(p));
}

/// The first eliminated column that is not positive definite, -1 when all are.
int SchurSolver::eliminate_and_form(const double* values, const double* damping) {
  const bool form = chosen_ != Reduced::kPcg;
  if (form && !threaded()) {
    // W is still in the cache when its products are taken.
    for (int p = 0; p < structure_.eliminated(); ++p) {
      if (!eliminate_column(p, values, damping)) return p;
      const SchurColumn column = structure_.column(p, factor_.data());
      structure_.kernels(p).subtract_products(column, 0, column.blocks, structure_.places(p),
                                              reduced_.data());
    }
    return -1;
  }
  run_chunks(threads_, chunks(), [&](int chunk) {
    failed_in_chunk_[chunk] = -1;
    const int end = std::min(structure_.eliminated(), (chunk + 1) * kChunk);
    for (int p = chunk * kChunk; p < end && failed_in_chunk_[chunk] < 0; ++p) {
      if (!eliminate_column(p, values, damping)) failed_in_chunk_[chunk] = p;
    }
  });
  for (const int failed : failed_in_chunk_) {
    if (failed >= 0) return failed;
  }
  if (!form) return -1;
  run_chunks(threads_, structure_.tasks(), [&](int task) {
    for (auto visit = structure_.visits_begin(task); visit != structure_.visits_end(task);
         ++visit) {
      structure_.kernels(visit->column)
          .subtract_products(structure_.column(visit->column, factor_.data()), visit->first,
                             visit->last, structure_.places(visit->column), reduced_.data());
    }
  });
  return -1;
}

void SchurSolver::form_preconditioner(const double* values, const double* damping) {
  preconditioner_.load(values, damping);
  run_chunks(threads_, structure_.tasks(), [&](int task) {
    for (auto visit = structure_.visits_begin(task); visit != structure_.visits_end(task);
         ++visit) {
      structure_.kernels(visit->column)
          .subtract_squares(structure_.column(visit->column, factor_.data()), visit->first,
                            visit->last, preconditioner_.places(), preconditioner_.blocks());
    }
  });
}

bool SchurSolver::factorise(const double* values, const double* damping) {
  failed_row_ = -1;
  values_ = values;
  damping_ = damping;
  if (pattern_.size() == 0) return true;
  const BlockPattern& reduced = structure_.reduced();
  if (chosen_ != Reduced::kPcg) {
    std::fill(reduced_.begin(), reduced_.end(), 0.0);
    for (const SchurStructure::Copy& copy : structure_.copies()) {
      std::copy_n(values + copy.from, copy.count, reduced_.data() + copy.to);
    }
    for (int c = 0; c < reduced.size(); ++c) {
      const int n = reduced.dimension[c];
      double* block = reduced_.data() + reduced.value_offset[reduced.column_begin[c + 1] - 1];
      for (int i = 0; i < n; ++i) block[i * n + i] += damping[reduced.scalar_begin[c] + i];
    }
  }
  const int failed = eliminate_and_form(values, damping);
  if (failed >= 0) {
    failed_row_ = pattern_.kept + failed;
    return false;
  }
  if (pattern_.kept == 0) return true;
  if (chosen_ == Reduced::kPcg) {
    form_preconditioner(values, damping);
    failed_row_ = preconditioner_.invert(threads_);
    return failed_row_ < 0;
  }
  if (solver_->factorise(reduced_.data(), no_damping_.data())) return true;
  failed_row_ = solver_->failed_row();
  return false;
}

void SchurSolver::scatter(const double* t, double* y) const {
  const int begin = pattern_.scalar_begin[pattern_.kept];
  double* factor = const_cast<double*>(factor_.data());
  if (!threaded()) {
    for (int p = 0; p < structure_.eliminated(); ++p) {
      const SchurColumn column = structure_.column(p, factor);
      structure_.kernels(p).scatter(column, 0, column.blocks,
                                    t + (structure_.scalar_begin(p) - begin), y);
    }
    return;
  }
  threads_->run(structure_.tasks(), [&](int task) {
    for (auto visit = structure_.visits_begin(task); visit != structure_.visits_end(task);
         ++visit) {
      structure_.kernels(visit->column)
          .scatter(structure_.column(visit->column, factor), visit->first, visit->last,
                   t + (structure_.scalar_begin(visit->column) - begin), y);
    }
  });
}

/// out = S v = (B + damping) v − W (Wᵀ v)
void SchurSolver::multiply(const double* v, double* out) const {
  const int begin = pattern_.scalar_begin[pattern_.kept];
  double* factor = const_cast<double*>(factor_.data());
  product_.apply(values_, damping_, v, out, threads_);
  const auto gather = [&](int p) {
    double* t = eliminated_part_.data() + (structure_.scalar_begin(p) - begin);
    const SchurColumn column = structure_.column(p, factor);
    std::fill_n(t, column.dimension, 0.0);
    structure_.kernels(p).gather(column, v, t);
    for (int i = 0; i < column.dimension; ++i) t[i] = -t[i];
  };
  if (threaded()) {
    each_column(gather);
    scatter(eliminated_part_.data(), out);
    return;
  }
  for (int p = 0; p < structure_.eliminated(); ++p) {
    gather(p);
    const SchurColumn column = structure_.column(p, factor);
    structure_.kernels(p).scatter(column, 0, column.blocks,
                                  eliminated_part_.data() + (structure_.scalar_begin(p) - begin),
                                  out);
  }
}

void SchurSolver::solve(const double* right_hand_side, double* x) const {
  if (pattern_.size() == 0) return;
  if (x != right_hand_side) std::copy_n(right_hand_side, pattern_.scalar_size(), x);
  double* factor = const_cast<double*>(factor_.data());
  each_column([&](int p) {
    structure_.kernels(p).solve_lower(structure_.column(p, factor), x + structure_.scalar_begin(p));
  });
  scatter(x + pattern_.scalar_begin[pattern_.kept], x);
  if (pattern_.kept > 0 && chosen_ == Reduced::kPcg) {
    iteration_.solve(
        pcg_options_, threads_, x, x, [&](const double* v, double* out) { multiply(v, out); },
        [&](const double* v, double* out) { preconditioner_.apply(v, out, threads_); });
  } else if (pattern_.kept > 0) {
    solver_->solve(x, x);
  }
  each_column([&](int p) {
    const SchurColumn column = structure_.column(p, factor);
    structure_.kernels(p).gather(column, x, x + structure_.scalar_begin(p));
    structure_.kernels(p).solve_lower_transposed(column, x + structure_.scalar_begin(p));
  });
}

}  // namespace locograph
