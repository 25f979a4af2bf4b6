#pragma once
/// What the examples of solvers/ take for granted.

#include <documentation/example_context.h>
#include <documentation/planar_map.h>
#include <locograph/common/thread_pool.h>
#include <locograph/core/graph.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/dense_qp.h>
#include <locograph/solvers/elimination_tree.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/solvers/ordering.h>
#include <locograph/solvers/pcg_block_jacobi.h>
#include <locograph/solvers/pcg_block_product.h>
#include <locograph/solvers/pcg_options.h>

#include <Eigen/SparseCore>
#include <utility>

namespace locograph::documentation::in_solvers {

/// The system of a small map, H x = b, and arrays as large as it.
struct Context {
  LinearisedMap map;
  Graph& graph = map.graph;
  const BlockPattern& pattern = map.problem.pattern();
  const int n = map.problem.dimension(), landmark = map.points[0].slot;
  std::vector<double> right_hand_side = std::vector<double>(n, 1.0);
  std::vector<double> arrays[4] = {right_hand_side, right_hand_side, right_hand_side,
                                   right_hand_side};
  const double *values = map.workspace.hessian().data(), *damping = map.workspace.damping().data(),
               *rhs = right_hand_side.data(), *b = rhs, *from = rhs;
  double *x = arrays[0].data(), *y = arrays[1].data(), *r = arrays[2].data(), *z = arrays[3].data(),
         *to = y;
  OptimiserOptions options, optimiser_options;
  ThreadPool pool{2};
  ThreadPool* threads = &pool;
};

/// A panel of a factor, of 6 rows and 3 columns, and what it is subtracted from.
struct PanelContext : Context {
  const int rows = 6, columns = 3, m = rows - columns, ld = 8, ldc = 4;
  std::vector<double> panel_memory = std::vector<double>(ld * columns, 0.1);
  std::vector<double> product_memory = std::vector<double>(ldc * m, 1.0);
  double *panel = panel_memory.data(), *c = product_memory.data();
  PanelContext() {
    for (int i = 0; i < columns; ++i) panel[i * ld + i] = 2.0;
  }
};

namespace block_cholesky_h {
struct Context : in_solvers::Context {
  ThreadPool& threads = pool;
};
}  // namespace block_cholesky_h
namespace dense_kernels_h {
using Context = PanelContext;
}
namespace kernels_h {
using Context = PanelContext;
}
namespace panel_solve_h {
using Context = PanelContext;
}
namespace front_kernels_h {
struct Context : PanelContext {
  const long count = static_cast<long>(panel_memory.size());
  const FrontRun first_two[2] = {{.from = 0, .to = 0, .length = 2},
                                 {.from = 2, .to = 5, .length = 3}};
  const FrontRun *runs = first_two, *last = first_two + 2;
  double* parent = panel;
  const double* child = rhs;
};
}  // namespace front_kernels_h
namespace item_graph_h {
struct Context : in_solvers::Context {
  ThreadPool& threads = pool;
  const std::vector<std::pair<int, int>> dependencies = {{0, 2}, {1, 2}};
  const std::vector<double> seconds = {1e-3, 2e-3, 1e-3};
  const int chunks = 4;
  std::vector<std::vector<double>> sums{3, std::vector<double>(chunks)};
  static double sum(int item, int chunk) { return item + 0.1 * chunk; }
};
}  // namespace item_graph_h
namespace pcg_iteration_h {
struct Context : in_solvers::Context {
  const PcgOptions options;
  BlockProduct product;
  BlockJacobi preconditioner;
  Context() {
    product.analyse(pattern);
    preconditioner.analyse(pattern);
    preconditioner.load(values, damping);
    preconditioner.invert(threads);
  }
};
}  // namespace pcg_iteration_h
namespace pcg_kernels_h {
struct Context : in_solvers::Context {
  std::vector<double> block = std::vector<double>(36, 0.5);
  const double* a = block.data();
};
}  // namespace pcg_kernels_h
namespace schur_structure_h {
struct Context : in_solvers::Context {
  Context() {
    for (const auto& point : map.points) graph.set_eliminate(point.slot, true);
    map.problem.compile(graph);
  }
};
}  // namespace schur_structure_h
namespace supernodes_h {
struct Context : in_solvers::Context {
  const BlockGraph graph = block_graph(pattern);
  const EliminationTree tree =
      elimination_tree(graph, pattern.dimension, minimum_degree_order(graph));
  const int i = 0;
  std::vector<double> memory = std::vector<double>(256);
  double* factor = memory.data();
};
}  // namespace supernodes_h

}  // namespace locograph::documentation::in_solvers
