#include <locograph/common/simd.h>
#include <locograph/solvers/level_tables.h>

namespace locograph::LOCOGRAPH_SIMD_NAMESPACE {
namespace {

LOCOGRAPH_INLINE void add(double* to, const double* from, int count) {
  int i = 0;
  for (; i + kLanes <= count; i += kLanes) store(to + i, load(to + i) + load(from + i));
  if (const int rest = count - i; rest != 0) {
    store_partial(to + i, load_partial(to + i, rest) + load_partial(from + i, rest), rest);
  }
}

/// The same for a block of rows × columns.
LOCOGRAPH_INLINE void add(double* to, long to_leading, const double* from, long from_leading,
                          int rows, int columns) {
  int i = 0;
  for (; i + kLanes <= rows; i += kLanes) {
    for (int j = 0; j < columns; ++j) {
      double* target = to + j * to_leading + i;
      store(target, load(target) + load(from + j * from_leading + i));
    }
  }
  if (const int rest = rows - i; rest != 0) {
    for (int j = 0; j < columns; ++j) {
      double* target = to + j * to_leading + i;
      store_partial(target,
                    load_partial(target, rest) + load_partial(from + j * from_leading + i, rest),
                    rest);
    }
  }
}

void clear(double* to, long count) {
  for (long i = 0; i < count; i += kLanes) store(to + i, Vector{});
}

void add_rows(double* to, const double* from, const FrontRun* first, const FrontRun* last) {
  for (; first != last; ++first) add(to + first->to, from + first->from, first->length);
}

void add_columns(double* to, long to_leading, int skipped, const double* from, long from_leading,
                 const FrontRun* first, const FrontRun* last, const FrontRun* rows_last, int begin,
                 int end) {
  for (const FrontRun* run = first; run != last; ++run) {
    const FrontRun across = *run;
    const int j = larger(0, begin - across.from);
    const int columns = smaller(across.length, end - across.from) - j;
    if (columns <= 0) continue;
    const double* source = from + (across.from + j) * from_leading;
    double* target = to + (across.to - skipped + j) * to_leading - skipped;
    for (int step = 0; step < columns; step += kLanes) {
      const int row = j + step;
      add(target + step * to_leading + across.to + row, to_leading,
          source + step * from_leading + across.from + row, from_leading, across.length - row,
          smaller(kLanes, columns - step));
    }
    for (const FrontRun* down = run + 1; down != rows_last; ++down) {
      add(target + down->to, to_leading, source + down->from, from_leading, down->length, columns);
    }
  }
}

}  // namespace

const FrontKernels front_kernels = {clear, add_rows, add_columns};

}  // namespace locograph::LOCOGRAPH_SIMD_NAMESPACE
