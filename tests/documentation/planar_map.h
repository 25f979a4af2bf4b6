#pragma once
/// A small map: three poses one metre apart that see two points, the first pose held, every
/// measurement a little off.
///
///     PlanarMap map;
///     optimise(map.graph, {}, *make_linear_solver("auto"));

#include <locograph/core/graph.h>
#include <locograph/core/workspace.h>
#include <locograph/types/slam2d/edges.h>

#include <string_view>

namespace locograph::documentation {

struct PlanarMap {
  Graph graph;
  VertexId<VertexSE2> poses[3];
  VertexId<VertexXY> points[2];
  EdgeId odometry[2], sights[6];

  PlanarMap() {
    for (int i = 0; i < 3; ++i) {
      poses[i] = graph.add_vertex(i, VertexSE2(SE2<double>(1.1 * i, 0.1, 0.05 * i)));
    }
    for (int i = 0; i < 2; ++i) {
      points[i] = graph.add_vertex(3 + i, VertexXY({1.5 * i, 1.9}));
    }
    for (int i = 0; i < 2; ++i) {
      EdgeSE2 edge;
      edge.measurement = SE2<double>(1.0, 0.0, 0.01);
      odometry[i] = graph.add_edge(edge, poses[i], poses[i + 1]);
    }
    for (int i = 0; i < 6; ++i) {
      EdgeSE2XY edge;
      edge.measurement = {1.5 * (i % 2) - 1.0 * (i / 2) + 0.02 * i, 2.0};
      sights[i] = graph.add_edge(edge, poses[i / 2], points[i % 2]);
    }
    graph.set_fixed(poses[0], true);
  }
};

/// What a file of a map looks like.
inline constexpr std::string_view kMapFile =
    "VERTEX_SE2 0 0 0 0\n"
    "VERTEX_SE2 1 1.1 0.1 0.1\n"
    "VERTEX_SE2 2 2.1 -0.1 0\n"
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
    "FIX 0\n";

/// The map, compiled, evaluated and linearised.
struct LinearisedMap : PlanarMap {
  Problem problem;
  Workspace workspace;

  LinearisedMap() {
    problem.compile(graph);
    workspace.allocate(problem);
    workspace.load_state();
    workspace.evaluate(workspace.state());
    workspace.linearise();
  }
};

}  // namespace locograph::documentation
