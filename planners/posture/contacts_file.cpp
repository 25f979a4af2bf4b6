#include <locograph/planners/posture/contacts_file.h>
#include <locograph/robots/xml_file.h>

#include <map>
#include <set>
#include <string>

namespace locograph {
namespace {

using Element = XmlFile::Element;

class ContactsReader {
 public:
  ContactsReader(const std::filesystem::path& file, const Robot& robot)
      : robot_(robot), xml_(file, "contacts") {}

  std::vector<PlacedContact> read() const {
    const Element& root = xml_.root();
    xml_.allow(root, {"version", "name"}, {"contact"});
    if (const std::string version = xml_.attribute(root, "version"); version != "1") {
      throw xml_.error(root, "contacts of version '" + version + "'", "version=\"1\"");
    }
    std::vector<PlacedContact> contacts;
    for (const Element& element : xml_.children(root, "contact")) {
      contacts.push_back(read_contact(element));
      // Whatever contradicts the contacts before is this one's mistake.
      with_line(element, [&] { require_sound_contacts(robot_, all_loaded(contacts)); });
    }
    with_line(root, [&] { require_sound_contacts(robot_, contacts); });
    return contacts;
  }

 private:
  template <class F>
  void with_line(const Element& element, F&& f) const {
    try {
      f();
    } catch (const Error& error) {
      throw xml_.error(element, error.what(), "");
    }
  }

  static std::vector<PlacedContact> all_loaded(std::vector<PlacedContact> contacts) {
    for (PlacedContact& contact : contacts) contact.bears_load = true;
    return contacts;
  }

  PlacedContact read_contact(const Element& element) const {
    static const std::map<std::string, WrenchKind> kKinds = {{"surface", WrenchKind::kSurface},
                                                             {"point", WrenchKind::kPoint},
                                                             {"rung", WrenchKind::kRung}};
    const std::string kind = xml_.attribute(element, "kind");
    if (!kKinds.contains(kind)) {
      throw xml_.error(element, "unknown kind of contact '" + kind + "'", "surface, point or rung");
    }
    PlacedContact placed;
    ContactDescription& contact = placed.contact;
    contact.kind = kKinds.at(kind);
    std::set<std::string> allowed = {"kind",   "link",    "point", "position",
                                     "normal", "forward", "load",  "max_force"};
    if (contact.kind == WrenchKind::kSurface) allowed.insert({"half_x", "half_y"});
    allowed.insert(contact.kind == WrenchKind::kRung ? "max_moment" : "mu");
    if (contact.kind != WrenchKind::kPoint) allowed.insert({"link_normal", "link_forward"});
    xml_.allow(element, allowed, {});

    contact.link = xml_.attribute(element, "link");
    contact.point = vector(element, "point", Eigen::Vector3d::Zero());
    contact.normal = vector(element, "link_normal", Eigen::Vector3d::UnitZ());
    contact.forward = vector(element, "link_forward", Eigen::Vector3d::UnitX());
    contact.max_force_N = xml_.positive(element, "max_force");
    if (contact.kind == WrenchKind::kRung) {
      contact.max_moment_Nm = xml_.number(element, "max_moment");
      if (contact.max_moment_Nm < 0.0) {
        throw xml_.error(element, "max_moment is " + std::to_string(contact.max_moment_Nm),
                         "zero or more");
      }
    } else {
      contact.mu = xml_.positive(element, "mu");
    }
    if (contact.kind == WrenchKind::kSurface) {
      contact.half_x_m = xml_.positive(element, "half_x");
      contact.half_y_m = xml_.positive(element, "half_y");
    }
    placed.position = vector(element, "position");
    placed.normal = vector(element, "normal");
    if (element.Attribute("forward") != nullptr) placed.forward = vector(element, "forward");
    if (element.Attribute("load") != nullptr) {
      const std::string load = xml_.attribute(element, "load");
      if (load != "yes" && load != "no") {
        throw xml_.error(element, "load is '" + load + "'", "yes or no");
      }
      placed.bears_load = load == "yes";
    }
    return placed;
  }

  Eigen::Vector3d vector(const Element& element, const char* name) const {
    const std::vector<double> numbers = xml_.numbers(element, name, 3);
    return {numbers[0], numbers[1], numbers[2]};
  }
  Eigen::Vector3d vector(const Element& element, const char* name,
                         const Eigen::Vector3d& otherwise) const {
    return element.Attribute(name) == nullptr ? otherwise : vector(element, name);
  }

  const Robot& robot_;
  XmlFile xml_;
};

}  // namespace

std::vector<PlacedContact> load_contacts(const std::filesystem::path& file, const Robot& robot) {
  return ContactsReader(file, robot).read();
}

}  // namespace locograph
