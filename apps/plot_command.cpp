#include <locograph/apps/graph_types.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plot.h>
#include <locograph/apps/plot_command.h>
#include <locograph/apps/progress.h>

#include <memory>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, output;
  std::vector<std::string> plugins;
};

ExitCode plot(const CommandOptions& options) {
  check_output(options.output, {options.input});
  {
    const Progress progress("drawing " + options.input);
    plot_result(options.input, options.plugins).write(options.output);
  }
  print_text("written: " + options.output + '\n');
  return kDone;
}

}  // namespace

Command add_plot(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser = app.add_subcommand("plot", "Draw a diagram of a result");
  parser
      .add_option(
          "RESULT", o.input,
          "JSON of optimize, refine or check (also -, standard input), a plan or the record of "
          "one carried out (.g2o), or a table (.csv)")
      .required();
  parser.add_option("-o,--output", o.output, "Diagram to write (.svg); - is standard output")
      .required();
  add_plugin_option(parser, o.plugins);
  return {parser, [options] { return plot(*options); }};
}

}  // namespace locograph
