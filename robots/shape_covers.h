#pragma once
/// Something made of every collision shape of a robot in the shape's own frame, of equal meshes
/// once only: half a robot's legs are the same file.
///
///     ShapeCovers<std::vector<Capsule>> covers(
///         [](const CollisionShape& shape) { return covering_capsules(shape); });
///     for (const CollisionShape& shape : link.collision) {
///       for (const Capsule& c : covers.of(robot, shape)) use(shape.link_from_shape * c.from);
///     }

#include <locograph/common/error.h>
#include <locograph/robots/robot.h>

#include <array>
#include <functional>
#include <map>
#include <utility>

namespace locograph {

template <class Cover>
class ShapeCovers {
 public:
  /// make is given shapes whose link_from_shape is the identity.
  explicit ShapeCovers(std::function<Cover(const CollisionShape&)> make) : make_(std::move(make)) {}

  /// Valid until the next call. Throws Error if the shape is a mesh that was not found.
  const Cover& of(const Robot& robot, CollisionShape shape) {
    shape.link_from_shape = Eigen::Isometry3d::Identity();
    if (shape.type != ShapeType::kMesh) return last_ = make_(shape);
    if (!shape.mesh_found) {
      throw Error(robot.urdf_file().string(), shape.line,
                  "collision mesh '" + shape.mesh_file.string() + "' not found",
                  "the file below a folder above the URDF");
    }
    const Mesh mesh{shape.mesh_file, {shape.size.x(), shape.size.y(), shape.size.z()}};
    const auto found = of_mesh_.find(mesh);
    if (found != of_mesh_.end()) return found->second;
    return of_mesh_.emplace(mesh, make_(shape)).first->second;
  }

 private:
  using Mesh = std::pair<std::filesystem::path, std::array<double, 3>>;
  std::function<Cover(const CollisionShape&)> make_;
  std::map<Mesh, Cover> of_mesh_;
  Cover last_;
};

}  // namespace locograph
