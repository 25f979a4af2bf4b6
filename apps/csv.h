#pragma once
/// Tables of comma-separated values (RFC 4180): fields in double quotes hold commas and line
/// breaks, and "" for a quote.
///
///     CsvReader reader(text, "runs.csv");
///     while (const std::optional<CsvRow> row = reader.next()) {
///       if (row->fields.size() != 2) reader.fail(row->line, "another table", "seed and time");
///     }
///     std::string line = csv_line({"planned, at last", "2.5"});

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace locograph {

struct CsvRow {
  std::vector<std::string> fields;
  int line = 0;  ///< of its beginning
};

/// Lines end in \n or \r\n; empty ones are left out.
class CsvReader {
 public:
  /// text and file, which is for messages, must outlive the reader.
  CsvReader(const std::string& text, const std::string& file) : text_(text), file_(file) {}

  /// Nothing at the end. Throws Error with file and line for quotes that are not closed.
  std::optional<CsvRow> next();
  [[noreturn]] void fail(int line, const std::string& what, const std::string& expected) const;

 private:
  bool take(std::string_view letters);
  std::string field();
  std::string quoted_field();

  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

/// With its line break.
std::string csv_line(const std::vector<std::string>& fields);

}  // namespace locograph
