#pragma once
/// Estimated seconds of the steps of a factorisation on one thread: what decides which columns are
/// joined, which order is taken and which solver `auto` chooses. Only ratios matter.
///
///     double seconds = front_seconds(6, 12);     // a front of 6 pivots over 12 rows
///
/// The constants are those of the kernels in dense_kernels.h, measured with AVX-512 on a Zen 4
/// core: products of large tiles run at 26·10⁹ multiply-adds a second, a pivot takes 8 ns (a
/// division behind the last one's update), a front 40 ns (calls, tables), and 0.16 ns go into each
/// number that is cleared, gathered or handed over. Their sums over the fronts of the public pose
/// graphs come within 25 % of the measured factorisations, from 0.1 ms (CSAIL) to 29 ms (torus3D);
/// see benchmarks/solvers/factorisation_benchmark.

namespace locograph {

/// A front with its panel and update matrix.
double front_seconds(int width, int below);
/// A panel whose products go straight to where they belong: no update matrix is kept.
double panel_seconds(int width, int below);
/// Minimum degree, without the factorisation it serves.
double ordering_seconds(int block_rows, int blocks);
/// Nested dissection, likewise (METIS; 0.7 to 3 µs for each row of the public pose graphs).
double dissection_seconds(int block_rows);

}  // namespace locograph
