#include <gtest/gtest.h>
#include <locograph/common/suggestion.h>

namespace locograph {
namespace {

TEST(Suggestion, EditDistanceCountsLetters) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("optmize", "optimize"), 1);
  EXPECT_EQ(edit_distance("optimzie", "optimize"), 1);  // neighbours exchanged
  EXPECT_EQ(edit_distance("Huber", "huber"), 0);
}

TEST(Suggestion, NamesTheNearest) {
  const std::vector<std::string> names = {"optimize", "plan", "plot", "posture"};
  EXPECT_EQ(did_you_mean("optmize", names), "; did you mean 'optimize'?");
  EXPECT_EQ(did_you_mean("plam", names), "; did you mean 'plan'?");
  EXPECT_EQ(did_you_mean("PLOT", names), "; did you mean 'plot'?");
}

TEST(Suggestion, NamesTheOneThatIsBegun) {
  const std::vector<std::string> names = {"centauro", "coman_plus"};
  EXPECT_EQ(did_you_mean("coman", names), "; did you mean 'coman_plus'?");
  EXPECT_EQ(did_you_mean("cen", names), "; did you mean 'centauro'?");
}

TEST(Suggestion, IsSilentWhereNothingIsNear) {
  const std::vector<std::string> names = {"optimize", "plan"};
  EXPECT_EQ(did_you_mean("dance", names), "");
  EXPECT_EQ(did_you_mean("", names), "");
  EXPECT_EQ(did_you_mean("plan", {}), "");
  EXPECT_EQ(did_you_mean(std::string(1000000, 'x'), names), "");
}

TEST(Suggestion, JoinsNames) {
  EXPECT_EQ(joined_names({}), "");
  EXPECT_EQ(joined_names({"a", "b"}), "a, b");
}

}  // namespace
}  // namespace locograph
