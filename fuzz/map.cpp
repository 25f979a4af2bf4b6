// OctoMap files, and what every command asks of a map.

#include <locograph/world/octree.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static locograph::MemoryFile file;
  file.assign(data, size);
  locograph::accept_or_refuse(file.path().string(),
                              [] { locograph::octree_info(*locograph::load_octree(file.path())); });
  return 0;
}
