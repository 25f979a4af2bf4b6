#pragma once
/// What the examples of types/ take for granted.

#include <documentation/example_context.h>
#include <documentation/planar_map.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/slam2d/vertices.h>
#include <locograph/types/slam3d/expmap.h>
#include <locograph/types/slam3d/planes_and_lines.h>

namespace locograph::documentation::in_types {

struct Context {
  PlanarMap map;
  Graph& graph = map.graph;
  std::unique_ptr<LinearSolver> solver = make_linear_solver("auto");
};

/// Two cameras that see four points, in the format of bundle adjustment in the large.
inline constexpr std::string_view kBundle =
    "2 4 8\n"
    "0 0 10 5\n0 1 -10 5\n0 2 10 -5\n0 3 -10 -6\n"
    "1 0 14 5\n1 1 -6 5\n1 2 15 -5\n1 3 -6 -5\n"
    "0\n0\n0\n0\n0\n0\n100\n0\n0\n"
    "0\n0\n0\n0.4\n0\n0\n100\n0\n0\n"
    "1\n0.5\n-10\n-1\n0.5\n-10\n1\n-0.5\n-10\n-1\n-0.5\n-10\n";

namespace best_guess_h {
struct Context : in_types::Context {
  Problem problem;
  Workspace workspace;
};
}  // namespace best_guess_h
namespace bundle_bal_file_h {
struct Context {
  const OptimiserOptions options;
  Context() { write_example_file("problem-49-7776-pre.txt", kBundle); }
};
}  // namespace bundle_bal_file_h
namespace bundle_camera_bal_h {
struct Context {
  Context() { write_example_file("problem.txt", kBundle); }
};
}  // namespace bundle_camera_bal_h
namespace doubtful_closures_h {
struct Context : in_types::Context {
  const GraduationOptions options;
};
}  // namespace doubtful_closures_h
namespace parts_h {
struct Context : in_types::Context {
  const int a = 1, b = 3;
};
}  // namespace parts_h
namespace slam2d_point_sets_h {
struct Context : in_types::Context {
  const VertexId<VertexXY> a = map.points[0], b = map.points[1],
                           c = graph.add_vertex(9, VertexXY({1.0, 0.5}));
  const VertexId<VertexSE2> pose = map.poses[1];
};
}  // namespace slam2d_point_sets_h
namespace slam2d_se2_h {
struct Context {
  const SE2<double> world_from_a{1.0, 2.0, 0.5}, a_from_b{0.5, 0.0, -0.1};
};
}  // namespace slam2d_se2_h
namespace slam3d_expmap_h {
struct Context {
  Graph graph;
  const SE3<double> world_from_camera;
  const VertexId<VertexPointXYZ> point =
      graph.add_vertex(0, VertexPointXYZ(Eigen::Vector3d(0.0, 0.0, 5.0)));
  Context() { graph.parameters().set(0, std::make_shared<PinholeCamera>()); }
};
}  // namespace slam3d_expmap_h
namespace slam3d_planes_and_lines_h {
struct Context {
  Graph graph;
  const VertexId<VertexSE3> pose = graph.add_vertex(0, VertexSE3());
  const VertexId<VertexPlane> plane = graph.add_vertex(1, VertexPlane());
};
}  // namespace slam3d_planes_and_lines_h
namespace slam3d_priors_h {
struct Context {
  const Eigen::Vector3d down_in_the_sensor = -Eigen::Vector3d::UnitZ();
};
}  // namespace slam3d_priors_h
namespace slam3d_se3_h {
struct Context {
  const SE3<double> world_from_a, a_from_b;
};
}  // namespace slam3d_se3_h
namespace standard_types_h {
struct Context {
  Context() {
    write_example_file("sphere.g2o",
                       "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"
                       "VERTEX_SE3:QUAT 1 1 0 0 0 0 0 1\n"
                       "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1 "
                       "1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n");
  }
};
}  // namespace standard_types_h

}  // namespace locograph::documentation::in_types
