#include <locograph/apps/json_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>

#include <algorithm>

namespace locograph {
namespace {

int line_of(const std::string& text, std::size_t at) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return 1 + static_cast<int>(std::count(text.begin(), end, '\n'));
}

}  // namespace

Json read_json(const std::filesystem::path& file, const std::string& expected) {
  const std::string text = file == "-" ? read_input(file, kMostInputBytes, expected)
                                       : read_file(file, kMostInputBytes, expected);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& failure) {
    const std::size_t at = failure.byte > 0 ? failure.byte - 1 : 0;
    throw Error(file.string(), line_of(text, at), "is not JSON", expected);
  } catch (const Json::out_of_range& failure) {
    // "number overflow parsing '1e400'", without a place.
    const std::string message = failure.what();
    const std::size_t begin = message.find('\'') + 1, end = message.rfind('\'');
    const std::string number = begin < end ? message.substr(begin, end - begin) : "a number";
    throw Error(file.string(), line_of(text, text.find(number)), "'" + number + "' is not finite",
                "finite numbers");
  }
}

}  // namespace locograph
