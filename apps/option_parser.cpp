#include <locograph/apps/option_parser.h>
#include <locograph/common/suggestion.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <sstream>
#include <type_traits>

namespace locograph {
namespace {

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands({}))
    names.push_back(subcommand->get_name());
  return names;
}

/// What is wrong with the first word that an app did not understand; "" if it understood all.
std::string not_understood(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  if (words.empty()) return "";
  std::string word = words.front();
  if (word.starts_with('-')) {
    word = word.substr(0, word.find('='));
    return "unknown option '" + word + "'" + did_you_mean(word, option_names(app));
  }
  const std::vector<std::string> commands = subcommand_names(app);
  if (commands.empty() || !app.get_subcommands().empty()) return "unexpected '" + word + "'";
  return "unknown command '" + word + "', expected one of " + joined_names(commands) +
         did_you_mean(word, commands);
}

/// Finite numbers only. CLI11's own accept NaN and print their bounds in 300 digits.
CLI::Validator finite_numbers(const std::string& help, const std::string& expected,
                              const std::function<bool(double)>& accepted) {
  const auto wrong = [expected, accepted](std::string& text) -> std::string {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_number = !text.empty() && *end == '\0' && std::isfinite(value);
    return is_number && accepted(value) ? "" : "'" + text + "', expected " + expected;
  };
  return CLI::Validator(wrong, help);
}

template <class Number>
CLI::Validator finite_numbers_between(Number least, Number most) {
  std::ostringstream range;
  range << least << " to " << most;
  return finite_numbers('[' + range.str() + ']', "a number from " + range.str(), [=](double value) {
    return value >= static_cast<double>(least) && value <= static_cast<double>(most);
  });
}

/// CLI11's own answer to what is no number of the type is that it could not convert it.
template <class Whole>
CLI::Validator whole_numbers() {
  const auto wrong = [](std::string& text) -> std::string {
    const char* end = text.data() + text.size();
    Whole value = 0;
    const std::from_chars_result parsed = std::from_chars(text.data(), end, value);
    if (parsed.ec == std::errc() && parsed.ptr == end) return "";
    const bool digits =
        text.find_first_not_of("0123456789", text.starts_with('-') ? 1 : 0) == std::string::npos;
    const std::string range = " from " + std::to_string(std::numeric_limits<Whole>::min()) +
                              " to " + std::to_string(std::numeric_limits<Whole>::max());
    const bool beyond = digits && text.size() > (text.starts_with('-') ? 1 : 0);
    return "'" + text + "', expected a whole number" + (beyond ? range : "");
  };
  return CLI::Validator(wrong, "");
}

CLI::Validator some_text() {
  return CLI::Validator([](std::string& text) { return text.empty() ? "'', expected a name" : ""; },
                        "");
}

}  // namespace

ParserOption& ParserOption::required() { return option_->required(), *this; }
ParserOption& ParserOption::show_default() { return option_->capture_default_str(), *this; }
ParserOption& ParserOption::one_at_a_time() { return option_->allow_extra_args(false), *this; }

ParserOption& ParserOption::positive() {
  const auto accepted = [](double value) { return value > 0.0; };
  return option_->check(finite_numbers("POSITIVE", "a number > 0", accepted)), *this;
}

ParserOption& ParserOption::not_negative() {
  const auto accepted = [](double value) { return value >= 0.0; };
  return option_->check(finite_numbers("NONNEGATIVE", "a number >= 0", accepted)), *this;
}

ParserOption& ParserOption::finite() {
  const auto accepted = [](double) { return true; };
  return option_->check(finite_numbers("", "a number", accepted)), *this;
}

ParserOption& ParserOption::between(int least, int most) {
  return option_->check(finite_numbers_between(least, most)), *this;
}

ParserOption& ParserOption::between(double least, double most) {
  return option_->check(finite_numbers_between(least, most)), *this;
}

ParserOption& ParserOption::one_of(const std::vector<std::string>& values) {
  const std::string all = '{' + CLI::detail::join(values, ",") + '}';
  const auto wrong = [values, all](std::string& value) -> std::string {
    if (std::find(values.begin(), values.end(), value) != values.end()) return "";
    return '\'' + value + "' is not in " + all + did_you_mean(value, values);
  };
  return option_->check(CLI::Validator(wrong, all)), *this;
}

ParserOption& ParserOption::separated_by(char delimiter) {
  return option_->delimiter(delimiter), *this;
}

ParserOption& ParserOption::value_name(const std::string& name) {
  return option_->type_name(name), *this;
}

OptionParser::OptionParser(const std::string& description, const std::string& name)
    : app_(std::make_shared<CLI::App>(description, name)) {}

template <class Value>
ParserOption OptionParser::add_option(const std::string& names, Value& value,
                                      const std::string& help) {
  CLI::Option* option = app_->add_option(names, value, help);
  if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    option->check(whole_numbers<Value>());
  } else if constexpr (std::is_convertible_v<Value, std::filesystem::path>) {
    option->check(some_text());
  }
  return ParserOption(*option);
}

#define LOCOGRAPH_OPTION(VALUE) \
  template ParserOption OptionParser::add_option(const std::string&, VALUE&, const std::string&);
LOCOGRAPH_OPTION(bool)
LOCOGRAPH_OPTION(int)
LOCOGRAPH_OPTION(long)
LOCOGRAPH_OPTION(unsigned)
LOCOGRAPH_OPTION(unsigned long)
LOCOGRAPH_OPTION(unsigned long long)
LOCOGRAPH_OPTION(double)
LOCOGRAPH_OPTION(std::string)
LOCOGRAPH_OPTION(std::filesystem::path)
LOCOGRAPH_OPTION(std::vector<int>)
LOCOGRAPH_OPTION(std::vector<std::string>)
LOCOGRAPH_OPTION(std::vector<std::filesystem::path>)

ParserOption OptionParser::add_flag(const std::string& names, bool& value,
                                    const std::string& help) {
  return ParserOption(*app_->add_flag(names, value, help));
}

void OptionParser::add_version(const std::string& text) {
  app_->set_version_flag("--version", text);
}

OptionParser OptionParser::add_subcommand(const std::string& name, const std::string& description) {
  app_->require_subcommand(1);
  return OptionParser(std::shared_ptr<CLI::App>(app_, app_->add_subcommand(name, description)));
}

bool OptionParser::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app_->exit(help_or_version), false;
  } catch (const CLI::ParseError& usage) {
    // What is not understood comes first: it may be why something else is missing.
    const std::vector<CLI::App*> chosen = app_->get_subcommands();
    std::string why = chosen.empty() ? "" : not_understood(*chosen.front());
    if (why.empty()) why = not_understood(*app_);
    if (why.empty()) why = usage.what();
    throw UsageError(why + " (see: " + name() + ' ' +
                     (chosen.empty() ? "" : chosen.front()->get_name() + ' ') + "--help)");
  }
  return true;
}

bool OptionParser::chosen() const { return app_->parsed(); }

bool OptionParser::has_option(const std::string& name) const {
  return app_->get_option_no_throw(name) != nullptr;
}

bool OptionParser::given(const std::string& name) const { return app_->count(name) > 0; }

std::string OptionParser::name() const { return app_->get_name(); }

}  // namespace locograph
