#include <locograph/apps/describe.h>
#include <locograph/common/error.h>

#include <fstream>
#include <string>

namespace locograph {
namespace {

std::string beginning(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) throw Error(path.string(), 0, "is a folder", "a file");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string(), 0, "cannot be opened", "a readable file");
  std::string text(64 * 1024, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.empty()) {
    throw Error(path.string(), 0, "is empty", "a graph, robot, map or obstacles file");
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

}  // namespace

Json describe_file(const std::filesystem::path& path, const TypeRegistry& types) {
  const std::string text = beginning(path);
  const std::string extension = path.extension().string();
  if (extension == ".g2o") return describe_graph(path, types);
  if (extension == ".urdf") return describe_robot(path);
  if (extension == ".bt" || extension == ".ot" || text.starts_with("# Octomap")) {
    return describe_map(path);
  }
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first == std::string::npos || text[first] != '<') return describe_graph(path, types);
  const std::string root = root_element(text);
  if (root == "obstacles") return describe_obstacles(path);
  if (root == "robot" && extension == ".srdf") {
    throw Error(path.string(), 0, "is an SRDF", "the URDF it belongs to");
  }
  if (root == "robot") return describe_robot(path);
  throw Error(path.string(), 0, "is XML with root element '" + root + "'",
              "a <robot> (URDF) or <obstacles> file");
}

}  // namespace locograph
