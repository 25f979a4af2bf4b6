#include <locograph/apps/describe.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/info_command.h>
#include <locograph/apps/margin_json.h>
#include <locograph/apps/refusal.h>
#include <locograph/apps/robot_skeleton.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace locograph {

Command add_info(OptionParser& app) {
  struct Options {
    std::string file, srdf;
    std::vector<std::string> plugins;
    bool json = false, pairs = false;
    LinkPairOptions sampling;
  };
  const auto options = std::make_shared<Options>();
  OptionParser parser = app.add_subcommand(
      "info", "What is in a graph, robot, map, scenario, obstacles, contacts or BAL file");
  parser
      .add_option("FILE", options->file,
                  "A graph (.g2o), robot (.urdf), map (.bt, .ot), scenario, obstacles or contacts "
                  "file (.xml), or bundle adjustment in the large (.txt, .bal); - reads a graph "
                  "from standard input")
      .required();
  add_plugin_option(parser, options->plugins);
  options->sampling.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  parser.add_flag("--pairs", options->pairs,
                  "Of a robot: which pairs of links meet in random postures, and which are off");
  parser.add_option(
      "--write-srdf", options->srdf,
      "Of a robot, where to write an SRDF (.srdf): pairs of links that never or always "
      "meet are off; and beside it a scenario with proposed end effectors");
  parser.add_option("--samples", options->sampling.samples, "Postures of --pairs, --write-srdf")
      .positive()
      .show_default();
  parser.add_option("--seed", options->sampling.seed, "Of the postures").show_default();
  parser.add_option("--threads", options->sampling.threads, "Threads to use (all cores)")
      .positive();
  parser.add_flag("--json", options->json, "Print one JSON object");
  return {parser, [options] {
            if (!options->srdf.empty()) {
              const Json told = write_skeleton(options->file, options->srdf, options->sampling);
              print_result(told, options->json);
              return told["scenario"].is_null() ? kNo : kDone;
            }
            if (options->pairs) {
              print_result(describe_link_pairs(options->file, options->sampling), options->json);
              return kDone;
            }
            Json told = describe_file(options->file, graph_types(options->plugins));
            const Loading loading = load_as_others_do(told["kind"], options->file);
            if (!loading.off_skin.empty()) told["off_skin"] = off_skin_json(loading.off_skin);
            if (loading.refused) told["refused"] = loading.refused->what();
            print_result(told, options->json);
            if (loading.refused) throw *loading.refused;
            return kDone;
          }};
}

}  // namespace locograph
