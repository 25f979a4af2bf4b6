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
#include <locograph/solvers/kernels.h>

#include <vector>

namespace locograph {
namespace {

int run(int argc, char** argv) {
  OptionParser app("Hyper-graph optimisation and loco-manipulation planning", "locograph");
  app.add_version("locograph " LOCOGRAPH_VERSION);
  const std::vector<Command> commands = {add_optimize(app), add_plan(app), add_refine(app),
                                         add_check(app),    add_info(app), add_list(app),
                                         add_view(app),     add_plot(app), add_posture(app)};
  if (!app.parse(argc, argv)) return kDone;
  for (const Command& command : commands) {
    if (!command.parser.chosen()) continue;
    kernels();  // a wrong LOCOGRAPH_SIMD is told before any work is done
    return command.run();
  }
  return kBadInput;
}

}  // namespace
}  // namespace locograph

int main(int argc, char** argv) {
  try {
    return locograph::run(argc, argv);
  } catch (const locograph::UsageError& error) {
    locograph::print_error(error.what());
  } catch (const locograph::Error& error) {
    locograph::print_error(error.what());
  } catch (const std::exception& error) {
    locograph::print_error(std::string("unexpected failure: ") + error.what());
  }
  return locograph::kBadInput;
}
