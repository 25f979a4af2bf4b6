#pragma once
/// A folder of clouds and depth images that cameras took, listed with their stamps in its
/// `clouds.csv`.
///
///     const CloudsFolder clouds("run_7", cameras_of(robot));
///     for (int i = 0; i < clouds.size(); ++i) {
///       const DepthImage image = clouds.load(i);   // at clouds.stamp_s(i), of clouds.camera(i)
///     }
///
///   time_s,camera,file
///   0.000,D435i_camera,pelvis_0000.pcd
///   0.011,D435_head_camera,head_0000.png
///
/// The first line may be left out. Each of the others is one image: its time, the camera's name,
/// and a file in the folder, PCD (`.pcd`, points in the camera's optical frame) or PNG (`.png`,
/// depth_png.h). Times ascend; two cameras may have the same one. The images are read when they are
/// asked for.

#include <locograph/world/perception/depth_image.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace locograph {

class CloudsFolder {
 public:
  /// Throws Error with file and line for lines that are not as above: unreadable times and times
  /// above 1e6 s, times out of order, a camera that is not one of these, a file that is missing or
  /// not in the folder. Throws Error without cameras, and if there is no line.
  CloudsFolder(const std::filesystem::path& folder, std::vector<DepthCamera> cameras);

  int size() const { return static_cast<int>(clouds_.size()); }
  double stamp_s(int i) const { return clouds_[static_cast<std::size_t>(i)].stamp_s; }
  /// Index into cameras().
  int camera(int i) const { return clouds_[static_cast<std::size_t>(i)].camera; }
  const std::vector<DepthCamera>& cameras() const { return cameras_; }
  /// The list and all that it names.
  std::vector<std::filesystem::path> files() const;

  /// Of its camera's size, stamped, without depths nearer than the camera's range. An image without
  /// any return is one that sees nothing: it is no mistake, and pixels_seen() tells it. Throws
  /// Error with the file's name for one that cannot be read or has a viewpoint of its own
  /// (depth_image.h), and for a PNG that is not of the camera's size or says of itself that it has
  /// another stamp (by 1 ms) or is of another camera (by name, or by 0.01 pixels in its lens).
  DepthImage load(int i) const;

 private:
  struct Cloud {
    double stamp_s = 0.0;
    int camera = 0;
    std::filesystem::path file;
  };

  void add_line(const std::string& csv, int line, std::string_view text);

  std::filesystem::path folder_;
  std::vector<DepthCamera> cameras_;
  std::vector<Cloud> clouds_;
};

}  // namespace locograph
