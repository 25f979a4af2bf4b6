#pragma once
/// A depth image: for each pixel how far in front of the camera that is which it shows.
///
///     DepthImage image = depth_image_of(read_point_cloud("scan.pcd"), camera);
///     image.stamp_s = 0.1;
///     if (pixels_seen(image) == 0) report("the camera is covered");
///
/// Depths are whole millimetres along the optical z (not along the ray), up to 65.535 m; 0 says
/// nothing: no return, neither free nor occupied. A depth beyond the camera's range says that
/// everything within the range is free there, as far as the sensor may be believed.

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/point_cloud.h>

#include <cstdint>
#include <vector>

namespace locograph {

struct DepthImage {
  double stamp_s = 0.0;
  int camera = 0;  ///< index into the list of cameras
  int width = 0, height = 0;
  std::vector<std::uint16_t> depth_mm = {};  ///< row by row from the top, each from the left
};

/// The pixels that show something.
int pixels_seen(const DepthImage& image);

/// Depths nearer than the camera can see become 0: such returns are noise.
void remove_nearer_than_range(const DepthCamera& camera, DepthImage& image);

/// The cloud's points, given in the camera's optical frame, as an image of the camera's size with
/// stamp 0 and camera 0. An organised cloud of this size all of whose points lie within one pixel
/// of their own goes pixel by pixel; of any other each point goes to the pixel that sees it, and
/// the nearest of a pixel stays. Points that are not finite, not in front of the camera, outside of
/// the image or farther than 65.535 m are left out: without any other the image sees nothing.
///
/// Throws Error for a cloud whose viewpoint is another than the origin, looking along z (the
/// identity): whether its points are in the sensor's frame and have yet to be moved there, or have
/// been moved already, no PCD file tells.
DepthImage depth_image_of(const PointCloud& cloud, const DepthCamera& camera);

}  // namespace locograph
