#include <locograph/apps/type_names.h>

#include <cmath>

namespace locograph {

const char* type_name(JointType type) {
  switch (type) {
    case JointType::kFixed:
      return "fixed";
    case JointType::kRevolute:
      return "revolute";
    case JointType::kContinuous:
      return "continuous";
    case JointType::kPrismatic:
      return "prismatic";
  }
  return "";
}

const char* type_name(ShapeType type) {
  switch (type) {
    case ShapeType::kSphere:
      return "sphere";
    case ShapeType::kCapsule:
      return "capsule";
    case ShapeType::kCylinder:
      return "cylinder";
    case ShapeType::kBox:
      return "box";
    case ShapeType::kMesh:
      return "mesh";
  }
  return "";
}

const char* type_name(Obstacle::Shape shape) {
  switch (shape) {
    case Obstacle::Shape::kBox:
      return "box";
    case Obstacle::Shape::kSphere:
      return "sphere";
    case Obstacle::Shape::kCylinder:
      return "cylinder";
  }
  return "";
}

Json limit_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace locograph
