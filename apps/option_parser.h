#pragma once
/// The options and subcommands of a program: as much of CLI11 as we use. Reading that library takes
/// a compiler some six seconds, so option_parser.cpp alone does.
///
///     std::string file;
///     int threads = 1;
///     OptionParser parser("Count what is in a file", "count");
///     parser.add_option("FILE", file, "What to read").required();
///     parser.add_option("--threads", threads, "Threads to use").positive().show_default();
///     if (parser.parse(argc, argv)) count(file, threads);
///
/// A copy speaks of the same parser. Variables must outlive the parsing.

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace locograph {

/// The command line is no good: one line that says why, and where to find help.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What else there is to say about one option of a parser, which must live.
class ParserOption {
 public:
  explicit ParserOption(CLI::Option& option) : option_(&option) {}

  ParserOption& required();
  ParserOption& positive();
  ParserOption& not_negative();
  /// Any number but those that are infinite or none.
  ParserOption& finite();
  ParserOption& between(int least, int most);
  ParserOption& between(double least, double most);
  ParserOption& one_of(const std::vector<std::string>& values);
  /// Help tells the value that the variable has now.
  ParserOption& show_default();
  /// Of a list: one value at a time, the option may be given many times.
  ParserOption& one_at_a_time();
  /// Of a list: values may be separated by this.
  ParserOption& separated_by(char delimiter);
  /// What help calls the value.
  ParserOption& value_name(const std::string& name);

 private:
  CLI::Option* option_;
};

class OptionParser {
 public:
  OptionParser(const std::string& description, const std::string& name);

  /// names: "NAME" for a positional argument, "-o,--output" for an option. Value: bool, a signed or
  /// unsigned integer, double, std::string, std::filesystem::path, or a list of int, std::string or
  /// std::filesystem::path. Names are not empty, integers those that the variable holds.
  template <class Value>
  ParserOption add_option(const std::string& names, Value& value, const std::string& help = "");
  ParserOption add_flag(const std::string& names, bool& value, const std::string& help);
  /// `--version`: prints the text.
  void add_version(const std::string& text);
  /// From the first one on, exactly one subcommand is required.
  OptionParser add_subcommand(const std::string& name, const std::string& description);

  /// Whether to go on: false when help or the version was asked for, which is then printed.
  /// Throws UsageError; of a name that does not exist it says which one may be meant.
  bool parse(int argc, const char* const* argv);
  /// Whether this is the subcommand that was named.
  bool chosen() const;
  /// Whether it has this option, e.g. "--lenient".
  bool has_option(const std::string& name) const;
  /// After parse(): whether the command line gave this option, which there must be.
  bool given(const std::string& name) const;
  std::string name() const;

 private:
  explicit OptionParser(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}

  std::shared_ptr<CLI::App> app_;
};

}  // namespace locograph
