#pragma once
/// Writes a file whole or not at all: the text goes to a temporary file beside it, then is renamed.
///
///     write_file_atomically("plan.g2o", text);

#include <locograph/common/error.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>

namespace locograph {

/// Throws Error when the folder is missing or not writable; then nothing is left behind.
inline void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  std::filesystem::path temporary = path;
  temporary += ".tmp" + std::to_string(::getpid());
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      throw Error(path.string(), 0, "cannot be written", "an existing, writable folder");
    }
  }
  std::error_code failed;
  std::filesystem::rename(temporary, path, failed);
  if (failed) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw Error(path.string(), 0, "cannot be written: " + failed.message(), "a writable path");
  }
}

/// The whole content of a file. Throws Error when it cannot be read.
inline std::string read_file(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw Error(path.string(), 0, "is a folder", "a file");
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path.string(), 0, "cannot be opened", "a readable file");
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return text;
}

}  // namespace locograph
