#include <locograph/apps/about_file.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/plan_file.h>
#include <locograph/common/data_folder.h>
#include <locograph/plugins/configuration/plan_parameters.h>

#include <algorithm>
#include <memory>

namespace locograph {

Plan plan_of_file(const Graph& graph, const std::string& file) {
  return about_file(file, [&] { return plan_of(graph); });
}

PlanFile plan_in(Graph graph, const std::string& file) {
  PlanFile result;
  result.name = file;
  result.graph = std::move(graph);
  result.plan = plan_of_file(result.graph, file);
  return result;
}

PlanFile load_plan(const std::string& file, const std::vector<std::string>& plugins) {
  return plan_in(read_input_graph(file, graph_types(plugins)), input_name(file));
}

void require_plan(const Plan& plan, const std::string& file) {
  if (plan.recorded) throw Error(file, 0, "is the record of a plan carried out", "a plan");
}

void require_increasing_times(const PlanFile& file) {
  const auto time_s = [&file](int slot) {
    return file.graph.vertex(VertexId<VertexConfiguration>{slot}).time_s;
  };
  for (std::size_t i = 1; i < file.plan.slots.size(); ++i) {
    const int before = file.plan.slots[i - 1], here = file.plan.slots[i];
    if (time_s(here) > time_s(before)) continue;
    throw Error(
        file.name,
        std::max(file.graph.vertex_record(before).line, file.graph.vertex_record(here).line),
        "two configurations at " + std::to_string(time_s(here)) + " s", "times that increase");
  }
}

std::vector<std::filesystem::path> files_of(const PlanFile& file) {
  std::vector<std::filesystem::path> files = {file.plan.robot->urdf, file.plan.robot->srdf};
  if (file.plan.world) {
    const WorldFiles& named = file.plan.world->snapshot->files();
    files.insert(files.end(), {named.map, named.obstacles});
  }
  const Parameters& parameters = file.graph.parameters();
  if (const auto origin = parameters.find<ScenarioParameter>();
      origin && origin->scenario.find('/') != std::string::npos) {
    files.emplace_back(origin->scenario);
  }
  if (const auto contacts = parameters.find<ContactsParameter>()) files.push_back(contacts->file);
  if (const auto record = parameters.find<RecordParameter>()) files.push_back(record->plan);
  return files;
}

void add_world_options(OptionParser& parser, WorldOptions& options) {
  parser.add_option("--map", options.map, "OctoMap, instead of what the plan says is in the way");
  parser.add_option("--obstacles", options.obstacles,
                    "Obstacle file (.xml), also moving ones; may go with --map");
}

Judging judging_of(const PlanFile& file, const WorldOptions& options) {
  const JudgingRequest request{.scenario = options.scenario,
                               .map = options.map,
                               .obstacles = options.obstacles,
                               .data_folder = data_folder()};
  return about_file(file.name, [&] { return judging_of(file.graph, file.plan, request); });
}

CheckReport check_plan(const PlanFile& file, const Judging& judging) {
  return about_file(file.name, [&] { return judged(file.graph, file.plan, judging); });
}

}  // namespace locograph
