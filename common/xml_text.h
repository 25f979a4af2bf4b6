#pragma once
/// Looks at the text of an XML file before it is parsed: TinyXML-2 compares each attribute of an
/// element with all before it, so that a hundred thousand of them take minutes.
///
///     if (const int line = crowded_tag(text)) throw Error(file, line, "…", "fewer attributes");

#include <string_view>

namespace locograph {

/// More than any element of our formats has, and than those of robot descriptions have.
inline constexpr int kMostAttributes = 100;

/// The line of the first tag with more than kMostAttributes attributes, 0 if there is none.
inline int crowded_tag(std::string_view text) {
  int line = 1, line_of_tag = 0, attributes = 0;
  char quote = 0;
  bool inside = false;
  std::string_view skipped_until;  // the end of a comment or of character data
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (!skipped_until.empty()) {
      if (text.substr(i, skipped_until.size()) == skipped_until) skipped_until = {};
    } else if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (!inside) {
      if (c != '<') continue;
      if (text.substr(i, 4) == "<!--") {
        skipped_until = "-->";
      } else if (text.substr(i, 9) == "<![CDATA[") {
        skipped_until = "]]>";
      } else {
        inside = true;
        attributes = 0;
        line_of_tag = line;
      }
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      inside = false;
    } else if (c == '=' && ++attributes > kMostAttributes) {
      return line_of_tag;
    }
  }
  return 0;
}

}  // namespace locograph
