#include <locograph/common/error.h>
#include <locograph/solvers/ordering.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <numeric>

#if LOCOGRAPH_HAVE_METIS
#include <metis.h>
#endif

namespace locograph {

BlockGraph block_graph(const BlockPattern& pattern) {
  const int n = pattern.size();
  BlockGraph graph;
  graph.begin.assign(n + 1, 0);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k];
      if (r == c) continue;
      ++graph.begin[r + 1];
      ++graph.begin[c + 1];
    }
  }
  std::partial_sum(graph.begin.begin(), graph.begin.end(), graph.begin.begin());
  graph.neighbour.resize(graph.begin.back());
  std::vector<int> next(graph.begin.begin(), graph.begin.end() - 1);
  for (int c = 0; c < n; ++c) {
    for (int k = pattern.column_begin[c]; k < pattern.column_begin[c + 1]; ++k) {
      const int r = pattern.row[k];
      if (r == c) continue;
      graph.neighbour[next[r]++] = c;
      graph.neighbour[next[c]++] = r;
    }
  }
  return graph;
}

std::vector<int> minimum_degree_order(const BlockGraph& graph) {
  const int n = graph.size();
  if (n == 0) return {};
  const int entries = graph.begin.back();
  Eigen::SparseMatrix<char, Eigen::ColMajor, int> matrix(n, n);
  matrix.resizeNonZeros(entries + n);
  // The diagonal belongs in the matrix that AMD takes.
  int next = 0;
  for (int c = 0; c < n; ++c) {
    matrix.outerIndexPtr()[c] = next;
    matrix.innerIndexPtr()[next++] = c;
    for (int k = graph.begin[c]; k < graph.begin[c + 1]; ++k) {
      matrix.innerIndexPtr()[next++] = graph.neighbour[k];
    }
  }
  matrix.outerIndexPtr()[n] = next;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::internal::minimum_degree_ordering(matrix, permutation);
  const int* order = permutation.indices().data();
  return std::vector<int>(order, order + n);
}

#if LOCOGRAPH_HAVE_METIS

bool nested_dissection_available() { return true; }

std::vector<int> nested_dissection_order(const BlockGraph& graph) {
  idx_t n = graph.size();
  if (n == 0) return {};
  std::vector<idx_t> begin(graph.begin.begin(), graph.begin.end());
  std::vector<idx_t> neighbour(graph.neighbour.begin(), graph.neighbour.end());
  std::vector<idx_t> old_of_new(n), new_of_old(n);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_NUMBERING] = 0;
  const int status = METIS_NodeND(&n, begin.data(), neighbour.data(), nullptr, options,
                                  old_of_new.data(), new_of_old.data());
  if (status != METIS_OK) throw Error("METIS returned " + std::to_string(status), "an ordering");
  return std::vector<int>(old_of_new.begin(), old_of_new.end());
}

#else

bool nested_dissection_available() { return false; }

std::vector<int> nested_dissection_order(const BlockGraph&) {
  throw Error("this build has no nested dissection", "one with METIS");
}

#endif

}  // namespace locograph
