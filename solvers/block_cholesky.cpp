#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/cost_model.h>

#include <algorithm>
#include <atomic>
#include <limits>

namespace locograph {
namespace {

/// Fronts below this are not worth the microseconds that threads need to meet.
constexpr double kShareFront = 30e-6;
constexpr std::int64_t kAhead = 8;
constexpr int kColumnChunk = 16;   // columns of a child that one task adds
constexpr int kPanelColumns = 64;  // columns of a shared front factored before threads meet
constexpr int kRowChunk = 96;      // rows of a shared panel that one task divides
constexpr int kTileColumns = 48, kTileRows = 192;  // of a shared product

template <int N>
void copy_square(double* to, long leading, const double* from, bool transposed) {
  if (transposed) {
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < N; ++j) to[i * leading + j] = from[j * N + i];
    }
  } else {
    for (int j = 0; j < N; ++j) {
      for (int i = 0; i < N; ++i) to[j * leading + i] = from[j * N + i];
    }
  }
}

/// The lower trapezoid of an m × n product in tiles, each of which one call computes.
struct LowerTiles {
  const DenseKernels& dense;
  int m, n;
  int count() const {
    int total = 0;
    for (int j = 0; j < n; j += kTileColumns) total += (m - j + kTileRows - 1) / kTileRows;
    return total;
  }
  void compute(int tile, double* c, int ldc, const double* a, int lda, int k,
               bool overwrite) const {
    int j = 0;
    for (int tiles; tile >= (tiles = (m - j + kTileRows - 1) / kTileRows); tile -= tiles) {
      j += kTileColumns;
    }
    const int i = j + tile * kTileRows;
    const int rows = std::min(kTileRows, m - i), columns = std::min(kTileColumns, n - j);
    double* target = c + static_cast<long>(j) * ldc + i;
    if (overwrite) {
      dense.negative_product(target, ldc, a + i, lda, a + j, lda, rows, columns, k, tile == 0);
    } else if (tile == 0) {
      dense.subtract_lower_product(target, ldc, a + i, lda, rows, columns, k);
    } else {
      dense.subtract_product(target, ldc, a + i, lda, a + j, lda, rows, columns, k);
    }
  }
};

}  // namespace

void BlockCholesky::analyse(const BlockPattern& pattern) {
  analyse_if_below(pattern, std::numeric_limits<double>::infinity());
}

bool BlockCholesky::analyse_if_below(const BlockPattern& pattern, double limit) {
  if (pattern == pattern_) return seconds_ < limit;
  const BlockGraph graph = block_graph(pattern);
  EliminationTree tree = elimination_tree(graph, pattern.dimension, minimum_degree_order(graph));
  double seconds = factorisation_seconds(tree, pattern.dimension);
  bool nested = false;
  // Nested dissection saves up to a quarter of each of about ten factorisations of a pose graph.
  constexpr double kSaved = 0.25, kFactorisations = 10.0;
  if (nested_dissection_available() && (1.0 - kSaved) * seconds < limit &&
      kSaved * kFactorisations * seconds > dissection_seconds(pattern.size())) {
    EliminationTree other =
        elimination_tree(graph, pattern.dimension, nested_dissection_order(graph));
    const double its = factorisation_seconds(other, pattern.dimension);
    if (its < seconds) {
      tree = std::move(other);
      seconds = its;
      nested = true;
    }
  }
  if (!(seconds < limit)) return false;
  pattern_ = pattern;
  seconds_ = seconds;
  nested_ = nested;
  s_ = supernodes(graph, tree, pattern.dimension);
  place_entries();
  factor_.reserve(s_.panel_begin.back());
  vectors_.reserve(s_.vector_begin.back());
  failed_.assign(s_.items(), -1);
  reserve_updates();
  return true;
}

void BlockCholesky::reserve_updates() {
  const int threads = threads_ ? threads_->size() : 1;
  runner_.prepare(s_.items(), threads);
  updates_.reserve(s_.shared_size + threads * s_.stack_size);
}

void BlockCholesky::use_threads(ThreadPool* threads) {
  threads_ = threads;
  reserve_updates();
}

void BlockCholesky::place_entries() {
  const int n = pattern_.size();
  // Blocks by the column of the factor they go to.
  std::vector<int> begin(n + 1, 0), block(pattern_.blocks()), column(pattern_.blocks());
  for (int c = 0; c < n; ++c) {
    for (int k = pattern_.column_begin[c]; k < pattern_.column_begin[c + 1]; ++k) {
      column[k] = c;
      ++begin[std::min(s_.new_of_old[pattern_.row[k]], s_.new_of_old[c]) + 1];
    }
  }
  for (int c = 0; c < n; ++c) begin[c + 1] += begin[c];
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (int k = 0; k < pattern_.blocks(); ++k) {
    const int a = s_.new_of_old[pattern_.row[k]], b = s_.new_of_old[column[k]];
    block[next[std::min(a, b)]++] = k;
  }
  entries_.clear();
  entries_.reserve(pattern_.blocks());
  entry_begin_.assign(1, 0);
  std::vector<int> place(n);
  for (int s = 0; s < s_.count(); ++s) {
    const int first = s_.first[s], end = s_.first[s + 1];
    for (int c = first; c < end; ++c) place[c] = s_.scalar_begin[c] - s_.scalar_begin[first];
    int row = kernels_.padded(s_.width[s]);
    for (std::int64_t k = s_.row_begin[s]; k < s_.row_begin[s + 1]; ++k) {
      place[s_.row[k]] = row;
      row += s_.scalar_begin[s_.row[k] + 1] - s_.scalar_begin[s_.row[k]];
    }
    for (int i = begin[first]; i < begin[end]; ++i) {
      const int k = block[i], r = pattern_.row[k], c = column[k];
      const int a = s_.new_of_old[r], b = s_.new_of_old[c];
      // H stores (r, c); the panel wants (larger, smaller): transposed when r is its column.
      const std::int64_t to = s_.panel_begin[s] +
                              std::int64_t{place[std::min(a, b)]} * s_.leading[s] +
                              place[std::max(a, b)];
      entries_.push_back({pattern_.value_offset[k], to, s_.leading[s],
                          static_cast<short>(pattern_.dimension[r]),
                          static_cast<short>(pattern_.dimension[c]), a < b});
    }
    entry_begin_.push_back(static_cast<std::int64_t>(entries_.size()));
  }
}

void BlockCholesky::assemble_entries(int s, const double* values, const double* damping) {
  double* factor = factor_.data();
  const std::int64_t most = static_cast<std::int64_t>(entries_.size()) - 1;
  for (std::int64_t k = entry_begin_[s]; k < entry_begin_[s + 1]; ++k) {
    const Entry& e = entries_[k];
    // Blocks of H lie anywhere: ask for one some blocks ahead.
    const double* ahead = values + entries_[std::min(k + kAhead, most)].from;
    __builtin_prefetch(ahead);
    if (e.rows > 3) {
      for (int line = 8; line < 40; line += 8) __builtin_prefetch(ahead + line);
    }
    const double* from = values + e.from;
    double* to = factor + e.to;
    const long leading = e.leading;
    if (e.rows == e.columns && e.rows == 6) {
      copy_square<6>(to, leading, from, e.transposed);
    } else if (e.rows == e.columns && e.rows == 3) {
      copy_square<3>(to, leading, from, e.transposed);
    } else if (e.transposed) {
      for (int i = 0; i < e.rows; ++i) {
        for (int j = 0; j < e.columns; ++j) to[i * leading + j] = from[j * e.rows + i];
      }
    } else {
      for (int j = 0; j < e.columns; ++j) {
        for (int i = 0; i < e.rows; ++i) to[j * leading + i] = from[j * e.rows + i];
      }
    }
  }
  double* diagonal = factor + s_.panel_begin[s];
  for (int c = s_.first[s]; c < s_.first[s + 1]; ++c) {
    const int old = s_.old_of_new[c];
    const double* own = damping + pattern_.scalar_begin[old];
    for (int i = 0; i < pattern_.dimension[old]; ++i) {
      *diagonal += own[i];
      diagonal += s_.leading[s] + 1;
    }
  }
}

double* BlockCholesky::update_matrix(int s, int thread) {
  double* begin = updates_.data() + s_.update_begin[s];
  return s_.on_stack(s) ? begin + s_.shared_size + thread * s_.stack_size : begin;
}

/// Adds the columns begin … end − 1 of a child's update matrix to its parent's panel, if they are
/// pivots there, or else to the parent's update matrix.
void BlockCholesky::add_child(int child, int thread, bool pivots, int begin, int end) {
  const int parent = s_.parent[child];
  const long from_leading = kernels_.padded(s_.below[child]);
  const double* from = update_matrix(child, thread);
  const int skipped = pivots ? 0 : kernels_.padded(s_.width[parent]);
  const long to_leading = pivots ? s_.leading[parent] : kernels_.padded(s_.below[parent]);
  double* to = pivots ? factor_.data() + s_.panel_begin[parent] : update_matrix(parent, thread);
  const FrontRun* runs = s_.run.data();
  const std::int64_t middle = s_.run_begin[child] + s_.pivot_runs[child];
  const std::int64_t last = s_.run_end[child];
  kernels_.front.add_columns(to, to_leading, skipped, from, from_leading,
                             runs + (pivots ? s_.run_begin[child] : middle),
                             runs + (pivots ? middle : last), runs + last, begin, end);
}

int BlockCholesky::factorise_front(int s, const double* values, const double* damping, int thread) {
  const int width = s_.width[s], below = s_.below[s], leading = s_.leading[s];
  double* panel = factor_.data() + s_.panel_begin[s];
  kernels_.front.clear(panel, std::int64_t{leading} * width);
  assemble_entries(s, values, damping);
  const int* begin = s_.child.data() + s_.child_begin[s];
  const int* end = s_.child.data() + s_.child_begin[s + 1];
  for (const int* c = begin; c != end; ++c) add_child(*c, thread, true, 0, s_.below[*c]);
  const int failed = kernels_.dense.cholesky_in_place(panel, leading, leading, width);
  if (failed >= 0 || below == 0) return failed;
  const double* under = panel + kernels_.padded(width);
  kernels_.dense.negative_product(update_matrix(s, thread), kernels_.padded(below), under, leading,
                                  under, leading, kernels_.padded(below), below, width, true);
  for (const int* c = begin; c != end; ++c) add_child(*c, thread, false, 0, s_.below[*c]);
  return -1;
}

bool BlockCholesky::worth_sharing(int s) const {
  return s >= s_.top && s_.seconds[s] > kShareFront;
}

/// The same front, its work divided among the threads. How it is divided depends on its size only.
int BlockCholesky::factorise_front_together(int s, const double* values, const double* damping,
                                            const ItemRunner::Crew& crew) {
  const int width = s_.width[s], below = s_.below[s], leading = s_.leading[s];
  const long ld = leading;
  double* panel = factor_.data() + s_.panel_begin[s];
  const auto chunks = [](int count, int size) { return (count + size - 1) / size; };
  const auto add_children = [&](bool pivots) {
    for (int k = s_.child_begin[s]; k < s_.child_begin[s + 1]; ++k) {
      const int child = s_.child[k];
      crew.share(chunks(s_.below[child], kColumnChunk), [&](int i) {
        add_child(child, crew.thread(), pivots, i * kColumnChunk, (i + 1) * kColumnChunk);
      });
    }
  };
  crew.share(chunks(width, kColumnChunk), [&](int i) {
    const int begin = i * kColumnChunk, end = std::min(width, begin + kColumnChunk);
    kernels_.front.clear(panel + begin * ld, ld * (end - begin));
  });
  assemble_entries(s, values, damping);
  add_children(true);
  for (int first = 0; first < width; first += kPanelColumns) {
    const int end = std::min(width, first + kPanelColumns);
    const int next = end == width ? kernels_.padded(width) : end;
    double* square = panel + first * ld + first;
    const int failed = kernels_.dense.cholesky_in_place(square, leading, next - first, end - first);
    if (failed >= 0) return first + failed;
    double* rest = panel + first * ld + next;
    crew.share(chunks(leading - next, kRowChunk), [&](int i) {
      const int row = i * kRowChunk;
      kernels_.dense.divide_rows(rest + row, leading, std::min(kRowChunk, leading - next - row),
                                 square, leading, end - first);
    });
    if (end == width) break;
    const LowerTiles tiles{kernels_.dense, leading - end, width - end};
    crew.share(tiles.count(), [&](int i) {
      tiles.compute(i, panel + end * ld + end, leading, rest, leading, end - first, false);
    });
  }
  if (below == 0) return -1;
  const LowerTiles tiles{kernels_.dense, kernels_.padded(below), below};
  crew.share(tiles.count(), [&](int i) {
    tiles.compute(i, update_matrix(s, crew.thread()), kernels_.padded(below),
                  panel + kernels_.padded(width), leading, width, true);
  });
  add_children(false);
  return -1;
}

bool BlockCholesky::factorise(const double* values, const double* damping) {
  // The lowest item that fails is the same whoever runs what: all below it are run in any case.
  std::atomic<int> lowest = s_.items();
  runner_.run(s_.upwards, threads_, [&](int item, const ItemRunner::Crew& crew) {
    if (item > lowest.load(std::memory_order_relaxed)) return;
    for (int s = s_.item_begin[item]; s < s_.item_begin[item + 1]; ++s) {
      const int failed = worth_sharing(s) ? factorise_front_together(s, values, damping, crew)
                                          : factorise_front(s, values, damping, crew.thread());
      if (failed < 0) continue;
      const int row = s_.scalar_begin[s_.first[s]] + failed;
      const auto after = std::upper_bound(s_.scalar_begin.begin(), s_.scalar_begin.end(), row);
      failed_[item] = static_cast<int>(after - s_.scalar_begin.begin()) - 1;
      for (int known = lowest.load(); item < known && !lowest.compare_exchange_weak(known, item);) {
      }
      return;
    }
  });
  const bool good = lowest.load() == s_.items();
  failed_row_ = good ? -1 : s_.old_of_new[failed_[lowest.load()]];
  return good;
}

double BlockCholesky::multiply_adds() const {
  double total = 0.0;
  for (int s = 0; s < s_.count(); ++s) {
    const double w = s_.width[s], m = s_.below[s];
    total += w * w * w / 6.0 + 0.5 * w * w * m + 0.5 * w * m * m;
  }
  return total;
}

std::int64_t BlockCholesky::factor_size() const {
  std::int64_t total = 0;
  for (int s = 0; s < s_.count(); ++s) {
    total +=
        std::int64_t{s_.width[s]} * (s_.width[s] + 1) / 2 + std::int64_t{s_.width[s]} * s_.below[s];
  }
  return total;
}

}  // namespace locograph
