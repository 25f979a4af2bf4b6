#pragma once
/// What commands print, and where: results to standard output, everything else to stderr.
///
///     Json result = {{"file", "hall.bt"}, {"resolution_m", 0.05}};
///     print_result(result, as_json);
///     print_warning("3 meshes are missing");
///
/// Control characters of names are printed as \\xNN, in JSON as \\u00NN: a file cannot make a
/// terminal do anything.
///
/// With --json standard output is one JSON object and nothing else. Without, the same object is
/// printed as indented lines `key: value unit`, the unit taken from the key's suffix (_m, _kg, _s,
/// _rad_s, _N, …); long lists are cut.

#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace locograph {

using Json = nlohmann::ordered_json;

/// Throws Error when standard output cannot be written.
void print_result(const Json& result, bool as_json);
/// Goes to stderr where standard output is a file that the command writes: check_output().
void print_text(const std::string& text);
void print_warning(const std::string& text);

/// From now on there are neither warnings nor progress on stderr; errors there are.
void be_quiet();
bool is_quiet();

/// `locograph: FILE:LINE: what, expected` on one line of stderr.
void print_error(const std::string& what);

/// Throws Error when a file could not be written at this path: asked before a long job, not after.
/// Also when that is standard output (`-`), and json or another file is to go there as well, when
/// another output goes to this file, and when the file is one of the inputs ("": none), by whatever
/// name: nothing that was given is lost.
void check_output(const std::filesystem::path& path,
                  const std::vector<std::filesystem::path>& inputs, bool json = false);
/// The last of these alone.
void check_not_input(const std::filesystem::path& output,
                     const std::vector<std::filesystem::path>& inputs);

/// Six significant digits.
std::string short_number(double value);
/// "1 edge", "2 edges"
std::string counted(long count, const std::string& singular, const std::string& plural);

}  // namespace locograph
