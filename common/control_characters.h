#pragma once
/// Characters that a terminal obeys instead of showing them: text from files may hold them, what is
/// printed must not.
///
///     without_controls("a\x1b[2J", "\\x");   // a\x1b[2J, as letters

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace locograph {

/// How many bytes the control character at this place of a text has: C0 and DEL one, C1 as UTF-8
/// two. 0: there is none.
inline std::size_t control_character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(at) < 0x20 || byte(at) == 0x7f) return 1;
  const bool two = byte(at) == 0xc2 && at + 1 < text.size() && byte(at + 1) >= 0x80;
  return two && byte(at + 1) < 0xa0 ? 2 : 0;
}

inline bool has_control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (control_character(text, i) > 0) return true;
  }
  return false;
}

/// The text with each control character but those to keep as `escape` and two hexadecimal digits.
inline std::string without_controls(std::string_view text, const char* escape,
                                    std::string_view keep = "") {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t bytes = control_character(text, i);
    if (bytes == 0 || keep.find(text[i]) != std::string_view::npos) {
      shown += text[i];
      continue;
    }
    i += bytes - 1;  // the second byte of a C1 character is its number
    char digits[8];
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned>(text[i]) & 0xffu);
    shown += std::string(escape) + digits;
  }
  return shown;
}

}  // namespace locograph
