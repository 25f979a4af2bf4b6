#include <fcntl.h>
#include <locograph/apps/child_process.h>
#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <locograph/common/stop_signals.h>
#include <signal.h>
#include <spawn.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <sstream>
#include <thread>

extern char** environ;

namespace locograph {
namespace {

/// What posix_spawn is told, released at the end.
struct SpawnSettings {
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;

  SpawnSettings(const std::filesystem::path& output, const std::filesystem::path& errors) {
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
    constexpr int kNewFile = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&files, 1, output.c_str(), kNewFile, 0600);
    if (errors == output) {
      posix_spawn_file_actions_adddup2(&files, 1, 2);
    } else {
      posix_spawn_file_actions_addopen(&files, 2, errors.c_str(), kNewFile, 0600);
    }
    // A process group of its own, so that its children can be ended with it.
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
};

constexpr std::string_view kScratchName = "locograph-scratch-";

/// Folders whose programs were killed: nobody holds their locks.
void remove_abandoned(const std::filesystem::path& parent) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(parent, ignored)) {
    if (!entry.path().filename().string().starts_with(kScratchName)) continue;
    const FileDescriptor folder(
        ::open(entry.path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    if (!folder.is_open() || ::flock(folder.get(), LOCK_EX | LOCK_NB) != 0) continue;
    std::filesystem::remove_all(entry.path(), ignored);
  }
}

}  // namespace

std::optional<std::filesystem::path> find_program(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::filesystem::path candidate = std::filesystem::path(folder) / name;
      std::error_code ignored;
      if (std::filesystem::is_regular_file(candidate, ignored) &&
          ::access(candidate.c_str(), X_OK) == 0) {
        return candidate;
      }
    }
  }
  return std::nullopt;
}

std::string ProcessResult::last_line() const {
  const std::size_t end = output.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const std::size_t before = output.find_last_of('\n', end);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return output.substr(begin, end + 1 - begin);
}

ChildProcess::ChildProcess(const std::filesystem::path& program,
                           const std::vector<std::string>& arguments,
                           const std::filesystem::path& output,
                           const std::filesystem::path& errors) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const SpawnSettings settings(output, errors);
  if (::posix_spawn(&child_, program.c_str(), &settings.files, &settings.attributes, argv.data(),
                    environ) != 0) {
    throw Error(program.string(), 0, "cannot be started", "an executable program");
  }
}

ChildProcess::~ChildProcess() { end(); }

std::optional<int> ChildProcess::exit_code() {
  int status = 0;
  if (!exit_code_ && ::waitpid(child_, &status, WNOHANG) != 0) take(status);
  return exit_code_;
}

void ChildProcess::end() {
  if (exit_code_) return;
  int status = 0;
  ::kill(-child_, SIGKILL);
  ::waitpid(child_, &status, 0);
  take(status);
}

void ChildProcess::take(int status) {
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, double timeout_s) {
  const ScratchFolder folder;
  const std::filesystem::path output = folder.path() / "output";
  const FinishOnSignal finish;
  const Deadline deadline = Deadline::after(timeout_s);
  ChildProcess child(program, arguments, output, output);
  ProcessResult result;
  while (!child.exit_code()) {
    if (deadline.passed() || stop_requested()) {
      result.timed_out = true;
      child.end();
      if (stop_requested()) throw Interrupted();
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  result.exit_code = *child.exit_code();
  result.output = read_file(output);
  return result;
}

ScratchFolder::ScratchFolder() {
  std::error_code failed;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(failed);
  remove_abandoned(parent);
  do {
    std::string pattern = (parent / kScratchName).string() + "XXXXXX";
    if (failed || ::mkdtemp(pattern.data()) == nullptr) {
      throw Error(pattern, 0, "no temporary folder can be made", "a writable folder TMPDIR");
    }
    path_ = pattern;
    lock_ = FileDescriptor(::open(pattern.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // Somebody who removes abandoned folders may have come before the lock.
  } while (lock_.is_open() && ::flock(lock_.get(), LOCK_EX) == 0 &&
           !std::filesystem::is_directory(path_));
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace locograph
