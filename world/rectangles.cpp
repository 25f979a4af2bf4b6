#include <locograph/world/convex_hull.h>
#include <locograph/world/rectangles.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

namespace locograph {
namespace {

constexpr int kTile = 2048;

/// The cells of a bounded part of the plane.
class Mask {
 public:
  explicit Mask(const std::vector<Cell>& cells) {
    from_ = to_ = cells.front();
    for (const Cell& cell : cells) {
      from_ = {std::min(from_.x, cell.x), std::min(from_.y, cell.y)};
      to_ = {std::max(to_.x, cell.x), std::max(to_.y, cell.y)};
    }
    set_.assign(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()), 0);
    for (const Cell& cell : cells) at(cell) = 1;
  }

  int width() const { return to_.x - from_.x + 1; }
  int height() const { return to_.y - from_.y + 1; }
  const Cell& from() const { return from_; }
  bool has(const Cell& cell) const {
    return cell.x >= from_.x && cell.x <= to_.x && cell.y >= from_.y && cell.y <= to_.y &&
           set_[index(cell)] != 0;
  }
  char& at(const Cell& cell) { return set_[index(cell)]; }

 private:
  std::size_t index(const Cell& cell) const {
    return static_cast<std::size_t>(cell.y - from_.y) * static_cast<std::size_t>(width()) +
           static_cast<std::size_t>(cell.x - from_.x);
  }

  Cell from_, to_;
  std::vector<char> set_;
};

bool large_enough(int width, int height, const CellSizes& sizes) {
  const double x = width * sizes.x * (1.0 + 1e-9), y = height * sizes.y * (1.0 + 1e-9);
  return std::max(x, y) >= sizes.least_length && std::min(x, y) >= sizes.least_width;
}

/// The largest rectangle of a mask that is large enough: of all under the columns' heights above
/// each row, found with a stack of columns that still rise. False if there is none.
bool largest_rectangle(const Mask& mask, const CellSizes& sizes, CellRectangle& best) {
  struct Step {
    int x = 0, height = 0;
  };
  const int width = mask.width();
  std::vector<int> heights(static_cast<std::size_t>(width), 0);
  std::vector<Step> steps;
  double best_area = 0.0;
  for (int y = 0; y < mask.height(); ++y) {
    steps.clear();
    for (int x = 0; x <= width; ++x) {
      int height = 0;
      if (x < width) {
        int& column = heights[static_cast<std::size_t>(x)];
        column = mask.has({mask.from().x + x, mask.from().y + y}) ? column + 1 : 0;
        height = column;
      }
      int start = x;
      while (!steps.empty() && steps.back().height >= height) {
        const Step step = steps.back();
        steps.pop_back();
        start = step.x;
        const double area = static_cast<double>(x - step.x) * step.height;
        if (area > best_area && large_enough(x - step.x, step.height, sizes)) {
          best_area = area;
          best = {{mask.from().x + step.x, mask.from().y + y - step.height + 1},
                  {mask.from().x + x - 1, mask.from().y + y}};
        }
      }
      if (height > 0) steps.push_back({start, height});
    }
  }
  return best_area > 0.0;
}

/// How many cells of a mask are below and left of each: a rectangle is counted with four of them,
/// however large it is.
class CellCounts {
 public:
  explicit CellCounts(const Mask& mask)
      : from_(mask.from()), width_(mask.width()), height_(mask.height()) {
    counts_.assign(static_cast<std::size_t>(width_ + 1) * static_cast<std::size_t>(height_ + 1), 0);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        const int here = mask.has({from_.x + x, from_.y + y}) ? 1 : 0;
        counts_[index(x + 1, y + 1)] =
            here + counts_[index(x, y + 1)] + counts_[index(x + 1, y)] - counts_[index(x, y)];
      }
  }

  bool all_in(const CellRectangle& cells) const {
    const int left = cells.from.x - from_.x, right = cells.to.x - from_.x + 1;
    const int low = cells.from.y - from_.y, high = cells.to.y - from_.y + 1;
    if (left < 0 || low < 0 || right > width_ || high > height_) return false;
    const int count = counts_[index(right, high)] - counts_[index(left, high)] -
                      counts_[index(right, low)] + counts_[index(left, low)];
    return count == (right - left) * (high - low);
  }

 private:
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_ + 1) +
           static_cast<std::size_t>(x);
  }

  Cell from_;
  int width_, height_;
  std::vector<int> counts_;
};

void grow(const CellCounts& whole, CellRectangle& r) {
  for (bool grown = true; grown;) {
    grown = false;
    if (whole.all_in({{r.from.x - 1, r.from.y}, {r.from.x - 1, r.to.y}})) --r.from.x, grown = true;
    if (whole.all_in({{r.to.x + 1, r.from.y}, {r.to.x + 1, r.to.y}})) ++r.to.x, grown = true;
    if (whole.all_in({{r.from.x, r.from.y - 1}, {r.to.x, r.from.y - 1}})) --r.from.y, grown = true;
    if (whole.all_in({{r.from.x, r.to.y + 1}, {r.to.x, r.to.y + 1}})) ++r.to.y, grown = true;
  }
}

/// Sets of cells that hang together by their sides. Empties the mask.
std::vector<std::vector<Cell>> take_apart(Mask& mask) {
  std::vector<std::vector<Cell>> parts;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      const Cell first{mask.from().x + x, mask.from().y + y};
      if (!mask.has(first)) continue;
      std::vector<Cell>& part = parts.emplace_back();
      const auto take = [&](const Cell& cell) {
        if (!mask.has(cell)) return;
        mask.at(cell) = 0;
        part.push_back(cell);
      };
      take(first);
      for (std::size_t i = 0; i < part.size(); ++i) {
        const Cell cell = part[i];
        take({cell.x - 1, cell.y});
        take({cell.x + 1, cell.y});
        take({cell.x, cell.y - 1});
        take({cell.x, cell.y + 1});
      }
    }
  return parts;
}

void rectangles_of(const std::vector<Cell>& cells, const CellSizes& sizes, const Deadline& deadline,
                   std::vector<CellRectangle>& out) {
  Mask rest(cells);
  const CellCounts whole(rest);
  std::vector<std::vector<Cell>> parts = take_apart(rest);
  while (!parts.empty()) {
    deadline.require();
    Mask part(parts.back());
    parts.pop_back();
    CellRectangle found;
    if (!largest_rectangle(part, sizes, found)) continue;
    grow(whole, found);
    out.push_back(found);
    for (int y = found.from.y; y <= found.to.y; ++y)
      for (int x = found.from.x; x <= found.to.x; ++x)
        if (part.has({x, y})) part.at({x, y}) = 0;
    for (std::vector<Cell>& left : take_apart(part)) parts.push_back(std::move(left));
  }
}

}  // namespace

std::vector<CellRectangle> cell_rectangles(std::vector<Cell> cells, const CellSizes& sizes,
                                           const Deadline& deadline) {
  Cell lowest;
  if (!cells.empty()) lowest = cells.front();
  for (const Cell& cell : cells) lowest = {std::min(lowest.x, cell.x), std::min(lowest.y, cell.y)};
  const auto tile = [&](const Cell& cell) {
    return std::pair((cell.y - lowest.y) / kTile, (cell.x - lowest.x) / kTile);
  };
  const auto place = [&](const Cell& cell) { return std::tuple(tile(cell), cell.y, cell.x); };
  std::sort(cells.begin(), cells.end(),
            [&](const Cell& a, const Cell& b) { return place(a) < place(b); });
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::vector<CellRectangle> rectangles;
  for (std::size_t first = 0; first < cells.size();) {
    std::size_t last = first;
    while (last < cells.size() && tile(cells[last]) == tile(cells[first])) ++last;
    rectangles_of({cells.begin() + static_cast<std::ptrdiff_t>(first),
                   cells.begin() + static_cast<std::ptrdiff_t>(last)},
                  sizes, deadline, rectangles);
    first = last;
  }
  const auto area = [](const CellRectangle& r) {
    return static_cast<double>(r.to.x - r.from.x + 1) * (r.to.y - r.from.y + 1);
  };
  std::stable_sort(
      rectangles.begin(), rectangles.end(),
      [&](const CellRectangle& a, const CellRectangle& b) { return area(a) > area(b); });
  return rectangles;
}

PlaneFrame smallest_frame(const std::vector<PlanePoint>& points) {
  const std::vector<PlanePoint> hull = convex_hull(points);
  const auto bounds = [&](double angle) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    PlaneFrame frame{angle, kInfinity, kInfinity, -kInfinity, -kInfinity};
    const double c = std::cos(angle), s = std::sin(angle);
    for (const PlanePoint& point : hull.empty() ? points : hull) {
      const double x = c * point.x + s * point.y, y = c * point.y - s * point.x;
      frame.lower_x = std::min(frame.lower_x, x), frame.upper_x = std::max(frame.upper_x, x);
      frame.lower_y = std::min(frame.lower_y, y), frame.upper_y = std::max(frame.upper_y, y);
    }
    return frame;
  };
  const auto area = [](const PlaneFrame& frame) {
    return (frame.upper_x - frame.lower_x) * (frame.upper_y - frame.lower_y);
  };
  PlaneFrame best = bounds(0.0);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const PlanePoint& a = hull[i];
    const PlanePoint& b = hull[(i + 1) % hull.size()];
    // Sides of a rectangle are a quarter turn apart.
    constexpr double kQuarter = 1.5707963267948966;
    const PlaneFrame frame = bounds(std::remainder(std::atan2(b.y - a.y, b.x - a.x), kQuarter));
    if (area(frame) < area(best) * (1.0 - 1e-9)) best = frame;
  }
  return best;
}

}  // namespace locograph
