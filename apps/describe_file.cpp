#include <locograph/apps/describe.h>
#include <locograph/apps/progress.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/types/bundle/bal_file.h>

#include <string>

namespace locograph {
namespace {

std::string beginning(const std::filesystem::path& path) {
  const std::string text = file_beginning(path, 64 * 1024, "a readable file");
  if (text.empty()) {
    throw Error(path.string(), 0, "is empty",
                "a graph, robot, map, scenario, obstacles, contacts or BAL file");
  }
  return text;
}

/// Name of the first element, "" when there is none.
std::string root_element(const std::string& text) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 1)) {
    if (text.compare(at, 4, "<!--") == 0) {
      at = text.find("-->", at);
      if (at == std::string::npos) return "";
    } else if (at + 1 < text.size() && text[at + 1] != '?' && text[at + 1] != '!') {
      return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at + 1) - at - 1);
    }
  }
  return "";
}

Json describe_xml(const std::filesystem::path& path, const std::string& text) {
  const std::string root = root_element(text);
  const Progress progress("reading " + path.string());
  if (root == "obstacles") return describe_obstacles(path);
  if (root == "scenario") return describe_scenario(path);
  if (root == "contacts") return describe_contacts(path);
  if (root == "robot" && path.extension() == ".srdf") {
    throw Error(path.string(), 0, "is an SRDF", "the URDF it belongs to");
  }
  if (root == "robot" || path.extension() == ".urdf") return describe_robot(path);
  throw Error(path.string(), 0, "is XML with root element '" + root + "'",
              "a <robot> (URDF), <scenario>, <contacts> or <obstacles> file");
}

}  // namespace

Json describe_file(const std::filesystem::path& path, const TypeRegistry& types) {
  // What comes from there cannot be looked at twice.
  if (path == "-") return describe_graph(path, types);
  const std::string text = beginning(path);
  const std::string extension = path.extension().string();
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string::npos && text[first] == '<') return describe_xml(path, text);
  if (extension != ".g2o") {
    const Progress progress("reading " + path.string());
    if (extension == ".urdf") return describe_robot(path);
    if (extension == ".bt" || extension == ".ot" || text.starts_with("# Octomap")) {
      return describe_map(path);
    }
    if (extension == ".bal" || looks_like_bal(text)) return describe_bal(path);
  }
  return describe_graph(path, types);
}

}  // namespace locograph
