#pragma once
/// The one family of exceptions for bad input: what is wrong, what was expected, and where.
///
///     throw locograph::Error("graph.g2o", 12, "unknown vertex 7", "the id of a VERTEX line");
///     // what(): graph.g2o:12: unknown vertex 7, expected the id of a VERTEX line
///
/// Numerical outcomes (not converged, singular, infeasible) are results, never exceptions.

#include <stdexcept>
#include <string>

namespace locograph {

class Error : public std::runtime_error {
 public:
  /// file: path or "" when there is none; line: 1-based, 0 when unknown.
  Error(std::string file, int line, const std::string& what, const std::string& expected);

  /// For a mistake in a call rather than in a file.
  explicit Error(const std::string& what, const std::string& expected = "");

  const std::string& file() const { return file_; }
  int line() const { return line_; }

 private:
  std::string file_;
  int line_;
};

}  // namespace locograph
