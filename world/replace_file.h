#pragma once
/// Writes a file so that nobody ever sees half of it: a temporary file beside it, then a rename.
///
///     locograph::replace_file("map.bt", [&](std::ostream& out) { tree.writeBinary(out); });
///
/// Throws Error when the folder or the file cannot be written; the old file then stays as it was.

#include <locograph/common/error.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <ostream>
#include <system_error>

namespace locograph {

inline void replace_file(const std::filesystem::path& path,
                         const std::function<void(std::ostream&)>& write) {
  std::filesystem::path temporary = path;
  temporary += ".partial";
  std::error_code ignored;
  try {
    std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
    if (!out) throw Error(path.string(), 0, "cannot be written", "a writable folder");
    write(out);
    out.close();
    if (!out) throw Error(path.string(), 0, "writing failed", "enough space");
    std::error_code failure;
    std::filesystem::rename(temporary, path, failure);
    if (failure)
      throw Error(path.string(), 0, "cannot be replaced: " + failure.message(), "a plain file");
  } catch (...) {
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

}  // namespace locograph
