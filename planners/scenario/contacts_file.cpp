#include <locograph/planners/scenario/contacts_file.h>
#include <locograph/planners/scenario/effector_element.h>
#include <locograph/robots/contact_kinds.h>

#include <map>
#include <set>
#include <string>

namespace locograph {
namespace {

using Element = XmlFile::Element;

class ContactsReader {
 public:
  /// robot: null if it is not known.
  ContactsReader(const std::filesystem::path& file, const Robot* robot)
      : robot_(robot), xml_(file, "contacts") {}

  Stance read() {
    const Element& root = xml_.root();
    xml_.allow(root, {"version", "name"}, {"contact"});
    if (const std::string version = xml_.attribute(root, "version"); version != "1") {
      throw xml_.error(root, "contacts of version '" + version + "'", "version=\"1\"");
    }
    Stance stance;
    for (const Element& element : xml_.children(root, "contact")) {
      if (stance.contacts.size() == ranges::kContacts) {
        throw xml_.error(element, "one contact more than " + std::to_string(ranges::kContacts),
                         "as many as a robot has use for");
      }
      stance.contacts.push_back(read_contact(element));
      if (robot_ == nullptr) {
        blame(xml_, element, [&] { require_directions(stance.contacts.back()); });
        continue;
      }
      // Whatever contradicts the contacts before is this one's mistake.
      blame(xml_, element, [&] { require_sound_stance(*robot_, all_loaded(stance)); });
    }
    if (robot_ != nullptr) blame(xml_, root, [&] { require_sound_stance(*robot_, stance); });
    return stance;
  }

 private:
  /// What can be told without the robot.
  static void require_directions(const Contact& contact) {
    if (contact_kind_entry(contact.effector.kind).axes_on_link) axes_in_link(contact.effector);
    require_sound_place(contact);
  }

  static Stance all_loaded(Stance stance) {
    for (Contact& contact : stance.contacts) contact.bears_load = true;
    return stance;
  }

  Contact read_contact(const Element& element) {
    const ContactKind kind = read_contact_kind(xml_, element);
    std::set<std::string> allowed = effector_attributes(kind);
    allowed.insert({"kind", "position", "normal", "forward", "load"});
    const bool has_friction = contact_kind_entry(kind).has_friction();
    if (has_friction) allowed.insert("mu");
    xml_.allow(element, allowed, {});

    Contact contact;
    contact.effector = read_effector(xml_, element, kind);
    if (has_friction) {
      contact.effector.friction = read_positive(xml_, element, "mu", ranges::kFriction);
    }
    const int before = of_link_[contact.effector.link]++;
    if (before > 0) {
      contact.effector.name = contact.effector.link + "_" + std::to_string(before + 1);
    }
    contact.position = read_vector(xml_, element, "position");
    contact.normal = read_vector(xml_, element, "normal");
    if (element.Attribute("forward") != nullptr) {
      contact.forward = read_vector(xml_, element, "forward");
    }
    if (element.Attribute("load") != nullptr) {
      const std::string load = xml_.attribute(element, "load");
      if (load != "yes" && load != "no") {
        throw xml_.error(element, "load is '" + load + "'", "yes or no");
      }
      contact.bears_load = load == "yes";
    }
    return contact;
  }

  const Robot* robot_;
  XmlFile xml_;
  std::map<std::string, int> of_link_;
};

}  // namespace

Stance load_contacts(const std::filesystem::path& file, const Robot& robot) {
  return ContactsReader(file, &robot).read();
}

Stance load_contacts(const std::filesystem::path& file) {
  return ContactsReader(file, nullptr).read();
}

}  // namespace locograph
