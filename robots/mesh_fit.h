#pragma once
/// Spheres or capsules that cover a triangle mesh.
///
///     const TriangleTree mesh(stl_triangles("thigh.stl"));
///     std::vector<Capsule> capsules = fit_capsules(mesh, {.max_overshoot_m = 0.01});
///
/// Every triangle lies inside the union (each in pieces, each piece in one convex capsule), and so
/// does the inside of a closed mesh, that up to the spacing of some thousand points. The piece that
/// sticks out furthest is cut in two by the plane that helps most, along the piece's principal axes
/// or those of the mesh, until none sticks out of the mesh by more than max_overshoot_m or there
/// are max_shapes; what is returned is the best on the way. How far a capsule sticks out is found
/// at some hundred points of its surface: see approximation.h for what it came to.
///
/// Capsules are the local minima of that overshoot over their two end points, the radius reaching
/// to the piece's farthest point. Deterministic. Meshes with holes, triangles without area or flat
/// meshes are covered like others; where the triangles enclose nothing, everything off the surface
/// counts as sticking out.
///
/// A fit takes a tenth of a second or two: the newest ones of the process are remembered, and all
/// are kept for later runs (fit_cache.h). Thread-safe.

#include <locograph/robots/capsule.h>
#include <locograph/robots/triangle_tree.h>

#include <vector>

namespace locograph {

struct MeshFitOptions {
  double max_overshoot_m = 0.01;
  int max_shapes = 12;
  bool spheres = false;  ///< spheres only: from = to

  bool operator==(const MeshFitOptions&) const = default;
};

std::vector<Capsule> fit_capsules(const TriangleTree& mesh, const MeshFitOptions& options = {});

}  // namespace locograph
