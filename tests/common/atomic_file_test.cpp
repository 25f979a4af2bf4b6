#include <gtest/gtest.h>
#include <locograph/common/atomic_file.h>

#include "common/temporary_folder.h"

namespace locograph {
namespace {

using test::TemporaryFolder;

TEST(AtomicFile, HoldsExactlyTheBytesGiven) {
  const TemporaryFolder folder;
  const std::string text("a\0b\r\nc", 6);
  write_file_atomically(folder.file("out"), text);
  EXPECT_EQ(read_file(folder.file("out")), text);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
}

TEST(AtomicFile, ReplacesAnOlderFileWhole) {
  const TemporaryFolder folder;
  folder.write("out", "a longer text that was there before");
  write_file_atomically(folder.file("out"), "new");
  EXPECT_EQ(read_file(folder.file("out")), "new");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
}

TEST(AtomicFile, InAMissingFolderIsAnErrorThatNamesTheFile) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.file("missing") / "out";
  try {
    write_file_atomically(path, "text");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.file(), path.string());
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, ThatCannotReplaceItsTargetLeavesNothingBehind) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("out"));
  folder.write("out/inside", "kept");
  EXPECT_THROW(write_file_atomically(folder.file("out"), "text"), Error);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out"});
  EXPECT_EQ(read_file(folder.file("out/inside")), "kept");
}

TEST(ReadFile, RefusesWhatIsMissingOrAFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_file(folder.file("missing")), Error);
  EXPECT_THROW(read_file(folder.path()), Error);
}

}  // namespace
}  // namespace locograph
