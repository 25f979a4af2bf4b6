// Mesh files of the three kinds, where they are looked for, and covers that are kept for later.
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/robots/covering_capsules.h>
#include <locograph/robots/fit_cache.h>
#include <locograph/robots/mesh_file.h>
#include <locograph/robots/urdf_reader.h>
#include <locograph/robots/visual_model.h>
#include <sys/stat.h>

#include <cstdlib>

#include "robots/robot_test_support.h"

namespace locograph::test {
namespace {

/// Two triangles of two materials in the plane z = 0, one moved by its node, in a unit of metres.
std::string dae(const std::string& unit, const std::string& up = "Y_UP") {
  const auto geometry = [](const std::string& name) {
    return "<geometry id='" + name + "'><mesh><source id='" + name + "-p'><float_array id='" +
           name +
           "-a' count='9'>0 0 0 1 0 0 0 2 0</float_array>"
           "<technique_common><accessor source='#" +
           name +
           "-a' count='3' stride='3'><param name='X' type='float'/><param name='Y' type='float'/>"
           "<param name='Z' type='float'/></accessor></technique_common></source><vertices id='" +
           name + "-v'><input semantic='POSITION' source='#" + name +
           "-p'/></vertices><triangles count='1' material='paint'><input semantic='VERTEX' "
           "source='#" +
           name + "-v' offset='0'/><p>0 1 2</p></triangles></mesh></geometry>";
  };
  const auto material = [](const std::string& name, const std::string& color) {
    return std::pair<std::string, std::string>(
        "<effect id='" + name + "-e'><profile_COMMON><technique sid='c'><lambert><diffuse><color>" +
            color + "</color></diffuse></lambert></technique></profile_COMMON></effect>",
        "<material id='" + name + "'><instance_effect url='#" + name + "-e'/></material>");
  };
  const auto node = [](const std::string& name, const std::string& paint,
                       const std::string& moved) {
    return "<node id='n" + name + "'>" + moved + "<instance_geometry url='#" + name +
           "'><bind_material><technique_common><instance_material symbol='paint' target='#" +
           paint + "'/></technique_common></bind_material></instance_geometry></node>";
  };
  const auto red = material("red", "1 0 0 1"), blue = material("blue", "0 0 1 1");
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit name='u' meter='" +
         unit + "'/><up_axis>" + up + "</up_axis></asset><library_effects>" + red.first +
         blue.first + "</library_effects><library_materials>" + red.second + blue.second +
         "</library_materials><library_geometries>" + geometry("a") + geometry("b") +
         "</library_geometries><library_visual_scenes><visual_scene id='s'>" +
         node("a", "red", "") + node("b", "blue", "<translate>0 0 3</translate>") +
         "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
         "</COLLADA>";
}

Eigen::AlignedBox3d bounds_of(const std::vector<Eigen::Vector3d>& corners) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& corner : corners) box.extend(corner);
  return box;
}

TEST(MeshFile, ColladaIsInMetresAndAsItsFileHasIt) {
  const TemporaryFolder folder;
  for (const std::string up : {"X_UP", "Y_UP", "Z_UP"}) {
    const std::vector<Eigen::Vector3d> corners =
        mesh_triangles(folder.write("a.dae", dae("0.001", up)));
    ASSERT_EQ(corners.size(), 6U);
    EXPECT_TRUE(bounds_of(corners).max().isApprox(Eigen::Vector3d(1e-3, 2e-3, 3e-3), 1e-6))
        << up << ' ' << bounds_of(corners).max().transpose();
    EXPECT_LT(bounds_of(corners).min().norm(), 1e-9);
  }
  EXPECT_NEAR(bounds_of(mesh_triangles(folder.write("B.DAE", dae("1")))).max().z(), 3.0, 1e-6);
}

TEST(MeshFile, PartsHaveTheColoursOfTheirMaterials) {
  const TemporaryFolder folder;
  const std::vector<MeshPart> parts = mesh_parts(folder.write("a.dae", dae("1")));
  ASSERT_EQ(parts.size(), 2U);
  ASSERT_TRUE(parts[0].color && parts[1].color);
  EXPECT_EQ(*parts[0].color + *parts[1].color, Eigen::Vector4d(1.0, 0.0, 1.0, 2.0));

  folder.write("paint.mtl", "newmtl green\nKd 0 1 0\n");
  const std::vector<MeshPart> object =
      mesh_parts(folder.write("a.obj",
                              "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\n"
                              "usemtl green\nf 1 2 3 4\n"));
  ASSERT_EQ(object.size(), 1U);
  EXPECT_EQ(object[0].corners.size(), 6U);  // a square is two triangles
  EXPECT_EQ(*object[0].color, Eigen::Vector4d(0.0, 1.0, 0.0, 1.0));
}

TEST(MeshFile, RefusesWhatIsNoMesh) {
  const TemporaryFolder folder;
  const std::string whole = dae("1");
  EXPECT_THROW(mesh_triangles(folder.file("none.dae")), Error);
  EXPECT_THROW(mesh_triangles(folder.path()), Error);
  EXPECT_THROW(mesh_triangles(folder.write("cut.dae", whole.substr(0, whole.size() / 2))), Error);
  EXPECT_THROW(mesh_triangles(folder.write("text.dae", "hello")), Error);
  EXPECT_THROW(mesh_triangles(folder.write("empty.obj", "")), Error);
  EXPECT_THROW(mesh_triangles(folder.write("points.obj", "v 0 0 0\nv 1 0 0\n")), Error);
  EXPECT_THROW(mesh_triangles(folder.write("beyond.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n")), Error);
  EXPECT_THROW(mesh_triangles(folder.write("a.ply", "ply\n")), Error);
  // Materials in a pipe that nobody writes to are none.
  ASSERT_EQ(mkfifo((folder.path() / "paint.mtl").c_str(), 0600), 0);
  EXPECT_EQ(mesh_triangles(folder.write("pipe.obj",
                                        "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                                        "f 1 2 3\n"))
                .size(),
            3U);
  EXPECT_FALSE(is_mesh_file("a.ply"));
  EXPECT_TRUE(is_mesh_file("a.STL"));
}

/// The variable for as long as it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() {
    if (before_) {
      setenv(name_, before_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(FindMesh, LooksBesideTheUrdfThenWherePackagesAreSaidToBe) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "elsewhere/robot/meshes");
  std::filesystem::create_directories(folder.path() / "there/urdf");
  const std::filesystem::path far = folder.write("elsewhere/robot/meshes/a.stl", "");
  const std::filesystem::path urdf = folder.path() / "there/urdf/robot.urdf";
  const std::string reference = "package://robot/meshes/a.stl";
  EXPECT_EQ(find_mesh(reference, urdf), std::filesystem::path());
  {
    const Variable told("ROS_PACKAGE_PATH",
                        "/nowhere:" + (folder.path() / "elsewhere").string() + "/");
    EXPECT_EQ(find_mesh(reference, urdf), far);
  }
  const Variable told("LOCOGRAPH_PACKAGE_PATH", (folder.path() / "elsewhere/robot").string());
  EXPECT_EQ(find_mesh(reference, urdf), far);
  EXPECT_EQ(find_mesh("package://other/meshes/a.stl", urdf), std::filesystem::path());
  std::filesystem::create_directories(folder.path() / "there/meshes");
  const std::filesystem::path near = folder.write("there/meshes/a.stl", "");
  EXPECT_EQ(find_mesh(reference, urdf), near);
}

TEST(FitCache, KeepsFitsToTheBitAndDoesNotBelieveFilesThatAreBroken) {
  const TemporaryFolder folder;
  const Variable cache("LOCOGRAPH_CACHE", (folder.path() / "cache").string());
  const std::vector<Eigen::Vector3d> corners = {{0.1, 0.2, 1.0 / 3.0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Capsule> capsules = {{{0.1, -1.0 / 7.0, 1e-300}, {0, 2, 3}, 1.0 / 3.0}};
  const MeshFitOptions options;
  EXPECT_FALSE(cached_fit(corners, options));
  cache_fit(corners, options, capsules);
  const auto known = cached_fit(corners, options);
  ASSERT_TRUE(known && known->size() == 1);
  EXPECT_EQ((*known)[0].from, capsules[0].from);
  EXPECT_EQ((*known)[0].to, capsules[0].to);
  EXPECT_EQ((*known)[0].radius, capsules[0].radius);
  EXPECT_FALSE(cached_fit(corners, {.max_shapes = 3}));
  std::vector<Eigen::Vector3d> others = corners;
  others[0].z() = std::nextafter(others[0].z(), 1.0);
  EXPECT_FALSE(cached_fit(others, options));

  const auto entry = std::filesystem::directory_iterator(folder.path() / "cache")->path();
  const std::string text = read_file(entry, 1 << 20);
  for (const std::string& broken :
       {text.substr(0, text.size() - 5), std::string("1\nnan\n"), std::string("-1"), std::string(),
        std::string("999999999\n"), "1\n7ff8000000000000 0 0 0 0 0 0\nend\n" + std::string()}) {
    folder.write("cache/" + entry.filename().string(), broken);
    EXPECT_FALSE(cached_fit(corners, options)) << broken;
  }
  const Variable none("LOCOGRAPH_CACHE", "");
  cache_fit(corners, options, capsules);
  EXPECT_FALSE(cached_fit(corners, options));
}

TEST(Visuals, OfMeshesAreColouredByTheirMaterialsWhereTheUrdfSaysNothing) {
  const TemporaryFolder folder;
  folder.write("a.dae", dae("1"));
  const auto visuals = [&](const std::string& material) {
    return load_visuals(Robot::load(
        folder.write("r.urdf",
                     "<robot name='r'><link name='a'><visual><geometry><mesh filename='a.dae'/>"
                     "</geometry>" +
                         material + "</visual></link></robot>")));
  };
  EXPECT_EQ(visuals("").size(), 2U);
  EXPECT_EQ(visuals("").front().mesh_part, 0);
  const std::vector<VisualShape> own =
      visuals("<material name='m'><color rgba='0.5 0.5 0 1'/></material>");
  ASSERT_EQ(own.size(), 1U);
  EXPECT_EQ(own[0].color, Eigen::Vector4d(0.5, 0.5, 0.0, 1.0));
  folder.write("a.dae", "broken");
  EXPECT_FALSE(missing_meshes(visuals("")).empty());
}

}  // namespace
}  // namespace locograph::test
