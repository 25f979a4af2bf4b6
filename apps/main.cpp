// The `locograph` command: parses the command line and runs the command that was named.

#include <locograph/apps/check_command.h>
#include <locograph/apps/info_command.h>
#include <locograph/apps/list_command.h>
#include <locograph/apps/optimize_command.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/apps/plot_command.h>
#include <locograph/apps/posture_command.h>
#include <locograph/apps/refine_command.h>
#include <locograph/apps/view_command.h>
#include <locograph/common/error.h>

#include <CLI/Error.hpp>
#include <vector>

namespace locograph {
namespace {

/// The chosen command's name, for messages about its usage.
std::string help_hint(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  return "see: locograph " + (chosen.empty() ? "" : chosen.front()->get_name() + ' ') + "--help";
}

int run(int argc, char** argv) {
  CLI::App app("Hyper-graph optimisation and loco-manipulation planning", "locograph");
  app.set_version_flag("--version", "locograph " LOCOGRAPH_VERSION);
  app.require_subcommand(1);
  const std::vector<Command> commands = {add_optimize(app), add_plan(app), add_refine(app),
                                         add_check(app),    add_info(app), add_list(app),
                                         add_view(app),     add_plot(app), add_posture(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& usage) {
    print_error(std::string(usage.what()) + " (" + help_hint(app) + ")");
    return kBadInput;
  }
  for (const Command& command : commands) {
    if (command.parser->parsed()) return command.run();
  }
  return kBadInput;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  try {
    return locograph::run(argc, argv);
  } catch (const locograph::Error& error) {
    locograph::print_error(error.what());
  } catch (const std::exception& error) {
    locograph::print_error(std::string("unexpected failure: ") + error.what());
  }
  return locograph::kBadInput;
}
