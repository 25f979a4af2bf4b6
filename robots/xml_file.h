#pragma once
/// An XML file in memory whose elements know their line, for URDF and SRDF; errors name file and
/// line.
///
///     const locograph::XmlFile xml("robot.urdf", "robot");
///     for (const tinyxml2::XMLElement& link : xml.children(xml.root(), "link")) {
///       std::string name = xml.attribute(link, "name");
///     }

#include <locograph/common/error.h>
#include <tinyxml2.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace locograph {

/// Files of robots have up to 200 kB.
constexpr std::uintmax_t kMostXmlBytes = std::uintmax_t{4} << 20;

class XmlFile {
 public:
  using Element = tinyxml2::XMLElement;

  /// Throws Error if the file is missing, not a regular file of at most kMostXmlBytes, empty, not
  /// XML, or its root element is not <root_name>.
  XmlFile(const std::filesystem::path& file, const std::string& root_name);

  const Element& root() const { return *document_.RootElement(); }
  /// The children called `name`, in order; all child elements if name is null.
  std::vector<std::reference_wrapper<const Element>> children(const Element& parent,
                                                              const char* name = nullptr) const;
  /// The value of an attribute that must be there, not empty, and without control characters.
  std::string attribute(const Element& element, const char* name) const;
  /// Exactly `count` finite numbers separated by blanks.
  std::vector<double> numbers(const Element& element, const char* name, int count) const;
  /// One finite number.
  double number(const Element& element, const char* name) const;
  /// One number > 0.
  double positive(const Element& element, const char* name) const;
  /// Throws Error for an attribute or a child that is not named here, most likely a misspelling,
  /// and for text, which nobody would read.
  void allow(const Element& element, const std::set<std::string>& attributes,
             const std::set<std::string>& children) const;
  Error error(const Element& element, const std::string& what, const std::string& expected) const;

 private:
  const char* value_of(const Element& element, const char* name) const;

  std::string file_;
  tinyxml2::XMLDocument document_;
};

}  // namespace locograph
