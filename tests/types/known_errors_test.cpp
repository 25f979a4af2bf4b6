// The error of every standard edge in a case worked out by hand.

#include <gtest/gtest.h>
#include <locograph/core/graph_file.h>
#include <locograph/types/slam2d/point_sets.h>
#include <locograph/types/standard_types.h>

#include <cmath>
#include <set>

#include "types/expect_error.h"

namespace locograph::test {
namespace {

struct Case {
  const char* lines;  ///< parameters, vertices and, last, the edge without its Ω
  std::vector<double> error;
};

/// Ω does not enter the error: the identity.
std::string with_information(const std::string& lines, std::size_t size) {
  std::string text = lines;
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t c = r; c < size; ++c) text += r == c ? " 1" : " 0";
  }
  return text + "\n";
}

std::string tag_of(const std::string& lines) {
  const std::size_t start = lines.rfind('\n') + 1;
  return lines.substr(start, lines.find(' ', start) - start);
}

// A quarter turn about z as quaternion x y z w. In it, x looks along the world's y.
#define QUARTER " 0 0 0.70710678118654752 0.70710678118654752"
#define UPRIGHT " 0 0 0 1"
const double kPi = std::acos(-1.0);
const double kHalf = std::sqrt(0.5);

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      // A planar pose at (1, 2) that looks along y sees (x, y) at (y − 2, 1 − x).
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_SE2 1 1 5 1.5707963267948966\n"
       "EDGE_SE2 0 1 2 0.5 0.1",
       {std::cos(0.1) * 1 - std::sin(0.1) * 0.5, -std::sin(0.1) * 1 - std::cos(0.1) * 0.5, -0.1}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 4 7\nEDGE_SE2_XY 0 1 4 -1", {1, -2}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 1 5\nEDGE_BEARING_SE2_XY 0 1 0.25",
       {-0.25}},
      {"VERTEX_SE2 0 1 2 3\nEDGE_PRIOR_SE2 0 0 4 -3",
       {std::cos(3.0) * 1 - std::sin(3.0) * -2, std::sin(3.0) * 1 + std::cos(3.0) * -2,
        6 - 2 * kPi}},
      {"VERTEX_SE2 0 1 2 3\nEDGE_PRIOR_SE2_XY 0 0 4", {1, -2}},
      {"VERTEX_XY 0 1 2\nEDGE_PRIOR_XY 0 0 4", {1, -2}},
      {"VERTEX_XY 0 1 2\nVERTEX_XY 1 4 7\nEDGE_POINTXY 0 1 1 1", {2, 4}},
      // Sensors half a metre ahead of both poses, that of the second turned by 0.2.
      {"PARAMS_SE2OFFSET 0 0.5 0 0\nPARAMS_SE2OFFSET 1 0.5 0 0.2\nVERTEX_SE2 0 0 0 0\n"
       "VERTEX_SE2 1 2 0 1.5707963267948966\nEDGE_SE2_OFFSET 0 1 0 1 1 0 0",
       {0.5, 0.5, kPi / 2 + 0.2}},
      {"PARAMS_SE2OFFSET 7 0.5 0 0\nVERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 4 7\n"
       "EDGE_SE2_XY_OFFSET 0 1 7 4 -1",
       {0.5, -2}},
      // The offset is only named.
      {"PARAMS_SE2OFFSET 7 0.5 0 0\nVERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 4 7\n"
       "EDGE_SE2_POINTXY_OFFSET 0 1 7 4 -1",
       {1, -2}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 4 7\nVERTEX_XY 2 1 2\n"
       "EDGE_SE2_TWOPOINTSXY 0 1 2 4 -1 0 1",
       {1, -2, 0, -1}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_XY 1 4 7\nVERTEX_XY 2 1 2\n"
       "EDGE_SE2_LOTSOFXY 0 1 2 || 2 4 -1 0 1",
       {1, -2, 0, -1}},
      // The mount looks to the left of the pose, from half a metre ahead.
      {"VERTEX_SE2 0 1 2 0\nVERTEX_XY 1 1.5 5\nVERTEX_SE2 2 0.5 0 1.5707963267948966\n"
       "EDGE_SE2_XY_CALIB 0 1 2 2 0",
       {1, 0}},
      {"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 0.5 0 1.5707963267948966\n"
       "EDGE_SE2_CALIB 0 1 2 0 0 0.5",
       {-std::sin(0.5), -std::cos(0.5), -0.5}},
      // Wheels 0.5 m apart; calibrated, the right one is faster by 1 m/s: half a turn in π/2 s, on
      // a
      // circle of radius 0.5 · 0.5 · (1 + 2) / 1 = 0.75 m.
      {"VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 1 3\nVERTEX_ODOM_DIFFERENTIAL 2 0.5 2 0.5\n"
       "EDGE_SE2_ODOM_DIFFERENTIAL_CALIB 0 1 2 2 1 1.5707963267948966",
       {0, 0.5, 3 - kPi}},
      // x = 3, seen along y from (1, 2): two metres to the right.
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_LINE2D 1 0 3 -1 -1\nEDGE_SE2_LINE2D 0 1 -1.5 1",
       {1.5 - kPi / 2, 1}},
      {"VERTEX_LINE2D 0 0.5 3 -1 -1\nVERTEX_LINE2D 1 1 2 5 6\nEDGE_LINE2D 0 1 0.25 0", {0.25, -1}},
      {"VERTEX_LINE2D 0 1.5707963267948966 3 -1 -1\nVERTEX_XY 1 8 5\nEDGE_LINE2D_POINTXY 0 1 0.5",
       {1.5}},
      // From (1, 2) along y: ends at (2, −1) and (4, −1), the normal to the right of the segment.
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_SEGMENT2D 1 2 4 2 6\n"
       "EDGE_SE2_SEGMENT2D 0 1 1 1 1 1",
       {1, -2, 3, -2}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_SEGMENT2D 1 2 4 2 6\n"
       "EDGE_SE2_SEGMENT2D_LINE 0 1 -1.5 0.25",
       {1.5 - kPi / 2, 0.75}},
      {"VERTEX_SE2 0 1 2 1.5707963267948966\nVERTEX_SEGMENT2D 1 2 4 2 6\n"
       "EDGE_SE2_SEGMENT2D_POINTLINE 0 1 1 1 1 -1.5",
       {3, -2, 1.5 - kPi / 2}},
      // Spatial poses at (1, 2, 3) that look along y.
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nVERTEX_SE3:QUAT 1 1 4 3" UPRIGHT
       "\nEDGE_SE3:QUAT 0 1 1 0 0" UPRIGHT,
       {1, 0, 0, 0, 0, -kHalf}},
      {"PARAMS_SE3OFFSET 0 0 0 1" UPRIGHT "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER
       "\nEDGE_SE3_PRIOR 0 0 1 0 0" UPRIGHT,
       {0, 2, 4, 0, 0, kHalf}},
      {"PARAMS_SE3OFFSET 0 0 0 1" UPRIGHT "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER
       "\nVERTEX_TRACKXYZ 1 0 6 5\nEDGE_SE3_TRACKXYZ 0 1 0 1 1 2",
       {3, 0, -1}},
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nVERTEX_TRACKXYZ 1 0 6 5\nVERTEX_TRACKXYZ 2 1 2 3\n"
       "EDGE_SE3_LOTSOF_XYZ 0 1 2 || 2 1 1 2 0 0 1",
       {3, 0, 0, 0, 0, -1}},
      {"PARAMS_SE3OFFSET 0 0 0 1" UPRIGHT "\nPARAMS_SE3OFFSET 1 0 0 2" UPRIGHT
       "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nVERTEX_SE3:QUAT 1 1 4 3" UPRIGHT
       "\nEDGE_SE3_OFFSET 0 1 0 1 1 0 0" UPRIGHT,
       {1, 0, 1, 0, 0, -kHalf}},
      // Driven 1 m along x with a sensor that looks to the left.
      {"VERTEX_SE3:QUAT 0 0 0 0" UPRIGHT "\nVERTEX_SE3:QUAT 1 1 0 0" UPRIGHT
       "\nVERTEX_SE3:QUAT 2 0 0 1" QUARTER "\nEDGE_SE3_CALIB 0 1 2 0 0 0" UPRIGHT,
       {0, -1, 0, 0, 0, 0}},
      {"PARAMS_SE3OFFSET 4 0 0 1" UPRIGHT "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER
       "\nEDGE_SE3_XYZ_PRIOR 0 4 0 0 1",
       {1, 2, 2}},
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nEDGE_SE3_PRIORXYZ 0 0 0 1", {1, 2, 2}},
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nEDGE_SE3_PRIORXY 0 0 1", {1, 1}},
      // The world's 2 y is ahead of a pose that looks along it; it was measured upwards.
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nEDGE_SE3_PRIORVEC 0 0 2 0 0 0 1", {1, 0, -1}},
      {"VERTEX_TRACKXYZ 0 1 2 3\nVERTEX_POINT_XYZ 1 4 7 9\nEDGE_POINTXYZ 0 1 1 1 1", {2, 4, 5}},
      {"VERTEX_XYZ 0 1 2 3\nEDGE_POINTXYZ_PRIOR 0 0 4 0", {1, -2, 3}},
      {"PARAMS_CAMERACALIB 0 0 0 -1" UPRIGHT " 100 200 30 40\nVERTEX_SE3:QUAT 0 0 0 0" UPRIGHT
       "\nVERTEX_TRACKXYZ 1 1 2 3\nEDGE_PROJECT_DEPTH 0 1 0 50 100 1",
       {5, 40, 3}},
      {"PARAMS_STEREOCAMERACALIB 0 0 0 -1" UPRIGHT
       " 100 200 30 40 0.1\nVERTEX_SE3:QUAT 0 0 0 0" UPRIGHT
       "\nVERTEX_TRACKXYZ 1 1 2 3\nEDGE_PROJECT_DISPARITY 0 1 0 50 100 1",
       {5, 40, -0.75}},
      // The wall y = 5, three metres ahead of the pose; measured 0.1 to the left, 0.2 up.
      {"VERTEX_SE3:QUAT 0 1 2 3" QUARTER "\nVERTEX_PLANE 1 0 2 0 -10 0 0 0\n"
       "EDGE_SE3_PLANE 0 1 0.97517032720181596 0.097843395007255714 0.19866933079506122 -1",
       {0.1, 0.2, 2}},
      // A floor, whose normal has no azimuth: taken as zero, y is to the left and up is back.
      {"VERTEX_SE3:QUAT 0 1 2 3" UPRIGHT "\nVERTEX_PLANE 1 0 0 1 0 0 0 0\n"
       "EDGE_SE3_PLANE 0 1 -0.19866933079506122 0 0.98006657784124163 3",
       {0, 0.2, 0}},
      {"VERTEX_SE3:QUAT 0 1 2 2" QUARTER "\nVERTEX_PLANE 1 0 2 0 -10 0 0 0\n"
       "VERTEX_SE3:QUAT 2 0.5 0 1" UPRIGHT
       "\nEDGE_SE3_PLANE_CALIB 0 1 2 0.97517032720181596 0.097843395007255714 "
       "0.19866933079506122 -1 1 0 0",
       {0.1, 0.2, 1.5}},
      {"VERTEX_PLANE 0 1 0 0 1 0 0 0\nVERTEX_PLANE 1 0 1 0 3 0 0 0\nEDGE_PLANE 0 1 0 0 0 1",
       {-1, 1, 0, 1}},
      // A vertical line through (1, 5, 0), w = p × d = (5, −1, 0): three metres ahead of the pose,
      // where w = (0, −3, 0). Measured at (1, 0, 0): the axes agree, the angle between (3, 1)
      // and (1, 1) is left.
      {"PARAMS_SE3OFFSET 0 0 0 9" UPRIGHT "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER
       "\nVERTEX_LINE3D 1 5 -1 0 0 0 1\nEDGE_SE3_LINE3D 0 1 0 0 -1 0 0 0 1",
       {0, 0, 0, std::atan(1.0) - std::atan(1.0 / 3.0)}},
      // Measured to the left, at (0, 3, 0): a quarter turn about the line, the second axis.
      {"PARAMS_SE3OFFSET 0 0 0 9" UPRIGHT "\nVERTEX_SE3:QUAT 0 1 2 3" QUARTER
       "\nVERTEX_LINE3D 1 5 -1 0 0 0 1\nEDGE_SE3_LINE3D 0 1 0 3 0 0 0 0 1",
       {0, kHalf, 0, 0}},
      // Poses 2 m apart along y that differ by a quarter turn, the measurement is none: log of
      // B Z⁻¹ A⁻¹, a turn about z by −π/2 whose translation is (0, 2, 0) − R (0, 0, 0).
      {"VERTEX_SE3:EXPMAP 0 0 0 0" QUARTER "\nVERTEX_SE3:EXPMAP 1 0 2 0" UPRIGHT
       "\nEDGE_SE3:EXPMAP 0 1 0 0 0" UPRIGHT,
       {0, 0, -kPi / 2, -kPi / 2, kPi / 2, 0}},
      {"PARAMS_CAMERAPARAMETERS 0 100 30 40 0.1\nVERTEX_TRACKXYZ 0 1 2 3\n"
       "VERTEX_SE3:EXPMAP 1 0 0 -1" UPRIGHT "\nEDGE_PROJECT_XYZ2UV:EXPMAP 0 1 0 50 100",
       {-5, 10}},
      {"PARAMS_CAMERAPARAMETERS 0 100 30 40 0.2\nVERTEX_TRACKXYZ 0 1 2 3\n"
       "VERTEX_SE3:EXPMAP 1 0 0 -1" UPRIGHT "\nEDGE_PROJECT_XYZ2UVU:EXPMAP 0 1 0 50 100 55",
       {-5, 10, 5}},
  };
  return all;
}

TEST(KnownErrors, AreWhatTheyAreByHand) {
  for (const Case& known : cases()) {
    SCOPED_TRACE(known.lines);
    expect_error(with_information(known.lines, known.error.size()), known.error, 1e-12);
  }
}

TEST(KnownErrors, CoverEveryRegisteredEdge) {
  // These have theirs in bundle_types_test.cpp and, for the prior, in marginalisation_test.cpp.
  std::set<std::string> covered{
      "EDGE_PROJECT_BAL",  "EDGE_PROJECT_INVERSE_DEPTH", "EDGE_PROJECT_P2MC",
      "EDGE_PROJECT_P2SC", "EDGE_PROJECT_PINHOLE",       "EDGE_PROJECT_STEREO",
      "PRIOR_DENSE",
  };
  for (const Case& known : cases()) covered.insert(tag_of(known.lines));
  const TypeRegistry types = standard_types();
  for (const std::string& tag : types.tags()) {
    const TypeRegistry::MakeEdgePool* make = types.edge_type(tag);
    // Aliases make a pool that is written under another tag.
    if (make == nullptr) continue;
    EXPECT_TRUE(covered.count((*make)()->tag())) << tag;
  }
}

TEST(Aliases, ReadOneTypeIntoOnePoolUnderItsOwnTag) {
  const Graph graph = read_graph_text(
      "VERTEX_XYZ 0 1 2 3\nVERTEX_TRACKXYZ 1 4 5 6\nVERTEX_POINT_XYZ 2 7 8 9\n"
      "EDGE_POINT_XYZ 0 1 1 1 1 1 0 0 1 0 1\nEDGE_POINTXYZ 1 2 1 1 1 1 0 0 1 0 1\n"
      "EDGE_XYZ_PRIOR 0 0 0 0 1 0 0 1 0 1\n",
      "aliases", {}, standard_types());
  EXPECT_EQ(graph.vertex_pools().size(), 1u);
  ASSERT_EQ(graph.edge_pools().size(), 2u);
  EXPECT_EQ(graph.edge_pools()[0]->size(), 2);
  const std::string text = write_graph_text(graph);
  EXPECT_EQ(text.find("VERTEX_XYZ 0 1 2 3\n"), 0u) << text;
  EXPECT_EQ(text.find("EDGE_POINT_XYZ"), std::string::npos) << text;
  EXPECT_NE(text.find("\nEDGE_POINTXYZ_PRIOR 0 0 0 0 1"), std::string::npos) << text;
}

TEST(LotsOfPoints, MustMeasureEveryVertexTheyName) {
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_XY 1 0 0\nVERTEX_XY 2 0 0\n";
  for (const char* edge :
       {"EDGE_SE2_LOTSOFXY 0 1 2 || 1 0 0 1 0 1",
        "EDGE_SE2_LOTSOFXY 0 1 2 || 3 0 0 0 0 0 0 1 0 0 0 0 0 1", "EDGE_SE2_LOTSOFXY 0 1 2 || -2",
        "EDGE_SE2_LOTSOFXY 0 1 2 || 2000000000"}) {
    try {
      read_graph_text(vertices + edge, "lots", {}, standard_types());
      ADD_FAILURE() << edge;
    } catch (const Error& error) {
      EXPECT_EQ(error.line(), 4) << error.what();
    }
  }
}

TEST(LotsOfPoints, AreRefusedWithoutAMeasurementOfEachAlsoInAProgram) {
  Graph graph;
  const VertexId<VertexSE2> pose = graph.add_vertex(0, VertexSE2());
  const VertexId<VertexXY> a = graph.add_vertex(1, VertexXY()), b = graph.add_vertex(2, VertexXY());
  EdgeSE2LotsOfXY scan;
  scan.resize(2);
  EXPECT_THROW(graph.add_dynamic_edge(scan, {a, b}, pose), Error);
  scan.resize(4);
  EXPECT_NO_THROW(graph.add_dynamic_edge(scan, {a, b}, pose));
}

}  // namespace
}  // namespace locograph::test
