#pragma once
/// What the examples of solvers/ take for granted.

#include <locograph/common/thread_pool.h>
#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/elimination_tree.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/solvers/ordering.h>
#include <locograph/solvers/pcg_block_jacobi.h>
#include <locograph/solvers/pcg_block_product.h>
#include <locograph/solvers/pcg_options.h>
#include <locograph/solvers/simd.h>

#include <Eigen/SparseCore>
#include <utility>
#include <vector>

namespace locograph::documentation::in_solvers {

extern const BlockPattern pattern;
extern const double *values, *damping, *rhs, *b, *from;
extern double *x, *y, *r, *z, *c, *to, *factor, *panel;
extern const int i, n, m, ld, ldc, rows, columns, chunks, landmark;
extern ThreadPool* threads;
extern Graph graph;
extern OptimiserOptions options, optimiser_options;
extern BlockProduct product;
extern BlockJacobi preconditioner;

namespace block_cholesky_h {
extern ThreadPool threads;
}
namespace front_kernels_h {
extern const long count;
extern double* parent;
extern const double* child;
extern const FrontRun *runs, *last;
}  // namespace front_kernels_h
namespace item_graph_h {
extern ThreadPool threads;
extern const std::vector<std::pair<int, int>> dependencies;
extern const std::vector<double> seconds;
extern std::vector<std::vector<double>> sums;
double sum(int item, int chunk);
}  // namespace item_graph_h
namespace pcg_iteration_h {
extern const PcgOptions options;
}
namespace pcg_kernels_h {
extern const double* a;
}
namespace simd_h {
using namespace simd_portable;
}
namespace supernodes_h {
extern const BlockGraph graph;
extern const EliminationTree tree;
}  // namespace supernodes_h

}  // namespace locograph::documentation::in_solvers
