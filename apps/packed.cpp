#include <locograph/apps/packed.h>

#include <bit>

namespace locograph {
namespace {

static_assert(std::endian::native == std::endian::little, "packed arrays are little-endian");

constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// RFC 4648, section 4.
std::string base64(const unsigned char* bytes, std::size_t size) {
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t left = size - i;
    const unsigned group =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += kDigits[group >> 18];
    text += kDigits[group >> 12 & 63];
    text += left > 1 ? kDigits[group >> 6 & 63] : '=';
    text += left > 2 ? kDigits[group & 63] : '=';
  }
  return text;
}

template <class T>
std::string packed(const std::vector<T>& values) {
  return base64(reinterpret_cast<const unsigned char*>(values.data()), sizeof(T) * values.size());
}

}  // namespace

std::string packed_floats(const std::vector<float>& values) { return packed(values); }
std::string packed_ints(const std::vector<std::int32_t>& values) { return packed(values); }
std::string packed_shorts(const std::vector<std::int16_t>& values) { return packed(values); }
std::string packed_bytes(const std::vector<std::uint8_t>& values) { return packed(values); }

}  // namespace locograph
