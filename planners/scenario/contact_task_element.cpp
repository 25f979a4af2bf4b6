#include <locograph/common/suggestion.h>
#include <locograph/planners/scenario/contact_task_element.h>
#include <locograph/planners/scenario/effector_element.h>
#include <locograph/robots/contact_kinds.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace locograph {
namespace {

using Element = XmlFile::Element;

class ContactTaskReader {
 public:
  ContactTaskReader(const XmlFile& xml, const std::vector<EndEffector>& end_effectors)
      : xml_(xml), end_effectors_(end_effectors) {}

  std::optional<ContactTask> read() const {
    const auto starts = xml_.children(xml_.root(), "start");
    const auto goals = xml_.children(xml_.root(), "goal");
    if (starts.empty() && goals.empty()) return std::nullopt;
    if (starts.empty()) throw xml_.error(goals.front(), "a <goal> without a <start>", "both");
    if (goals.empty()) throw xml_.error(starts.front(), "a <start> without a <goal>", "both");
    if (starts.size() > 1) throw xml_.error(starts[1], "a second <start>", "one");

    const Element& start = starts.front();
    ContactTask task;
    xml_.allow(start, {"base"}, {"joint", "contact"});
    if (start.Attribute("base") != nullptr) task.base = read_base(start);
    task.joints = read_joints(start);
    task.start = read_stance(start);
    task.start_line = start.GetLineNum();
    for (const Element& goal : goals) {
      xml_.allow(goal, {}, {"contact"});
      task.goals.push_back(read_stance(goal));
      task.goal_lines.push_back(goal.GetLineNum());
    }
    return task;
  }

 private:
  Eigen::Matrix<double, 7, 1> read_base(const Element& start) const {
    constexpr double kNearOne = 1e-3;
    const std::vector<double> numbers = xml_.numbers(start, "base", 7);
    Eigen::Matrix<double, 7, 1> base =
        Eigen::Map<const Eigen::Matrix<double, 7, 1>>(numbers.data());
    const std::string given = "base=\"" + xml_.attribute(start, "base") + "\"";
    if (!(base.head<3>().cwiseAbs().maxCoeff() <= ranges::kCoordinate_m)) {
      throw xml_.error(start, given, "coordinates up to 1e+06");
    }
    const double norm = base.tail<4>().norm();
    if (!(std::abs(norm - 1.0) <= kNearOne)) {
      throw xml_.error(start, given, "x y z qx qy qz qw, the quaternion of length 1");
    }
    base.tail<4>() /= norm;
    return base;
  }

  std::vector<GivenJoint> read_joints(const Element& start) const {
    std::vector<GivenJoint> joints;
    std::set<std::string> names;
    for (const Element& joint : xml_.children(start, "joint")) {
      xml_.allow(joint, {"name", "position"}, {});
      const std::string name = xml_.attribute(joint, "name");
      if (!names.insert(name).second) {
        throw xml_.error(joint, "a second position of joint '" + name + "'", "each joint once");
      }
      const double position = xml_.number(joint, "position");
      if (!(std::abs(position) <= ranges::kJoint_rad)) {
        throw xml_.error(joint, "position=\"" + xml_.attribute(joint, "position") + "\"",
                         "a number up to 1e+06, either sign");
      }
      joints.push_back({name, position, joint.GetLineNum()});
    }
    return joints;
  }

  Stance read_stance(const Element& parent) const {
    Stance stance;
    for (const Element& element : xml_.children(parent, "contact")) {
      if (stance.contacts.size() == ranges::kContacts) {
        throw xml_.error(element, "one contact more than " + std::to_string(ranges::kContacts),
                         "as many as a robot has use for");
      }
      Contact contact = read_contact(element);
      for (const Contact& other : stance.contacts) {
        if (other.effector.name != contact.effector.name) continue;
        throw xml_.error(element, "a second contact of '" + contact.effector.name + "'",
                         "each end effector once in a stance");
      }
      stance.contacts.push_back(std::move(contact));
    }
    if (stance.contacts.empty()) {
      throw xml_.error(parent, "a <" + std::string(parent.Name()) + "> without contacts",
                       "one <contact> or more");
    }
    return stance;
  }

  Contact read_contact(const Element& element) const {
    xml_.allow(element, {"end_effector", "position", "normal", "forward"}, {});
    Contact contact;
    contact.effector = end_effector(element);
    const ContactKindEntry& kind = contact_kind_entry(contact.effector.kind);
    contact.position = read_vector(xml_, element, "position");
    contact.normal = read_vector(xml_, element, "normal");
    if (element.Attribute("forward") != nullptr) {
      contact.forward = read_vector(xml_, element, "forward");
    } else if (!kind.forward_needed.empty()) {
      throw xml_.error(element, "contact of " + contact.effector.name + " without forward",
                       "forward=\"…\": a direction " + kind.forward_needed);
    }
    contact.locked = kind.rolls;
    blame(xml_, element, [&] { axes_in_world(contact); });
    return contact;
  }

  const EndEffector& end_effector(const Element& element) const {
    const std::string name = xml_.attribute(element, "end_effector");
    const auto found = std::find_if(end_effectors_.begin(), end_effectors_.end(),
                                    [&](const EndEffector& one) { return one.name == name; });
    if (found != end_effectors_.end()) return *found;
    std::vector<std::string> names;
    for (const EndEffector& one : end_effectors_) names.push_back(one.name);
    throw xml_.error(element, "unknown end effector '" + name + "'",
                     names.empty() ? "one of <end_effectors>, which has none"
                                   : "one of " + joined_names(names) + did_you_mean(name, names));
  }

  const XmlFile& xml_;
  const std::vector<EndEffector>& end_effectors_;
};

}  // namespace

std::optional<ContactTask> read_contact_task(const XmlFile& xml,
                                             const std::vector<EndEffector>& end_effectors) {
  return ContactTaskReader(xml, end_effectors).read();
}

}  // namespace locograph
