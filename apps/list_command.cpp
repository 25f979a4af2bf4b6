#include <locograph/apps/graph_types.h>
#include <locograph/apps/list_command.h>
#include <locograph/apps/output.h>
#include <locograph/common/data_folder.h>
#include <locograph/core/robust_kernel.h>
#include <locograph/planners/offline/stance/stance_planners.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/solvers/linear_solvers.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {
namespace {

std::vector<std::string> names_of(const std::string& what,
                                  const std::vector<std::string>& plugins) {
  if (what == "types") return graph_types(plugins).tags();
  if (what == "solvers") return linear_solver_names();
  if (what == "kernels") return RobustKernel::names();
  if (what == "robots") return robot_names(data_folder());
  if (what == "planners") return stance_planner_names();
  return scenario_names(data_folder());
}

}  // namespace

Command add_list(OptionParser& app) {
  struct Options {
    std::string what;
    std::vector<std::string> plugins;
  };
  const auto options = std::make_shared<Options>();
  OptionParser parser = app.add_subcommand("list", "What is registered, one name per line");
  parser.add_option("WHAT", options->what, "types, solvers, kernels, robots, scenarios or planners")
      .required()
      .one_of({"types", "solvers", "kernels", "robots", "scenarios", "planners"});
  add_plugin_option(parser, options->plugins);
  return {parser, [options] {
            std::string text;
            for (const std::string& name : names_of(options->what, options->plugins))
              text += name + '\n';
            print_text(text);
            return kDone;
          }};
}

}  // namespace locograph
