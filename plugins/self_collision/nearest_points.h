#pragma once
/// The nearest points of two line segments.
///
///     const SegmentPoints s = nearest_points(a_from, a_to, b_from, b_to);
///     const double distance = (s.on_second - s.on_first).norm();    // of the axes of two capsules
///
/// C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.9. Segments may be points; of
/// parallel ones that overlap it takes one of the possible pairs.

#include <Eigen/Core>
#include <algorithm>

namespace locograph {

struct SegmentPoints {
  Eigen::Vector3d on_first, on_second;
};

inline SegmentPoints nearest_points(const Eigen::Vector3d& a_from, const Eigen::Vector3d& a_to,
                                    const Eigen::Vector3d& b_from, const Eigen::Vector3d& b_to) {
  constexpr double kPoint_m2 = 1e-18;
  const Eigen::Vector3d a = a_to - a_from, b = b_to - b_from, between = a_from - b_from;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), b_between = b.dot(between);
  double s = 0.0, t = 0.0;  // fractions along a and b
  if (aa <= kPoint_m2) {
    if (bb > kPoint_m2) t = std::clamp(b_between / bb, 0.0, 1.0);
  } else {
    const double a_between = a.dot(between);
    if (bb <= kPoint_m2) {
      s = std::clamp(-a_between / aa, 0.0, 1.0);
    } else {
      const double ab = a.dot(b), squared_sine = aa * bb - ab * ab;
      if (squared_sine > 1e-12 * aa * bb) {
        s = std::clamp((ab * b_between - a_between * bb) / squared_sine, 0.0, 1.0);
      }
      t = (ab * s + b_between) / bb;
      if (t < 0.0 || t > 1.0) {
        t = std::clamp(t, 0.0, 1.0);
        s = std::clamp((ab * t - a_between) / aa, 0.0, 1.0);
      }
    }
  }
  return {a_from + s * a, b_from + t * b};
}

}  // namespace locograph
