#include <console_bridge/console.h>
#include <locograph/common/error.h>
#include <locograph/robots/urdfdom_model.h>
#include <urdf_parser/urdf_parser.h>

#include <exception>
#include <mutex>
#include <set>
#include <sstream>
#include <string>

namespace locograph {
namespace {

using tinyxml2::XMLElement;

/// Keeps what urdfdom would print.
class SilentConsole : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error.empty()) {
      first_error = text;
    }
  }
  std::string first_error;
};

std::string with_single_blanks(const std::string& text) {
  std::istringstream words(text);
  std::string result, word;
  while (words >> word) result += (result.empty() ? "" : " ") + word;
  return result;
}

/// urdfdom knows no blanks but single ones between numbers. Names stay as they are.
void tidy_numbers(XMLElement& element) {
  static const std::set<std::string> kNumbers = {
      "xyz",   "rpy",      "value",  "ixx",        "ixy",   "ixz",   "iyy",
      "iyz",   "izz",      "radius", "length",     "size",  "scale", "lower",
      "upper", "velocity", "effort", "multiplier", "offset"};
  for (const std::string& name : kNumbers) {
    const char* value = element.Attribute(name.c_str());
    if (value != nullptr) element.SetAttribute(name.c_str(), with_single_blanks(value).c_str());
  }
  for (XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    tidy_numbers(*child);
  }
}

std::string text_for_urdfdom(const XmlFile& xml) {
  tinyxml2::XMLDocument text;
  tinyxml2::XMLNode* robot = text.InsertEndChild(xml.root().ShallowClone(&text));
  for (const XMLElement& element : xml.children(xml.root())) {
    const std::string kind = element.Name();
    if (kind != "link" && kind != "joint") continue;
    tinyxml2::XMLNode* clone = robot->InsertEndChild(element.DeepClone(&text));
    while (XMLElement* visual = clone->FirstChildElement("visual")) clone->DeleteChild(visual);
    tidy_numbers(*clone->ToElement());
  }
  tinyxml2::XMLPrinter printer;
  text.Print(&printer);
  return printer.CStr();
}

}  // namespace

std::shared_ptr<const urdf::ModelInterface> urdfdom_model(const XmlFile& xml,
                                                          const std::filesystem::path& file) {
  const std::string text = text_for_urdfdom(xml);
  static std::mutex console_mutex;  // console_bridge has one output handler per process
  const std::lock_guard<std::mutex> lock(console_mutex);
  SilentConsole console;
  console_bridge::useOutputHandler(&console);
  urdf::ModelInterfaceSharedPtr model;
  std::string failure;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& exception) {
    failure = exception.what();
  }
  console_bridge::restorePreviousOutputHandler();
  if (failure.empty()) failure = console.first_error;
  if (!model || !failure.empty()) {
    throw Error(file.string(), 0, "urdfdom refuses it: " + failure, "a valid URDF");
  }
  return model;
}

}  // namespace locograph
