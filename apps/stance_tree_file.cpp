#include <locograph/apps/json_file.h>
#include <locograph/apps/packed.h>
#include <locograph/apps/scene.h>
#include <locograph/apps/stance_tree_file.h>
#include <locograph/common/error.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace locograph {
namespace {

constexpr char kExpectedTree[] = "a tree of stances, as `locograph plan --tree` writes it";
constexpr double kFarthest_m = 1e6;
enum NodeState : std::int32_t { kFailed = 0, kFound = 1, kOnWay = 2 };

Json node_json(const StanceTreeNode& node) {
  Json contacts = Json::object();
  for (const Contact& contact : node.stance.contacts) {
    contacts[contact.name()] = vector_json(contact.position);
  }
  return {{"parent", node.parent},
          {"found", node.found},
          {"on_way", node.on_way},
          {"contacts", std::move(contacts)}};
}

/// Nothing unless it is three numbers, none beyond all distances.
std::optional<Eigen::Vector3d> point_of(const Json& json) {
  if (!json.is_array() || json.size() != 3) return {};
  Eigen::Vector3d point;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!json[i].is_number() || !(std::abs(json[i].get<double>()) <= kFarthest_m)) return {};
    point[static_cast<Eigen::Index>(i)] = json[i].get<double>();
  }
  return point;
}

/// Whether a node that was checked has the contacts of a stance.
bool is_at(const Json& node, const Stance& stance) {
  constexpr double kWritten_m = 1e-5;
  const Json& contacts = node["contacts"];
  return contacts.size() == stance.contacts.size() &&
         std::all_of(stance.contacts.begin(), stance.contacts.end(), [&](const Contact& contact) {
           const std::optional<Eigen::Vector3d> point = contacts.contains(contact.name())
                                                            ? point_of(contacts[contact.name()])
                                                            : std::nullopt;
           return point && (*point - contact.position).norm() <= kWritten_m;
         });
}

/// Nodes of a file, each checked as it is added.
class NodeReader {
 public:
  explicit NodeReader(const std::string& file) : file_(file) {}

  void add(const Json& node) {
    if (!node.is_object()) refuse("is no object", "an object with parent, found and contacts");
    const int parent = parent_of(node);
    parents_.push_back(parent);
    states_.push_back(state_of(node));
    add_centre(node, parent);
  }

  Json scene() const {
    return {{"centres", packed_floats(centres_)},
            {"parents", packed_ints(parents_)},
            {"states", packed_ints(states_)}};
  }

 private:
  [[noreturn]] void refuse(const std::string& what, const std::string& expected) const {
    throw Error(file_, 0, "node " + std::to_string(centres_.size() / 3) + ' ' + what, expected);
  }

  int parent_of(const Json& node) const {
    const Json parent = node.value("parent", Json());
    const auto count = static_cast<std::int64_t>(parents_.size());
    const bool good = parent.is_number_integer() && parent.get<std::int64_t>() >= -1 &&
                      parent.get<std::int64_t>() < count;
    if (!good) {
      refuse("has the parent " + parent.dump(), "the number of an earlier node, or -1");
    }
    return parent.get<int>();
  }

  std::int32_t state_of(const Json& node) const {
    const Json found = node.value("found", Json()), on_way = node.value("on_way", Json(false));
    if (!found.is_boolean() || !on_way.is_boolean()) {
      refuse("does not say what became of it", "found and on_way, true or false");
    }
    if (!found.get<bool>()) return kFailed;
    return on_way.get<bool>() ? kOnWay : kFound;
  }

  /// The middle of the contacts; where there are none, that of the parent's.
  void add_centre(const Json& node, int parent) {
    const Json contacts = node.value("contacts", Json());
    if (!contacts.is_object()) refuse("has no contacts", "an object of positions by name");
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const auto& [name, position] : contacts.items()) {
      const std::optional<Eigen::Vector3d> point = point_of(position);
      if (!point) refuse("has the contact " + name + " at " + position.dump(), "[x, y, z]");
      sum += *point / static_cast<double>(contacts.size());
    }
    for (int i = 0; i < 3; ++i) {
      const bool inherits = contacts.empty() && parent >= 0;
      centres_.push_back(inherits ? centres_[static_cast<std::size_t>(3 * parent + i)]
                                  : static_cast<float>(sum[i]));
    }
  }

  std::string file_;
  std::vector<float> centres_;
  std::vector<std::int32_t> parents_, states_;
};

}  // namespace

std::string stance_tree_text(const std::string& scenario, const std::string& planner,
                             std::uint64_t seed, const StancePlan& plan) {
  const Json head = {{"scenario", scenario}, {"planner", planner}, {"seed", seed}};
  std::string text = head.dump();
  text.pop_back();
  text += ", \"nodes\": [";
  for (std::size_t i = 0; i < plan.tree.size(); ++i) {
    text += (i > 0 ? ",\n" : "\n") + node_json(plan.tree[i]).dump();
  }
  return text + "\n]}\n";
}

Json tree_scene(const std::string& file, const std::string& scenario, const Stance& first) {
  const Json tree = read_json(file, kExpectedTree);
  if (!tree.is_object() || !tree.contains("nodes") || !tree["nodes"].is_array()) {
    throw Error(file, 0, "has no nodes", kExpectedTree);
  }
  NodeReader nodes(file);
  for (const Json& node : tree["nodes"]) nodes.add(node);
  const Json of = tree.value("scenario", Json());
  if (!scenario.empty() && of != scenario) {
    throw Error(file, 0, "is a tree of the scenario " + of.dump(),
                "one of the plan's, \"" + scenario + '"');
  }
  if (std::none_of(tree["nodes"].begin(), tree["nodes"].end(),
                   [&](const Json& node) { return node["parent"] == -1 && is_at(node, first); })) {
    throw Error(file, 0, "is the tree of another plan: none of its roots is where that one starts",
                "what `locograph plan --tree` wrote with the plan");
  }
  return nodes.scene();
}

}  // namespace locograph
