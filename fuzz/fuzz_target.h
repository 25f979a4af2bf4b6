#pragma once
/// What the fuzz targets share. A target hands libFuzzer's bytes to one parser, which may take them
/// or refuse them with an Error that names the file; anything else is a finding.
///
///     extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
///       static locograph::MemoryFile file;
///       file.assign(data, size);
///       locograph::accept_or_refuse(file.path().string(), [] { load_obstacles(file.path()); });
///       return 0;
///     }

#include <locograph/common/error.h>
#include <locograph/common/file_descriptor.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace locograph {

/// A file that lives in memory, for parsers that take a path.
class MemoryFile {
 public:
  void assign(const std::uint8_t* data, std::size_t size) {
    const auto whole = static_cast<ssize_t>(size);
    if (::ftruncate(file_.get(), 0) != 0 || ::pwrite(file_.get(), data, size, 0) != whole) {
      std::abort();
    }
  }
  std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(file_.get()); }

 private:
  FileDescriptor file_{::memfd_create("fuzz", 0)};
};

/// A folder with files that inputs may name, kept as long as the process.
class FuzzFolder {
 public:
  FuzzFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "locograph_fuzz_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Runs the parser. file: what the message of a refusal has to begin with, unless it names another
/// file that the input asked for. Returns whether the input was taken.
template <class Parse>
bool accept_or_refuse(const std::string& file, Parse&& parse) {
  try {
    parse();
    return true;
  } catch (const Error& error) {
    if (!error.file().empty() || std::string(error.what()).starts_with(file)) return false;
    std::fprintf(stderr, "a refusal that names no file: %s\n", error.what());
    std::abort();
  }
}

}  // namespace locograph
