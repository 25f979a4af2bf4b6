#pragma once
/// What an XML element says of an end effector: the attributes that scenarios and contacts files
/// share.
///
///     const ContactKind kind = read_contact_kind(xml, element);
///     std::set<std::string> allowed = effector_attributes(kind);
///     allowed.insert({"kind", "position", "mu"});
///     xml.allow(element, allowed, {});
///     EndEffector foot = read_effector(xml, element, kind);
///     foot.friction = read_positive(xml, element, "mu", ranges::kFriction);

#include <locograph/common/ranges.h>
#include <locograph/robots/contact.h>
#include <locograph/robots/xml_file.h>

#include <set>
#include <string>

namespace locograph {

/// `kind`: a name of the table of kinds (robots/contact_kinds).
ContactKind read_contact_kind(const XmlFile& xml, const XmlFile::Element& element);

/// link, point, max_force and what the kind has beside them: link_normal and link_forward, sizes,
/// max_moment. Friction has other names in other files.
std::set<std::string> effector_attributes(ContactKind kind);

/// These attributes. Throws Error with the line for one that is missing or out of range; the link
/// is not looked for.
EndEffector read_effector(const XmlFile& xml, const XmlFile::Element& element, ContactKind kind);

/// Three numbers within ±1e6: a place [m] or a direction.
Eigen::Vector3d read_vector(const XmlFile& xml, const XmlFile::Element& element, const char* name);

/// `rpy` as in URDF; without the attribute, none.
Eigen::Matrix3d read_rotation(const XmlFile& xml, const XmlFile::Element& element);
/// `position` and `rpy`, each of them optional.
Eigen::Isometry3d read_pose(const XmlFile& xml, const XmlFile::Element& element);

/// A number from `least`, or, where that is 0, above it, to `most`.
double read_positive(const XmlFile& xml, const XmlFile::Element& element, const char* name,
                     double most, double least = 0.0);
/// The size of a contact or of an end effector.
double read_size(const XmlFile& xml, const XmlFile::Element& element, const char* name);

/// Runs f; what it throws is the element's mistake.
template <class F>
void blame(const XmlFile& xml, const XmlFile::Element& element, F&& f) {
  try {
    f();
  } catch (const Error& error) {
    throw xml.error(element, error.what(), "");
  }
}

}  // namespace locograph
