#include <gtest/gtest.h>
#include <locograph/common/error.h>

namespace locograph {
namespace {

TEST(Error, SaysWhereWhatAndWhatWasExpected) {
  const Error error("graph.g2o", 12, "unknown vertex 7", "a declared id");
  EXPECT_STREQ(error.what(), "graph.g2o:12: unknown vertex 7, expected a declared id");
  EXPECT_EQ(error.file(), "graph.g2o");
  EXPECT_EQ(error.line(), 12);
}

TEST(Error, IsToldWholeWhereWhatIsWrongHoldsANul) {
  EXPECT_STREQ(Error("unknown tag 'a" + std::string(1, '\0') + "b'", "a tag").what(),
               "unknown tag 'a\\x00b', expected a tag");
}

TEST(Error, LeavesOutWhatIsUnknown) {
  EXPECT_STREQ(Error("graph.g2o", 0, "holds no graph", "").what(), "graph.g2o: holds no graph");
  EXPECT_STREQ(Error("", 3, "bad", "").what(), "line 3: bad");
  EXPECT_STREQ(Error("option gain is out of range", "a fraction").what(),
               "option gain is out of range, expected a fraction");
  EXPECT_EQ(Error("bad").line(), 0);
}

}  // namespace
}  // namespace locograph
