#pragma once
/// Distance between two convex sets given by support functions, by the algorithm of Gilbert,
/// Johnson and Keerthi, with a certificate.
///
///     GjkResult r = locograph::gjk_distance(
///         [&](const Eigen::Vector3d& n) { return farthest_point_of_a(n); },
///         [&](const Eigen::Vector3d& n) { return farthest_point_of_b(n); }, b_point - a_point);
///
/// Works on the difference set {a - b}: v is its point nearest to the origin within the current
/// simplex, w its support point along -v; |v| - v.w / |v| bounds the error of |v| from above.
/// E. Gilbert, D. Johnson, S. Keerthi, "A fast procedure for computing the distance between complex
/// objects in three-dimensional space", IEEE J. Robotics and Automation 4(2), 1988.

#include <Eigen/Dense>
#include <array>
#include <limits>

namespace locograph {

struct GjkResult {
  double distance = 0.0;  ///< 0: the sets intersect
  double error = 0.0;     ///< the true distance is at least distance - error
  Eigen::Vector3d on_first = Eigen::Vector3d::Zero(), on_second = Eigen::Vector3d::Zero();
};

namespace gjk_detail {

struct Vertex {
  Eigen::Vector3d difference, first, second;
};

struct Simplex {
  std::array<Vertex, 4> vertices;
  std::array<double, 4> weights{};
  int size = 0;
};

// Keeps the vertices of the face that holds the point nearest to the origin, and that point's
// barycentric coordinates. Tries all 15 faces: few, and immune to the sign errors of the recursion.
inline Eigen::Vector3d reduce(Simplex& simplex) {
  double best = std::numeric_limits<double>::infinity();
  Simplex nearest;
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  for (int mask = 1; mask < 1 << simplex.size; ++mask) {
    Simplex face;
    for (int i = 0; i < simplex.size; ++i)
      if (mask >> i & 1) face.vertices[face.size++] = simplex.vertices[i];
    const Eigen::Vector3d origin = face.vertices[0].difference;
    const int edges = face.size - 1;
    Eigen::Matrix3d span = Eigen::Matrix3d::Zero();
    for (int i = 0; i < edges; ++i) span.col(i) = face.vertices[i + 1].difference - origin;
    Eigen::Vector3d weights = Eigen::Vector3d::Zero();
    if (edges > 0) {
      Eigen::Matrix3d normal = span.transpose() * span;
      for (int i = edges; i < 3; ++i) normal(i, i) = 1.0;
      if (normal.determinant() <= 1e-14 * normal.diagonal().prod()) continue;  // flat face
      const Eigen::Vector3d right = -(span.transpose() * origin);
      weights = normal.ldlt().solve(right);
    }
    if (weights.minCoeff() < 0.0 || weights.sum() > 1.0) continue;
    const Eigen::Vector3d point = origin + span * weights;
    if (point.squaredNorm() >= best) continue;
    best = point.squaredNorm();
    v = point;
    face.weights[0] = 1.0 - weights.sum();
    for (int i = 0; i < edges; ++i) face.weights[i + 1] = weights[i];
    nearest = face;
  }
  simplex = nearest;
  return v;
}

}  // namespace gjk_detail

/// start: a guess of a vector between the sets, not zero.
template <class FirstSupport, class SecondSupport>
GjkResult gjk_distance(const FirstSupport& first, const SecondSupport& second,
                       const Eigen::Vector3d& start, double tolerance = 1e-9) {
  gjk_detail::Simplex simplex;
  Eigen::Vector3d v = start;
  GjkResult result;
  double bound = 0.0;  // largest lower bound so far
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < 100; ++iteration) {
    gjk_detail::Vertex& added = simplex.vertices[simplex.size];
    added.first = first(Eigen::Vector3d(-v));
    added.second = second(v);
    added.difference = added.first - added.second;
    if (iteration > 0) {
      bound = std::max(bound, v.dot(added.difference) / v.norm());
      if (v.norm() - bound <= tolerance) break;
    }
    ++simplex.size;
    v = gjk_detail::reduce(simplex);
    const double norm = v.norm();
    if (simplex.size == 4 || norm < 1e-12) {
      result.distance = 0.0;
      return result;
    }
    if (norm >= last) break;  // no progress left in double precision
    last = norm;
  }
  result.distance = v.norm();
  result.error = result.distance - bound;
  for (int i = 0; i < simplex.size; ++i) {
    result.on_first += simplex.weights[i] * simplex.vertices[i].first;
    result.on_second += simplex.weights[i] * simplex.vertices[i].second;
  }
  return result;
}

}  // namespace locograph
