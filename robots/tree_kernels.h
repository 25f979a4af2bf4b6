#pragma once
/// The kinematics of several configurations of one robot, side by side in vector registers;
/// compiled once for each level of vector instructions (common/simd_level.h). Internal:
/// states_together.h calls them.
///
/// What a configuration gets does not depend on what stands beside it, to the bit.

#include <locograph/common/level_table.h>

#include <string>

namespace locograph {

/// An axis and the body that it moves: KinematicTree::Body, without Eigen.
struct TreeAxis {
  double a[12], b[12], c[12];  ///< the upper three rows of A, B, C, by column
  double axis[3];
  double moment[3], mass, subtree_mass;
  double multiplier, offset;  ///< of its active joint's position
  int active;
  int parent_body;        ///< a body, body 0 the root
  int parent_link, link;  ///< whose frames are those of the bodies
  bool revolute;
};
/// A link whose frame is not that of a body.
struct TreeLink {
  int link, body_link;
  double pose[12];  ///< in the body
};
/// A point fixed to a link, in the frame of the link.
struct LinkPoint {
  int link;
  double at[3];
};

struct TreeView {
  const TreeAxis* axes;
  int axis_count;
  const TreeLink* rigid_links;
  int rigid_link_count;
  int link_count;
  double moment[3], mass, subtree_mass;  ///< of the root
  bool floating_base;
};
struct PointsView {
  const LinkPoint* points;
  int count;
};

/// Where a configuration is, and where its kinematics go: those of robot_state.h, and points in
/// the world by row, all x first.
struct TreeState {
  const double* q;
  double* world_from_link;  ///< 4 x 4 for each link
  double* joint_axis;       ///< 3 for each axis
  double* joint_origin;
  double* subtree_moment;  ///< 4 for each body
  double* points[2];
};

struct TreeKernels {
  /// Doubles that update() asks of `work`.
  long (*work)(const TreeView& tree, const PointsView points[2]);
  void (*update)(const TreeView& tree, const PointsView points[2], int count,
                 const TreeState* states, double* work);
};

LOCOGRAPH_DECLARE_LEVELS(TreeKernels, tree_kernels);

/// Those of this process. Throws Error like simd_level().
const TreeKernels& tree_kernels();
/// Those of one of simd_levels(). Throws Error like require_simd_level().
const TreeKernels& tree_kernels_at(const std::string& level);

}  // namespace locograph
