#include <locograph/robots/urdf_reader.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace locograph {
namespace {

constexpr double kCapsuleTolerance = 1e-4;  // m; public URDFs round the ends to six digits

/// A sphere not yet used, of the radius of the cylinder and centred at `centre`, or -1.
int end_sphere(const std::vector<CollisionShape>& shapes, const std::vector<bool>& used,
               double radius, const Eigen::Vector3d& centre, int other) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const bool matches =
        shapes[i].type == ShapeType::kSphere && !used[i] && static_cast<int>(i) != other &&
        std::abs(shapes[i].radius - radius) < kCapsuleTolerance &&
        (shapes[i].link_from_shape.translation() - centre).norm() < kCapsuleTolerance;
    if (matches) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

std::vector<CollisionShape> merge_capsules(const std::vector<CollisionShape>& shapes) {
  std::vector<bool> used(shapes.size(), false);
  std::vector<CollisionShape> merged = shapes;
  for (CollisionShape& shape : merged) {
    if (shape.type != ShapeType::kCylinder) continue;
    const Eigen::Vector3d half(0.0, 0.0, 0.5 * shape.length);
    const int top = end_sphere(shapes, used, shape.radius, shape.link_from_shape * half, -1);
    const int bottom = end_sphere(shapes, used, shape.radius, shape.link_from_shape * -half, top);
    if (top < 0 || bottom < 0) continue;
    used[static_cast<std::size_t>(top)] = used[static_cast<std::size_t>(bottom)] = true;
    shape.type = ShapeType::kCapsule;
  }
  std::vector<CollisionShape> result;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    if (!used[i]) result.push_back(merged[i]);
  }
  return result;
}

std::vector<std::filesystem::path> package_folders() {
  std::vector<std::filesystem::path> folders;
  for (const char* name : {"LOCOGRAPH_PACKAGE_PATH", "ROS_PACKAGE_PATH"}) {
    const char* told = std::getenv(name);
    std::istringstream list(told == nullptr ? "" : told);
    for (std::string folder; std::getline(list, folder, ':');) {
      while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
      if (!folder.empty()) folders.emplace_back(folder);
    }
  }
  return folders;
}

std::filesystem::path find_mesh(const std::string& reference, const std::filesystem::path& urdf) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(urdf).lexically_normal().parent_path();
  std::error_code ignored;  // as of names longer than paths may be
  const std::size_t scheme = reference.find("://");
  if (scheme == std::string::npos) {
    const fs::path file = folder / reference;
    return fs::is_regular_file(file, ignored) ? file : fs::path();
  }
  const std::string rest = reference.substr(scheme + 3);
  if (reference.starts_with("file://")) {
    return fs::is_regular_file(rest, ignored) ? fs::path(rest) : fs::path();
  }
  const std::size_t slash = rest.find('/');
  const std::string inside = slash == std::string::npos ? rest : rest.substr(slash + 1);
  const std::string package = rest.substr(0, slash);
  for (fs::path base = folder;; base = base.parent_path()) {
    for (const std::string& candidate : {rest, inside}) {
      if (fs::is_regular_file(base / candidate, ignored)) return base / candidate;
    }
    if (base == base.parent_path()) break;
  }
  for (const fs::path& told : package_folders()) {
    if (fs::is_regular_file(told / rest, ignored)) return told / rest;
    if (told.filename() == package && fs::is_regular_file(told / inside, ignored)) {
      return told / inside;
    }
  }
  return {};
}

}  // namespace locograph
