#pragma once
/// The one family of exceptions for bad input: what is wrong, what was expected, and where.
///
///     throw locograph::Error("graph.g2o", 12, "unknown vertex 7", "an id declared by a VERTEX
///     line");
///     // what(): graph.g2o:12: unknown vertex 7, expected an id declared by a VERTEX line
///
/// Numerical outcomes (not converged, singular, infeasible) are results, never exceptions.

#include <stdexcept>
#include <string>
#include <utility>

namespace locograph {

class Error : public std::runtime_error {
 public:
  /// file: path or "" when there is none; line: 1-based, 0 when unknown.
  Error(std::string file, int line, const std::string& what, const std::string& expected)
      : std::runtime_error(text(file, line, what, expected)), file_(std::move(file)), line_(line) {}

  /// For a mistake in a call rather than in a file.
  explicit Error(const std::string& what, const std::string& expected = "")
      : Error("", 0, what, expected) {}

  const std::string& file() const { return file_; }
  int line() const { return line_; }

 private:
  static std::string text(const std::string& file, int line, const std::string& what,
                          const std::string& expected) {
    std::string message = file;
    if (line > 0) message += (message.empty() ? "line " : ":") + std::to_string(line);
    if (!message.empty()) message += ": ";
    message += what;
    if (!expected.empty()) message += ", expected " + expected;
    return message;
  }

  std::string file_;
  int line_;
};

}  // namespace locograph
