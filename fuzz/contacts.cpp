// Contacts files, for a robot whose links the seeds name.

#include <locograph/planners/scenario/contacts_file.h>

#include "fuzz_target.h"
#include "plugins/small_robot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const locograph::FuzzFolder folder;
  static const locograph::Robot robot =
      locograph::Robot::load(folder.write("cart.urdf", locograph::test::kCartUrdf));
  static locograph::MemoryFile file;
  file.assign(data, size);
  locograph::accept_or_refuse(file.path().string(),
                              [] { locograph::load_contacts(file.path(), robot); });
  return 0;
}
