#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/stl_file.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <system_error>

namespace locograph {
namespace {

constexpr std::uintmax_t kMostMeshBytes = std::uintmax_t{512} << 20;

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

MeshPart part_of(const aiMesh& mesh, const aiScene& scene) {
  MeshPart part;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;  // points and lines
    for (unsigned c = 0; c < 3; ++c) {
      const aiVector3D& corner = mesh.mVertices[face.mIndices[c]];
      part.corners.emplace_back(corner.x, corner.y, corner.z);
    }
  }
  aiColor4D color;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS) {
    part.color = Eigen::Vector4d(color.r, color.g, color.b, color.a).cwiseMax(0.0).cwiseMin(1.0);
    // Alpha is not always written, and then often 0.
    if (part.color->w() == 0.0) part.color->w() = 1.0;
  }
  return part;
}

/// Nothing but regular files: a pipe that a mesh names as its materials would never end.
class RegularFiles final : public Assimp::DefaultIOSystem {
 public:
  bool Exists(const char* file) const override {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
  }
};

std::vector<MeshPart> import(const std::filesystem::path& file) {
  file_beginning(file, 1, "a mesh");  // throws what is no regular file
  if (std::filesystem::file_size(file) > kMostMeshBytes) {
    throw Error(file.string(), 0, "a mesh of more than 512 MB", "a smaller one");
  }
  Assimp::Importer importer;
  importer.SetIOHandler(new RegularFiles);  // which it deletes
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    throw Error(file.string(), 0, std::string("an unreadable mesh: ") + importer.GetErrorString(),
                "COLLADA or Wavefront OBJ");
  }
  std::vector<MeshPart> parts;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    MeshPart part = part_of(*scene->mMeshes[i], *scene);
    if (!part.corners.empty()) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".stl" || extension == ".dae" || extension == ".obj";
}

std::vector<MeshPart> mesh_parts(const std::filesystem::path& file) {
  if (extension_of(file) == ".stl") return {{.corners = stl_triangles(file)}};
  if (!is_mesh_file(file)) {
    throw Error(file.string(), 0, "a mesh of another kind", "STL, COLLADA (.dae) or OBJ");
  }
  std::vector<MeshPart> parts = import(file);
  std::size_t corners = 0;
  for (const MeshPart& part : parts) {
    corners += part.corners.size();
    for (const Eigen::Vector3d& corner : part.corners) {
      if (!corner.allFinite()) {
        throw Error(file.string(), 0, "a corner that is not finite", "finite coordinates");
      }
    }
  }
  if (corners == 0) throw Error(file.string(), 0, "a mesh without triangles", "triangles");
  return parts;
}

std::vector<Eigen::Vector3d> mesh_triangles(const std::filesystem::path& file) {
  std::vector<MeshPart> parts = mesh_parts(file);
  std::vector<Eigen::Vector3d> corners = std::move(parts.front().corners);
  for (std::size_t i = 1; i < parts.size(); ++i) {
    corners.insert(corners.end(), parts[i].corners.begin(), parts[i].corners.end());
  }
  return corners;
}

}  // namespace locograph
