#include <locograph/apps/graph_types.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/scene_perception.h>
#include <locograph/apps/stance_tree_file.h>
#include <locograph/common/data_folder.h>
#include <locograph/common/input_file.h>
#include <locograph/core/graph_file.h>
#include <locograph/planners/scenario/scenario.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace locograph {
namespace {

bool has_configurations(const Graph& graph) {
  for (const auto& pool : graph.vertex_pools()) {
    if (pool->type() == typeid(VertexConfiguration) && pool->size() > 0) return true;
  }
  return false;
}

struct KnownWorld {
  std::optional<Judging> judging;
  std::shared_ptr<const WorldSnapshot> world;
};

/// What the plan is judged by, and its world; where it names files that are not there, the world of
/// the command line alone, with a warning.
KnownWorld known_world(const PlanFile& file, const SceneOptions& options) {
  try {
    const Judging judging =
        judging_of(file, {.scenario = {}, .map = options.map, .obstacles = options.obstacles});
    return {judging, judging.world};
  } catch (const Error& error) {
    if (options.perception.given()) throw;
    // What the command line names must be there.
    auto named = std::make_shared<const WorldSnapshot>(load_world(options.map, options.obstacles));
    print_warning(std::string("neither judged nor shown in its world: ") + error.what());
    return {std::nullopt, std::move(named)};
  }
}

/// "" where it names none, or one that is not there.
std::string scenario_name(const PlanFile& file) {
  const auto origin = file.graph.parameters().find<ScenarioParameter>();
  if (!origin) return "";
  try {
    return load_scenario(origin->scenario, data_folder()).name;
  } catch (const Error&) {
    return "";
  }
}

Stance first_stance(const PlanFile& file) {
  const auto& first = file.plan.stance_from.front();
  return first ? first->stance : Stance();
}

Json perception_json(const PlanFile& file, const Judging& judging, const SceneOptions& options) {
  PerceptionScene seen(file, judging, options.perception);
  for (const std::filesystem::path& output : options.outputs) {
    check_not_input(output, seen.eyes().files());
  }
  return options.live ? seen.blank() : seen.along_plan(options.on_progress);
}

Json plan_scene(PlanFile file, const SceneOptions& options) {
  const Robot& robot = *file.plan.robot->robot;
  Json scene = {{"version", 1},
                {"kind", "plan"},
                {"title", std::filesystem::path(file.name).filename().string()},
                {"robot", robot_scene(robot)}};
  auto [judging, world] = known_world(file, options);
  if (judging) judging->options.robustness = options.robustness;
  add_plan_scene(file, judging ? &*judging : nullptr, options, scene);
  if (!options.tree.empty()) {
    scene["tree"] = tree_scene(options.tree, scenario_name(file), first_stance(file));
  }
  Eigen::AlignedBox3d near;
  if (robot.floating_base()) {
    for (const int slot : file.plan.slots) {
      near.extend(Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(file.graph.state(slot))));
    }
  } else {
    near.extend(Eigen::Vector3d::Zero());
  }
  add_world_scene(world->world(), near, scene);
  if (options.perception.given()) {
    scene["perception"] = perception_json(file, *judging, options);
  }
  if (!options.check || !judging || file.plan.recorded) return scene;
  try {
    scene["check"] = check_scene(file, check_plan(file, *judging));
  } catch (const Error& error) {
    // E.g. a collision mesh that is missing: the rest can be shown all the same.
    print_warning(std::string("not checked: ") + error.what());
  }
  return scene;
}

}  // namespace

double rounded(double value) { return std::round(1e6 * value) / 1e6; }

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({rounded(v.x()), rounded(v.y()), rounded(v.z())});
}

Json pose_json(const Eigen::Isometry3d& pose) {
  Json json = vector_json(pose.translation());
  const Eigen::Quaterniond q(pose.linear());
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) json.push_back(rounded(value));
  return json;
}

Json make_scene(const std::string& file, const SceneOptions& options) {
  const bool robot = std::filesystem::path(file).extension() == ".urdf";
  const auto require_plan = [&](bool is_plan) {
    if (is_plan) return;
    if (!options.tree.empty()) {
      throw Error(file, 0, "--tree has no plan to go with", "a plan of stances (.g2o)");
    }
    if (options.perception.given()) {
      const std::string option = options.perception.cameras ? "--cameras" : "--clouds";
      throw Error(file, 0, option + " has no plan to go with", "a plan of a motion (.g2o)");
    }
  };
  require_plan(!robot);
  if (robot) return standing_scene(file, options);
  ReadReport report;
  Graph graph =
      read_input_graph(file, graph_types(options.plugins), {.lenient = options.lenient}, &report);
  require_plan(has_configurations(graph));
  if (!has_configurations(graph)) return pose_graph_scene(std::move(graph), file, options);
  return plan_scene(plan_in(std::move(graph), input_name(file)), options);
}

std::string scene_page(const Json& scene) {
  const std::filesystem::path file = data_folder() / "viewer/template.html";
  if (!std::filesystem::is_regular_file(file)) {
    throw Error(file.string(), 0, "the viewer's page is missing",
                "a locograph built with -DLOCOGRAPH_VIEWER=ON");
  }
  std::string page = read_file(file);
  const std::string begin = "<script type=\"application/json\" id=\"locograph-scene\">";
  const std::size_t at = page.find(begin + "{}</script>");
  if (at == std::string::npos) {
    throw Error(file.string(), 0, "no place for a scene", begin + "{}</script>");
  }
  std::string text;
  // Inside a script element no < may stand that could end it or begin another; in JSON it is only
  // ever part of a string, where it can be written as its number.
  for (const char c : scene.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return page.replace(at + begin.size(), 2, text);
}

}  // namespace locograph
