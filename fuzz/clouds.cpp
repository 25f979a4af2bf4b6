// Lists of clouds, with the image and the cloud that they may name.

#include <locograph/world/perception/clouds_folder.h>
#include <locograph/world/perception/depth_png.h>

#include "fuzz_target.h"

namespace {

struct Folder : locograph::FuzzFolder {
  const locograph::DepthCamera head = locograph::depth_camera("head", 0, 2, 1, 1.0);
  Folder() {
    write("a.pcd",
          "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n0 0 1\nnan "
          "0 1\n");
    locograph::save_depth_png(path() / "b.png", {.width = 2, .height = 1, .depth_mm = {1000, 0}},
                              head);
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const auto list =
      folder.write("clouds.csv", std::string(reinterpret_cast<const char*>(data), size));
  locograph::accept_or_refuse(folder.path().string(), [&] {
    const locograph::CloudsFolder clouds(folder.path(), {folder.head});
    for (int i = 0; i < clouds.size(); ++i) clouds.load(i);
  });
  return 0;
}
