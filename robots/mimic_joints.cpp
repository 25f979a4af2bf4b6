#include <locograph/common/error.h>
#include <locograph/robots/mimic_joints.h>
#include <locograph/robots/names.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace locograph {
namespace {

Joint& joint_at(UrdfModel& model, int joint) {
  return model.joints[static_cast<std::size_t>(joint)];
}

/// The joints that the elements name, one for each.
std::vector<int> named_leaders(const UrdfModel& model, const std::vector<MimicElement>& elements,
                               const std::string& file) {
  std::map<std::string, int> index;
  std::vector<std::string> names;
  for (const Joint& joint : model.joints) {
    index.emplace(joint.name, static_cast<int>(index.size()));
    if (joint.type != JointType::kFixed) names.push_back(joint.name);
  }
  std::vector<int> leaders;
  for (const MimicElement& element : elements) {
    const std::string what =
        "joint '" + model.joints[static_cast<std::size_t>(element.joint)].name + "' mimics ";
    const auto found = index.find(element.leader);
    if (found == index.end()) {
      throw Error(file, element.line, what + "unknown joint '" + element.leader + "'",
                  similar_names(element.leader, names));
    }
    if (model.joints[static_cast<std::size_t>(found->second)].type == JointType::kFixed) {
      throw Error(file, element.line, what + "fixed joint '" + element.leader + "'",
                  "a joint that moves");
    }
    leaders.push_back(found->second);
  }
  return leaders;
}

/// Empty if there is room, otherwise what is wrong.
std::string narrow_position(Joint& leader, const Joint& mimic) {
  if (mimic.multiplier == 0.0 || mimic.type == JointType::kContinuous) return {};
  const auto [lower, upper] = std::minmax({(mimic.lower - mimic.offset) / mimic.multiplier,
                                           (mimic.upper - mimic.offset) / mimic.multiplier});
  const double low = std::max(leader.lower, lower), high = std::min(leader.upper, upper);
  if (!(low < high)) {
    if (!(leader.lower < leader.upper)) return {};
    return "the limits of mimic joint '" + mimic.name + "' leave joint '" + leader.name +
           "', which it follows, no room to move: they are not looked at";
  }
  leader.lower = low;
  leader.upper = high;
  const bool limited = std::isfinite(low) && std::isfinite(high);
  if (leader.type == JointType::kContinuous && limited) leader.type = JointType::kRevolute;
  return {};
}

void narrow_velocity(Joint& leader, const Joint& mimic) {
  if (mimic.multiplier == 0.0 || !(mimic.max_velocity > 0.0)) return;
  leader.max_velocity =
      std::min(leader.max_velocity, mimic.max_velocity / std::abs(mimic.multiplier));
}

}  // namespace

void lead_mimic_joints(UrdfModel& model, const std::vector<MimicElement>& elements,
                       const std::filesystem::path& file) {
  const std::vector<int> leaders = named_leaders(model, elements, file.string());
  std::vector<int> element_of(model.joints.size(), -1);
  for (std::size_t e = 0; e < elements.size(); ++e) {
    element_of[static_cast<std::size_t>(elements[e].joint)] = static_cast<int>(e);
  }
  for (const MimicElement& element : elements) {
    Joint& mimic = joint_at(model, element.joint);
    int leader = element.joint;
    std::size_t passed = 0;
    for (int e = element_of[static_cast<std::size_t>(leader)]; e >= 0;
         e = element_of[static_cast<std::size_t>(leader)]) {
      const MimicElement& next = elements[static_cast<std::size_t>(e)];
      mimic.offset += mimic.multiplier * next.offset;
      mimic.multiplier *= next.multiplier;
      leader = leaders[static_cast<std::size_t>(e)];
      if (++passed > elements.size()) {
        throw Error(file.string(), element.line,
                    "joint '" + mimic.name + "' follows mimic joints that lead each other",
                    "a leader that is not a mimic joint");
      }
    }
    if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset)) {
      throw Error(file.string(), element.line,
                  "joint '" + mimic.name + "' follows its leader by a factor that is not finite",
                  "smaller multipliers and offsets");
    }
    mimic.mimics = leader;
  }
  for (const MimicElement& element : elements) {
    const Joint& mimic = joint_at(model, element.joint);
    Joint& leader = joint_at(model, mimic.mimics);
    narrow_velocity(leader, mimic);
    const std::string contradiction = narrow_position(leader, mimic);
    if (contradiction.empty()) continue;
    model.warnings.push_back(file.string() + ":" + std::to_string(element.line) + ": " +
                             contradiction);
  }
}

}  // namespace locograph
