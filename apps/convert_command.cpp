#include <locograph/apps/convert_command.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/trajectory_file.h>
#include <locograph/common/atomic_file.h>
#include <locograph/core/graph_file.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, output;
  std::vector<std::string> plugins;
  bool json = false;
};

enum class Format { kGraph, kTable, kJson };

Format format_of(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".g2o") return Format::kGraph;
  if (ending == ".csv") return Format::kTable;
  if (ending == ".json") return Format::kJson;
  throw Error(file, 0, "a plan in no format that is known",
              "a name that ends in .g2o, .csv or .json");
}

PlanFile read_plan(const std::string& file, Format format,
                   const std::vector<std::string>& plugins) {
  if (format == Format::kGraph) return load_plan(file, plugins);
  const TypeRegistry types = graph_types(plugins);
  return plan_in(with_edges(format == Format::kTable ? read_trajectory_csv(file, types)
                                                     : read_trajectory_json(file, types),
                            file),
                 file);
}

ExitCode convert(const CommandOptions& options) {
  const Format from = format_of(options.input), to = format_of(options.output);
  if (from == to) {
    throw Error(options.output, 0, "a plan in the format that it has", "another one");
  }
  check_output(options.output, {options.input}, options.json);
  std::optional<Progress> progress("converting " + options.input);
  const PlanFile plan = read_plan(options.input, from, options.plugins);
  require_plan(plan.plan, plan.name);
  check_not_input(options.output, files_of(plan));
  if (to == Format::kGraph) {
    write_graph(plan.graph, options.output);
  } else {
    const std::filesystem::path folder = folder_of_output(options.output);
    write_file_atomically(options.output, to == Format::kTable ? trajectory_csv(plan, folder)
                                                               : trajectory_json(plan, folder));
  }
  progress.reset();
  const std::size_t count = plan.plan.slots.size();
  if (options.json) {
    print_result({{"file", options.output},
                  {"configurations", count},
                  {"segments", plan.plan.segments.size()}},
                 true);
  } else {
    print_text(counted(static_cast<long>(count), "configuration", "configurations") +
               "\nwritten: " + options.output + '\n');
  }
  return kDone;
}

}  // namespace

Command add_convert(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser = app.add_subcommand(
      "convert", "Write a plan as a graph (.g2o), a table (.csv) or JSON (.json), or back");
  parser.add_option("PLAN", o.input, "Plan to read (.g2o, .csv, .json)").required();
  parser.add_option("-o,--output", o.output, "File to write (.g2o, .csv, .json)").required();
  add_plugin_option(parser, o.plugins);
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] { return convert(*options); }};
}

}  // namespace locograph
