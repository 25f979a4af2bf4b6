#pragma once
/// Reads and writes the fields of one line of a graph file.
///
///     const FileLine where{"plan.g2o", 12, "/home/me"};
///     FieldReader in("0 1 0.5 \"my map.bt\"", where);
///     int a = in.integer(), b = in.integer();
///     double range = in.number();
///     std::string map = in.word();
///     in.expect_end();
///
/// Numbers are written with 17 significant digits, so reading them back gives the same bits. Words
/// that are empty or hold blanks are quoted. Every mistake is an Error with file and line.

#include <locograph/common/error.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <tuple>

namespace locograph {

class Parameters;

/// Where a line came from: for messages, and to resolve paths relative to the file.
struct FileLine {
  std::string file;
  int line = 0;
  std::filesystem::path folder;
};

class FieldReader {
 public:
  /// Keeps references to both.
  FieldReader(std::string_view text, const FileLine& where) : text_(text), where_(where) {}
  FieldReader(std::string_view, FileLine&&) = delete;

  double number();          ///< a finite number
  int integer();            ///< a decimal integer
  std::string word();       ///< a word, or a "quoted string"
  std::string_view peek();  ///< the next token as it stands, empty at the end of the line
  bool at_end();
  std::size_t characters_left() const { return text_.size(); }
  void expect_end();  ///< throws if fields are left

  const FileLine& where() const { return where_; }
  /// Shared parameters of the graph being read; null where there is no graph.
  const Parameters* parameters() const { return parameters_; }
  void set_parameters(const Parameters* parameters) { parameters_ = parameters; }
  [[noreturn]] void fail(const std::string& what, const std::string& expected) const;

 private:
  void skip_blanks();

  std::string_view text_;
  const FileLine& where_;
  const Parameters* parameters_ = nullptr;
};

class FieldWriter {
 public:
  /// folder: of the file being written; paths are written relative to it, absolute if it is empty.
  explicit FieldWriter(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  void tag(std::string_view tag) { text_ += tag; }
  void number(double value);
  void integer(long value);
  void word(std::string_view value);
  void end_line() { text_ += '\n'; }

  const std::filesystem::path& folder() const { return folder_; }
  const std::string& text() const { return text_; }

 private:
  std::filesystem::path folder_;
  std::string text_;
};

/// How one member of a vertex, edge or parameter is read and written. Types with their own
/// read(FieldReader&) and write(FieldWriter&) const take part without further ado.
inline void read_field(FieldReader& in, double& value) { value = in.number(); }
inline void read_field(FieldReader& in, int& value) { value = in.integer(); }
inline void read_field(FieldReader& in, std::string& value) { value = in.word(); }
template <int Rows, int Columns>
void read_field(FieldReader& in, Eigen::Matrix<double, Rows, Columns>& value) {
  for (Eigen::Index i = 0; i < value.size(); ++i) value(i) = in.number();
}
template <class T>
requires requires(T& value, FieldReader& in) { value.read(in); }
void read_field(FieldReader& in, T& value) { value.read(in); }

inline void write_field(FieldWriter& out, double value) { out.number(value); }
inline void write_field(FieldWriter& out, int value) { out.integer(value); }
inline void write_field(FieldWriter& out, const std::string& value) { out.word(value); }
template <int Rows, int Columns>
void write_field(FieldWriter& out, const Eigen::Matrix<double, Rows, Columns>& value) {
  for (Eigen::Index i = 0; i < value.size(); ++i) out.number(value(i));
}
template <class T>
requires requires(const T& value, FieldWriter& out) { value.write(out); }
void write_field(FieldWriter& out, const T& value) { value.write(out); }

/// Reads or writes all members named by a class's fields(), in order.
template <class... Members>
void read_fields(FieldReader& in, std::tuple<Members&...> members) {
  std::apply([&in](Members&... member) { (read_field(in, member), ...); }, members);
}
template <class... Members>
void write_fields(FieldWriter& out, std::tuple<Members&...> members) {
  std::apply([&out](Members&... member) { (write_field(out, member), ...); }, members);
}

}  // namespace locograph
