#include <locograph/common/data_folder.h>
#include <locograph/robots/shipped_robot.h>

#include <system_error>

namespace locograph {
namespace {

bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code failed;
  return a.empty() ? b.empty() : std::filesystem::equivalent(a, b, failed);
}

}  // namespace

std::optional<RobotFiles> shipped_robot(const std::string& name) {
  const auto data = find_data_folder();
  return data ? shipped_robot(name, *data) : std::nullopt;
}

std::optional<RobotFiles> shipped_robot(const std::string& name,
                                        const std::filesystem::path& data_folder) {
  if (name.empty() || name.find('/') != std::string::npos) return std::nullopt;
  std::error_code failed;
  const std::filesystem::path folder =
      std::filesystem::canonical(data_folder / "robots/models" / name, failed);
  RobotFiles files{folder / (name + ".urdf"), folder / (name + ".srdf")};
  if (failed || !std::filesystem::exists(files.urdf)) return std::nullopt;
  if (!std::filesystem::exists(files.srdf)) files.srdf.clear();
  return files;
}

std::string shipped_robot_name(const std::filesystem::path& urdf,
                               const std::filesystem::path& srdf) {
  const std::string name = urdf.stem();
  const auto files = shipped_robot(name);
  return files && is_one_file(urdf, files->urdf) && is_one_file(srdf, files->srdf) ? name : "";
}

}  // namespace locograph
