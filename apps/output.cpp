#include <locograph/apps/output.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/control_characters.h>
#include <locograph/common/error.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <utility>

namespace locograph {
namespace {

/// check_output() was told so: then nothing else goes to standard output.
bool output_is_a_file = false;
bool silenced = false;
std::vector<std::filesystem::path> outputs;  // that check_output() was asked for
constexpr const char *kEscape = "\\x", *kJsonEscape = "\\u00";

std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return without_controls(text, kEscape);
}

std::string scalar_text(const Json& value) {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return short_number(value.get<double>());
  return value.dump();
}

bool is_flat(const Json& value) {
  return std::none_of(value.begin(), value.end(),
                      [](const Json& item) { return item.is_structured(); });
}

/// "mass_kg" of a number → {"mass", " kg"}
std::pair<std::string, std::string> label_and_unit(const std::string& key, const Json& value) {
  const bool numeric =
      value.is_number() || (value.is_array() && !value.empty() && value.front().is_number());
  struct Unit {
    std::string_view suffix, text;
  };
  // Longer ones first: a speed in m_s is no time in s.
  static constexpr Unit kUnits[] = {{"_rad_s2", " rad/s2"}, {"_rad_s", " rad/s"}, {"_m_s", " m/s"},
                                    {"_1_m", " 1/m"},       {"_mm", " mm"},       {"_m", " m"},
                                    {"_kg", " kg"},         {"_s", " s"},         {"_rad", " rad"},
                                    {"_Nm", " Nm"},         {"_N", " N"}};
  for (const Unit& unit : kUnits) {
    if (numeric && key.ends_with(unit.suffix)) {
      return {key.substr(0, key.size() - unit.suffix.size()), std::string(unit.text)};
    }
  }
  return {key, ""};
}

/// One line: "a, b unit", or "x 1 m, y 2 s"; the values must be flat.
std::string inline_text(const Json& value, const std::string& unit) {
  if (!value.is_structured()) return scalar_text(value) + (value.is_number() ? unit : "");
  if (value.empty()) return "none";
  std::string text;
  for (const auto& [key, item] : value.items()) {
    text += text.empty() ? "" : ", ";
    if (value.is_object()) {
      const auto [label, own_unit] = label_and_unit(key, item);
      text += label + ' ' + scalar_text(item) + own_unit;
    } else {
      text += scalar_text(item);
    }
  }
  return text + (value.is_array() ? unit : "");
}

void write_value(std::ostream& out, const Json& value, const std::string& unit,
                 const std::string& indent) {
  constexpr std::size_t kWidth = 100, kMostItems = 8;
  if (!value.is_structured() || is_flat(value)) {
    const std::string text = inline_text(value, unit);
    if (text.size() <= kWidth || !value.is_array()) {
      out << ' ' << text << '\n';
      return;
    }
  }
  out << '\n';
  std::size_t count = 0;
  for (const auto& [key, item] : value.items()) {
    if (value.is_array() && ++count > kMostItems) {
      out << indent << "and " << value.size() - kMostItems << " more (see --json)\n";
      return;
    }
    const auto [label, own_unit] = label_and_unit(key, item);
    out << indent << (value.is_array() ? "-" : label + ':');
    write_value(out, item, value.is_array() ? unit : own_unit, indent + "  ");
  }
}

/// Of a file that keeps what is in it.
bool is_one_file(const std::filesystem::path& output, const std::filesystem::path& input) {
  std::error_code failed;
  return !input.empty() && input != "-" && !is_standard_output(output) &&
         std::filesystem::is_regular_file(output, failed) &&
         std::filesystem::equivalent(output, input, failed);
}

/// What names hold that a terminal would obey is escaped.
void print_escaped(const std::string& raw, const char* escape) {
  const std::string text = without_controls(raw, escape, "\n");
  if (output_is_a_file) {
    std::cerr << text << std::flush;
  } else {
    write_to_descriptor(STDOUT_FILENO, text, "standard output");
  }
}

}  // namespace

void print_text(const std::string& text) { print_escaped(text, kEscape); }

void print_result(const Json& result, bool as_json) {
  std::ostringstream text;
  if (as_json) {
    // Names of files may hold bytes that are no UTF-8: they are replaced, JSON must stay JSON.
    text << result.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    for (const auto& [key, value] : result.items()) {
      const auto [label, unit] = label_and_unit(key, value);
      text << label << ':';
      write_value(text, value, unit, "  ");
    }
  }
  print_escaped(text.str(), as_json ? kJsonEscape : kEscape);
}

void be_quiet() { silenced = true; }
bool is_quiet() { return silenced; }

void print_warning(const std::string& text) {
  if (silenced) return;
  if (::isatty(STDERR_FILENO) != 0) std::cerr << "\r\033[K";  // over a line of progress
  std::cerr << "locograph: warning: " << one_line(text) << '\n';
}

void print_error(const std::string& what) {
  std::cerr << "locograph: " << one_line(what) << std::endl;
}

void check_not_input(const std::filesystem::path& output,
                     const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    if (!is_one_file(output, input)) continue;
    throw Error(output.string(), 0,
                "is to be written and is an input" +
                    (output == input ? "" : ", " + input.string()) + ", which would be lost",
                "another file");
  }
}

void check_output(const std::filesystem::path& path,
                  const std::vector<std::filesystem::path>& inputs, bool json) {
  check_not_input(path, inputs);
  if (is_standard_output(path)) {
    if (json || output_is_a_file) {
      throw Error(path.string(), 0, "two results on standard output",
                  json ? "a file, or no --json" : "one of the two in a file");
    }
    output_is_a_file = true;
  }
  check_output_path(path);
  if (is_standard_output(path)) return;
  std::error_code failed;
  const std::filesystem::path file =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path), failed);
  const bool keeps =
      std::filesystem::is_regular_file(file, failed) || !std::filesystem::exists(file, failed);
  if (keeps && std::find(outputs.begin(), outputs.end(), file) != outputs.end()) {
    throw Error(path.string(), 0, "two results in one file", "two files");
  }
  outputs.push_back(file);
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string counted(long count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

}  // namespace locograph
