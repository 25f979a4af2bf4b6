// SRDF files, of a robot whose names the seeds know.

#include <locograph/robots/srdf_reader.h>

#include "fuzz_target.h"
#include "plugins/small_robot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const locograph::FuzzFolder folder;
  static const locograph::UrdfModel urdf =
      locograph::read_urdf(folder.write("cart.urdf", locograph::test::kCartUrdf));
  static locograph::MemoryFile file;
  file.assign(data, size);
  for (const bool lenient : {false, true}) {
    locograph::accept_or_refuse(file.path().string(),
                                [&] { locograph::read_srdf(file.path(), urdf, lenient); });
  }
  return 0;
}
