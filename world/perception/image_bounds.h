#pragma once
/// The pixels in which a shape may show, and in which depths.
///
///     const ImageBounds bounds = image_bounds(camera, {{0, 0, 1}, {0, 0.5, 1}, 0.1});
///     for (int v = bounds.v_begin; v < bounds.v_end; ++v) look(v, bounds.u_begin, bounds.u_end);
///
/// Shapes are given in the optical frame, metres. Never too small: for all that shows, not for what
/// is outside of the image. Close to the optical centre they are the whole image.

#include <locograph/robots/capsule.h>
#include <locograph/world/perception/depth_camera.h>

#include <Eigen/Geometry>

namespace locograph {

struct ImageBounds {
  int u_begin = 0, u_end = 0, v_begin = 0, v_end = 0;  ///< columns and rows, without the ends
  double near_m = 0.0, far_m = 0.0;                    ///< along the optical z

  bool empty() const { return u_begin >= u_end || v_begin >= v_end; }
};

ImageBounds image_bounds(const DepthCamera& camera, const Capsule& capsule);

/// Of a box about the origin of its own frame.
ImageBounds image_bounds(const DepthCamera& camera, const Eigen::Isometry3d& optical_from_box,
                         const Eigen::Vector3d& half_extents);

}  // namespace locograph
