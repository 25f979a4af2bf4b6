// Point clouds.

#include <locograph/world/point_cloud.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static locograph::MemoryFile file;
  file.assign(data, size);
  locograph::accept_or_refuse(file.path().string(),
                              [] { locograph::load_point_cloud(file.path()); });
  return 0;
}
