#include <fcntl.h>
#include <locograph/common/error.h>
#include <locograph/common/file_descriptor.h>
#include <locograph/common/input_file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>

namespace locograph {
namespace {

struct OpenedInput {
  FileDescriptor file;
  std::uintmax_t size = 0;  ///< as the file system tells it, 0 for a pipe
};

std::string kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

OpenedInput open_input(const std::filesystem::path& path, bool pipes, std::string_view expected) {
  // Without O_NONBLOCK the open itself would wait for a writer to the pipe.
  OpenedInput opened{FileDescriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK))};
  struct stat status = {};
  if (!opened.file.is_open() || ::fstat(opened.file.get(), &status) != 0) {
    throw Error(path.string(), 0, "cannot be opened: " + errno_text(errno), std::string(expected));
  }
  if (!S_ISREG(status.st_mode) && !(pipes && S_ISFIFO(status.st_mode))) {
    const std::string regular = S_ISDIR(status.st_mode) ? "" : ", a regular file";
    throw Error(path.string(), 0, "is " + kind_of(status.st_mode), std::string(expected) + regular);
  }
  ::fcntl(opened.file.get(), F_SETFL, O_RDONLY);  // from here on a pipe is waited for
  opened.size = S_ISREG(status.st_mode) ? static_cast<std::uintmax_t>(status.st_size) : 0;
  return opened;
}

/// At most limit bytes. size: about how many are there, 0 if unknown.
std::string read_up_to(std::uintmax_t limit, std::uintmax_t size, int file,
                       const std::string& name) {
  constexpr std::uintmax_t kPiece = 1 << 16;
  std::string text;
  std::size_t filled = 0;
  while (filled < limit) {
    if (filled == text.size()) {
      // One byte more than the size: the read after the last one finds the end in place.
      const std::uintmax_t wanted = std::max({size + 1, kPiece, std::uintmax_t{2} * filled});
      text.resize(static_cast<std::size_t>(std::min(wanted, limit)));
    }
    const ssize_t count = ::read(file, text.data() + filled, text.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error(name, 0, "cannot be read: " + errno_text(errno), "a readable file");
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  text.resize(filled);
  return text;
}

std::string read_whole(std::uintmax_t max_bytes, std::uintmax_t size, int file,
                       const std::string& name) {
  const auto refuse = [&](const std::string& found) {
    throw Error(name, 0, "has " + found + " bytes", "at most " + std::to_string(max_bytes));
  };
  if (size > max_bytes) refuse(std::to_string(size));
  std::string text = read_up_to(max_bytes + 1, size, file, name);
  if (text.size() > max_bytes) refuse("more than " + std::to_string(max_bytes));
  return text;
}

}  // namespace

std::string read_file(const std::filesystem::path& path, std::uintmax_t max_bytes,
                      std::string_view expected) {
  const OpenedInput opened = open_input(path, false, expected);
  return read_whole(max_bytes, opened.size, opened.file.get(), path.string());
}

std::string read_input(const std::filesystem::path& path, std::uintmax_t max_bytes,
                       std::string_view expected) {
  if (path == "-") return read_whole(max_bytes, 0, STDIN_FILENO, "standard input");
  const OpenedInput opened = open_input(path, true, expected);
  return read_whole(max_bytes, opened.size, opened.file.get(), path.string());
}

std::string file_beginning(const std::filesystem::path& path, std::size_t max_bytes,
                           std::string_view expected) {
  const OpenedInput opened = open_input(path, false, expected);
  return read_up_to(max_bytes, opened.size, opened.file.get(), path.string());
}

std::string errno_text(int error) {
  std::string text = std::generic_category().message(error);
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

}  // namespace locograph
