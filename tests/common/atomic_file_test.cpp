#include <fcntl.h>
#include <gtest/gtest.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <functional>
#include <thread>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using Names = std::vector<std::string>;

std::string complaint(const std::function<void()>& write) {
  try {
    write();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct stat status_of(const fs::path& file) {
  struct stat status = {};
  EXPECT_EQ(::lstat(file.c_str(), &status), 0) << file;
  return status;
}

unsigned mode_of(const fs::path& file) { return status_of(file).st_mode & 0777u; }

/// The rights of a user whom nothing belongs to, for as long as this lives; root has every right.
class WithoutRights {
 public:
  WithoutRights() {
    if (::geteuid() == 0) changed_ = ::seteuid(65534) == 0;
  }
  ~WithoutRights() {
    if (!changed_) return;
    EXPECT_EQ(::seteuid(0), 0);
  }

 private:
  bool changed_ = false;
};

/// Files of this process may have so many bytes.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    action_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, action_);
  }

 private:
  rlimit before_ = {};
  void (*action_)(int) = nullptr;
};

TEST(AtomicFile, HoldsExactlyTheBytesGiven) {
  const TemporaryFolder folder;
  const std::string text("a\0b\r\nc", 6);
  write_file_atomically(folder.file("out"), text);
  EXPECT_EQ(read_file(folder.file("out")), text);
  EXPECT_EQ(folder.names(), Names{"out"});
}

TEST(AtomicFile, ReplacesAnOlderFileWhole) {
  const TemporaryFolder folder;
  folder.write("out", "a longer text that was there before");
  write_file_atomically(folder.file("out"), "new");
  EXPECT_EQ(read_file(folder.file("out")), "new");
  EXPECT_EQ(folder.names(), Names{"out"});
}

TEST(AtomicFile, IsReplacedBehindALinkThatStays) {
  const TemporaryFolder folder;
  folder.write("real/out", "old");
  fs::create_symlink("real/out", folder.file("second"));
  fs::create_symlink(folder.file("second"), folder.file("first"));
  write_file_atomically(folder.file("first"), "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("first")));
  EXPECT_TRUE(fs::is_symlink(folder.file("second")));
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(folder.file("real/out"))));
  EXPECT_EQ(read_file(folder.file("real/out")), "new");
}

TEST(AtomicFile, IsMadeWhereALinkLeadsToNothingYet) {
  const TemporaryFolder folder;
  fs::create_symlink("out", folder.file("link"));
  write_file_atomically(folder.file("link"), "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("link")));
  EXPECT_EQ(read_file(folder.file("out")), "new");
}

TEST(AtomicFile, IsRefusedWhereLinksLeadInACircle) {
  const TemporaryFolder folder;
  fs::create_symlink("b", folder.file("a"));
  fs::create_symlink("a", folder.file("b"));
  EXPECT_NE(complaint([&] {
              write_file_atomically(folder.file("a"), "new");
            }).find("cannot be written: too many levels of symbolic links"),
            std::string::npos);
}

TEST(AtomicFile, KeepsTheModeOfTheFileItReplaces) {
  const TemporaryFolder folder;
  for (const mode_t mode : {0600u, 0640u, 0666u, 0755u}) {
    folder.write("out", "old");
    ASSERT_EQ(::chmod(folder.file("out").c_str(), mode), 0);
    write_file_atomically(folder.file("out"), "new");
    EXPECT_EQ(mode_of(folder.file("out")), mode);
  }
}

TEST(AtomicFile, GetsTheModeThatUmaskLeavesANewOne) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  write_file_atomically(folder.file("out"), "new");
  ::umask(before);
  EXPECT_EQ(mode_of(folder.file("out")), 0640u);
}

TEST(AtomicFile, KeepsTheOwnerOfTheFileThatRootReplaces) {
  if (::geteuid() != 0) GTEST_SKIP() << "only root may give files away";
  const TemporaryFolder folder;
  folder.write("out", "old");
  ASSERT_EQ(::chown(folder.file("out").c_str(), 1234, 2345), 0);
  write_file_atomically(folder.file("out"), "new");
  EXPECT_EQ(status_of(folder.file("out")).st_uid, 1234u);
  EXPECT_EQ(status_of(folder.file("out")).st_gid, 2345u);
}

TEST(AtomicFile, NeverReplacesADevice) {
  write_file_atomically("/dev/null", "text");
  EXPECT_TRUE(S_ISCHR(status_of("/dev/null").st_mode));
}

TEST(AtomicFile, GoesThroughAPipeThatStays) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string large(300'000, 'x');
  std::string read;
  std::thread reader([&] {
    const int end = ::open(pipe.c_str(), O_RDONLY);
    char piece[4096];
    for (ssize_t n; (n = ::read(end, piece, sizeof(piece))) > 0;) {
      read.append(piece, static_cast<std::size_t>(n));
    }
    ::close(end);
  });
  write_file_atomically(pipe, large);
  reader.join();
  EXPECT_EQ(read, large);
  EXPECT_TRUE(S_ISFIFO(status_of(pipe).st_mode));
  EXPECT_EQ(folder.names(), Names{"pipe"});
}

TEST(AtomicFile, IsAppendedToAnOpenFileThatIsNamedByItsNumber) {
  const TemporaryFolder folder;
  const int file = ::open(folder.write("log", "before, ").c_str(), O_WRONLY | O_APPEND);
  const std::uint64_t inode = status_of(folder.file("log")).st_ino;
  write_file_atomically("/dev/fd/" + std::to_string(file), "after");
  ::close(file);
  EXPECT_EQ(read_file(folder.file("log")), "before, after");
  EXPECT_EQ(status_of(folder.file("log")).st_ino, inode);
}

TEST(AtomicFile, NamesStandardOutputInSeveralWays) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    EXPECT_TRUE(is_standard_output(name)) << name;
  }
  for (const char* name : {"/dev/stderr", "/dev/null", "./-", "1"}) {
    EXPECT_FALSE(is_standard_output(name)) << name;
  }
}

TEST(AtomicFile, SaysThatADeviceIsFull) {
  EXPECT_EQ(complaint([] { write_file_atomically("/dev/full", "text"); }),
            "/dev/full: cannot be written: no space left on device, expected room for it");
}

TEST(AtomicFile, IsAsBeforeWhenThereIsNoRoomForTheNewOne) {
  const TemporaryFolder folder;
  folder.write("out", "old");
  {
    const FileSizeLimit limit(1000);
    EXPECT_NE(complaint([&] {
                write_file_atomically(folder.file("out"), std::string(5000, 'x'));
              }).find("cannot be written: file too large"),
              std::string::npos);
  }
  EXPECT_EQ(read_file(folder.file("out")), "old");
  EXPECT_EQ(folder.names(), Names{"out"});
}

TEST(AtomicFile, InAMissingFolderIsAnErrorThatNamesTheFile) {
  const TemporaryFolder folder;
  const fs::path path = folder.file("missing") / "out";
  const std::string expected = path.string() + ": cannot be written: no folder " +
                               folder.file("missing").string() +
                               ", expected an existing, writable folder";
  EXPECT_EQ(complaint([&] { write_file_atomically(path, "text"); }), expected);
  EXPECT_EQ(complaint([&] { check_output_path(path); }), expected);
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, IsRefusedWhereAFolderIs) {
  const TemporaryFolder folder;
  folder.write("out/inside", "kept");
  for (const fs::path& path : {folder.file("out"), folder.file("new") / ""}) {
    EXPECT_EQ(complaint([&] { write_file_atomically(path, "text"); }),
              path.string() + ": is a folder, expected the name of a file to write");
  }
  EXPECT_EQ(folder.names(), Names{"out"});
  EXPECT_EQ(read_file(folder.file("out/inside")), "kept");
}

TEST(AtomicFile, IsRefusedInAFolderThatMayNotBeWritten) {
  const TemporaryFolder folder;
  folder.write("out", "old");
  ASSERT_EQ(::chmod(folder.path().c_str(), 0555), 0);
  {
    const WithoutRights nobody;
    for (const char* name : {"out", "new"}) {
      EXPECT_NE(complaint([&] {
                  check_output_path(folder.file(name));
                }).find("cannot be written: permission denied"),
                std::string::npos);
    }
  }
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(folder.names(), Names{"out"});
}

TEST(AtomicFile, IsRefusedWhereTheOldFileMayNotBeWritten) {
  const TemporaryFolder folder;
  folder.write("out", "old");
  ASSERT_EQ(::chmod(folder.file("out").c_str(), 0444), 0);
  ASSERT_EQ(::chmod(folder.path().c_str(), 0777), 0);
  const WithoutRights nobody;
  EXPECT_NE(complaint([&] {
              write_file_atomically(folder.file("out"), "new");
            }).find("cannot be written: permission denied"),
            std::string::npos);
}

TEST(AtomicFile, IsNotMadeByTheCheckOfItsPath) {
  const TemporaryFolder folder;
  check_output_path(folder.file("out"));
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, RemovesWhatKilledWritersLeft) {
  const TemporaryFolder folder;
  for (const bool write : {true, false}) {
    folder.write(".out.locograph-abc123", "half");
    folder.write(".out.locograph-xyz789", "");
    write ? write_file_atomically(folder.file("out"), "new")
          : check_output_path(folder.file("out"));
    EXPECT_EQ(folder.names(), Names{"out"});
  }
}

TEST(AtomicFile, LeavesTheFilesOfOthersAlone) {
  const TemporaryFolder folder;
  // Of another target, the user's own, and one that is being written just now.
  for (const char* name : {".out2.locograph-abc123", ".out.locograph-abc", "out.locograph-abc123",
                           ".out.locograph-locked"}) {
    folder.write(name, "theirs");
  }
  const int writer = ::open(folder.file(".out.locograph-locked").c_str(), O_WRONLY);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  write_file_atomically(folder.file("out"), "new");
  EXPECT_EQ(folder.names().size(), 5u);
  ::close(writer);
  write_file_atomically(folder.file("out"), "new");
  EXPECT_EQ(folder.names().size(), 4u);
}

TEST(AtomicFile, MayHaveTheLongestName) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  write_file_atomically(folder.file(name), "text");
  EXPECT_EQ(folder.names(), Names{name});
  EXPECT_NE(complaint([&] {
              check_output_path(folder.file(name + "n"));
            }).find("cannot be written: file name too long"),
            std::string::npos);
}

TEST(AtomicFile, IsThatOfOneOfSeveralWriters) {
  const TemporaryFolder folder;
  const fs::path file = folder.file("out");
  std::vector<std::thread> writers;
  for (const char letter : {'a', 'b', 'c', 'd'}) {
    writers.emplace_back([&file, letter] {
      for (int i = 0; i < 20; ++i) write_file_atomically(file, std::string(10'000, letter));
    });
  }
  for (std::thread& writer : writers) writer.join();
  const std::string text = read_file(file);
  EXPECT_EQ(text, std::string(10'000, text.at(0)));
  EXPECT_EQ(folder.names(), Names{"out"});
}

TEST(FolderOfOutput, IsWhereTheFileReallyIs) {
  const TemporaryFolder folder;
  folder.write("real/out", "");
  fs::create_symlink("real/out", folder.file("link"));
  EXPECT_EQ(fs::canonical(folder_of_output(folder.file("link"))),
            fs::canonical(folder.file("real")));
  EXPECT_EQ(folder_of_output("out"), ".");
  EXPECT_EQ(folder_of_output("-"), "");
  EXPECT_EQ(folder_of_output("/dev/null"), "");
}

}  // namespace
}  // namespace locograph
