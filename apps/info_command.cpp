#include <locograph/apps/describe.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/info_command.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {

Command add_info(OptionParser& app) {
  struct Options {
    std::string file;
    std::vector<std::string> plugins;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  OptionParser parser =
      app.add_subcommand("info", "What is in a graph, robot, map or obstacles file");
  parser.add_option("FILE", options->file, "A .g2o, .urdf, .bt, .ot or .xml file").required();
  add_plugin_option(parser, options->plugins);
  parser.add_flag("--json", options->json, "Print one JSON object");
  return {parser, [options] {
            print_result(describe_file(options->file, graph_types(options->plugins)),
                         options->json);
            return kDone;
          }};
}

}  // namespace locograph
