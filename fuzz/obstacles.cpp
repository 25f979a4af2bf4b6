// Obstacle files. What was read has to survive being written.

#include <locograph/world/obstacles.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const locograph::FuzzFolder folder;
  static locograph::MemoryFile file;
  file.assign(data, size);
  std::vector<locograph::Obstacle> obstacles;
  const bool taken = locograph::accept_or_refuse(
      file.path().string(), [&] { obstacles = locograph::load_obstacles(file.path()); });
  if (!taken) return 0;
  const std::filesystem::path written = folder.path() / "written.xml";
  locograph::save_obstacles(obstacles, written);
  if (locograph::load_obstacles(written).size() != obstacles.size()) std::abort();
  return 0;
}
