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
  return message;
}

}  // namespace

Error::Error(std::string file, int line, const std::string& what, const std::string& expected)
    : std::runtime_error(text(file, line, what, expected)), file_(std::move(file)), line_(line) {}

Error::Error(const std::string& what, const std::string& expected) : Error("", 0, what, expected) {}

}  // namespace locograph
