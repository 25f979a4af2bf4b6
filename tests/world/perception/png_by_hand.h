#pragma once
/// PNG files of any kind, sound or not, without libpng: stored, not compressed.
///
///     folder.write("a.png", png_by_hand({.width = 2, .height = 1}, grey_row({300, 0})));

#include <cstdint>
#include <string>
#include <vector>

namespace locograph::test {

struct PngHeader {
  std::uint32_t width = 1, height = 1;
  int bits = 16, colour = 0, interlaced = 0;
};

inline std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

inline std::uint32_t png_crc(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

inline std::string png_chunk(const std::string& kind, const std::string& data) {
  return big_endian(static_cast<std::uint32_t>(data.size())) + kind + data +
         big_endian(png_crc(kind + data));
}

/// One stored block: up to 65535 bytes.
inline std::string stored(const std::string& data) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : data) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  const auto size = static_cast<std::uint16_t>(data.size());
  const auto little = [](std::uint16_t value) {
    return std::string{static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
  };
  return "\x78\x01\x01" + little(size) + little(static_cast<std::uint16_t>(~size)) + data +
         big_endian(b << 16 | a);
}

/// Of 16-bit grey: the filter's byte and the pixels.
inline std::string grey_row(const std::vector<std::uint16_t>& pixels) {
  std::string row(1, '\0');
  for (const std::uint16_t pixel : pixels) {
    row += static_cast<char>(pixel >> 8);
    row += static_cast<char>(pixel & 0xff);
  }
  return row;
}

inline std::string png_text_chunk(const std::string& key, const std::string& text) {
  return png_chunk("tEXt", key + std::string(1, '\0') + text);
}

/// before: chunks that stand before the pixels.
inline std::string png_by_hand(const PngHeader& header, const std::string& rows,
                               const std::string& before = "") {
  const std::string kinds{static_cast<char>(header.bits), static_cast<char>(header.colour), 0, 0,
                          static_cast<char>(header.interlaced)};
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", big_endian(header.width) + big_endian(header.height) + kinds) + before +
         png_chunk("IDAT", stored(rows)) + png_chunk("IEND", "");
}

}  // namespace locograph::test
