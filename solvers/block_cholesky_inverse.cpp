#include <locograph/solvers/block_cholesky.h>
#include <locograph/solvers/kernels.h>

#include <Eigen/Core>
#include <algorithm>

namespace locograph {
namespace {

using ConstPanel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

/// A block that is asked for and found in a front.
struct Wanted {
  int supernode;
  int row, column;  ///< scalar rows of the front, without padding
  std::size_t request;
};

}  // namespace

/// With J the pivots of a front, I the rows under them and Y = L_IJ L_JJ⁻¹, the inverse Z has
/// Z_IJ = −Z_II Y and Z_JJ = (L_JJ L_JJᵀ)⁻¹ − Yᵀ Z_IJ; Z_II is part of the front of the parent
/// (Takahashi, Fagan & Chin 1973; Erisman & Tinney 1975, by fronts).
bool BlockCholesky::inverse_blocks(const BlockPattern& pattern,
                                   std::span<const std::pair<int, int>> blocks, double* out) const {
  const auto place_in_front = [&](int s, int block) {
    if (block < s_.first[s + 1]) return s_.scalar_begin[block] - s_.scalar_begin[s_.first[s]];
    int place = s_.width[s];
    for (std::int64_t k = s_.row_begin[s]; k < s_.row_begin[s + 1]; ++k) {
      if (s_.row[k] == block) return place;
      place += s_.scalar_begin[s_.row[k] + 1] - s_.scalar_begin[s_.row[k]];
    }
    return -1;
  };
  std::vector<Wanted> wanted;
  std::vector<std::pair<int, int>> outside;
  std::vector<std::size_t> outside_request, begin(blocks.size() + 1, 0);
  std::vector<bool> needed(s_.count(), false);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const int r = s_.new_of_old[blocks[i].first], c = s_.new_of_old[blocks[i].second];
    begin[i + 1] = begin[i] + static_cast<std::size_t>(pattern.dimension[blocks[i].first]) *
                                  pattern.dimension[blocks[i].second];
    const int lower = std::min(r, c);
    const int s = static_cast<int>(std::upper_bound(s_.first.begin(), s_.first.end(), lower) -
                                   s_.first.begin()) -
                  1;
    const int row = place_in_front(s, r), column = place_in_front(s, c);
    if (row < 0 || column < 0) {
      outside.push_back(blocks[i]);
      outside_request.push_back(i);
    } else {
      wanted.push_back({s, row, column, i});
      for (int a = s; a != -1 && !needed[a]; a = s_.parent[a]) needed[a] = true;
    }
  }
  std::stable_sort(wanted.begin(), wanted.end(),
                   [](const Wanted& a, const Wanted& b) { return a.supernode > b.supernode; });

  // From the roots down; the inverse of a front is kept until the last of its children has it.
  std::vector<Eigen::MatrixXd> inverse(s_.count());
  std::vector<int> children(s_.count(), 0);
  for (int s = 0; s < s_.count(); ++s) {
    if (needed[s] && s_.parent[s] != -1) ++children[s_.parent[s]];
  }
  auto next = wanted.begin();
  bool finite = true;
  for (int s = s_.count() - 1; s >= 0; --s) {
    if (!needed[s]) continue;
    const int width = s_.width[s], below = s_.below[s], parent = s_.parent[s];
    const double* panel = factor_.data() + s_.panel_begin[s];
    const ConstPanel l(panel, width, width, Eigen::OuterStride<>(s_.leading[s]));
    const ConstPanel under(panel + kernels().padded(width), below, width,
                           Eigen::OuterStride<>(s_.leading[s]));
    Eigen::MatrixXd& z = inverse[s];
    z.resize(width + below, width + below);
    Eigen::MatrixXd triangle = Eigen::MatrixXd::Identity(width, width);
    l.triangularView<Eigen::Lower>().solveInPlace(triangle);
    z.topLeftCorner(width, width).noalias() = triangle.transpose() * triangle;
    if (below > 0) {
      const Eigen::MatrixXd& above = inverse[parent];
      const int gap = kernels().padded(s_.width[parent]) - s_.width[parent];
      const auto in_parent = [&](const FrontRun& run) {
        return run.to < s_.width[parent] ? run.to : run.to - gap;
      };
      for (std::int64_t a = s_.run_begin[s]; a < s_.run_end[s]; ++a) {
        for (std::int64_t b = s_.run_begin[s]; b < s_.run_end[s]; ++b) {
          const FrontRun &rows = s_.run[a], &columns = s_.run[b];
          z.block(width + rows.from, width + columns.from, rows.length, columns.length) =
              above.block(in_parent(rows), in_parent(columns), rows.length, columns.length);
        }
      }
      const Eigen::MatrixXd y = under * triangle;
      z.bottomLeftCorner(below, width).noalias() = -z.bottomRightCorner(below, below) * y;
      z.topLeftCorner(width, width).noalias() -= y.transpose() * z.bottomLeftCorner(below, width);
      z.topRightCorner(width, below) = z.bottomLeftCorner(below, width).transpose();
    }
    for (; next != wanted.end() && next->supernode == s; ++next) {
      const auto [r, c] = blocks[next->request];
      Eigen::Map<Eigen::MatrixXd> block(out + begin[next->request], pattern.dimension[r],
                                        pattern.dimension[c]);
      block = z.block(next->row, next->column, block.rows(), block.cols());
      finite = finite && block.allFinite();
    }
    if (children[s] == 0) z.resize(0, 0);
    if (parent != -1 && --children[parent] == 0) inverse[parent].resize(0, 0);
  }

  if (!outside.empty()) {
    std::size_t size = 0;
    for (const std::size_t i : outside_request) size += begin[i + 1] - begin[i];
    std::vector<double> solved(size);
    finite = solve_for_inverse_blocks(pattern, outside, solved.data()) && finite;
    const double* from = solved.data();
    for (const std::size_t i : outside_request) {
      std::copy_n(from, begin[i + 1] - begin[i], out + begin[i]);
      from += begin[i + 1] - begin[i];
    }
  }
  return finite;
}

}  // namespace locograph
