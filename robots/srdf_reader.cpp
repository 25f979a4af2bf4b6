#include <locograph/common/error.h>
#include <locograph/robots/names.h>
#include <locograph/robots/srdf_reader.h>
#include <locograph/robots/xml_file.h>

#include <algorithm>
#include <bitset>
#include <map>

namespace locograph {
namespace {

using Element = XmlFile::Element;

template <class Items>
std::map<std::string, int> index_by_name(const Items& items) {
  std::map<std::string, int> index;
  for (const auto& item : items) index.emplace(item.name, static_cast<int>(index.size()));
  return index;
}

std::vector<std::string> keys(const std::map<std::string, int>& index) {
  std::vector<std::string> names;
  for (const auto& [name, position] : index) names.push_back(name);
  return names;
}

constexpr std::size_t kMostSuggestions = 32;  // looking for similar names takes its time
constexpr std::size_t kMostGroups = 1000;

class SrdfReader {
 public:
  SrdfReader(const std::filesystem::path& file, const UrdfModel& urdf, bool lenient)
      : xml_(file, "robot"),
        urdf_(urdf),
        lenient_(lenient),
        links_(index_by_name(urdf.links)),
        joints_(index_by_name(urdf.joints)) {}

  SrdfModel read() {
    // As Pinocchio calls the joint above a floating base, which no <virtual_joint> names there.
    if (!joints_.contains("root_joint")) virtual_joints_.insert("root_joint");
    for (const Element& joint : xml_.children(xml_.root(), "virtual_joint")) {
      attempt([&] { look_up(joint, "child_link", links_, "link"); });
      virtual_joints_.insert(xml_.attribute(joint, "name"));
    }
    read_groups();
    for (const Element& state : xml_.children(xml_.root(), "group_state")) read_state(state);
    for (const Element& element : xml_.children(xml_.root(), "disable_collisions")) {
      attempt([&] { model_.disabled.insert(link_pair(element)); });
    }
    for (const Element& element : xml_.children(xml_.root(), "enable_collisions")) {
      attempt([&] { model_.enabled.insert(link_pair(element)); });
    }
    for (const Element& element : xml_.children(xml_.root(), "disable_default_collisions")) {
      attempt([&] { model_.default_disabled.insert(look_up(element, "link", links_, "link")); });
    }
    const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
    std::sort(model_.groups.begin(), model_.groups.end(), by_name);
    std::sort(model_.states.begin(), model_.states.end(), by_name);
    return std::move(model_);
  }

 private:
  /// One flag for each joint of the URDF.
  using Joints = std::bitset<kMostLinks>;

  /// Runs `read`; an Error in it passes, or is noted if the reader is lenient.
  template <class Function>
  void attempt(const Function& read) {
    try {
      read();
    } catch (const Error& error) {
      if (!lenient_) throw;
      model_.warnings.push_back(error.what());
    }
  }

  int look_up(const Element& element, const char* attribute,
              const std::map<std::string, int>& known, const std::string& kind) const {
    const std::string name = xml_.attribute(element, attribute);
    const auto found = known.find(name);
    if (found == known.end()) {
      throw xml_.error(element, "unknown " + kind + " '" + name + "'",
                       model_.warnings.size() < kMostSuggestions ? similar_names(name, keys(known))
                                                                 : "a name of the URDF");
    }
    return found->second;
  }

  std::pair<int, int> link_pair(const Element& element) const {
    const int first = look_up(element, "link1", links_, "link");
    const int second = look_up(element, "link2", links_, "link");
    return std::minmax({first, second});
  }

  void read_groups() {
    std::map<std::string, int> names;
    std::vector<const Element*> elements;
    for (const Element& group : xml_.children(xml_.root(), "group")) {
      const std::string name = xml_.attribute(group, "name");
      if (!names.emplace(name, static_cast<int>(elements.size())).second) {
        throw xml_.error(group, "second group '" + name + "'", "a name of its own for each group");
      }
      elements.push_back(&group);
    }
    if (elements.size() > kMostGroups) {
      throw xml_.error(*elements[kMostGroups],
                       "more than " + std::to_string(kMostGroups) + " groups", "fewer groups");
    }
    group_index_ = names;
    std::vector<Group> groups;
    for (const Element* element : elements) groups.push_back(read_group(*element));
    gather(groups);
    for (const auto& [name, index] : names) {
      std::vector<int> joints;
      const Joints& of_group = groups[static_cast<std::size_t>(index)].joints;
      for (std::size_t j = 0; j < urdf_.joints.size(); ++j) {
        if (of_group[j]) joints.push_back(static_cast<int>(j));
      }
      model_.groups.push_back({name, joints});
    }
  }

  struct Group {
    const Element* element;
    Joints joints;           // its own, then those of its groups too
    std::set<int> contains;  // groups
  };

  Group read_group(const Element& element) {
    Group group{&element, {}, {}};
    for (const Element& member : xml_.children(element)) {
      const std::string kind = member.Name();
      attempt([&] {
        if (kind == "joint") {
          if (!virtual_joints_.contains(xml_.attribute(member, "name"))) {
            add(look_up(member, "name", joints_, "joint"), group.joints);
          }
        } else if (kind == "link") {
          const int link = look_up(member, "name", links_, "link");
          add(urdf_.links[static_cast<std::size_t>(link)].parent_joint, group.joints);
        } else if (kind == "chain") {
          add_chain(member, group.joints);
        } else if (kind == "group") {
          group.contains.insert(look_up(member, "name", group_index_, "group"));
        } else {
          throw xml_.error(member, "unknown member <" + kind + "> of a group",
                           "joint, link, chain or group");
        }
      });
    }
    return group;
  }

  /// Adds the joints of the groups that a group contains, each group once: those first that contain
  /// none, or only finished ones (Kahn's order).
  void gather(std::vector<Group>& groups) const {
    std::vector<std::vector<std::size_t>> part_of(groups.size());
    std::vector<std::size_t> unfinished(groups.size()), finished;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const int part : groups[g].contains)
        part_of[static_cast<std::size_t>(part)].push_back(g);
      unfinished[g] = groups[g].contains.size();
      if (unfinished[g] == 0) finished.push_back(g);
    }
    for (std::size_t next = 0; next < finished.size(); ++next) {
      for (const std::size_t whole : part_of[finished[next]]) {
        groups[whole].joints |= groups[finished[next]].joints;
        if (--unfinished[whole] == 0) finished.push_back(whole);
      }
    }
    if (finished.size() == groups.size()) return;
    // Each unfinished group contains another one: following them ends in a circle.
    const auto is_unfinished = [&](int g) { return unfinished[static_cast<std::size_t>(g)] > 0; };
    int in_circle = 0;
    while (!is_unfinished(in_circle)) ++in_circle;
    for (std::set<int> passed; passed.insert(in_circle).second;) {
      const std::set<int>& parts = groups[static_cast<std::size_t>(in_circle)].contains;
      in_circle = *std::find_if(parts.begin(), parts.end(), is_unfinished);
    }
    const Element& element = *groups[static_cast<std::size_t>(in_circle)].element;
    throw xml_.error(element, "group '" + xml_.attribute(element, "name") + "' contains itself",
                     "groups without a circle");
  }

  void add(int joint, Joints& joints) const {
    if (joint >= 0 && urdf_.joints[static_cast<std::size_t>(joint)].type != JointType::kFixed) {
      joints[static_cast<std::size_t>(joint)] = true;
    }
  }

  void add_chain(const Element& chain, Joints& joints) const {
    const int base = look_up(chain, "base_link", links_, "link");
    const int tip = look_up(chain, "tip_link", links_, "link");
    std::vector<int> between;
    for (int link = tip; link != base;) {
      const int joint = urdf_.links[static_cast<std::size_t>(link)].parent_joint;
      if (joint < 0) {
        throw xml_.error(chain,
                         "chain from '" + xml_.attribute(chain, "base_link") + "' to '" +
                             xml_.attribute(chain, "tip_link") + "'",
                         "a tip_link below the base_link");
      }
      between.push_back(joint);
      link = urdf_.joints[static_cast<std::size_t>(joint)].parent_link;
    }
    for (const int joint : between) add(joint, joints);
  }

  void read_state(const Element& element) {
    const std::string name = xml_.attribute(element, "name");
    attempt([&] { look_up(element, "group", group_index_, "group"); });
    const auto [known, is_new] = states_.emplace(name, model_.states.size());
    if (is_new) model_.states.push_back({name, {}});
    GroupState& state = model_.states[known->second];
    for (const Element& joint : xml_.children(element, "joint")) {
      if (virtual_joints_.contains(xml_.attribute(joint, "name"))) continue;
      attempt([&] {
        const int index = look_up(joint, "name", joints_, "joint");
        state.positions.emplace_back(index, xml_.numbers(joint, "value", 1)[0]);
      });
    }
  }

  XmlFile xml_;
  const UrdfModel& urdf_;
  bool lenient_;
  std::map<std::string, int> links_, joints_, group_index_;
  std::set<std::string> virtual_joints_;
  std::map<std::string, std::size_t> states_;  // into model_.states while they are read
  SrdfModel model_;
};

}  // namespace

bool SrdfModel::is_disabled(int first, int second) const {
  const std::pair<int, int> pair = std::minmax({first, second});
  const bool by_default = default_disabled.contains(first) || default_disabled.contains(second);
  return disabled.contains(pair) || (by_default && !enabled.contains(pair));
}

SrdfModel read_srdf(const std::filesystem::path& file, const UrdfModel& urdf, bool lenient) {
  return SrdfReader(file, urdf, lenient).read();
}

}  // namespace locograph
