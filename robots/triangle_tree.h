#pragma once
/// Distances to the triangles of a mesh, and which side of them a point is on. Any soup of
/// triangles will do: with holes, overlaps, triangles without area.
///
///     const TriangleTree tree(stl_triangles("thigh.stl"));
///     double distance = tree.distance(point);                       // to the nearest triangle
///     bool inside = std::abs(tree.winding_number(point)) > 0.5;     // either orientation
///     double along = tree.first_hit(point, Eigen::Vector3d::UnitX());
///
/// Lengths in the units of the corners. Thread-safety: const, freely shared.

#include <Eigen/Geometry>
#include <limits>
#include <vector>

namespace locograph {

class TriangleTree {
 public:
  /// Three corners for each triangle; at least one triangle, all finite.
  explicit TriangleTree(std::vector<Eigen::Vector3d> corners);

  const std::vector<Eigen::Vector3d>& corners() const { return corners_; }  ///< in another order
  const Eigen::AlignedBox3d& bounds() const { return nodes_[0].box; }

  /// To the nearest triangle, or `most` if that is nearer.
  double distance(const Eigen::Vector3d& point,
                  double most = std::numeric_limits<double>::infinity()) const;

  /// Generalised winding number (Jacobson et al., SIGGRAPH 2013, equation 3): how often the
  /// surface goes around the point, between whole numbers where it has holes. Far parts count as
  /// one dipole each (Barill et al., SIGGRAPH 2018, first order), good to some per cent.
  double winding_number(const Eigen::Vector3d& point) const;

  /// Distance to the solid that the triangles enclose: 0 inside, unless the winding number says
  /// they enclose none.
  double distance_outside(const Eigen::Vector3d& point) const;

  /// The least t > 0 at which origin + t * direction meets a triangle, from either side, or `most`
  /// if that is less.
  double first_hit(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                   double most = std::numeric_limits<double>::infinity()) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();    // sum of the normals times the areas
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // of the areas
    double radius = 0.0;                               // around the centre, of all corners
    int begin = 0, end = 0;                            // triangles
    int right = -1;                                    // the left child follows; -1: a leaf
  };
  void build(int begin, int end);

  std::vector<Eigen::Vector3d> corners_;
  std::vector<Node> nodes_;
};

}  // namespace locograph
