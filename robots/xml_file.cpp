#include <locograph/common/control_characters.h>
#include <locograph/common/input_file.h>
#include <locograph/common/xml_text.h>
#include <locograph/robots/xml_file.h>

#include <charconv>
#include <cmath>
#include <sstream>

namespace locograph {

XmlFile::XmlFile(const std::filesystem::path& file, const std::string& root_name)
    : file_(file.string()) {
  const std::string text = read_file(file, kMostXmlBytes, "an XML file");
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw Error(file_, 0, "is empty", "XML with a <" + root_name + "> element");
  }
  if (const int line = crowded_tag(text)) {
    throw Error(file_, line,
                "an element with more than " + std::to_string(kMostAttributes) + " attributes",
                "those that are known");
  }
  if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw Error(file_, document_.ErrorLineNum(), "not well-formed XML",
                "XML with a <" + root_name + "> element");
  }
  const Element* root = document_.RootElement();
  if (root == nullptr || root->Name() != root_name) {
    throw Error(
        file_, root == nullptr ? 0 : root->GetLineNum(),
        root == nullptr ? "no XML element" : "root element is <" + std::string(root->Name()) + ">",
        "<" + root_name + ">");
  }
}

std::vector<std::reference_wrapper<const XmlFile::Element>> XmlFile::children(
    const Element& parent, const char* name) const {
  std::vector<std::reference_wrapper<const Element>> result;
  for (const Element* child = parent.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    result.emplace_back(*child);
  }
  return result;
}

const char* XmlFile::value_of(const Element& element, const char* name) const {
  const char* value = element.Attribute(name);
  if (value == nullptr || *value == '\0') {
    throw error(element, "<" + std::string(element.Name()) + "> without " + name,
                "attribute " + std::string(name));
  }
  return value;
}

std::string XmlFile::attribute(const Element& element, const char* name) const {
  const std::string value = value_of(element, name);
  if (has_control_character(value)) {
    throw error(element, "a control character in " + std::string(name), "letters that can be seen");
  }
  return value;
}

std::vector<double> XmlFile::numbers(const Element& element, const char* name, int count) const {
  std::istringstream words(value_of(element, name));
  std::vector<double> values;
  std::string word;
  bool valid = true;
  while (words >> word) {
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    const char* end = word.data() + word.size();
    double value = 0.0;
    const std::from_chars_result parsed = std::from_chars(begin, end, value);
    valid = valid && parsed.ec == std::errc() && parsed.ptr == end && std::isfinite(value);
    values.push_back(value);
  }
  if (!valid || values.size() != static_cast<std::size_t>(count)) {
    throw error(element,
                "<" + std::string(element.Name()) + "> with " + name + "=\"" +
                    element.Attribute(name) + "\"",
                std::to_string(count) + (count == 1 ? " finite number" : " finite numbers"));
  }
  return values;
}

double XmlFile::number(const Element& element, const char* name) const {
  return numbers(element, name, 1).front();
}

double XmlFile::positive(const Element& element, const char* name) const {
  const double value = number(element, name);
  if (!(value > 0.0)) {
    throw error(element, std::string(name) + " is " + std::to_string(value), "a number > 0");
  }
  return value;
}

void XmlFile::allow(const Element& element, const std::set<std::string>& attributes,
                    const std::set<std::string>& children) const {
  const auto one_of = [](const std::set<std::string>& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "one of " : ", ") + word;
    return text.empty() ? "none" : text;
  };
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (!attributes.contains(a->Name())) {
      throw error(element, "unknown attribute '" + std::string(a->Name()) + "'",
                  one_of(attributes));
    }
  }
  for (const Element& child : this->children(element)) {
    if (!children.contains(child.Name())) {
      throw error(child, "unknown element <" + std::string(child.Name()) + ">", one_of(children));
    }
  }
  for (const tinyxml2::XMLNode* n = element.FirstChild(); n != nullptr; n = n->NextSibling()) {
    if (n->ToText() == nullptr) continue;
    throw Error(file_, n->GetLineNum(), "text in <" + std::string(element.Name()) + ">",
                children.empty() ? "attributes alone" : "elements alone");
  }
}

Error XmlFile::error(const Element& element, const std::string& what,
                     const std::string& expected) const {
  return Error(file_, element.GetLineNum(), what, expected);
}

}  // namespace locograph
