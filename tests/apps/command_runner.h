#pragma once
/// Runs the `locograph` command as a user would, in a folder of its own.
///
///     CommandRunner runner;
///     runner.write("a.g2o", "VERTEX_XY 0 0 0\n");
///     Outcome outcome = runner.run("optimize a.g2o --json");
///     EXPECT_EQ(outcome.exit_code, 0) << outcome.err;

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "common/temporary_folder.h"

namespace locograph {

struct Outcome {
  int exit_code = -1;  ///< 128 + signal when it was killed
  std::string out, err;

  /// Throws unless standard output is exactly one JSON object.
  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

class CommandRunner {
 public:
  const std::filesystem::path& folder() const { return folder_.path(); }

  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_.file(name), std::ios::binary);
    return std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_.file(name)); }
  int files() const {
    return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder()),
                                          std::filesystem::directory_iterator()));
  }

  /// arguments: as typed in a shell whose current folder is folder().
  Outcome run(const std::string& arguments) const {
    const std::filesystem::path out = folder_.file(".stdout"), err = folder_.file(".stderr");
    const std::string line = "cd '" + folder().string() + "' && '" LOCOGRAPH_COMMAND "' " +
                             arguments + " >.stdout 2>.stderr";
    const int status = std::system(line.c_str());
    Outcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = read(".stdout");
    outcome.err = read(".stderr");
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return outcome;
  }

 private:
  test::TemporaryFolder folder_;
};

/// Exit code 2, nothing on standard output, one line on stderr that begins `locograph: PLACE: `.
inline void expect_refusal(const Outcome& outcome, const std::string& place,
                           const std::string& words) {
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
  const std::string start = "locograph: " + (place.empty() ? "" : place + ": ");
  EXPECT_EQ(outcome.err.substr(0, start.size()), start) << outcome.err;
  EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

/// Path of a file in the shared data, quoted for the shell.
inline std::string shared(const std::string& name) {
  return "'" LOCOGRAPH_SHARED_DATA "/" + name + "'";
}

#define LOCOGRAPH_NEEDS_SHARED_DATA()                               \
  if (!std::filesystem::is_directory(LOCOGRAPH_SHARED_DATA)) {      \
    GTEST_SKIP() << "no shared data folder " LOCOGRAPH_SHARED_DATA; \
  }

}  // namespace locograph
