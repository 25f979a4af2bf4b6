#include <fcntl.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/error.h>
#include <locograph/common/file_descriptor.h>
#include <locograph/common/input_file.h>
#include <locograph/common/stop_signals.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <optional>
#include <string>

namespace locograph {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMark = ".locograph-";
constexpr std::size_t kRandomLetters = 6;
/// File names have 255 bytes at most.
constexpr std::size_t kMostOfName = 255 - 1 - kMark.size() - kRandomLetters;

/// 0, or the errno of what failed.
int write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(descriptor, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      pollfd ready = {descriptor, POLLOUT, 0};
      ::poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return errno;
    }
  }
  return 0;
}

[[noreturn]] void refuse(const std::string& name, int error) {
  std::string expected = "a writable file in a writable folder";
  if (error == ENOSPC || error == EDQUOT) expected = "room for it";
  if (error == EFBIG) expected = "a smaller file, or a higher limit";
  throw Error(name, 0, "cannot be written: " + errno_text(error), expected);
}

/// Where a path leads.
struct OutputTarget {
  fs::path asked;       ///< for errors
  fs::path path;        ///< links followed
  int descriptor = -1;  ///< of an open file of this program, written to as it stands
  bool exists = false;
  struct stat status = {};

  bool is_stream() const { return descriptor >= 0 || (exists && !S_ISREG(status.st_mode)); }
  fs::path folder() const { return path.has_parent_path() ? path.parent_path() : "."; }

  [[noreturn]] void fail(int error) const { refuse(asked.string(), error); }
};

/// The number in /dev/stdout, /dev/fd/3, /proc/self/fd/3; -1 for other paths.
int own_descriptor(const fs::path& path) {
  if (path == "-") return STDOUT_FILENO;
  std::error_code failed;
  const fs::path folder = fs::canonical(path.has_parent_path() ? path.parent_path() : ".", failed);
  if (failed || folder != "/proc/" + std::to_string(::getpid()) + "/fd") return -1;
  const std::string name = path.filename();
  int number = -1;
  const auto parsed = std::from_chars(name.data(), name.data() + name.size(), number);
  return parsed.ec == std::errc() && parsed.ptr == name.data() + name.size() ? number : -1;
}

OutputTarget target_of(const fs::path& asked) {
  constexpr int kMostLinks = 40;
  OutputTarget target{asked, asked};
  for (int links = 0;; ++links) {
    target.descriptor = own_descriptor(target.path);
    if (target.descriptor >= 0) return target;
    target.exists = ::lstat(target.path.c_str(), &target.status) == 0;
    if (!target.exists && errno != ENOENT) target.fail(errno);
    if (!target.exists || !S_ISLNK(target.status.st_mode)) return target;
    if (links == kMostLinks) target.fail(ELOOP);
    std::error_code failed;
    const fs::path next = fs::read_symlink(target.path, failed);
    if (failed) target.fail(failed.value());
    target.path = target.folder() / next;  // `next` alone where it is absolute
  }
}

void require_access(const OutputTarget& target, const fs::path& path, int kind) {
  if (::faccessat(AT_FDCWD, path.c_str(), kind, AT_EACCESS) != 0) target.fail(errno);
}

void check(const OutputTarget& target) {
  if (target.descriptor >= 0) {
    const int flags = ::fcntl(target.descriptor, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY) target.fail(EBADF);
    return;
  }
  if (target.path.filename().empty() || (target.exists && S_ISDIR(target.status.st_mode))) {
    throw Error(target.asked.string(), 0, "is a folder", "the name of a file to write");
  }
  if (target.exists) require_access(target, target.path, W_OK);
  if (target.is_stream()) return;
  if (!fs::is_directory(target.folder())) {
    throw Error(target.asked.string(), 0,
                "cannot be written: no folder " + target.folder().string(),
                "an existing, writable folder");
  }
  require_access(target, target.folder(), W_OK | X_OK);
}

/// Name of the target's temporary files but for their random letters.
std::string temporary_prefix(const fs::path& target) {
  return '.' + target.filename().string().substr(0, kMostOfName) + std::string(kMark);
}

bool is_same_file(int descriptor, const fs::path& path) {
  struct stat a = {}, b = {};
  return ::fstat(descriptor, &a) == 0 && ::lstat(path.c_str(), &b) == 0 && a.st_dev == b.st_dev &&
         a.st_ino == b.st_ino;
}

/// Temporary files of the target whose writers were killed: nobody holds their locks.
void remove_leftovers(const OutputTarget& target) {
  const std::string prefix = temporary_prefix(target.path);
  std::error_code ignored;
  for (fs::directory_iterator entry(target.folder(), ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::string name = entry->path().filename();
    if (name.size() != prefix.size() + kRandomLetters || !name.starts_with(prefix)) continue;
    const FileDescriptor file(
        ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (!file.is_open() || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) continue;
    if (is_same_file(file.get(), entry->path())) ::unlink(entry->path().c_str());
  }
}

std::string random_letters() {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  unsigned char bytes[kRandomLetters] = {};
  if (::getrandom(bytes, sizeof(bytes), 0) < 0) throw Error("the system gives no random number");
  std::string text;
  for (const unsigned char byte : bytes) text += kLetters[byte % kLetters.size()];
  return text;
}

/// A new file beside the target, locked; it disappears unless it takes the target's place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const OutputTarget& target) : target_(target) {
    do {
      create();
      // Who removes leftovers may have come before the lock: then the file has no name any more.
      // A file system without locks has none of that.
    } while (::flock(file_.get(), LOCK_EX) == 0 && !is_same_file(file_.get(), path_));
    if (target.exists) take_over_owner_and_mode();
  }
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::string_view text) {
    if (const int error = write_all(file_.get(), text)) target_.fail(error);
    // Some file systems cannot; others say only now that there is no room.
    if (::fsync(file_.get()) != 0 && errno != EINVAL && errno != ENOTSUP) target_.fail(errno);
  }

  void replace_target() {
    if (::rename(path_.c_str(), target_.path.c_str()) != 0) target_.fail(errno);
    path_.clear();
    const FileDescriptor folder(
        ::open(target_.folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder.is_open()) ::fsync(folder.get());
  }

 private:
  void create() {
    // Nobody may read what replaces a file that they could not read; new files as umask says.
    const mode_t mode = target_.exists ? 0600 : 0666;
    do {
      path_ = target_.folder() / (temporary_prefix(target_.path) + random_letters());
      removed_.emplace(path_);
      file_ = FileDescriptor(
          ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
    } while (!file_.is_open() && errno == EEXIST);
    if (file_.is_open()) return;
    path_.clear();
    target_.fail(errno);
  }

  void take_over_owner_and_mode() {
    const struct stat& was = target_.status;
    // Only root may give files away; others may still keep the group.
    // Where that or the mode cannot be had, the file is its writer's alone.
    constexpr uid_t kAsItIs = static_cast<uid_t>(-1);
    [[maybe_unused]] const bool kept = (::fchown(file_.get(), was.st_uid, was.st_gid) == 0 ||
                                        ::fchown(file_.get(), kAsItIs, was.st_gid) == 0) &&
                                       ::fchmod(file_.get(), was.st_mode & 0777) == 0;
  }

  const OutputTarget& target_;
  std::optional<RemovedOnSignal> removed_;
  fs::path path_;
  FileDescriptor file_;
};

}  // namespace

void write_to_descriptor(int descriptor, std::string_view text, const std::string& name) {
  if (const int error = write_all(descriptor, text)) refuse(name, error);
}

void write_file_atomically(const fs::path& path, std::string_view text) {
  const OutputTarget target = target_of(path);
  check(target);
  if (target.descriptor >= 0) {
    write_to_descriptor(target.descriptor, text, path.string());
    return;
  }
  if (target.is_stream()) {
    const FileDescriptor stream(::open(target.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!stream.is_open()) target.fail(errno);
    if (const int error = write_all(stream.get(), text)) target.fail(error);
    return;
  }
  remove_leftovers(target);
  TemporaryFile temporary(target);
  temporary.write(text);
  temporary.replace_target();
}

void check_output_path(const fs::path& path) {
  const OutputTarget target = target_of(path);
  check(target);
  if (!target.is_stream()) remove_leftovers(target);
}

bool is_standard_output(const fs::path& path) {
  return target_of(path).descriptor == STDOUT_FILENO;
}

fs::path folder_of_output(const fs::path& path) {
  const OutputTarget target = target_of(path);
  return target.is_stream() ? fs::path() : target.folder();
}

}  // namespace locograph
