#include <locograph/common/error.h>

#include <utility>

namespace locograph {

namespace {

std::string text(const std::string& file, int line, const std::string& what,
                 const std::string& expected) {
  std::string message = file;
  if (line > 0) message += (message.empty() ? "line " : ":") + std::to_string(line);
  if (!message.empty()) message += ": ";
  message += what;
  if (!expected.empty()) message += ", expected " + expected;
  // what() would end at one.
  for (std::size_t at = 0; (at = message.find('\0', at)) != std::string::npos;) {
    message.replace(at, 1, "\\x00");
  }
  return message;
}

}  // namespace

Error::Error(std::string file, int line, const std::string& what, const std::string& expected)
    : std::runtime_error(text(file, line, what, expected)), file_(std::move(file)), line_(line) {}

Error::Error(const std::string& what, const std::string& expected) : Error("", 0, what, expected) {}

}  // namespace locograph
