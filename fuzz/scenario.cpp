// Scenario files; the files that they name are not opened.

#include <locograph/planners/scenario/scenario.h>

#include "fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static locograph::MemoryFile file;
  file.assign(data, size);
  locograph::accept_or_refuse(file.path().string(), [] {
    locograph::load_scenario(file.path().string(), LOCOGRAPH_SOURCE_DIR);
  });
  return 0;
}
