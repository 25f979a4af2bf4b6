// Libraries that are no good plug-ins, written without our headers as an old or foreign one is.

#include <cstdint>

#ifdef WITH_ENTRY_POINT
namespace {

struct Record {
  char magic[8];
  std::uint32_t abi_version;
  std::uint32_t field_count;
  const void* fields;
  void (*register_types)();
};
const Record record = {MAGIC, ABI_VERSION, 0, nullptr, nullptr};

}  // namespace

extern "C" __attribute__((visibility("default"))) const Record* locograph_plugin() {
  return &record;
}
#else
extern "C" int some_other_function() { return 1; }
#endif
