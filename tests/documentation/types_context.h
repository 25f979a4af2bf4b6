#pragma once
/// What the examples of types/ take for granted.

#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/slam2d/vertices.h>
#include <locograph/types/slam3d/expmap.h>
#include <locograph/types/slam3d/planes_and_lines.h>

#include <iostream>
#include <memory>

namespace locograph::documentation::in_types {

extern Graph graph;
extern std::unique_ptr<LinearSolver> solver;

namespace best_guess_h {
extern Problem problem;
extern Workspace workspace;
}  // namespace best_guess_h
namespace bundle_bal_file_h {
extern const OptimiserOptions options;
}
namespace doubtful_closures_h {
extern const GraduationOptions options;
}
namespace parts_h {
extern const int a, b;
}
namespace slam2d_point_sets_h {
extern VertexId<VertexXY> a, b, c;
extern VertexId<VertexSE2> pose;
}  // namespace slam2d_point_sets_h
namespace slam2d_se2_h {
extern const SE2<double> world_from_a, a_from_b;
}
namespace slam3d_expmap_h {
extern const SE3<double> world_from_camera;
extern VertexId<VertexPointXYZ> point;
}  // namespace slam3d_expmap_h
namespace slam3d_planes_and_lines_h {
extern VertexId<VertexSE3> pose;
extern VertexId<VertexPlane> plane;
}  // namespace slam3d_planes_and_lines_h
namespace slam3d_priors_h {
extern const Eigen::Vector3d down_in_the_sensor;
}
namespace slam3d_se3_h {
extern const SE3<double> world_from_a, a_from_b;
}

}  // namespace locograph::documentation::in_types
