#include <locograph/apps/csv.h>
#include <locograph/common/error.h>

#include <algorithm>

namespace locograph {
namespace {

std::string quoted(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string text = "\"";
  for (const char letter : field) {
    if (letter == '"') text.push_back('"');
    text.push_back(letter);
  }
  text.push_back('"');
  return text;
}

}  // namespace

std::optional<CsvRow> CsvReader::next() {
  while (at_ < text_.size()) {
    CsvRow row{{}, line_};
    do row.fields.push_back(field());
    while (take(","));
    if (!take("\r\n") && !take("\n") && at_ < text_.size()) {
      fail(line_, "'" + text_.substr(at_, 1) + "' behind a closing quote", "a comma");
    }
    ++line_;
    if (row.fields.size() > 1 || !row.fields.front().empty()) return row;
  }
  return std::nullopt;
}

void CsvReader::fail(int line, const std::string& what, const std::string& expected) const {
  throw Error(file_, line, what, expected);
}

bool CsvReader::take(std::string_view letters) {
  if (text_.compare(at_, letters.size(), letters) != 0) return false;
  at_ += letters.size();
  return true;
}

std::string CsvReader::field() {
  if (take("\"")) return quoted_field();
  std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
  if (end < text_.size() && text_[end] == '\n' && end > at_ && text_[end - 1] == '\r') --end;
  std::string value = text_.substr(at_, end - at_);
  at_ = end;
  return value;
}

std::string CsvReader::quoted_field() {
  const int begin = line_;
  std::string value;
  while (at_ < text_.size()) {
    if (take("\"\"")) {
      value += '"';
    } else if (take("\"")) {
      return value;
    } else {
      line_ += text_[at_] == '\n' ? 1 : 0;
      value += text_[at_++];
    }
  }
  fail(begin, "a field whose quote is not closed", "a closing \"");
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (&field != &fields.front()) line.push_back(',');
    line += quoted(field);
  }
  line.push_back('\n');
  return line;
}

}  // namespace locograph
