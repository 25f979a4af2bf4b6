#include <locograph/apps/graph_types.h>
#include <locograph/common/input_file.h>
#include <locograph/core/plugin_library.h>
#include <locograph/plugins/robot_types.h>
#include <locograph/types/standard_types.h>

#include <filesystem>
#include <system_error>

namespace locograph {
namespace {

std::vector<std::filesystem::path> plugin_folders() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  std::vector<std::filesystem::path> folders;
  for (std::filesystem::path folder = program.parent_path();
       !failed && folder != folder.parent_path(); folder = folder.parent_path()) {
    std::error_code missing;
    if (std::filesystem::is_directory(folder / "lib/locograph", missing)) {
      folders.push_back(folder / "lib/locograph");
    }
  }
  return folders;
}

}  // namespace

TypeRegistry graph_types(const std::vector<std::string>& plugins) {
  TypeRegistry types = standard_types();
  add_robot_types(types);
  for (const std::string& name : plugins) {
    load_plugin(find_plugin(name, plugin_folders()), types);
  }
  return types;
}

std::string input_name(const std::string& input) { return input == "-" ? "stdin" : input; }

Graph read_input_graph(const std::string& input, const TypeRegistry& types,
                       const ReadOptions& options, ReadReport* report) {
  if (input != "-") return read_graph(input, types, options, report);
  const std::string text = read_input(input, kMostInputBytes, "a graph");
  return read_graph_text(text, input_name(input), ".", types, options, report);
}

void add_plugin_option(OptionParser& parser, std::vector<std::string>& plugins) {
  parser
      .add_option("--plugin", plugins,
                  "Library (.so) with more types; a bare name is looked for in lib/locograph")
      .value_name("LIB.so")
      .one_at_a_time();
}

}  // namespace locograph
