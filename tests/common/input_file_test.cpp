#include <fcntl.h>
#include <gtest/gtest.h>
#include <locograph/common/error.h>
#include <locograph/common/input_file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <functional>
#include <thread>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

std::string refusal(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// A pipe whose writing end was given this text and closed; the path is that of the shell's <(…).
struct WrittenPipe {
  explicit WrittenPipe(const std::string& text) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
    ::close(ends[1]);
    reading = ends[0];
  }
  ~WrittenPipe() { ::close(reading); }
  std::string path() const { return "/dev/fd/" + std::to_string(reading); }
  int reading = -1;
};

TEST(ReadFile, GivesEveryByte) {
  const TemporaryFolder folder;
  const std::string text("a\0b\r\nc", 6);
  EXPECT_EQ(read_file(folder.write("in", text)), text);
  EXPECT_EQ(read_input(folder.file("in")), text);
  EXPECT_EQ(read_file(folder.write("empty", "")), "");
}

TEST(ReadFile, FollowsLinks) {
  const TemporaryFolder folder;
  folder.write("in", "text");
  std::filesystem::create_symlink("in", folder.file("link"));
  EXPECT_EQ(read_file(folder.file("link")), "text");
}

TEST(ReadFile, SaysWhyAFileCannotBeOpenedAndWhatWasExpected) {
  const TemporaryFolder folder;
  const std::string missing = folder.file("missing").string();
  EXPECT_EQ(refusal([&] { read_file(missing, 10, "a map"); }),
            missing + ": cannot be opened: no such file or directory, expected a map");
}

TEST(ReadFile, RefusesWhatIsNoRegularFile) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string(), pipe = folder.file("pipe").string();
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal([&] { read_file(path, 10, "a map"); }), path + ": is a folder, expected a map");
  EXPECT_EQ(refusal([&] { read_file(pipe, 10, "a map"); }),
            pipe + ": is a pipe, expected a map, a regular file");
  for (const auto read : {read_file, read_input}) {
    EXPECT_EQ(refusal([&] { read("/dev/zero", 10, "a map"); }),
              "/dev/zero: is a device, expected a map, a regular file");
  }
}

TEST(ReadFile, RefusesAFileAboveTheBoundAndSaysBothSizes) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("in", "12345");
  EXPECT_EQ(read_file(file, 5), "12345");
  EXPECT_EQ(refusal([&] { read_file(file, 4); }),
            file.string() + ": has 5 bytes, expected at most 4");
}

TEST(ReadFile, BoundsAFileWhoseSizeIsNotTold) {
  // Files of /proc are regular ones of size 0.
  EXPECT_NE(read_file("/proc/self/maps"), "");
  EXPECT_EQ(refusal([] { read_file("/proc/self/maps", 4); }),
            "/proc/self/maps: has more than 4 bytes, expected at most 4");
}

TEST(ReadInput, ReadsAPipe) {
  EXPECT_EQ(read_input(WrittenPipe("text").path()), "text");
  EXPECT_EQ(read_input(WrittenPipe("").path()), "");
}

TEST(ReadInput, BoundsAPipe) {
  const WrittenPipe pipe("12345");
  EXPECT_EQ(refusal([&] { read_input(pipe.path(), 4); }),
            pipe.path() + ": has more than 4 bytes, expected at most 4");
}

TEST(ReadInput, WaitsForTheWriterOfAPipeToEnd) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const std::string large(300'000, 'x');  // more than a pipe holds at once
  std::thread writer([&] {
    for (std::size_t at = 0; at < large.size();) {
      const ssize_t count = ::write(ends[1], large.data() + at, large.size() - at);
      if (count > 0) at += static_cast<std::size_t>(count);
    }
    ::close(ends[1]);
  });
  EXPECT_EQ(read_input("/dev/fd/" + std::to_string(ends[0])), large);
  writer.join();
  ::close(ends[0]);
}

TEST(ReadInput, FindsAPipeEmptyThatNobodyWritesTo) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_input(folder.file("pipe")), "");
}

TEST(FileBeginning, GivesAtMostTheBytesAskedFor) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("in", "12345");
  EXPECT_EQ(file_beginning(file, 3), "123");
  EXPECT_EQ(file_beginning(file, 30), "12345");
  EXPECT_EQ(refusal([] { file_beginning("/dev/zero", 3, "a map"); }),
            "/dev/zero: is a device, expected a map, a regular file");
}

}  // namespace
}  // namespace locograph
