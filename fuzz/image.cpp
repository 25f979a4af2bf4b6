// Depth images: PNG files, as they are and with the checksums of their chunks made right, which
// no input would have otherwise.

#include <locograph/world/perception/depth_png.h>
#include <world/perception/png_by_hand.h>

#include "fuzz_target.h"

namespace {

std::string with_checksums(std::string png) {
  constexpr std::size_t kSignature = 8, kFrame = 12;  // of a chunk: size, kind, checksum
  for (std::size_t at = kSignature; at + kFrame <= png.size();) {
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(png[at + i]);
    if (size > png.size() - at - kFrame) break;
    const std::uint32_t checksum = locograph::test::png_crc(png.substr(at + 4, size + 4));
    png.replace(at + 8 + size, 4, locograph::test::big_endian(checksum));
    at += kFrame + size;
  }
  return png;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static locograph::MemoryFile file;
  const auto load = [] {
    locograph::accept_or_refuse(file.path().string(),
                                [] { locograph::load_depth_png(file.path()); });
  };
  file.assign(data, size);
  load();
  const std::string right = with_checksums({reinterpret_cast<const char*>(data), size});
  file.assign(reinterpret_cast<const std::uint8_t*>(right.data()), right.size());
  load();
  return 0;
}
