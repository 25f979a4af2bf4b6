#include <locograph/planners/scenario/effector_element.h>
#include <locograph/robots/contact_kinds.h>

#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

double read_field(const XmlFile& xml, const XmlFile::Element& element, const EffectorField& field) {
  using Zero = EffectorField::Zero;
  if (field.zero == Zero::kWhenLeftOut && element.Attribute(field.attribute) == nullptr) return 0.0;
  if (field.zero != Zero::kAllowed) {
    return read_positive(xml, element, field.attribute, field.most, field.least);
  }
  const double value = xml.number(element, field.attribute);
  if (value >= 0.0 && value <= field.most) return value;
  throw xml.error(element, std::string(field.attribute) + " is " + short_text(value),
                  "zero or more, at most " + short_text(field.most));
}

}  // namespace

ContactKind read_contact_kind(const XmlFile& xml, const XmlFile::Element& element) {
  const std::string word = xml.attribute(element, "kind");
  const std::optional<ContactKind> kind = contact_kind_of(word);
  if (!kind) {
    throw xml.error(element, "unknown kind of contact '" + word + "'", contact_kind_names());
  }
  return *kind;
}

std::set<std::string> effector_attributes(ContactKind kind) {
  const ContactKindEntry& entry = contact_kind_entry(kind);
  std::set<std::string> names = {"link", "point", "max_force"};
  if (entry.axes_on_link) names.insert({"link_normal", "link_forward"});
  for (const EffectorField& field : entry.fields) {
    if (field.value != &EndEffector::friction) names.insert(field.attribute);
  }
  return names;
}

EndEffector read_effector(const XmlFile& xml, const XmlFile::Element& element, ContactKind kind) {
  const auto vector = [&](const char* name, Eigen::Vector3d& out) {
    if (element.Attribute(name) != nullptr) out = read_vector(xml, element, name);
  };
  EndEffector effector;
  effector.kind = kind;
  effector.link = xml.attribute(element, "link");
  vector("point", effector.point);
  vector("link_normal", effector.normal);
  vector("link_forward", effector.forward);
  effector.max_force_N = read_positive(xml, element, "max_force", ranges::kForce_N);
  for (const EffectorField& field : contact_kind_entry(kind).fields) {
    const bool read_elsewhere =
        field.value == &EndEffector::max_force_N || field.value == &EndEffector::friction;
    if (!read_elsewhere) effector.*field.value = read_field(xml, element, field);
  }
  return effector;
}

Eigen::Vector3d read_vector(const XmlFile& xml, const XmlFile::Element& element, const char* name) {
  const std::vector<double> numbers = xml.numbers(element, name, 3);
  for (const double number : numbers) {
    if (std::abs(number) <= ranges::kCoordinate_m) continue;
    throw xml.error(element, std::string(name) + "=\"" + xml.attribute(element, name) + "\"",
                    "numbers up to " + short_text(ranges::kCoordinate_m));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

Eigen::Matrix3d read_rotation(const XmlFile& xml, const XmlFile::Element& element) {
  if (element.Attribute("rpy") == nullptr) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d rpy = read_vector(xml, element, "rpy");
  return (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Isometry3d read_pose(const XmlFile& xml, const XmlFile::Element& element) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = read_rotation(xml, element);
  if (element.Attribute("position") != nullptr) {
    pose.translation() = read_vector(xml, element, "position");
  }
  return pose;
}

double read_positive(const XmlFile& xml, const XmlFile::Element& element, const char* name,
                     double most, double least) {
  const double value = xml.number(element, name);
  if (value > 0.0 && value >= least && value <= most) return value;
  const std::string from = least > 0.0 ? "from " + short_text(least) : "> 0";
  throw xml.error(element, std::string(name) + " is " + short_text(value),
                  "a number " + from + " to " + short_text(most));
}

double read_size(const XmlFile& xml, const XmlFile::Element& element, const char* name) {
  return read_positive(xml, element, name, ranges::kMostSize_m, ranges::kLeastSize_m);
}

}  // namespace locograph
