#include <locograph/apps/csv.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/trajectory_file.h>
#include <locograph/apps/trajectory_parts.h>
#include <locograph/common/input_file.h>

#include <algorithm>
#include <iterator>

namespace locograph {
namespace {

std::vector<std::string> column_names(const Robot& robot) {
  std::vector<std::string> names = {"time_s", "segment", "stance"};
  if (robot.floating_base()) {
    for (const char* name :
         {"base_x", "base_y", "base_z", "base_qx", "base_qy", "base_qz", "base_qw"}) {
      names.emplace_back(name);
    }
  }
  for (int i = 0; i < robot.active_joint_count(); ++i) names.push_back(robot.active_joint(i).name);
  return names;
}

/// What a column of slopes is called after what it is the slope of.
constexpr char kSlopeOf[] = "d_";

std::vector<std::string> slope_names(const Robot& robot) {
  std::vector<std::string> names;
  if (robot.floating_base()) {
    for (const char* name : {"base_x", "base_y", "base_z", "base_wx", "base_wy", "base_wz"}) {
      names.push_back(std::string(kSlopeOf) + name);
    }
  }
  for (int i = 0; i < robot.active_joint_count(); ++i) {
    names.push_back(kSlopeOf + robot.active_joint(i).name);
  }
  return names;
}

bool has_slopes(const PlanFile& file) {
  return std::ranges::any_of(file.plan.slots, [&file](int slot) {
    return file.graph.vertex(VertexId<VertexConfiguration>{slot}).slopes.size() > 0;
  });
}

std::string number_text(double value) {
  FieldWriter out;
  out.number(value);
  return out.text().substr(out.text().find_first_not_of(' '));
}

std::string whole_text(int value) { return value < 0 ? "-" : std::to_string(value); }

/// Of a table what its lines that begin with `#` hold of a graph file, line by line; they are empty
/// then.
std::string take_parameters(std::string& text) {
  std::string parameters, table;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (text[at] == '#') {
      const std::size_t word = std::min(text.find_first_not_of("# \t", at), end);
      if (text.compare(word, 7, "PARAMS_") == 0) parameters.append(text, word, end - word);
    } else {
      table.append(text, at, end - at);
    }
    parameters += '\n';
    table += '\n';
    at = end + 1;
  }
  text = std::move(table);
  return parameters;
}

/// Where the columns after the stance are to be found, in the order of a VERTEX_CONFIGURATION;
/// those of slopes, all or none, are the last.
std::vector<std::size_t> columns_of(const CsvReader& reader, CsvRow head, const Robot& robot) {
  const std::vector<std::string> expected = column_names(robot);
  std::vector<std::string> slopes = slope_names(robot);
  std::vector<std::size_t> slope_columns;
  const bool sloped =
      std::ranges::find(head.fields, slopes.empty() ? "" : slopes.back()) != head.fields.end();
  if (!sloped) slopes.clear();
  for (const std::string& slope : slopes) {
    const auto found = std::ranges::find(head.fields, slope);
    if (found == head.fields.end()) {
      reader.fail(head.line, "column '" + slope + "' is missing", "slopes of all, or of none");
    }
    slope_columns.push_back(static_cast<std::size_t>(found - head.fields.begin()));
    if (slope_columns.back() < expected.size()) {
      reader.fail(head.line, "column '" + slope + "' is among the positions", "slopes after them");
    }
  }
  if (sloped) head.fields.resize(std::min(head.fields.size(), expected.size()));
  const std::size_t fixed = 3U + static_cast<std::size_t>(robot.base_configuration_size());
  for (std::size_t i = 0; i < fixed; ++i) {
    if (i < head.fields.size() && head.fields[i] == expected[i]) continue;
    reader.fail(head.line, "column " + std::to_string(i + 1) + " is not '" + expected[i] + "'",
                "the columns time_s, segment, stance, those of the base, and the joints");
  }
  const std::vector<std::string> joints(head.fields.begin() + static_cast<std::ptrdiff_t>(fixed),
                                        head.fields.end());
  std::string what, wanted;
  const std::vector<int> order = joint_order(robot, joints, what, wanted);
  if (!what.empty()) reader.fail(head.line, what, wanted);
  std::vector<std::size_t> columns;
  for (std::size_t i = 3; i < fixed; ++i) columns.push_back(i);
  columns.resize(columns.size() + order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    columns[fixed - 3 + static_cast<std::size_t>(order[i])] = fixed + i;
  }
  columns.insert(columns.end(), slope_columns.begin(), slope_columns.end());
  return columns;
}

}  // namespace

std::string trajectory_csv(const PlanFile& file, const std::filesystem::path& folder) {
  require_motion(file);
  const Robot& robot = *file.plan.robot->robot;
  std::string text =
      "# A plan of locograph: m, rad, s; the base in the world, its angular velocity along its own "
      "axes\n";
  for (const std::string& line : parameter_lines(file.graph, folder)) text += "# " + line + '\n';
  std::vector<std::string> head = column_names(robot);
  const bool sloped = has_slopes(file);
  if (sloped) std::ranges::copy(slope_names(robot), std::back_inserter(head));
  text += csv_line(head);
  const std::vector<int>& segments = file.plan.index.segment;
  for (std::size_t i = 0; i < file.plan.slots.size(); ++i) {
    const VertexConfiguration& vertex =
        file.graph.vertex(VertexId<VertexConfiguration>{file.plan.slots[i]});
    std::vector<std::string> fields = {number_text(vertex.time_s), whole_text(segments[i]),
                                       whole_text(vertex.stance_number)};
    for (const double value : vertex.state) fields.push_back(number_text(value));
    for (const double slope : vertex.slopes) fields.push_back(number_text(slope));
    // By the rule, among others that have some.
    if (sloped) fields.resize(head.size(), "-");
    text += csv_line(fields);
  }
  return text;
}

ReadTrajectory read_trajectory_csv(const std::string& file, const TypeRegistry& types) {
  std::string text = read_input(file, kMostTrajectoryBytes, "a plan as a table (.csv)");
  const std::string parameters = take_parameters(text);
  if (parameters.find("PARAMS_") == std::string::npos) {
    throw Error(file, 0, "names neither robot nor contacts",
                "lines '# PARAMS_…', as `locograph convert` writes them");
  }
  const std::filesystem::path folder = std::filesystem::weakly_canonical(file).parent_path();
  ReadTrajectory result{read_graph_text(parameters, file, folder, types), {}};
  ConfigurationReader configurations(result.graph, file);
  CsvReader reader(text, file);
  const std::optional<CsvRow> head = reader.next();
  if (!head) throw Error(file, 0, "has no table", "a line of column names");
  const std::vector<std::size_t> columns = columns_of(reader, *head, configurations.robot());
  std::vector<std::pair<std::string, int>> segments;  // and their lines
  while (const std::optional<CsvRow> row = reader.next()) {
    if (row->fields.size() != head->fields.size()) {
      reader.fail(row->line, std::to_string(row->fields.size()) + " fields",
                  std::to_string(head->fields.size()) + ", one for each column");
    }
    for (const std::string& field : row->fields) {
      if (!field.empty() && field.find_first_of(" \t") == std::string::npos) continue;
      reader.fail(row->line, "'" + field + "' in a column", "one number");
    }
    std::vector<std::string> fields = {row->fields[0], row->fields[2]};
    for (const std::size_t column : columns) fields.push_back(row->fields[column]);
    // Slopes by the rule; a "-" anywhere else is no number.
    const auto slopes = fields.begin() + 2 + configurations.robot().configuration_size();
    if (std::all_of(slopes, fields.end(), [](const auto& slope) { return slope == "-"; })) {
      fields.erase(slopes, fields.end());
    }
    configurations.add(fields, row->line);
    segments.emplace_back(row->fields[1], row->line);
  }
  if (segments.empty()) throw Error(file, head->line, "no configurations", "a row for each");
  PlanFile plan = plan_in(std::move(result.graph), file);
  const std::vector<int>& told = plan.plan.index.segment;
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (segments[i].first == whole_text(told[i])) continue;
    std::string expected = "'";
    expected += whole_text(told[i]);
    expected += "', as the lines '# PARAMS_SEGMENT' say";
    reader.fail(segments[i].second, "segment '" + segments[i].first + "'", expected);
  }
  result.graph = std::move(plan.graph);
  return result;
}

}  // namespace locograph
