#pragma once
/// Depth images as PNG files: 16-bit grey, a millimetre a step, 0 for nothing seen.
///
///     save_depth_png("0001.png", image, camera);
///     const DepthPng file = load_depth_png("0001.png");
///     if (file.camera && file.camera->fx != camera.fx) report("another lens");
///
/// Beside the pixels a file may have these tEXt chunks, which files from elsewhere may lack:
///
///   stamp_s                                       of the image
///   camera                                        the camera's name, and with it all of
///   fx fy cx cy range_min_m range_max_m           as in DepthCamera
///
/// Numbers have 17 digits. Text with other keys is left alone.

#include <locograph/world/perception/depth_image.h>

#include <filesystem>
#include <optional>

namespace locograph {

struct DepthPng {
  DepthImage image;  ///< camera 0; its stamp is 0 where the file has none
  bool stamped = false;
  /// As the file tells it: on link 0, at its origin.
  std::optional<DepthCamera> camera;
};

/// Throws Error with the file's name for one that cannot be read, is no PNG, is damaged anywhere or
/// ends early, is of another kind (8 bits, colour, palette, interlaced), has more than
/// DepthCamera::kMostPixels along a side, or has chunks of ours with other than one number, twice,
/// or a part of them. Pixels take memory as they are read, not as the header promises them.
DepthPng load_depth_png(const std::filesystem::path& path);

/// Throws Error for an image that is not of the camera's size or has no finite stamp, for a camera
/// that is not valid, and when the file cannot be written, which is written whole or not at all.
void save_depth_png(const std::filesystem::path& path, const DepthImage& image,
                    const DepthCamera& camera);

}  // namespace locograph
