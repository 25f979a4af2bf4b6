// The `locograph` command: parses the command line and runs the command that was named.

#include <locograph/apps/campaign_command.h>
#include <locograph/apps/check_command.h>
#include <locograph/apps/convert_command.h>
#include <locograph/apps/info_command.h>
#include <locograph/apps/list_command.h>
#include <locograph/apps/optimize_command.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_command.h>
#include <locograph/apps/plot_command.h>
#include <locograph/apps/posture_command.h>
#include <locograph/apps/refine_command.h>
#include <locograph/apps/simulate_command.h>
#include <locograph/apps/view_command.h>
#include <locograph/common/error.h>
#include <locograph/common/stop_signals.h>
#include <locograph/solvers/kernels.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace locograph {
namespace {

/// A tag that nobody knows may be a plug-in's, or of no interest.
std::string advice(const std::string& what, const OptionParser& parser) {
  if (what.find("unknown tag '") == std::string::npos) return "";
  std::string text;
  if (parser.has_option("--plugin")) text += "; --plugin LIB.so loads more types";
  if (parser.has_option("--lenient")) text += ", --lenient leaves out unknown lines";
  return text;
}

ExitCode run_chosen(const std::vector<Command>& commands) {
  for (const Command& command : commands) {
    if (!command.parser.chosen()) continue;
    kernels();  // a wrong LOCOGRAPH_SIMD is told before any work is done
    try {
      return command.run();
    } catch (const Error& error) {
      print_error(error.what() + advice(error.what(), command.parser));
      return kBadInput;
    }
  }
  return kBadInput;
}

int run(int argc, char** argv) {
  OptionParser app("Hyper-graph optimisation and loco-manipulation planning", "locograph");
  app.add_version("locograph " LOCOGRAPH_VERSION);
  std::vector<Command> commands = {add_optimize(app), add_plan(app),    add_refine(app),
                                   add_check(app),    add_info(app),    add_list(app),
                                   add_view(app),     add_plot(app),    add_posture(app),
                                   add_campaign(app), add_convert(app), add_simulate(app)};
  bool quiet = false;
  std::string packages;
  for (Command& command : commands) {
    command.parser.add_flag("--quiet", quiet, "Neither progress nor warnings on stderr");
    command.parser.add_option("--package-path", packages,
                              "Where meshes of package:// are, too: folders, separated by ':'");
  }
  if (!app.parse(argc, argv)) return kDone;
  // As if it were told by the environment, before anything is loaded.
  if (!packages.empty()) setenv("LOCOGRAPH_PACKAGE_PATH", packages.c_str(), 1);
  if (quiet) be_quiet();
  return run_chosen(commands);
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  locograph::take_stop_signals();
  try {
    return locograph::run(argc, argv);
  } catch (const locograph::Interrupted&) {
    locograph::end_by_stop_signal();
  } catch (const locograph::UsageError& error) {
    locograph::print_error(error.what());
  } catch (const locograph::Error& error) {
    locograph::print_error(error.what());
  } catch (const std::exception& error) {
    locograph::print_error(std::string("unexpected failure: ") + error.what());
  }
  return locograph::kBadInput;
}
