#include <locograph/common/error.h>
#include <locograph/robots/body_inertia.h>
#include <locograph/robots/mimic_joints.h>
#include <locograph/robots/names.h>
#include <locograph/robots/urdf_reader.h>
#include <locograph/robots/urdfdom_model.h>
#include <locograph/robots/xml_file.h>
#include <urdf_model/model.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace locograph {
namespace {

using Element = XmlFile::Element;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostShapes = 2000;

/// The structure of a URDF, checked: urdfdom reads the values but knows neither lines nor most
/// mistakes.
class UrdfStructure {
 public:
  explicit UrdfStructure(const XmlFile& xml) : xml_(xml) {
    read_links();
    read_joints();
    find_root();
  }

  /// Link names, depth first.
  const std::vector<std::string>& order() const { return order_; }
  const Element& link(const std::string& name) const { return *links_.at(name); }
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// The <joint> above a link, null for the root.
  const Element* parent_joint(const std::string& link) const {
    const auto found = parent_joint_.find(link);
    return found == parent_joint_.end() || link == order_[0] ? nullptr : found->second;
  }

 private:
  void read_links() {
    for (const Element& link : xml_.children(xml_.root(), "link")) {
      const std::string name = xml_.attribute(link, "name");
      if (!links_.emplace(name, &link).second) {
        throw xml_.error(link, "second link '" + name + "'", "a name of its own for each link");
      }
      if (links_.size() > kMostLinks) {
        throw xml_.error(link, "more than " + std::to_string(kMostLinks) + " links",
                         "a robot of fewer links");
      }
      shapes_ += xml_.children(link, "collision").size();
      if (shapes_ > kMostShapes) {
        throw xml_.error(link, "more than " + std::to_string(kMostShapes) + " collision shapes",
                         "fewer of them, or meshes");
      }
      for (const char* kind : {"collision", "visual"}) {
        for (const Element& shape : xml_.children(link, kind)) check_geometry(shape, name);
      }
      check_numbers(link);
      if (const Element* inertial = link.FirstChildElement("inertial")) {
        check_inertial(*inertial, name);
      }
    }
    if (links_.empty()) throw xml_.error(xml_.root(), "no <link>", "at least one link");
  }

  void check_geometry(const Element& shape, const std::string& link) const {
    const Element* geometry = shape.FirstChildElement("geometry");
    const Element* kind = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    const std::string name = kind == nullptr ? "" : kind->Name();
    if (!is_geometry(name)) {
      const std::string found = name.empty() ? "no geometry" : "unknown geometry <" + name + ">";
      throw xml_.error(kind == nullptr ? shape : *kind,
                       "link '" + link + "' has a <" + shape.Name() + "> with " + found,
                       "sphere, cylinder, box or mesh");
    }
    if (shape.Name() == std::string("collision")) check_single(shape, *geometry, link);
    if (name == "mesh") xml_.attribute(*kind, "filename");
    if (name == "sphere" || name == "cylinder") check_positive(*kind, "radius", 1);
    if (name == "cylinder") check_positive(*kind, "length", 1);
    if (name == "box") check_positive(*kind, "size", 3);
  }

  static bool is_geometry(const std::string& name) {
    return name == "sphere" || name == "cylinder" || name == "box" || name == "mesh";
  }

  /// Of several, all but the first would be lost.
  void check_single(const Element& shape, const Element& geometry, const std::string& link) const {
    const auto kinds = xml_.children(geometry);
    const auto count = std::count_if(kinds.begin(), kinds.end(),
                                     [](const Element& kind) { return is_geometry(kind.Name()); });
    if (count == 1 && geometry.NextSiblingElement("geometry") == nullptr) return;
    throw xml_.error(shape, "link '" + link + "' has a <collision> with more than one geometry",
                     "a <collision> for each");
  }

  void check_inertial(const Element& inertial, const std::string& link) {
    const Element* mass = inertial.FirstChildElement("mass");
    const Element* inertia = inertial.FirstChildElement("inertia");
    if (mass == nullptr || inertia == nullptr) {
      throw xml_.error(
          inertial,
          "link '" + link + "' has an <inertial> without " + (mass == nullptr ? "mass" : "inertia"),
          "<mass value> and <inertia ixx ixy ixz iyy iyz izz>, or no <inertial>");
    }
    if (xml_.numbers(*mass, "value", 1)[0] < 0.0) {
      throw xml_.error(*mass, "link '" + link + "' has a negative mass", "0 kg or more");
    }
    // Read before it is filled: Eigen aborts where an exception leaves a matrix half filled.
    const auto entry = [&](const char* name) { return xml_.numbers(*inertia, name, 1)[0]; };
    const double xx = entry("ixx"), xy = entry("ixy"), xz = entry("ixz"), yy = entry("iyy"),
                 yz = entry("iyz"), zz = entry("izz");
    Eigen::Matrix3d matrix;
    matrix << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    if (is_inertia_of_a_body(matrix)) return;
    warn(*inertia, "link '" + link + "' has an inertia that no body has",
         "principal moments of which none is below zero or above the sum of the other two");
  }

  void warn(const Element& element, const std::string& what, const std::string& expected) {
    warnings_.push_back(xml_.error(element, what, expected).what());
  }

  void check_positive(const Element& element, const char* name, int count) const {
    for (const double value : xml_.numbers(element, name, count)) {
      if (value <= 0.0) {
        throw xml_.error(element,
                         "<" + std::string(element.Name()) + "> with " + name + "=\"" +
                             element.Attribute(name) + "\"",
                         "a positive " + std::string(name));
      }
    }
  }

  void check_numbers(const Element& parent) const {
    static const std::map<std::string, std::vector<std::pair<const char*, int>>> kNumbers = {
        {"origin", {{"xyz", 3}, {"rpy", 3}}},
        {"axis", {{"xyz", 3}}},
        {"mass", {{"value", 1}}},
        {"inertia", {{"ixx", 1}, {"ixy", 1}, {"ixz", 1}, {"iyy", 1}, {"iyz", 1}, {"izz", 1}}},
        {"limit", {{"lower", 1}, {"upper", 1}, {"effort", 1}, {"velocity", 1}}},
        {"mimic", {{"multiplier", 1}, {"offset", 1}}},
        {"mesh", {{"scale", 3}}}};
    for (const Element& child : xml_.children(parent)) {
      const auto known = kNumbers.find(child.Name());
      if (known != kNumbers.end()) {
        for (const auto& [attribute, count] : known->second) {
          if (child.Attribute(attribute) != nullptr) xml_.numbers(child, attribute, count);
        }
      }
      check_numbers(child);
    }
  }

  void read_joints() {
    for (const Element& joint : xml_.children(xml_.root(), "joint")) {
      const std::string name = xml_.attribute(joint, "name");
      if (!joints_.emplace(name, &joint).second) {
        throw xml_.error(joint, "second joint '" + name + "'", "a name of its own for each joint");
      }
      check_type(joint, name);
      check_numbers(joint);
      const std::string parent = end_link(joint, name, "parent");
      const std::string child = end_link(joint, name, "child");
      if (!parent_joint_.emplace(child, &joint).second) {
        throw xml_.error(joint, "link '" + child + "' has a second parent, joint '" + name + "'",
                         "one joint above each link");
      }
      children_[parent].push_back(child);
    }
  }

  void check_type(const Element& joint, const std::string& name) {
    const std::string type = xml_.attribute(joint, "type");
    if (type == "revolute" || type == "prismatic") {
      const Element* limit = joint.FirstChildElement("limit");
      if (limit == nullptr) {
        throw xml_.error(joint, type + " joint '" + name + "' has no <limit>",
                         "<limit lower upper velocity effort>");
      }
      const double lower = position_limit(*limit, "lower"), upper = position_limit(*limit, "upper");
      if (lower > upper) {
        throw xml_.error(*limit, "joint '" + name + "' has its lower limit above the upper one",
                         "lower <= upper, either of which is 0 where it is not given");
      }
      const bool given =
          limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
      if (!given) {
        warn(*limit, "joint '" + name + "' cannot move: both of its limits are 0, as none is given",
             "lower and upper");
      }
    } else if (type != "fixed" && type != "continuous" && type != "floating") {
      throw xml_.error(joint, "joint '" + name + "' has unknown type '" + type + "'",
                       "fixed, revolute, continuous, prismatic, or floating below the root link");
    }
    if (const Element* limit = joint.FirstChildElement("limit")) {
      for (const char* needed : {"velocity", "effort"}) xml_.number(*limit, needed);
    }
    if (const Element* mimic = joint.FirstChildElement("mimic")) xml_.attribute(*mimic, "joint");
    const Element* axis = joint.FirstChildElement("axis");
    if (type != "fixed" && type != "floating" && axis != nullptr) {
      const std::vector<double> xyz = xml_.numbers(*axis, "xyz", 3);
      if (Eigen::Vector3d(xyz[0], xyz[1], xyz[2]).norm() < 1e-9) {
        throw xml_.error(*axis, "joint '" + name + "' has a zero axis", "a direction");
      }
    }
  }

  double position_limit(const Element& limit, const char* name) const {
    return limit.Attribute(name) == nullptr ? 0.0 : xml_.number(limit, name);
  }

  std::string end_link(const Element& joint, const std::string& name, const char* end) const {
    const Element* element = joint.FirstChildElement(end);
    if (element == nullptr) {
      throw xml_.error(joint, "joint '" + name + "' has no <" + end + ">",
                       "<" + std::string(end) + " link=\"...\">");
    }
    const std::string link = xml_.attribute(*element, "link");
    if (!links_.contains(link)) {
      throw xml_.error(*element, "joint '" + name + "' names unknown link '" + link + "'",
                       similar_names(link, link_names()));
    }
    return link;
  }

  std::vector<std::string> link_names() const {
    std::vector<std::string> names;
    for (const auto& [name, element] : links_) names.push_back(name);
    return names;
  }

  void find_root() {
    std::vector<std::string> roots;
    for (const Element& link : xml_.children(xml_.root(), "link")) {
      const std::string name = link.Attribute("name");
      if (!parent_joint_.contains(name)) roots.push_back(name);
    }
    if (roots.empty()) {
      throw xml_.error(xml_.root(), "no root link", "one link that is no joint's child");
    }
    if (roots.size() > 1) {
      throw xml_.error(link(roots[1]), "two root links, '" + roots[0] + "' and '" + roots[1] + "'",
                       "one link that is no joint's child");
    }
    order_from(root_below_floating_joint(roots[0]));
    const std::set<std::string> reached(order_.begin(), order_.end());
    for (const auto& [name, element] : links_) {
      if (!reached.contains(name) && name != roots[0]) {
        throw xml_.error(*element, "link '" + name + "' is part of a loop",
                         "a tree of links and joints");
      }
    }
  }

  std::string root_below_floating_joint(const std::string& root) const {
    const auto children = children_.find(root);
    for (const auto& [name, joint] : joints_) {
      if (joint->Attribute("type") != std::string("floating")) continue;
      const bool below_root = children != children_.end() && children->second.size() == 1 &&
                              joint->FirstChildElement("parent")->Attribute("link") == root;
      if (!below_root) {
        throw xml_.error(*joint, "joint '" + name + "' has type 'floating'",
                         "a floating joint only as the one joint below the root link");
      }
      if (link(root).FirstChildElement("inertial") || link(root).FirstChildElement("collision")) {
        throw xml_.error(link(root), "link '" + root + "' above the floating base has a body",
                         "neither <inertial> nor <collision>");
      }
    }
    if (children == children_.end() || children->second.size() != 1) return root;
    const std::string& child = children->second[0];
    const bool floating = parent_joint_.at(child)->Attribute("type") == std::string("floating");
    return floating ? child : root;
  }

  void order_from(const std::string& root) {
    std::vector<std::string> waiting = {root};
    while (!waiting.empty()) {
      order_.push_back(waiting.back());
      waiting.pop_back();
      const auto children = children_.find(order_.back());
      if (children == children_.end()) continue;
      waiting.insert(waiting.end(), children->second.rbegin(), children->second.rend());
    }
  }

  const XmlFile& xml_;
  std::map<std::string, const Element*> links_, joints_, parent_joint_;
  std::map<std::string, std::vector<std::string>> children_;
  std::vector<std::string> order_, warnings_;
  std::size_t shapes_ = 0;
};

Eigen::Isometry3d isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() << pose.position.x, pose.position.y, pose.position.z;
  double x = 0.0, y = 0.0, z = 0.0, w = 1.0;
  pose.rotation.getQuaternion(x, y, z, w);
  result.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  return result;
}

CollisionShape convert(const urdf::Collision& collision, int link, int line,
                       const std::filesystem::path& urdf) {
  CollisionShape shape;
  shape.link = link;
  shape.line = line;
  shape.link_from_shape = isometry(collision.origin);
  const urdf::Geometry& geometry = *collision.geometry;
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      shape.type = ShapeType::kSphere;
      shape.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::CYLINDER:
      shape.type = ShapeType::kCylinder;
      shape.radius = static_cast<const urdf::Cylinder&>(geometry).radius;
      shape.length = static_cast<const urdf::Cylinder&>(geometry).length;
      break;
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      shape.type = ShapeType::kBox;
      shape.size << size.x, size.y, size.z;
      break;
    }
    case urdf::Geometry::MESH: {
      const urdf::Mesh& mesh = static_cast<const urdf::Mesh&>(geometry);
      shape.type = ShapeType::kMesh;
      shape.size << mesh.scale.x, mesh.scale.y, mesh.scale.z;
      shape.mesh_file = find_mesh(mesh.filename, urdf);
      shape.mesh_found = !shape.mesh_file.empty();
      if (!shape.mesh_found) shape.mesh_file = mesh.filename;
      break;
    }
  }
  return shape;
}

Link convert(const urdf::Link& source, const XmlFile& xml, const Element& element, int index,
             const std::filesystem::path& urdf) {
  Link link;
  link.name = source.name;
  const Element* inertial_element = element.FirstChildElement("inertial");
  link.inertial_line = (inertial_element == nullptr ? element : *inertial_element).GetLineNum();
  if (source.inertial) {
    const urdf::Inertial& inertial = *source.inertial;
    const Eigen::Isometry3d origin = isometry(inertial.origin);
    Eigen::Matrix3d inertia;
    inertia << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz,
        inertial.ixz, inertial.iyz, inertial.izz;
    link.mass = inertial.mass;
    link.com = origin.translation();
    link.inertia = origin.linear() * inertia * origin.linear().transpose();
  }
  const std::vector<std::reference_wrapper<const Element>> collisions =
      xml.children(element, "collision");
  std::vector<CollisionShape> shapes;
  for (std::size_t i = 0; i < source.collision_array.size(); ++i) {
    shapes.push_back(
        convert(*source.collision_array[i], index, collisions[i].get().GetLineNum(), urdf));
  }
  link.collision_elements = static_cast<int>(shapes.size());
  link.collision = merge_capsules(shapes);
  link.visible = element.FirstChildElement("visual") != nullptr;
  return link;
}

Joint convert(const urdf::Joint& source) {
  Joint joint;
  joint.name = source.name;
  joint.parent_from_joint = isometry(source.parent_to_joint_origin_transform);
  joint.type = source.type == urdf::Joint::REVOLUTE     ? JointType::kRevolute
               : source.type == urdf::Joint::CONTINUOUS ? JointType::kContinuous
               : source.type == urdf::Joint::PRISMATIC  ? JointType::kPrismatic
                                                        : JointType::kFixed;
  if (joint.type == JointType::kFixed) return joint;
  joint.axis = Eigen::Vector3d(source.axis.x, source.axis.y, source.axis.z).normalized();
  const bool limited = joint.type != JointType::kContinuous;
  joint.lower = limited ? source.limits->lower : -kInfinity;
  joint.upper = limited ? source.limits->upper : kInfinity;
  joint.max_velocity = source.limits ? source.limits->velocity : kInfinity;
  joint.max_effort = source.limits ? source.limits->effort : kInfinity;
  return joint;
}

/// urdfdom reads XML by another parser than ours: stray characters become another name.
Error unreadable_name(const XmlFile& xml, const XmlFile::Element& element) {
  return xml.error(element,
                   "<" + std::string(element.Name()) + "> with the name '" +
                       element.Attribute("name") + "', which is not well-formed XML",
                   "a name without control characters or a bare '&'");
}

}  // namespace

UrdfModel read_urdf(const std::filesystem::path& file) {
  const XmlFile xml(file, "robot");
  const UrdfStructure structure(xml);
  const std::shared_ptr<const urdf::ModelInterface> source = urdfdom_model(xml, file);

  UrdfModel model;
  model.name = source->getName();
  model.warnings = structure.warnings();
  std::vector<MimicElement> mimics;
  std::map<std::string, int> index;
  for (const std::string& name : structure.order()) {
    const int link_index = static_cast<int>(model.links.size());
    index[name] = link_index;
    const urdf::LinkConstSharedPtr link_source = source->getLink(name);
    if (!link_source) throw unreadable_name(xml, structure.link(name));
    Link link = convert(*link_source, xml, structure.link(name), link_index, file);
    if (const Element* element = structure.parent_joint(name)) {
      const urdf::JointConstSharedPtr found = source->getJoint(element->Attribute("name"));
      if (!found) throw unreadable_name(xml, *element);
      const urdf::Joint& joint_source = *found;
      Joint joint = convert(joint_source);
      joint.parent_link = index.at(joint_source.parent_link_name);
      joint.child_link = link_index;
      link.parent_joint = static_cast<int>(model.joints.size());
      if (joint_source.mimic && joint.type != JointType::kFixed) {
        mimics.push_back({link.parent_joint, joint_source.mimic->joint_name,
                          joint_source.mimic->multiplier, joint_source.mimic->offset,
                          element->FirstChildElement("mimic")->GetLineNum()});
      }
      model.joints.push_back(joint);
      model.joint_lines.push_back(element->GetLineNum());
    }
    model.links.push_back(link);
  }
  lead_mimic_joints(model, mimics, file);
  return model;
}

}  // namespace locograph
