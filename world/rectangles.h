#pragma once
/// Rectangles of cells that cover an irregular set of cells, the largest first.
///
///     std::vector<Cell> free = {{0, 0}, {1, 0}, {2, 0}, {0, 1}};
///     cell_rectangles(free, {.least_length = 2, .least_width = 1});
///     // (0,0)-(2,0) and, as rectangles may overlap, (0,0)-(0,1)
///
/// Greedy: the largest rectangle of cells that no other covers yet, which then grows over covered
/// ones as far as it can. Every rectangle is full of the given cells, and no side of it can move
/// out. None is longer than 2048 cells: larger sets are cut there.

#include <locograph/common/deadline.h>
#include <locograph/world/convex_hull.h>

#include <vector>

namespace locograph {

struct Cell {
  int x = 0, y = 0;
  bool operator==(const Cell&) const = default;
};

/// Both corners belong to it.
struct CellRectangle {
  Cell from, to;
};

struct CellSizes {
  double x = 1.0, y = 1.0;  ///< of a cell
  /// Of what a rectangle covers first: its longer and its shorter side.
  double least_length = 0.0, least_width = 0.0;
};

/// Cells in any order, also several times. Throws OutOfTime.
std::vector<CellRectangle> cell_rectangles(std::vector<Cell> cells, const CellSizes& sizes,
                                           const Deadline& deadline = {});

struct PlaneFrame {
  double angle_rad = 0.0;                                             ///< of its x axis
  double lower_x = 0.0, lower_y = 0.0, upper_x = 0.0, upper_y = 0.0;  ///< bounds along its axes
};
/// The smallest rectangle around points of a plane, one of whose sides is on their convex hull.
PlaneFrame smallest_frame(const std::vector<PlanePoint>& points);

}  // namespace locograph
