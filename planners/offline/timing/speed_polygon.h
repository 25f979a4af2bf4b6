#pragma once
/// Pairs of squared speeds at the two ends of an interval of the grid: a convex polygon.
///
///     SpeedPolygon polygon(0.0, 4.0, 0.0, 1.0);       // here in [0, 4], next in [0, 1]
///     polygon.clip(1.0, -1.0, 2.0);                   // here - next <= 2
///     polygon.here();                                 // [0, 3]
///     polygon.most_next(2.0);                         // 1

#include <algorithm>
#include <utility>
#include <vector>

namespace locograph {

class SpeedPolygon {
 public:
  SpeedPolygon(double least_here, double most_here, double least_next, double most_next)
      : corners_{{least_here, least_next},
                 {most_here, least_next},
                 {most_here, most_next},
                 {least_here, most_next}} {}

  struct Corner {
    double here, next;
  };

  bool empty() const { return corners_.empty(); }
  const std::vector<Corner>& corners() const { return corners_; }

  /// Keeps p here + q next <= r (Sutherland & Hodgman 1974).
  void clip(double p, double q, double r) {
    const auto beyond = [&](const Corner& corner) { return p * corner.here + q * corner.next - r; };
    if (std::none_of(corners_.begin(), corners_.end(),
                     [&](const Corner& corner) { return beyond(corner) > 0.0; })) {
      return;
    }
    kept_.clear();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Corner& from = corners_[i];
      const Corner& to = corners_[(i + 1) % corners_.size()];
      const double before = beyond(from), after = beyond(to);
      if (before <= 0.0) kept_.push_back(from);
      if ((before < 0.0 && after > 0.0) || (before > 0.0 && after < 0.0)) {
        const double share = before / (before - after);
        kept_.push_back(
            {from.here + share * (to.here - from.here), from.next + share * (to.next - from.next)});
      }
    }
    corners_.swap(kept_);
  }

  /// Least and most; not of an empty polygon.
  std::pair<double, double> here() const {
    const auto [least, most] =
        std::minmax_element(corners_.begin(), corners_.end(),
                            [](const Corner& a, const Corner& b) { return a.here < b.here; });
    return {least->here, most->here};
  }

  /// The largest `next` at a value of `here`, which is clamped to the polygon.
  double most_next(double at) const {
    const auto [least, most] = here();
    at = std::clamp(at, least, most);
    double result = -1.0;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Corner& from = corners_[i];
      const Corner& to = corners_[(i + 1) % corners_.size()];
      if (std::min(from.here, to.here) > at || std::max(from.here, to.here) < at) continue;
      if (from.here == to.here) {
        result = std::max({result, from.next, to.next});
      } else {
        const double share = (at - from.here) / (to.here - from.here);
        result = std::max(result, from.next + share * (to.next - from.next));
      }
    }
    return result;
  }

 private:
  std::vector<Corner> corners_, kept_;
};

}  // namespace locograph
