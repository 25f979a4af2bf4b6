#include <locograph/core/linear_solver.h>
#include <locograph/solvers/kernels.h>
#include <locograph/solvers/schur_structure.h>

#include <algorithm>

namespace locograph {
namespace {

constexpr int kMostTasks = 32;

}  // namespace

TiedRows tied_eliminated_rows(const BlockPattern& pattern) {
  for (int c = pattern.kept; c < pattern.size(); ++c) {
    // Rows ascend, the diagonal is the last: what comes before it must be kept.
    const int last = pattern.column_begin[c + 1] - 1;
    if (last > pattern.column_begin[c] && pattern.row[last - 1] >= pattern.kept) {
      return {pattern.row[last - 1], c};
    }
  }
  return {};
}

SchurColumn SchurStructure::column(int column) const {
  const int c = pattern_.kept + column, begin = pattern_.column_begin[c];
  SchurColumn result;
  result.blocks = pattern_.column_begin[c + 1] - 1 - begin;
  result.dimension = pattern_.dimension[c];
  result.row = pattern_.row.data() + begin;
  result.row_dimension = pattern_.dimension.data();
  result.row_scalar = pattern_.scalar_begin.data();
  return result;
}

SchurColumn SchurStructure::column(int column, double* factor) const {
  SchurColumn result = this->column(column);
  result.factor = factor + (value_begin(column) - value_begin(0));
  return result;
}

void SchurStructure::build(const BlockPattern& pattern, bool form) {
  const TiedRows tied = tied_eliminated_rows(pattern);
  if (tied.first >= 0) throw TiedRowsError(tied.first, tied.second);
  pattern_ = pattern;
  factor_size_ = pattern.size() == 0
                     ? 0
                     : pattern.values() - pattern.value_offset[pattern.column_begin[pattern.kept]];
  choose_kernels();
  cut_into_tasks();
  place_begin_.clear();
  places_.clear();
  copies_.clear();
  if (form) {
    build_reduced();
  } else {
    keep_blocks();
  }
}

void SchurStructure::choose_kernels() {
  const int n = pattern_.size() - pattern_.kept;
  kernels_.resize(n);
  cost_ = 0.0;
  for (int p = 0; p < n; ++p) {
    const SchurColumn c = column(p);
    const int first = c.blocks > 0 ? pattern_.dimension[c.row[0]] : 0;
    bool same = true;
    double height = 0.0;
    for (int i = 0; i < c.blocks; ++i) {
      same = same && pattern_.dimension[c.row[i]] == first;
      height += pattern_.dimension[c.row[i]];
    }
    kernels_[p] = &locograph::kernels().schur(same ? first : 0, c.dimension);
    cost_ += c.dimension * (0.5 * height * height + height * c.dimension);
  }
}

/// Ranges of kept rows with about the same number of products; every visit is one contiguous range
/// of an eliminated column's blocks because its rows ascend.
void SchurStructure::cut_into_tasks() {
  std::vector<double> work(pattern_.kept + 1, 0.0);
  double total = 0.0;
  for (int p = 0; p < eliminated(); ++p) {
    const SchurColumn c = column(p);
    for (int j = 0; j < c.blocks; ++j) work[c.row[j]] += j + 1.0;
    total += 0.5 * c.blocks * (c.blocks + 1.0);
  }
  const int tasks = std::max(1, std::min(kMostTasks, pattern_.kept));
  std::vector<int> task_of_row(pattern_.kept, 0);
  double done = 0.0;
  for (int r = 0; r < pattern_.kept; ++r) {
    task_of_row[r] = total > 0.0 ? std::min(tasks - 1, static_cast<int>(done / total * tasks)) : 0;
    done += work[r];
  }
  const auto each_visit = [&](auto&& f) {
    for (int p = 0; p < eliminated(); ++p) {
      const SchurColumn c = column(p);
      for (int i = 0; i < c.blocks;) {
        const int task = task_of_row[c.row[i]], first = i;
        while (i < c.blocks && task_of_row[c.row[i]] == task) ++i;
        f(task, Visit{p, first, i});
      }
    }
  };
  visit_begin_.assign(tasks + 1, 0);
  each_visit([&](int task, const Visit&) { ++visit_begin_[task + 1]; });
  for (int t = 0; t < tasks; ++t) visit_begin_[t + 1] += visit_begin_[t];
  visits_.resize(visit_begin_.back());
  std::vector<std::int64_t> next(visit_begin_.begin(), visit_begin_.end() - 1);
  each_visit([&](int task, const Visit& visit) { visits_[next[task]++] = visit; });
}

/// The kept columns come first in H and hold kept rows only: a prefix of all its arrays.
void SchurStructure::keep_blocks() {
  const int kept = pattern_.kept;
  const int blocks = pattern_.column_begin.empty() ? 0 : pattern_.column_begin[kept];
  reduced_.kept = kept;
  reduced_.dimension.assign(pattern_.dimension.begin(), pattern_.dimension.begin() + kept);
  reduced_.scalar_begin.assign(pattern_.scalar_begin.begin(),
                               pattern_.scalar_begin.begin() + kept + 1);
  reduced_.column_begin.assign(pattern_.column_begin.begin(),
                               pattern_.column_begin.begin() + kept + 1);
  reduced_.row.assign(pattern_.row.begin(), pattern_.row.begin() + blocks);
  reduced_.value_offset.assign(pattern_.value_offset.begin(),
                               pattern_.value_offset.begin() + blocks + 1);
}

void SchurStructure::build_reduced() {
  const int kept = pattern_.kept;
  // The eliminated columns on each kept row, as (column, number of the block in it).
  struct Touch {
    int column, block;
  };
  std::vector<std::int64_t> touch_begin(kept + 1, 0);
  place_begin_.assign(1, 0);
  for (int p = 0; p < eliminated(); ++p) {
    const SchurColumn c = column(p);
    for (int i = 0; i < c.blocks; ++i) ++touch_begin[c.row[i] + 1];
    place_begin_.push_back(place_begin_.back() + std::int64_t{c.blocks} * (c.blocks + 1) / 2);
  }
  for (int r = 0; r < kept; ++r) touch_begin[r + 1] += touch_begin[r];
  std::vector<Touch> touches(touch_begin.back());
  std::vector<std::int64_t> next(touch_begin.begin(), touch_begin.end() - 1);
  for (int p = 0; p < eliminated(); ++p) {
    const SchurColumn c = column(p);
    for (int i = 0; i < c.blocks; ++i) touches[next[c.row[i]]++] = {p, i};
  }

  places_.resize(place_begin_.back());
  keep_blocks();
  reduced_.column_begin.assign(1, 0);
  reduced_.row.clear();
  reduced_.value_offset.assign(1, 0);
  std::vector<int> mark(kept, -1);
  std::vector<std::int64_t> place(kept);
  for (int j = 0; j < kept; ++j) {
    const std::size_t begin = reduced_.row.size();
    const auto add = [&](int r) {
      if (mark[r] == j) return;
      mark[r] = j;
      reduced_.row.push_back(r);
    };
    for (int k = pattern_.column_begin[j]; k < pattern_.column_begin[j + 1]; ++k) {
      add(pattern_.row[k]);
    }
    for (std::int64_t k = touch_begin[j]; k < touch_begin[j + 1]; ++k) {
      const SchurColumn c = column(touches[k].column);
      for (int i = 0; i < touches[k].block; ++i) add(c.row[i]);
    }
    std::sort(reduced_.row.begin() + static_cast<std::ptrdiff_t>(begin), reduced_.row.end());
    for (std::size_t k = begin; k < reduced_.row.size(); ++k) {
      const int r = reduced_.row[k];
      place[r] = reduced_.value_offset.back();
      reduced_.value_offset.push_back(place[r] +
                                      std::int64_t{pattern_.dimension[r]} * pattern_.dimension[j]);
    }
    reduced_.column_begin.push_back(static_cast<int>(reduced_.row.size()));
    for (std::int64_t k = touch_begin[j]; k < touch_begin[j + 1]; ++k) {
      const int b = touches[k].block;
      const SchurColumn c = column(touches[k].column);
      std::int64_t* to =
          places_.data() + place_begin_[touches[k].column] + std::int64_t{b} * (b + 1) / 2;
      for (int i = 0; i <= b; ++i) to[i] = place[c.row[i]];
    }
    for (int k = pattern_.column_begin[j]; k < pattern_.column_begin[j + 1]; ++k) {
      copies_.push_back({pattern_.value_offset[k], place[pattern_.row[k]],
                         pattern_.value_offset[k + 1] - pattern_.value_offset[k]});
    }
  }
}

}  // namespace locograph
