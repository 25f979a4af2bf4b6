#pragma once
/// What each level's sources leave behind: its tables, and no other symbol. A source of a level is
/// compiled once with the flags of each (CMakeLists.txt) and defines its table in the namespace of
/// the level; kernels.cpp gathers them.

#include <locograph/solvers/dense_kernels.h>
#include <locograph/solvers/front_kernels.h>
#include <locograph/solvers/panel_solve.h>
#include <locograph/solvers/pcg_kernels.h>
#include <locograph/solvers/schur_kernels.h>

#define LOCOGRAPH_LEVEL_TABLES(level)                         \
  namespace locograph::level {                                \
  extern const DenseKernels dense_kernels;                    \
  extern const FrontKernels front_kernels;                    \
  extern const PanelSolve panel_solve;                        \
  const SchurKernels& schur_kernels(int rows, int dimension); \
  const PcgKernels& pcg_kernels(int dimension);               \
  }                                                           \
  static_assert(true, "")

LOCOGRAPH_LEVEL_TABLES(simd_v2);
LOCOGRAPH_LEVEL_TABLES(simd_v3);
LOCOGRAPH_LEVEL_TABLES(simd_v4);
LOCOGRAPH_LEVEL_TABLES(simd_portable);
