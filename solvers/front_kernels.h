#pragma once
/// How fronts of a multifrontal factorisation are cleared and added to one another: small pieces,
/// many of them, so that a call does all of a front's and not one piece.
///
///     const FrontKernels& fronts = kernels().front;                    // kernels.h
///     fronts.clear(panel, count);
///     fronts.add_rows(parent, child, runs, last);

namespace locograph {

/// Rows that are contiguous both in the update matrix of a supernode and in its parent's front.
struct FrontRun {
  int from;    ///< row of the update matrix
  int to;      ///< row of the parent's front, padding included
  int length;  ///< scalar rows
};

struct FrontKernels {
  /// count: a multiple of the lanes.
  void (*clear)(double* to, long count);

  /// to[run.to …] += from[run.from …] for the runs first … last − 1.
  void (*add_rows)(double* to, const double* from, const FrontRun* first, const FrontRun* last);

  /// The columns begin … end − 1 of an update matrix, as far as they are in the runs first …
  /// last − 1, with the rows of these runs and of those up to `rows_last`, added to a front whose
  /// first row and column are the parent's `skipped`th. On and below the diagonal; the little that
  /// is added above it means nothing on either side.
  void (*add_columns)(double* to, long to_leading, int skipped, const double* from,
                      long from_leading, const FrontRun* first, const FrontRun* last,
                      const FrontRun* rows_last, int begin, int end);
};

}  // namespace locograph
