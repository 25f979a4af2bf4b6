#pragma once
/// The symbolic half of a Schur complement: the reduced pattern and every offset that forming it
/// takes, worked out once.
///
///     SchurStructure structure;
///     structure.build(pattern, true);            // throws when eliminated vertices are tied
///     structure.reduced();                       // pattern of S = B − E C⁻¹ Eᵀ
///
/// Work is cut by kept rows into a fixed number of tasks, whatever the number of threads: each owns
/// block columns of S, visits the eliminated columns that touch them in ascending order, and so
/// adds up the same terms in the same order as one pass over all eliminated columns.

#include <locograph/core/block_matrix.h>
#include <locograph/solvers/schur_kernels.h>

#include <cstdint>
#include <vector>

namespace locograph {

/// The first two eliminated block rows that an off-diagonal block ties together; -1, -1 when there
/// are none and a Schur complement exists.
struct TiedRows {
  int first = -1, second = -1;
};
TiedRows tied_eliminated_rows(const BlockPattern& pattern);

class SchurStructure {
 public:
  /// Throws TiedRowsError when two eliminated block rows share a block. Without `form` only what
  /// the implicit product needs is built: no reduced pattern beyond the kept blocks of H.
  void build(const BlockPattern& pattern, bool form);

  int eliminated() const { return static_cast<int>(kernels_.size()); }
  /// Numbers in the factor (W and L) of all eliminated columns.
  std::int64_t factor_size() const { return factor_size_; }
  const SchurKernels& kernels(int column) const { return *kernels_[column]; }
  /// The shape of an eliminated column, its factor left out.
  SchurColumn column(int column) const;
  /// The same in `factor`, an array of factor_size().
  SchurColumn column(int column, double* factor) const;
  /// First scalar row of an eliminated column.
  int scalar_begin(int column) const { return pattern_.scalar_begin[pattern_.kept + column]; }
  /// Its first number in the values of H.
  std::int64_t value_begin(int column) const {
    return pattern_.value_offset[pattern_.column_begin[pattern_.kept + column]];
  }
  /// See SchurKernels::subtract_products.
  const std::int64_t* places(int column) const { return places_.data() + place_begin_[column]; }

  /// S, or the kept blocks of H alone when it is not formed.
  const BlockPattern& reduced() const { return reduced_; }
  /// A kept block of H and where it goes in S.
  struct Copy {
    std::int64_t from, to, count;
  };
  const std::vector<Copy>& copies() const { return copies_; }

  /// An eliminated column and those of its blocks that a task owns.
  struct Visit {
    int column, first, last;
  };
  int tasks() const { return static_cast<int>(visit_begin_.size()) - 1; }
  const Visit* visits_begin(int task) const { return visits_.data() + visit_begin_[task]; }
  const Visit* visits_end(int task) const { return visits_.data() + visit_begin_[task + 1]; }

  /// Multiply-adds of eliminating all columns.
  double cost() const { return cost_; }

 private:
  void choose_kernels();
  void cut_into_tasks();
  void build_reduced();
  void keep_blocks();

  BlockPattern pattern_;
  BlockPattern reduced_;
  std::vector<const SchurKernels*> kernels_;
  std::vector<std::int64_t> place_begin_, places_;
  std::vector<Copy> copies_;
  std::vector<Visit> visits_;
  std::vector<std::int64_t> visit_begin_;
  std::int64_t factor_size_ = 0;
  double cost_ = 0.0;
};

}  // namespace locograph
