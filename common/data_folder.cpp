#include <locograph/common/data_folder.h>
#include <locograph/common/error.h>

#include <cstdlib>
#include <system_error>

namespace locograph {
namespace {

std::filesystem::path running_program() {
  std::error_code failed;
  return std::filesystem::read_symlink("/proc/self/exe", failed);
}

bool holds_data(const std::filesystem::path& folder) {
  std::error_code failed;
  return std::filesystem::is_directory(folder / "robots/models", failed);
}

}  // namespace

std::optional<std::filesystem::path> find_data_folder() {
  if (const char* told = std::getenv("LOCOGRAPH_DATA"); told != nullptr && *told != '\0') {
    if (holds_data(told)) return told;
    return std::nullopt;
  }
  for (std::filesystem::path folder = running_program().parent_path();
       !folder.empty() && folder != folder.parent_path(); folder = folder.parent_path()) {
    if (holds_data(folder / "share/locograph")) return folder / "share/locograph";
  }
  return std::nullopt;
}

std::filesystem::path data_folder() {
  if (const auto found = find_data_folder()) return *found;
  throw Error(running_program().string(), 0, "the data folder is missing",
              "share/locograph/robots/models beside the program's folder, or LOCOGRAPH_DATA");
}

}  // namespace locograph
