#pragma once
/// The pattern of a symmetric block-sparse matrix: its upper triangle, by block columns.
///
///     for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
///       rows.push_back(pattern.row[k]);           // blocks (row[k], c), row[k] ≤ c, ascending
///     }
///
/// The values are one flat array; block k is column-major, dimension[row] × dimension[c], and
/// starts at value_offset[k]. Diagonal blocks are stored in full.
///
/// The last block rows, from `kept` on, are those of vertices marked for elimination: a Schur
/// complement takes them out first, other solvers treat them like the rest.

#include <cstdint>
#include <vector>

namespace locograph {

struct BlockPattern {
  std::vector<int> dimension;     ///< of each block row (= column)
  std::vector<int> scalar_begin;  ///< first scalar row of each block row; size + 1 entries
  std::vector<int> column_begin;  ///< size + 1 entries
  std::vector<int> row;
  std::vector<std::int64_t> value_offset;  ///< blocks + 1 entries

  int kept = 0;  ///< block rows before the eliminated ones

  int size() const { return static_cast<int>(dimension.size()); }
  int scalar_size() const { return scalar_begin.empty() ? 0 : scalar_begin.back(); }
  int blocks() const { return static_cast<int>(row.size()); }
  std::int64_t values() const { return value_offset.empty() ? 0 : value_offset.back(); }

  /// Number of block (r, c), r ≤ c. It must exist.
  int block_of(int r, int c) const;

  bool operator==(const BlockPattern&) const = default;
};

}  // namespace locograph
