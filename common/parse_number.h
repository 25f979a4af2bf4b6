#pragma once
/// A number that is all of a word.
///
///     double x = 0.0;
///     if (!parse_number("+1.5e-3", x)) throw Error("unreadable number", "one like 1.5e-3");
///     std::size_t count = 0;
///     const bool whole = parse_number("3.5", count);  // false

#include <charconv>
#include <string_view>

namespace locograph {

/// False, and the number as it was, for what is no number, has something after it or does not fit.
/// `nan` and `inf` are numbers.
template <typename Number>
bool parse_number(std::string_view word, Number& number) {
  if (!word.empty() && word.front() == '+') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size();
}

}  // namespace locograph
