#include <locograph/common/atomic_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/ranges.h>
#include <locograph/common/xml_text.h>
#include <locograph/world/obstacle_way.h>
#include <tinyxml2.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <locale>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

namespace locograph {
namespace {

using tinyxml2::XMLElement;

Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  const Eigen::Quaterniond q = Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
  return q.toRotationMatrix();
}

std::string brief(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path.string()) {}

  std::vector<Obstacle> read() {
    tinyxml2::XMLDocument document;
    const std::string content = read_file(file_, kMostInputBytes, "an obstacles file");
    if (const int line = crowded_tag(content))
      fail(line, "an element with more than " + std::to_string(kMostAttributes) + " attributes",
           "those that are known");
    const tinyxml2::XMLError status = document.Parse(content.data(), content.size());
    if (status == tinyxml2::XML_ERROR_EMPTY_DOCUMENT)
      fail(0, "is empty", "an element <obstacles version=\"1\">");
    if (status != tinyxml2::XML_SUCCESS)
      fail(document.ErrorLineNum(),
           std::string("not well-formed XML (") + document.ErrorName() + ")", "well-formed XML");
    const XMLElement* root = document.RootElement();
    if (root == nullptr || std::string_view(root->Name()) != "obstacles")
      fail(root ? root->GetLineNum() : 0,
           root ? std::string("root element <") + root->Name() + ">" : "no root element",
           "<obstacles version=\"1\">");
    if (const XMLElement* second = root->NextSiblingElement())
      fail(second->GetLineNum(), std::string("second root element <") + second->Name() + ">",
           "one <obstacles>");
    only_attributes(*root, {"version"});
    const std::string version = text(*root, "version");
    if (version != "1") fail(root->GetLineNum(), "version '" + version + "'", "version 1");

    std::vector<Obstacle> obstacles;
    no_text(*root);
    for (const XMLElement* e = root->FirstChildElement(); e; e = e->NextSiblingElement())
      obstacles.push_back(obstacle(*e));
    return obstacles;
  }

 private:
  Obstacle obstacle(const XMLElement& e) {
    Obstacle out;
    const std::string_view kind = e.Name();
    if (kind == "box") {
      only_attributes(
          e, {"name", "center", "rpy", "rotation", "repeat", "appears", "vanishes", "size"});
      out.shape = Obstacle::Shape::kBox;
      const std::vector<double> extents = numbers(e, "size", 3);
      out.size = Eigen::Vector3d(extents[0], extents[1], extents[2]);
      for (const double extent : extents) require_size(e, "size", extent);
    } else if (kind == "sphere") {
      only_attributes(
          e, {"name", "center", "rpy", "rotation", "repeat", "appears", "vanishes", "radius"});
      out.shape = Obstacle::Shape::kSphere;
      out.size[0] = size(e, "radius");
    } else if (kind == "cylinder") {
      only_attributes(e, {"name", "center", "rpy", "rotation", "repeat", "appears", "vanishes",
                          "radius", "height"});
      out.shape = Obstacle::Shape::kCylinder;
      out.size[0] = size(e, "radius");
      out.size[1] = size(e, "height");
    } else {
      fail(e.GetLineNum(), "unknown element <" + std::string(kind) + ">",
           "<box>, <sphere> or <cylinder>");
    }
    if (e.Attribute("name") != nullptr) {
      out.name = text(e, "name");
      if (out.name.empty()) fail(e.GetLineNum(), "empty name", "a name, or no such attribute");
      if (!names_.insert(out.name).second)
        fail(e.GetLineNum(), "second obstacle named '" + out.name + "'", "unique names");
    }
    out.world_from_obstacle = pose(e, "center", Eigen::Matrix3d::Identity());
    key_frames(e, out);
    presence(e, out);
    if (const double speed = fastest_m_s(out); !(speed <= ranges::kObstacleSpeed_m_s))
      fail(e.GetLineNum(), "the obstacle moves at up to " + brief(speed) + " m/s",
           "at most " + brief(ranges::kObstacleSpeed_m_s) + " m/s (positions are in metres)");
    return out;
  }

  void key_frames(const XMLElement& e, Obstacle& out) const {
    double last = 0.0;
    Eigen::Matrix3d orientation = out.world_from_obstacle.linear();
    no_text(e);
    for (const XMLElement* k = e.FirstChildElement(); k; k = k->NextSiblingElement()) {
      if (std::string_view(k->Name()) != "keyframe")
        fail(k->GetLineNum(), std::string("unknown element <") + k->Name() + ">", "<keyframe>");
      only_attributes(*k, {"time", "position", "rpy", "rotation"});
      no_text(*k);
      if (const XMLElement* inner = k->FirstChildElement())
        fail(inner->GetLineNum(), std::string("unknown element <") + inner->Name() + ">",
             "an empty <keyframe>");
      KeyFrame frame;
      frame.time_s = time(*k, "time");
      if (frame.time_s <= last)
        fail(k->GetLineNum(), "key frame at " + text(*k, "time") + " s",
             "times after 0 that increase");
      frame.pose = pose(*k, "position", orientation);
      orientation = frame.pose.linear();
      last = frame.time_s;
      out.motion.push_back(frame);
    }
    if (e.Attribute("repeat") == nullptr) return;
    out.repeat_s = time(e, "repeat");
    if (out.motion.empty())
      fail(e.GetLineNum(), "repeat without a key frame", "at least one <keyframe>");
    if (out.repeat_s <= last)
      fail(e.GetLineNum(), "repeat=\"" + text(e, "repeat") + "\"",
           "a period longer than the last key frame's time");
  }

  void presence(const XMLElement& e, Obstacle& out) const {
    if (e.Attribute("appears") != nullptr) {
      out.appears_s = time(e, "appears");
      if (!(out.appears_s >= 0.0))
        fail(e.GetLineNum(), "appears=\"" + text(e, "appears") + "\"",
             "seconds from the start of the plan, 0 or more");
    }
    if (e.Attribute("vanishes") != nullptr) {
      out.vanishes_s = time(e, "vanishes");
      const double appears_s = std::max(0.0, out.appears_s);
      if (!(out.vanishes_s > appears_s))
        fail(e.GetLineNum(), "vanishes=\"" + text(e, "vanishes") + "\"",
             "seconds, later than it appears (" + brief(appears_s) + ")");
    }
  }

  Eigen::Isometry3d pose(const XMLElement& e, const char* position,
                         const Eigen::Matrix3d& default_orientation) const {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    const std::vector<double> p = numbers(e, position, 3);
    for (const double coordinate : p)
      if (!(std::abs(coordinate) <= ranges::kCoordinate_m))
        fail(e.GetLineNum(), std::string(position) + "=\"" + text(e, position) + "\"",
             "coordinates up to " + brief(ranges::kCoordinate_m) + " m");
    out.translation() = Eigen::Vector3d(p[0], p[1], p[2]);
    out.linear() = default_orientation;
    const bool has_rpy = e.Attribute("rpy") != nullptr;
    const bool has_rotation = e.Attribute("rotation") != nullptr;
    if (has_rpy && has_rotation) fail(e.GetLineNum(), "rpy and rotation", "only one of the two");
    if (has_rpy) {
      const std::vector<double> a = numbers(e, "rpy", 3);
      out.linear() = rotation_from_rpy(Eigen::Vector3d(a[0], a[1], a[2]));
    }
    if (has_rotation) {
      const std::vector<double> r = numbers(e, "rotation", 9);
      out.linear() << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
      const Eigen::Matrix3d product = out.linear() * out.linear().transpose();
      if (!product.isIdentity(1e-6) || out.linear().determinant() < 0.0)
        fail(e.GetLineNum(), "rotation is not a rotation matrix",
             "orthonormal rows, right-handed, to 1e-6");
    }
    return out;
  }

  double size(const XMLElement& e, const char* attribute) const {
    const double value = numbers(e, attribute, 1)[0];
    require_size(e, attribute, value);
    return value;
  }

  void require_size(const XMLElement& e, const char* attribute, double value) const {
    if (!(value >= ranges::kLeastSize_m && value <= ranges::kMostSize_m))
      fail(e.GetLineNum(), std::string(attribute) + "=\"" + text(e, attribute) + "\"",
           "metres from " + brief(ranges::kLeastSize_m) + " to " + brief(ranges::kMostSize_m));
  }

  double time(const XMLElement& e, const char* attribute) const {
    const double value = numbers(e, attribute, 1)[0];
    if (!(std::abs(value) <= ranges::kTime_s))
      fail(e.GetLineNum(), std::string(attribute) + "=\"" + text(e, attribute) + "\"",
           "seconds, at most " + brief(ranges::kTime_s));
    return value;
  }

  std::vector<double> numbers(const XMLElement& e, const char* attribute, std::size_t count) const {
    const std::string value = text(e, attribute);
    const std::string expected =
        count == 1 ? std::string("one finite number")
                   : std::to_string(count) + " finite numbers separated by blanks";
    const std::string what = std::string(attribute) + "=\"" + value + "\" of <" + e.Name() + ">";
    std::vector<double> out;
    std::istringstream words(value);
    words.imbue(std::locale::classic());
    std::string word;
    while (words >> word) {
      const char* begin = word.c_str() + (word.front() == '+' ? 1 : 0);
      const char* end = word.c_str() + word.size();
      double number = 0.0;
      const std::from_chars_result result = std::from_chars(begin, end, number);
      if (result.ec != std::errc() || result.ptr != end || !std::isfinite(number))
        fail(e.GetLineNum(), what + ": '" + word + "' is not a finite number", expected);
      out.push_back(number);
    }
    if (out.size() != count)
      fail(e.GetLineNum(), what + " has " + std::to_string(out.size()) + " numbers", expected);
    return out;
  }

  std::string text(const XMLElement& e, const char* attribute) const {
    const char* value = e.Attribute(attribute);
    if (value == nullptr)
      fail(e.GetLineNum(), std::string("<") + e.Name() + "> without " + attribute,
           std::string("an attribute ") + attribute);
    return value;
  }

  void only_attributes(const XMLElement& e, std::initializer_list<std::string_view> known) const {
    std::string list;
    for (std::string_view name : known) list += (list.empty() ? "" : ", ") + std::string(name);
    for (const tinyxml2::XMLAttribute* a = e.FirstAttribute(); a; a = a->Next()) {
      if (std::find(known.begin(), known.end(), std::string_view(a->Name())) == known.end())
        fail(a->GetLineNum(),
             std::string("unknown attribute ") + a->Name() + " of <" + e.Name() + ">", list);
    }
  }

  void no_text(const XMLElement& e) const {
    for (const tinyxml2::XMLNode* n = e.FirstChild(); n; n = n->NextSibling())
      if (const tinyxml2::XMLText* stray = n->ToText())
        fail(stray->GetLineNum(), std::string("text inside <") + e.Name() + ">", "elements only");
  }

  [[noreturn]] void fail(int line, const std::string& what, const std::string& expected) const {
    throw Error(file_, line, what, expected);
  }

  std::string file_;
  std::set<std::string> names_;
};

std::string number(double value) {
  char buffer[32];
  const std::to_chars_result end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17);
  return std::string(buffer, end.ptr);
}

std::string list(std::initializer_list<double> values) {
  std::string out;
  for (double value : values) {
    if (!out.empty()) out += ' ';
    out += number(value);
  }
  return out;
}

void put_pose(XMLElement& e, const char* position, const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  e.SetAttribute(position, list({p.x(), p.y(), p.z()}).c_str());
  const Eigen::Matrix3d r = pose.linear();
  const Eigen::Vector3d rpy(std::atan2(r(2, 1), r(2, 2)),
                            std::atan2(-r(2, 0), std::hypot(r(2, 1), r(2, 2))),
                            std::atan2(r(1, 0), r(0, 0)));
  if (rotation_from_rpy(rpy) == r)
    e.SetAttribute("rpy", list({rpy.x(), rpy.y(), rpy.z()}).c_str());
  else
    e.SetAttribute("rotation", list({r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0),
                                     r(2, 1), r(2, 2)})
                                   .c_str());
}

}  // namespace

std::vector<Obstacle> load_obstacles(const std::filesystem::path& path) {
  return Reader(path).read();
}

void save_obstacles(std::span<const Obstacle> obstacles, const std::filesystem::path& path) {
  tinyxml2::XMLDocument document;
  XMLElement* root = document.NewElement("obstacles");
  root->SetAttribute("version", "1");
  document.InsertEndChild(root);
  std::set<std::string> names;
  for (const Obstacle& obstacle : obstacles) {
    obstacle.validate();
    if (!obstacle.name.empty() && !names.insert(obstacle.name).second)
      throw Error("second obstacle named '" + obstacle.name + "'", "unique names");
    const char* kind = obstacle.shape == Obstacle::Shape::kBox      ? "box"
                       : obstacle.shape == Obstacle::Shape::kSphere ? "sphere"
                                                                    : "cylinder";
    XMLElement* e = root->InsertNewChildElement(kind);
    if (!obstacle.name.empty()) e->SetAttribute("name", obstacle.name.c_str());
    const Eigen::Vector3d& size = obstacle.size;
    if (obstacle.shape == Obstacle::Shape::kBox)
      e->SetAttribute("size", list({size[0], size[1], size[2]}).c_str());
    else
      e->SetAttribute("radius", number(size[0]).c_str());
    if (obstacle.shape == Obstacle::Shape::kCylinder)
      e->SetAttribute("height", number(size[1]).c_str());
    put_pose(*e, "center", obstacle.world_from_obstacle);
    if (obstacle.repeat_s > 0.0) e->SetAttribute("repeat", number(obstacle.repeat_s).c_str());
    if (std::isfinite(obstacle.appears_s))
      e->SetAttribute("appears", number(obstacle.appears_s).c_str());
    if (std::isfinite(obstacle.vanishes_s))
      e->SetAttribute("vanishes", number(obstacle.vanishes_s).c_str());
    for (const KeyFrame& frame : obstacle.motion) {
      XMLElement* k = e->InsertNewChildElement("keyframe");
      k->SetAttribute("time", number(frame.time_s).c_str());
      put_pose(*k, "position", frame.pose);
    }
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  write_file_atomically(path, printer.CStr());
}

}  // namespace locograph
