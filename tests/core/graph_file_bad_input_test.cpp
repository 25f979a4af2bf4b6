#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/information.h>
#include <locograph/types/slam3d/edges.h>
#include <locograph/types/standard_types.h>

#include "common/temporary_folder.h"
#include "core/toy_types.h"

namespace locograph::test {
namespace {

struct BadFile {
  const char* name;
  const char* text;
  int line;
  const char* message;  ///< a part of it
};

void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.name; }

constexpr const char* kPoints = "VERTEX_XY 0 1 2\nVERTEX_XY 1 3 4\nVERTEX_SE2 2 0 0 0\n";

// The text follows the three vertices above: its first line is line 4.
const BadFile kBadFiles[] = {
    {"TruncatedVertex", "VERTEX_XY 5 1", 4, "too few fields"},
    {"VertexWithoutId", "VERTEX_XY", 4, "too few fields"},
    {"TruncatedEdge", "EDGE_POINTXY 0 1 1 1 1 0", 4, "too few fields"},
    {"EdgeWithOneId", "EDGE_POINTXY 0", 4, "too few fields"},
    {"TooManyVertexFields", "VERTEX_XY 5 1 2 3", 4, "too many fields, from '3' on"},
    {"TooManyEdgeFields", "EDGE_POINTXY 0 1 1 1 1 0 1 9", 4, "too many fields, from '9' on"},
    {"NotANumber", "\nVERTEX_XY 5 1 two", 5, "'two' is not a number"},
    {"NaN", "VERTEX_XY 5 1 nan", 4, "'nan' is not finite"},
    {"Infinity", "VERTEX_XY 5 -inf 1", 4, "'-inf' is not finite"},
    {"NaNInInformation", "EDGE_POINTXY 0 1 1 1 1 nan 1", 4, "'nan' is not finite"},
    {"TooLargeForADouble", "VERTEX_XY 5 1e999 1", 4, "'1e999'"},
    {"IdThatIsNotAnInteger", "VERTEX_XY 5.5 1 2", 4, "'5.5' is not an integer"},
    {"DanglingId", "# comment\n\nEDGE_POINTXY 0 77 1 1 1 0 1", 6, "unknown vertex 77"},
    {"DanglingFix", "FIX 0 78", 4, "unknown vertex 78"},
    {"FixWithoutId", "FIX", 4, "too few fields"},
    {"DuplicatedId", "VERTEX_XY 1 1 2", 4, "vertex 1 is declared twice, first on line 2"},
    {"DuplicatedIdOfAnotherType", "VERTEX_SE2 1 1 2 3", 4, "vertex 1 is declared twice"},
    {"UnknownTag", "VERTEX_UNHEARD_OF 5 1 2", 4, "unknown tag 'VERTEX_UNHEARD_OF'"},
    {"WrongTypeOfVertex", "EDGE_POINTXY 0 2 1 1 1 0 1", 4, "vertex 2 is a VERTEX_SE2"},
    {"VertexNamedTwice", "EDGE_POINTXY 1 1 1 1 1 0 1", 4, "names vertex 1 twice"},
    {"VertexNamedTwiceAtRunTimeArity", "TOY_MOMENTS_DUAL 0 1 0 || 2 1 1 1 0 1", 4,
     "names vertex 0 twice"},
    {"IndefiniteInformation",
     "EDGE_POINTXY 0 1 1 1 1 0 1\nEDGE_POINTXY 0 1 1 1 1 2 1\nEDGE_POINTXY 0 1 1 1 -1 0 1", 5,
     "indefinite, the first of 2 such among 3 edges"},
    {"ZeroQuaternion", "VERTEX_SE3:QUAT 5 1 2 3 0 0 0 0", 4, "quaternion of length zero"},
    {"ZeroQuaternionInParameter", "PARAMS_SE3OFFSET 0 1 2 3 0 0 0 0", 4,
     "quaternion of length zero"},
    {"UnknownParameter", "EDGE_SE2_XY_OFFSET 2 0 3 1 1 1 0 1", 4, "unknown parameter 3"},
    {"DuplicatedParameter", "PARAMS_SE2OFFSET 0 0 0 0\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1", 5,
     "parameter 0 is given twice"},
    {"ParameterOfTheWrongType",
     "PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\nEDGE_SE2_XY_OFFSET 2 0 0 1 1 1 0 1", 5,
     "parameter 0 is a PARAMS_SE3OFFSET"},
    {"TruncatedParameter", "PARAMS_SE2OFFSET 0 0 0", 4, "too few fields"},
    {"ZeroFocalLength", "PARAMS_CAMERACALIB 0 0 0 0 0 0 0 1 0 1 1 1", 4, "focal length of zero"},
    {"RunTimeArityWithoutBars", "TOY_MOMENTS_DUAL 0 1", 4, "no '||' after the vertices"},
    {"RunTimeArityWithoutVertices", "TOY_MOMENTS_DUAL || 2 1 1 1 0 1", 4,
     "an edge without vertices"},
    {"RunTimeArityWithoutMany", "TOY_VIEW_DUAL 2 || 3 1 1 1 1 0 0 1 0 1", 4,
     "an edge on 1 vertices, expected 2 or more"},
    {"RunTimeArityOfTheWrongSize", "TOY_MOMENTS_DUAL 0 || 3 1 1 1 1 0 0 1 0 1", 4,
     "error of size 3, expected size 2"},
    {"RunTimeSizeOfZero", "TOY_SIGNAL 0 || 0", 4, "error of size 0"},
    {"RunTimeSizeBeyondReason", "TOY_SIGNAL 0 || 2000000000 1", 4, "too few fields"},
    {"RunTimeArityWithTheLeaderLast", "TOY_VIEW_DUAL 0 2 || 3 1 1 1 1 0 0 1 0 1", 4,
     "vertex 0 is a VERTEX_XY"},
};

class EveryBadFile : public testing::TestWithParam<BadFile> {
 protected:
  static TypeRegistry types() {
    TypeRegistry types = standard_types();
    types.add_edge<ToyMoments<Derivatives::kDual>>();
    types.add_edge<ToyView<Derivatives::kDual>>();
    types.add_edge<ToySignal>();
    return types;
  }
};
INSTANTIATE_TEST_SUITE_P(GraphFile, EveryBadFile, testing::ValuesIn(kBadFiles),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(EveryBadFile, IsAnErrorWithFileLineAndReason) {
  const TemporaryFolder folder;
  const std::filesystem::path path =
      folder.write("bad.g2o", kPoints + std::string(GetParam().text) + "\nVERTEX_XY 9 0 0\n");
  try {
    read_graph(path, types());
    FAIL() << "was accepted";
  } catch (const Error& error) {
    const std::string message = error.what();
    const std::string begin = path.string() + ":" + std::to_string(GetParam().line) + ": ";
    EXPECT_EQ(message.find(begin), 0u) << message;
    EXPECT_EQ(error.file(), path.string());
    EXPECT_EQ(error.line(), GetParam().line);
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "more than one line: " << message;
  }
}

TEST(GraphFile, ThatIsMissingIsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  for (const std::filesystem::path& path : {folder.file("missing.g2o"), folder.path()}) {
    try {
      read_graph(path, standard_types());
      ADD_FAILURE() << path << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), path.string());
    }
  }
}

TEST(GraphFile, ThatHoldsNothingIsAnError) {
  const TemporaryFolder folder;
  for (const char* text : {"", "\n\n", "# only\n  # comments\n"}) {
    const std::filesystem::path path = folder.write("empty.g2o", text);
    try {
      read_graph(path, standard_types());
      ADD_FAILURE() << "'" << text << "' was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": holds no graph"), 0u)
          << error.what();
    }
  }
}

TEST(GraphFile, AQuoteThatEndsInAnEscapeIsReadNoFurtherThanItsLine) {
  const auto read = [](const std::string& text) {
    // Of its exact size, so that AddressSanitizer sees a byte that is read behind it.
    const std::vector<char> exact(text.begin(), text.end());
    return read_graph_text({exact.data(), exact.size()}, "test.g2o", {}, standard_types());
  };
  EXPECT_EQ(read("VERTEX_XY 0 1 2 # \"a\\").vertex_count(), 1);
  try {
    read("VERTEX_XY 0 1 2\nVERTEX_XY 1 3 4 \"#\\");
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "test.g2o:2: too many fields, from '\"#\\' on, expected end of line");
  }
}

TEST(GraphFile, LenientReadingStillRefusesWhatIsNotAMatterOfTaste) {
  for (const char* text : {"VERTEX_XY 0 1", "VERTEX_XY 0 1 nan", "EDGE_POINTXY 1 1 0 0 1 0 1",
                           "VERTEX_XY 0 1 2\nEDGE_POINTXY 0 1 0 0 1 0 1"}) {
    EXPECT_THROW(read_graph_text(text, "test.g2o", {}, standard_types(), {.lenient = true}), Error)
        << text;
  }
}

TEST(GraphFile, CubicleIsRefusedWithTheNumberOfItsIndefiniteMatricesAndTheFirstLine) {
  const std::filesystem::path path =
      std::filesystem::path(LOCOGRAPH_SHARED_DATA) / "pose_graphs" / "cubicle.g2o";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
  try {
    read_graph(path, standard_types());
    FAIL() << "was accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.line(), 5753);
    EXPECT_NE(std::string(error.what()).find("the first of 5021 such among 16869 edges"),
              std::string::npos)
        << error.what();
  }
  ReadReport report;
  const Graph graph = read_graph(path, standard_types(), {.lenient = true}, &report);
  EXPECT_EQ(report.indefinite_information, 5021);
  EXPECT_EQ(report.first_indefinite_line, 5753);
  for (const EdgeSE3& edge : graph.edges_of<EdgeSE3>()) {
    ASSERT_TRUE(is_positive_semidefinite(edge.information));
  }
}

}  // namespace
}  // namespace locograph::test
