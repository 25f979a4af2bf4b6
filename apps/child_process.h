#pragma once
/// Other programs: found on the PATH, run without a shell, ended when they take too long.
///
///     if (const auto gnuplot = find_program({"gnuplot"})) {
///       ProcessResult result = run_process(*gnuplot, {"-d", "plot.gp"}, 60.0);
///       if (result.exit_code != 0) throw Error("gnuplot: " + result.last_line());
///     }

#include <locograph/common/file_descriptor.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace locograph {

/// The first of the names that is an executable file in a folder of PATH.
std::optional<std::filesystem::path> find_program(const std::vector<std::string>& names);

struct ProcessResult {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  bool timed_out = false;
  std::string output;  ///< standard output and error

  std::string last_line() const;
};

/// Waits for the program; after timeout_s it is killed with all its children. Its standard input is
/// empty. Throws Error when it cannot be started, Interrupted when Ctrl-C ended it.
ProcessResult run_process(const std::filesystem::path& program,
                          const std::vector<std::string>& arguments, double timeout_s);

/// A program that runs beside this one, without input and in a process group of its own: Ctrl-C on
/// the terminal does not reach it.
///
///     ChildProcess child(*gnuplot, {"-d", "plot.gp"}, "output", "errors");
///     while (!child.exit_code()) do_something_else();
class ChildProcess {
 public:
  /// output, errors: files for its standard output and error, replaced; they may be the same one.
  /// Throws Error when it cannot be started.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::filesystem::path& output, const std::filesystem::path& errors);
  /// As end().
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Nothing while it runs; 128 + signal when a signal ended it.
  std::optional<int> exit_code();
  /// Kills it with all its children, unless it has ended.
  void end();

 private:
  void take(int status);

  pid_t child_ = -1;
  std::optional<int> exit_code_;
};

/// A fresh folder that is removed with all that is in it, by the next one made if the program is
/// killed.
class ScratchFolder {
 public:
  /// Throws Error when there is no temporary folder to make it in.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  FileDescriptor lock_;  ///< shows others that somebody uses the folder
};

}  // namespace locograph
