#pragma once
/// Reads a JSON file of the user's.
///
///     const Json result = read_json("result.json", "what `optimize --json` prints");
///
/// Throws Error for a file that cannot be read, and with the line where it is no JSON. Where a
/// value stands that is JSON but not what it should be:
///
///     const std::string text = read_file("plan.json");
///     const Json plan = parse_json(text, "plan.json", "a plan");
///     if (!plan["points"][3].is_object()) fail(json_line(text, {"points", "3"}));

#include <locograph/apps/output.h>

#include <string>
#include <vector>

namespace locograph {

/// expected: what the file should be, for errors.
Json read_json(const std::filesystem::path& file, const std::string& expected);

/// The same of a text; file: for errors.
Json parse_json(const std::string& text, const std::string& file, const std::string& expected);

/// The lines where the elements of a list of the outermost object begin, by its name; fewer where
/// there is none.
std::vector<int> json_lines(const std::string& text, const std::string& list);
/// The line where a value of a text that is JSON begins, by the names and numbers on the way to it;
/// where there is none of them, the line where what would hold it ends.
int json_line(const std::string& text, const std::vector<std::string>& path);

}  // namespace locograph
