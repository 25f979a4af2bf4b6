// Point clouds, and what a camera sees of them.

#include <locograph/world/perception/depth_image.h>
#include <locograph/world/point_cloud.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static locograph::MemoryFile file;
  static const locograph::DepthCamera camera = locograph::depth_camera("c", 0, 2, 2, 1.0);
  file.assign(data, size);
  const std::string name = file.path().string();
  locograph::accept_or_refuse(name, [] { locograph::load_point_cloud(file.path()); });
  locograph::accept_or_refuse(name, [] {
    locograph::PointCloud cloud = locograph::read_point_cloud(file.path());
    cloud.viewpoint.setIdentity();  // others are refused without the name of a file
    locograph::depth_image_of(cloud, camera);
  });
  return 0;
}
