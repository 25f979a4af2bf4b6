#include <locograph/common/error.h>
#include <locograph/robots/names.h>
#include <locograph/robots/srdf_reader.h>
#include <locograph/robots/xml_file.h>

#include <algorithm>
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

class SrdfReader {
 public:
  SrdfReader(const std::filesystem::path& file, const UrdfModel& urdf, bool lenient)
      : xml_(file, "robot"),
        urdf_(urdf),
        lenient_(lenient),
        links_(index_by_name(urdf.links)),
        joints_(index_by_name(urdf.joints)) {}

  SrdfModel read() {
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
                       similar_names(name, keys(known)));
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
    group_index_ = names;
    group_elements_ = elements;
    for (const auto& [name, index] : names) {
      std::set<int> joints;
      collect(*elements[static_cast<std::size_t>(index)], 0, joints);
      model_.groups.push_back({name, std::vector<int>(joints.begin(), joints.end())});
    }
  }

  /// Adds the movable joints of a group and of the groups it refers to.
  void collect(const Element& group, std::size_t depth, std::set<int>& joints) {
    if (depth > group_elements_.size()) {
      throw xml_.error(group, "group '" + xml_.attribute(group, "name") + "' contains itself",
                       "groups without a circle");
    }
    for (const Element& member : xml_.children(group)) {
      const std::string kind = member.Name();
      attempt([&] {
        if (kind == "joint") {
          if (!virtual_joints_.contains(xml_.attribute(member, "name"))) {
            add(look_up(member, "name", joints_, "joint"), joints);
          }
        } else if (kind == "link") {
          const int link = look_up(member, "name", links_, "link");
          add(urdf_.links[static_cast<std::size_t>(link)].parent_joint, joints);
        } else if (kind == "chain") {
          add_chain(member, joints);
        } else if (kind == "group") {
          const int index = look_up(member, "name", group_index_, "group");
          collect(*group_elements_[static_cast<std::size_t>(index)], depth + 1, joints);
        } else {
          throw xml_.error(member, "unknown member <" + kind + "> of a group",
                           "joint, link, chain or group");
        }
      });
    }
  }

  void add(int joint, std::set<int>& joints) const {
    if (joint >= 0 && urdf_.joints[static_cast<std::size_t>(joint)].type != JointType::kFixed) {
      joints.insert(joint);
    }
  }

  void add_chain(const Element& chain, std::set<int>& joints) const {
    const int base = look_up(chain, "base_link", links_, "link");
    const int tip = look_up(chain, "tip_link", links_, "link");
    std::set<int> between;
    for (int link = tip; link != base;) {
      const int joint = urdf_.links[static_cast<std::size_t>(link)].parent_joint;
      if (joint < 0) {
        throw xml_.error(chain,
                         "chain from '" + xml_.attribute(chain, "base_link") + "' to '" +
                             xml_.attribute(chain, "tip_link") + "'",
                         "a tip_link below the base_link");
      }
      add(joint, between);
      link = urdf_.joints[static_cast<std::size_t>(joint)].parent_link;
    }
    joints.insert(between.begin(), between.end());
  }

  void read_state(const Element& element) {
    const std::string name = xml_.attribute(element, "name");
    attempt([&] { look_up(element, "group", group_index_, "group"); });
    auto state = std::find_if(model_.states.begin(), model_.states.end(),
                              [&](const GroupState& other) { return other.name == name; });
    if (state == model_.states.end()) {
      state = model_.states.insert(state, GroupState{name, {}});
    }
    for (const Element& joint : xml_.children(element, "joint")) {
      if (virtual_joints_.contains(xml_.attribute(joint, "name"))) continue;
      attempt([&] {
        const int index = look_up(joint, "name", joints_, "joint");
        state->positions.emplace_back(index, xml_.numbers(joint, "value", 1)[0]);
      });
    }
  }

  XmlFile xml_;
  const UrdfModel& urdf_;
  bool lenient_;
  std::map<std::string, int> links_, joints_, group_index_;
  std::vector<const Element*> group_elements_;
  std::set<std::string> virtual_joints_;
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
