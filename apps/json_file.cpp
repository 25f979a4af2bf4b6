#include <locograph/apps/json_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>

#include <algorithm>

namespace locograph {
namespace {

int line_of(const std::string& text, std::size_t at) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

/// Behind the value that begins here.
std::size_t behind_value(const std::string& text, std::size_t at) {
  int depth = 0;
  do {
    const char letter = text[at];
    if (letter == '"') {
      for (++at; at < text.size() && text[at] != '"'; ++at) at += text[at] == '\\' ? 1 : 0;
      ++at;
    } else if (letter == '{' || letter == '[') {
      ++depth, ++at;
    } else if (letter == '}' || letter == ']') {
      --depth, ++at;
    } else {
      at = text.find_first_of(",]}\"{[", at + 1);
    }
  } while (depth > 0 && at < text.size());
  return at;
}

/// How deep lists and objects lie in each other where they lie too deep for those who read them: at
/// this place.
constexpr int kDeepestJson = 64;
std::size_t too_deep(const std::string& text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char letter = text[at];
    if (quoted && letter == '\\') ++at;
    if (letter == '"') quoted = !quoted;
    if (quoted) continue;
    if ((letter == '{' || letter == '[') && ++depth > kDeepestJson) return at;
    if (letter == '}' || letter == ']') --depth;
  }
  return std::string::npos;
}

std::size_t next_token(const std::string& text, std::size_t at) {
  return std::min(text.find_first_not_of(" \t\r\n,:", at), text.size());
}

}  // namespace

int json_line(const std::string& text, const std::vector<std::string>& path) {
  std::size_t at = next_token(text, 0);
  for (const std::string& name : path) {
    if (at >= text.size() || (text[at] != '{' && text[at] != '[')) break;
    const bool names = text[at] == '{';
    at = next_token(text, at + 1);
    for (int i = 0; at < text.size() && text[at] != '}' && text[at] != ']'; ++i) {
      std::string here = std::to_string(i);
      if (names) {
        const std::size_t end = behind_value(text, at);
        here = text.substr(at + 1, end - at - 2);
        at = next_token(text, end);
      }
      if (here == name) break;
      at = next_token(text, behind_value(text, at));
    }
  }
  return line_of(text, at);
}

std::vector<int> json_lines(const std::string& text, const std::string& list) {
  std::vector<int> lines;
  std::size_t at = next_token(text, 0);
  if (at >= text.size() || text[at] != '{') return lines;
  at = next_token(text, at + 1);
  while (at < text.size() && text[at] == '"') {
    const std::size_t end = behind_value(text, at);
    const bool here = text.compare(at + 1, end - at - 2, list) == 0;
    at = next_token(text, end);
    if (here) break;
    at = next_token(text, behind_value(text, at));
  }
  if (at >= text.size() || text[at] != '[') return lines;
  int line = line_of(text, at);
  std::size_t counted = at;
  at = next_token(text, at + 1);
  while (at < text.size() && text[at] != ']') {
    const auto begin = text.begin() + static_cast<std::ptrdiff_t>(counted);
    line +=
        static_cast<int>(std::count(begin, text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    counted = at;
    lines.push_back(line);
    at = next_token(text, behind_value(text, at));
  }
  return lines;
}

Json read_json(const std::filesystem::path& file, const std::string& expected) {
  const std::string text = file == "-" ? read_input(file, kMostInputBytes, expected)
                                       : read_file(file, kMostInputBytes, expected);
  return parse_json(text, file.string(), expected);
}

Json parse_json(const std::string& text, const std::string& file, const std::string& expected) {
  if (const std::size_t at = too_deep(text); at != std::string::npos) {
    throw Error(file, line_of(text, at), "lists and objects lie too deep in each other",
                "up to " + std::to_string(kDeepestJson));
  }
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& failure) {
    const std::size_t at = failure.byte > 0 ? failure.byte - 1 : 0;
    throw Error(file, line_of(text, at), "is not JSON", expected);
  } catch (const Json::out_of_range& failure) {
    // "number overflow parsing '1e400'", without a place.
    const std::string message = failure.what();
    const std::size_t begin = message.find('\'') + 1, end = message.rfind('\'');
    const std::string number = begin < end ? message.substr(begin, end - begin) : "a number";
    throw Error(file, line_of(text, text.find(number)), "'" + number + "' is not finite",
                "finite numbers");
  }
}

}  // namespace locograph
