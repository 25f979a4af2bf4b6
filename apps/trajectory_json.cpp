#include <locograph/apps/graph_types.h>
#include <locograph/apps/json_file.h>
#include <locograph/apps/trajectory_file.h>
#include <locograph/apps/trajectory_parts.h>
#include <locograph/check/motion_curve.h>
#include <locograph/common/input_file.h>
#include <locograph/common/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace locograph {
namespace {

using Path = std::vector<std::string>;

constexpr char kExpectedPlan[] = "a plan as JSON, as `locograph convert` writes it";

Json numbers_json(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return std::vector<double>(values.begin(), values.end());
}

const VertexConfiguration& configuration_at(const PlanFile& file, std::size_t i) {
  return file.graph.vertex(VertexId<VertexConfiguration>{file.plan.slots[i]});
}

/// A time of ROS.
Json duration_json(double time_s) {
  const double sec = std::floor(time_s);
  const auto nanosec = std::llround(1e9 * (time_s - sec));
  const auto more = nanosec / 1'000'000'000;
  return {{"sec", static_cast<long>(sec) + more}, {"nanosec", nanosec - more * 1'000'000'000}};
}

Json contact_json(const Contact& contact) {
  return {{"end_effector", contact.name()},
          {"link", contact.effector.link},
          {"kind", contact_kind_name(contact.effector.kind)},
          {"position", numbers_json(contact.position)},
          {"normal", numbers_json(contact.normal)},
          {"forward", contact.forward ? numbers_json(*contact.forward) : Json(nullptr)}};
}

/// Which stance is held from when until when, one after the other.
Json schedule_json(const PlanFile& file) {
  Json schedule = Json::array();
  const std::size_t count = file.plan.slots.size();
  for (std::size_t first = 0, last = 0; first < count; first = last) {
    const int number = configuration_at(file, first).stance_number;
    while (last < count && configuration_at(file, last).stance_number == number) ++last;
    const std::size_t end = std::min(last, count - 1);
    Json contacts = Json::array();
    if (file.plan.stance_from[first]) {
      for (const Contact& contact : file.plan.stance_from[first]->stance.contacts) {
        contacts.push_back(contact_json(contact));
      }
    }
    schedule.push_back({{"stance", number == kNoStance ? Json(nullptr) : Json(number)},
                        {"first_point", first},
                        {"last_point", end},
                        {"from_s", configuration_at(file, first).time_s},
                        {"to_s", configuration_at(file, end).time_s},
                        {"contacts", contacts}});
  }
  return schedule;
}

Json segments_json(const PlanFile& file) {
  Json segments = Json::array();
  for (const PlanSegment& segment : file.plan.segments) {
    segments.push_back({{"segment", segments.size()},
                        {"first_point", segment.first},
                        {"last_point", segment.last},
                        {"duration_s", segment.duration_s},
                        {"planner", segment.planner}});
  }
  return segments;
}

/// By end effector fx fy fz mx my mz; null: not known.
Json wrenches_json(const StanceWrenches& wrenches, const StanceParameter* stance) {
  if (wrenches.empty()) return nullptr;
  Json result = Json::object();
  for (std::size_t c = 0; c < wrenches.size(); ++c) {
    const Contact& contact = stance->stance.contacts[c];
    if (contact.bears_load) result[contact.name()] = numbers_json(wrenches[c]);
  }
  return result;
}

/// "name": [ … ], an element a line.
std::string list_text(const std::string& name, const Json& list) {
  std::string text = Json(name).dump() + ": [";
  for (const Json& element : list) {
    text += (&element == &list.front() ? "\n" : ",\n") + element.dump();
  }
  return text + "\n]";
}

/// Reads the parts of a file, each with its place for errors.
class JsonPlan {
 public:
  explicit JsonPlan(const std::string& file)
      : file_(file),
        text_(read_input(file, kMostTrajectoryBytes, kExpectedPlan)),
        root_(parse_json(text_, file, kExpectedPlan)) {
    if (!root_.is_object()) throw Error(file, 0, "is no JSON object", kExpectedPlan);
  }

  const Json& root() const { return root_; }
  const std::string& text() const { return text_; }
  int line(const Path& path) const { return json_line(text_, path); }

  [[noreturn]] void fail(const Path& path, const std::string& what,
                         const std::string& expected) const {
    std::string name;
    for (const std::string& part : path) {
      const bool number = part.find_first_not_of("0123456789") == std::string::npos;
      name += number ? '[' + part + ']' : (name.empty() ? "" : ".") + part;
    }
    throw Error(file_, line(path), name + ' ' + what, expected);
  }

  bool has(const std::string& name) const { return root_.contains(name); }

  /// A list at the top; size: that it must have, -1: any.
  const Json& list(const std::string& name, std::ptrdiff_t size = -1) const {
    if (!has(name)) fail({name}, "is missing", kExpectedPlan);
    const Json& list = root_[name];
    if (!list.is_array()) fail({name}, "is no list", "a list");
    if (size >= 0 && std::cmp_not_equal(list.size(), size)) {
      fail({name}, "has " + std::to_string(list.size()) + " elements",
           std::to_string(size) + ", one for each point");
    }
    return list;
  }

  std::string string(const Json& value, const Path& path) const {
    if (!value.is_string()) fail(path, "is no text", "a text");
    return value.get<std::string>();
  }

  double number(const Json& value, const Path& path) const {
    if (!value.is_number()) fail(path, "is " + value.dump(), "a number");
    return value.get<double>();
  }

  /// path leads to the object that holds the list.
  std::vector<double> numbers(const Json& object, const std::string& name, Path path,
                              std::size_t count) const {
    if (!object.is_object()) fail(path, "is no object", "an object with " + name);
    path.push_back(name);
    const Json list = object.value(name, Json());
    if (!list.is_array() || list.size() != count) {
      fail(path, list.is_array() ? "has " + std::to_string(list.size()) + " numbers" : "is no list",
           std::to_string(count) + " numbers");
    }
    std::vector<double> values;
    for (const Json& value : list) values.push_back(number(value, path));
    return values;
  }

  int whole(const Json& value, const Path& path, int least, int most) const {
    const bool good = value.is_number_integer() && value >= least && value <= most;
    if (!good) {
      fail(path, "is " + value.dump(),
           "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return value.get<int>();
  }

  /// Throws Error where a part that is there is not what the rest of the file makes it.
  void require_same(const std::string& name, const Json& expected) const {
    if (!has(name)) return;
    const Json& given = list(name, static_cast<std::ptrdiff_t>(expected.size()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      // Whatever the order of names.
      if (nlohmann::json(given[i]) == nlohmann::json(expected[i])) continue;
      fail({name, std::to_string(i)}, "is not what points and parameters say", expected[i].dump());
    }
  }

 private:
  std::string file_, text_;
  Json root_;
};

/// The parameters as the lines of a graph file, each in the line where it stands.
std::string parameters_text(const JsonPlan& json) {
  const Json& list = json.list("parameters");
  const std::vector<int> lines = json_lines(json.text(), "parameters");
  std::string text;
  int line = 1;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Path path = {"parameters", std::to_string(i)};
    const std::string words = json.string(list[i], path);
    if (!words.starts_with("PARAMS_") || words.find_first_of("\r\n") != std::string::npos) {
      json.fail(path, "is no parameter", "a line 'PARAMS_…' of a graph file");
    }
    const int here = i < lines.size() ? lines[i] : 0;
    for (; line < here; ++line) text += '\n';
    text += words + '\n';
    ++line;
  }
  return text;
}

/// The stance of each point in the words of a graph file.
std::vector<std::string> stances_of(const JsonPlan& json, std::size_t points) {
  const Json& list = json.list("contacts");
  std::vector<std::string> stances(points, "-");
  int first = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Path path = {"contacts", std::to_string(k)};
    if (!list[k].is_object()) json.fail(path, "is no object", "an object with a stance");
    const int begin =
        json.whole(list[k].value("first_point", Json()), {"contacts", path.back(), "first_point"},
                   k == 0 ? 0 : first + 1, k == 0 ? 0 : static_cast<int>(points) - 1);
    const Json stance = list[k].value("stance", Json());
    const std::string word =
        stance.is_null() ? "-"
                         : std::to_string(json.whole(stance, {"contacts", path.back(), "stance"}, 0,
                                                     std::numeric_limits<int>::max()));
    std::fill(stances.begin() + begin, stances.end(), word);
    first = begin;
  }
  return stances;
}

/// From `time_s` where it is there, which has all digits.
std::vector<double> times_of(const JsonPlan& json, const Json& points) {
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const Json* exact = json.has("time_s") ? &json.list("time_s", count) : nullptr;
  std::vector<double> times;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string index = std::to_string(i);
    const Path path = {"points", index, "time_from_start"};
    if (!points[i].is_object()) json.fail({"points", index}, "is no object", "an object");
    const Json from_start = points[i].value("time_from_start", Json());
    if (!from_start.is_object()) json.fail(path, "is missing", "an object of sec and nanosec");
    const double time_s = json.number(from_start.value("sec", Json()), path) +
                          1e-9 * json.number(from_start.value("nanosec", Json()), path);
    if (exact == nullptr) {
      times.push_back(time_s);
      continue;
    }
    times.push_back(json.number((*exact)[i], {"time_s", index}));
    constexpr double kRounded_s = 1e-8;
    if (!(std::abs(times.back() - times.front() - time_s) <= kRounded_s)) {
      json.fail(path, "is " + std::to_string(time_s) + " s",
                "what time_s says, " + std::to_string(times.back() - times.front()) + " s");
    }
  }
  return times;
}

/// Wrenches of each point, none where the file has none.
std::vector<StanceWrenches> wrenches_of(const JsonPlan& json, const PlanFile& plan) {
  std::vector<StanceWrenches> all;
  if (!json.has("wrenches")) return all;
  const Json& list = json.list("wrenches", static_cast<std::ptrdiff_t>(plan.plan.slots.size()));
  for (std::size_t i = 0; i < list.size(); ++i) {
    StanceWrenches& here = all.emplace_back();
    if (list[i].is_null() || !plan.plan.stance_from[i]) continue;
    const Path path = {"wrenches", std::to_string(i)};
    const std::vector<Contact>& contacts = plan.plan.stance_from[i]->stance.contacts;
    for (const auto& [name, ignored] : list[i].items()) {
      if (std::ranges::find(contacts, name, &Contact::name) != contacts.end()) continue;
      json.fail(path, "has '" + name + "', which is no contact of its stance", "its contacts");
    }
    for (const Contact& contact : contacts) {
      here.push_back(Eigen::Matrix<double, 6, 1>::Zero());
      if (!contact.bears_load) continue;
      const std::vector<double> given = json.numbers(list[i], contact.name(), path, 6);
      for (const double value : given) {
        if (std::abs(value) > ranges::kWrench) json.fail(path, "is beyond all forces", "up to 1e9");
      }
      std::ranges::copy(given, here.back().begin());
    }
  }
  return all;
}

}  // namespace

std::string trajectory_json(const PlanFile& file, const std::filesystem::path& folder) {
  require_motion(file);
  const Robot& robot = *file.plan.robot->robot;
  const Motion motion = motion_of(file.graph, file.plan);
  const MotionCurve curve(robot, motion);
  const int joints = robot.active_joint_count();
  Json names = Json::array(), points = Json::array(), bases = Json::array(),
       wrenches = Json::array();
  for (int i = 0; i < joints; ++i) names.push_back(robot.active_joint(i).name);
  for (std::size_t i = 0; i < motion.configurations.size(); ++i) {
    const Eigen::VectorXd& q = motion.configurations[i];
    const int step = static_cast<int>(i);
    const Eigen::VectorXd& velocity = curve.slope(step);
    const Eigen::VectorXd acceleration = curve.at_vertex(step).acceleration;
    points.push_back({{"positions", numbers_json(q.tail(joints))},
                      {"velocities", numbers_json(velocity.tail(joints))},
                      {"accelerations", numbers_json(acceleration.tail(joints))},
                      {"effort", Json::array()},
                      {"time_from_start", duration_json(motion.time_s[i] - motion.time_s[0])}});
    if (robot.floating_base()) {
      bases.push_back({{"position", numbers_json(q.head<3>())},
                       {"orientation", numbers_json(q.segment<4>(3))},
                       {"twist",
                        {{"linear", numbers_json(velocity.head<3>())},
                         {"angular", numbers_json(velocity.segment<3>(3))}}}});
    }
    if (!motion.wrenches.empty()) {
      wrenches.push_back(wrenches_json(motion.wrenches[i], file.plan.stance_from[i].get()));
    }
  }
  std::string text =
      "{\"header\": {\"stamp\": {\"sec\": 0, \"nanosec\": 0}, \"frame_id\": \"world\"},\n";
  // First: its lines are looked for whenever a file is read.
  text += list_text("parameters", parameter_lines(file.graph, folder)) + ",\n";
  text += "\"joint_names\": " + names.dump() + ",\n" + list_text("points", points) + ",\n";
  text += "\"time_s\": " + Json(motion.time_s).dump() + ",\n";
  if (std::ranges::any_of(motion.slopes, [](const auto& slope) { return slope.size() > 0; })) {
    Json slopes = Json::array();
    for (const Eigen::VectorXd& slope : motion.slopes) slopes.push_back(numbers_json(slope));
    text += list_text("slopes", slopes) + ",\n";
  }
  if (robot.floating_base()) text += list_text("base", bases) + ",\n";
  if (!wrenches.empty()) text += list_text("wrenches", wrenches) + ",\n";
  text += list_text("contacts", schedule_json(file)) + ",\n";
  return text + list_text("segments", segments_json(file)) + "}\n";
}

ReadTrajectory read_trajectory_json(const std::string& file, const TypeRegistry& types) {
  const JsonPlan json(file);
  const std::filesystem::path folder = std::filesystem::weakly_canonical(file).parent_path();
  ReadTrajectory result{read_graph_text(parameters_text(json), file, folder, types), {}};
  ConfigurationReader configurations(result.graph, file);
  const Robot& robot = configurations.robot();
  std::vector<std::string> names;
  for (const Json& name : json.list("joint_names")) {
    names.push_back(json.string(name, {"joint_names"}));
  }
  std::string what, expected;
  const std::vector<int> order = joint_order(robot, names, what, expected);
  if (!what.empty()) json.fail({"joint_names"}, "has " + what, expected);
  const Json& points = json.list("points");
  if (points.empty()) json.fail({"points"}, "is empty", "a point for each configuration");
  const std::vector<double> times = times_of(json, points);
  const std::vector<std::string> stances = stances_of(json, points.size());
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const Json* bases = robot.floating_base() ? &json.list("base", count) : nullptr;
  const Json* slopes = json.has("slopes") ? &json.list("slopes", count) : nullptr;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string index = std::to_string(i);
    std::vector<double> values;
    if (bases != nullptr) {
      for (const auto& [name, size] : {std::pair("position", 3U), std::pair("orientation", 4U)}) {
        const std::vector<double> part = json.numbers((*bases)[i], name, {"base", index}, size);
        values.insert(values.end(), part.begin(), part.end());
      }
    }
    const std::vector<double> given =
        json.numbers(points[i], "positions", {"points", index}, names.size());
    const std::size_t before = values.size();
    values.resize(before + given.size());
    for (std::size_t j = 0; j < given.size(); ++j) {
      values[before + static_cast<std::size_t>(order[j])] = given[j];
    }
    FieldWriter words;
    words.number(times[i]);
    words.word(stances[i]);
    for (const double value : values) words.number(value);
    if (slopes != nullptr) {
      const Json& given = (*slopes)[i];
      const Path path = {"slopes", index};
      if (!given.is_array()) json.fail(path, "is no list", "a list");
      if (!given.empty() && std::cmp_not_equal(given.size(), robot.tangent_size())) {
        json.fail(path, "has " + std::to_string(given.size()) + " numbers",
                  std::to_string(robot.tangent_size()) + ", or none");
      }
      for (const Json& slope : given) words.number(json.number(slope, path));
    }
    try {
      configurations.add({words.text()}, 0);
    } catch (const Error&) {  // again, now that somebody wants to know the line
      configurations.add({words.text()}, json.line({"points", index}));
    }
  }
  PlanFile plan = plan_in(std::move(result.graph), file);
  json.require_same("contacts", schedule_json(plan));
  json.require_same("segments", segments_json(plan));
  result.wrenches = wrenches_of(json, plan);
  result.graph = std::move(plan.graph);
  return result;
}

}  // namespace locograph
