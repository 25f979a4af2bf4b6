#include <locograph/core/fields.h>

#include <charconv>
#include <cmath>

namespace locograph {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

void FieldReader::skip_blanks() {
  while (!text_.empty() && is_blank(text_.front())) text_.remove_prefix(1);
}

std::string_view FieldReader::peek() {
  skip_blanks();
  std::size_t length = 0;
  while (length < text_.size() && !is_blank(text_[length])) ++length;
  return text_.substr(0, length);
}

bool FieldReader::at_end() {
  skip_blanks();
  return text_.empty();
}

void FieldReader::expect_end() {
  if (!at_end()) fail("too many fields, from '" + std::string(peek()) + "' on", "end of line");
}

void FieldReader::fail(const std::string& what, const std::string& expected) const {
  throw Error(where_.file, where_.line, what, expected);
}

double FieldReader::number() {
  std::string_view token = peek();
  if (token.empty()) fail("too few fields", "a number");
  double value = 0.0;
  const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-';
  const char* begin = token.data() + (plus ? 1 : 0);
  const char* end = token.data() + token.size();
  std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::result_out_of_range) {
    // Too small is zero for every purpose, too large is infinite; a wider type tells them apart.
    long double wide = 0.0L;
    result = std::from_chars(begin, end, wide);
    value = static_cast<double>(wide);
  }
  if (result.ec != std::errc() || result.ptr != end) {
    fail("'" + std::string(token) + "' is not a number", "a number");
  }
  if (!std::isfinite(value)) fail("'" + std::string(token) + "' is not finite", "a finite number");
  text_.remove_prefix(token.size());
  return value;
}

int FieldReader::integer() {
  std::string_view token = peek();
  if (token.empty()) fail("too few fields", "an integer");
  int value = 0;
  const char* end = token.data() + token.size();
  const std::from_chars_result result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) {
    fail("'" + std::string(token) + "' is not an integer", "an integer");
  }
  text_.remove_prefix(token.size());
  return value;
}

std::string FieldReader::word() {
  skip_blanks();
  if (text_.empty()) fail("too few fields", "a word");
  if (text_.front() != '"') {
    const std::string_view token = peek();
    text_.remove_prefix(token.size());
    return std::string(token);
  }
  std::string value;
  std::size_t i = 1;
  for (; i < text_.size() && text_[i] != '"'; ++i) {
    if (text_[i] == '\\' && i + 1 < text_.size()) ++i;
    value += text_[i];
  }
  if (i >= text_.size()) fail("quote without end", "a closing \"");
  text_.remove_prefix(i + 1);
  return value;
}

void FieldWriter::number(double value) {
  char buffer[40];
  const std::to_chars_result result =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17);
  text_ += ' ';
  text_.append(buffer, result.ptr);
}

void FieldWriter::integer(long value) {
  text_ += ' ';
  text_ += std::to_string(value);
}

void FieldWriter::word(std::string_view value) {
  if (value.find('\n') != std::string_view::npos) {
    throw Error("'" + std::string(value) + "' cannot be written", "a word on one line");
  }
  text_ += ' ';
  if (!value.empty() && value.find_first_of(" \t\r\"\\#|") == std::string_view::npos) {
    text_ += value;
    return;
  }
  text_ += '"';
  for (const char c : value) {
    if (c == '"' || c == '\\') text_ += '\\';
    text_ += c;
  }
  text_ += '"';
}

}  // namespace locograph
