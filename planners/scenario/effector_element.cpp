#include <locograph/planners/scenario/effector_element.h>

#include <cmath>
#include <cstdio>

namespace locograph {
namespace {

bool has_axes(ContactKind kind) {
  return kind == ContactKind::kSurface || kind == ContactKind::kGrasp;
}

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

ContactKind read_contact_kind(const XmlFile& xml, const XmlFile::Element& element) {
  const std::string word = xml.attribute(element, "kind");
  const std::optional<ContactKind> kind = contact_kind_of(word);
  if (!kind) {
    throw xml.error(element, "unknown kind of contact '" + word + "'",
                    "surface, point, rung or wheel");
  }
  return *kind;
}

std::set<std::string> effector_attributes(ContactKind kind) {
  std::set<std::string> names = {"link", "point", "max_force"};
  if (has_axes(kind)) names.insert({"link_normal", "link_forward"});
  if (kind == ContactKind::kSurface) names.insert({"half_x", "half_y"});
  if (kind == ContactKind::kPoint || kind == ContactKind::kWheel) names.insert("radius");
  if (kind == ContactKind::kGrasp) names.insert("max_moment");
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
  if (kind == ContactKind::kSurface) {
    effector.half_x_m = read_size(xml, element, "half_x");
    effector.half_y_m = read_size(xml, element, "half_y");
  }
  if (kind == ContactKind::kWheel || element.Attribute("radius") != nullptr) {
    effector.radius_m = read_size(xml, element, "radius");
  }
  if (kind == ContactKind::kGrasp) {
    effector.max_moment_Nm = xml.number(element, "max_moment");
    if (!(effector.max_moment_Nm >= 0.0 && effector.max_moment_Nm <= ranges::kMoment_Nm)) {
      throw xml.error(element, "max_moment is " + short_text(effector.max_moment_Nm),
                      "zero or more, at most " + short_text(ranges::kMoment_Nm));
    }
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
