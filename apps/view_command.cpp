#include <locograph/apps/child_process.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/live_refine.h>
#include <locograph/apps/output.h>
#include <locograph/apps/page_picture.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/view_command.h>
#include <locograph/common/atomic_file.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct CommandOptions {
  std::string input, output, png;
  SceneOptions scene;
  double at_s = 0.0, speed = 1.0;
  int port = -1;
  bool no_check = false, json = false;
};

ExitCode serve(const CommandOptions& options, Json scene) {
  if (scene["kind"] != "plan" || scene["plan"]["times"].size() < 2) {
    throw Error(options.input, 0, "--serve has nothing to run", "a plan (.g2o)");
  }
  if (scene["plan"].contains("recorded")) {
    throw Error(options.input, 0, "is the record of a plan carried out", "a plan to --serve");
  }
  scene["live"] = "/live";
  const LiveJob job = {options.input,           options.scene.map, options.scene.obstacles,
                       options.scene.window,    options.speed,     options.scene.plugins,
                       options.scene.perception};
  LiveServer server(options.port, scene_page(scene),
                    [job](LiveChannel& channel) { live_refine(job, channel); });
  if (options.json) {
    print_result({{"address", server.address()}}, true);
  } else {
    print_text("serving " + server.address() + " (Ctrl-C stops)\n");
  }
  server.run();
  return kDone;
}

void save(const CommandOptions& options, const std::string& page) {
  if (!options.output.empty()) write_file_atomically(options.output, page);
  if (options.png.empty()) return;
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "page.html";
  write_file_atomically(file, page);
  save_page_picture(file, options.at_s, options.png);
}

void report(const CommandOptions& options, const Json& scene, std::size_t bytes) {
  Json json = {{"file", options.input}, {"kind", scene["kind"]}, {"title", scene["title"]}};
  if (scene.contains("plan")) json["configurations"] = scene["plan"]["times"].size();
  if (scene.contains("robot")) json["missing_meshes"] = scene["robot"]["missing"];
  if (scene.contains("check")) json["feasible"] = scene["check"]["feasible"];
  if (scene.contains("perception") && scene["perception"].contains("images")) {
    for (const char* count : {"images", "blind_images", "refused_images"}) {
      json[count] = scene["perception"][count];
    }
    json["clouds"] = scene["perception"]["clouds"].size();
  }
  if (!options.output.empty()) json["output"] = options.output;
  if (!options.output.empty()) json["bytes"] = bytes;
  if (!options.png.empty()) json["picture"] = options.png;
  if (options.json) {
    print_result(json, true);
    return;
  }
  if (!options.output.empty()) print_text("written: " + options.output + '\n');
  if (!options.png.empty()) print_text("written: " + options.png + '\n');
}

void warn_of_missing_meshes(const Json& scene) {
  if (!scene.contains("robot") || scene["robot"]["missing"].empty()) return;
  const Json& missing = scene["robot"]["missing"];
  constexpr std::size_t kNamed = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(missing.size(), kNamed); ++i) {
    names += (i > 0 ? ", " : " ") + missing[i].get<std::string>();
  }
  if (missing.size() > kNamed) names += " …";
  print_warning(counted(static_cast<long>(missing.size()), "mesh", "meshes") +
                " not found or not STL, stand-ins shown:" + names);
}

std::vector<std::filesystem::path> outputs_of(const CommandOptions& options) {
  std::vector<std::filesystem::path> files;
  for (const std::string& file : {options.output, options.png}) {
    if (!file.empty()) files.emplace_back(file);
  }
  return files;
}

ExitCode view(const OptionParser& parser, const CommandOptions& options) {
  const bool serving = options.port >= 0;
  if (options.output.empty() && options.png.empty() && !serving) {
    throw Error("nothing to write", "-o OUT.html, --png FILE or --serve PORT");
  }
  const SceneOptions& given = options.scene;
  const std::vector<std::filesystem::path> inputs = {options.input,   given.map,
                                                     given.obstacles, given.tree,
                                                     given.srdf,      given.perception.known_map};
  for (const std::filesystem::path& file : given.outputs) check_output(file, inputs, options.json);
  check_perception_options(parser, given.perception, inputs);
  if (given.perception.given() && given.perception.unknown == "slow") {
    throw Error("--unknown slow", "free or occupied: a page has the times of the plan");
  }
  if (serving && options.input == "-") {
    throw Error("standard input", 0, "can be read once only", "a file to --serve");
  }
  if (!options.png.empty()) require_browser();
  std::optional<Progress> progress("reading " + options.input);
  SceneOptions scene_options = options.scene;
  scene_options.on_progress = [&progress](double share) { progress->show(share); };
  Json scene = make_scene(options.input, scene_options);
  warn_of_missing_meshes(scene);
  const std::string page = scene_page(scene);
  progress.emplace("drawing " + options.input);
  save(options, page);
  progress.reset();
  if (!options.output.empty() || !options.png.empty()) {
    if (!serving || !options.json) report(options, scene, page.size());
  }
  return serving ? serve(options, std::move(scene)) : kDone;
}

}  // namespace

Command add_view(OptionParser& app) {
  const auto options = std::make_shared<CommandOptions>();
  CommandOptions& o = *options;
  OptionParser parser =
      app.add_subcommand("view", "Show a plan, a pose graph or a robot in one self-contained page");
  parser
      .add_option(
          "FILE", o.input,
          "Plan or pose graph (.g2o), or robot (.urdf); - reads a graph from standard input")
      .required();
  parser.add_option("-o,--output", o.output,
                    "Page to write (.html); opens without a network; - is standard output");
  parser.add_option("--map", o.scene.map, "OctoMap to show instead of the plan's own world");
  parser.add_option("--obstacles", o.scene.obstacles, "Obstacle file (.xml); may go with --map");
  parser.add_option("--tree", o.scene.tree,
                    "Plans of stances: what the search tried, as `plan --tree` wrote it");
  add_perception_options(parser, o.scene.perception);
  parser.add_option("--png", o.png, "Picture to write, taken by headless Chromium");
  parser.add_option("--at", o.at_s, "Time of the picture [s]").finite().show_default();
  parser
      .add_option("--serve", o.port,
                  "Serve the page on 127.0.0.1:PORT and refine the plan live (0: any port)")
      .between(0, 65535);
  parser.add_option("--speed", o.speed, "Of the live plan, in times of its own pace")
      .between(1e-3, 1e3)
      .show_default();
  parser
      .add_option("--executed", o.scene.executed,
                  "Show the plan as when the robot is at this configuration")
      .not_negative();
  parser.add_option("--horizon", o.scene.window, "Configurations that one cycle refines")
      .positive()
      .show_default();
  parser.add_flag("--no-check", o.no_check, "Do not judge the plan");
  parser.add_flag("--robustness", o.scene.robustness,
                  "Plans: also tell how far from falling they are, as `check --robustness`");
  parser.add_flag("--optimize", o.scene.optimize, "Pose graphs: show before and after");
  add_plugin_option(parser, o.scene.plugins);
  parser.add_flag("--lenient", o.scene.lenient,
                  "Leave out unknown tags, project indefinite information");
  parser.add_option("--srdf", o.scene.srdf, "Robots: the SRDF, if not beside the URDF");
  parser.add_option("--state", o.scene.state, "Robots: group_state to stand in");
  parser.add_flag("--capsules", o.scene.capsules,
                  "Robots: draw the capsules that self-collision edges see");
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [parser, options] {
            options->scene.check = !options->no_check;
            options->scene.outputs = outputs_of(*options);
            options->scene.live = options->port >= 0 && options->scene.outputs.empty();
            return view(parser, *options);
          }};
}

}  // namespace locograph
