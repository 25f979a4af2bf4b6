#include "core/toy_graphs.h"

#include <numbers>
#include <random>

namespace locograph::test {

std::string name_of(Algorithm algorithm) {
  switch (algorithm) {
    case Algorithm::kGaussNewton:
      return "GaussNewton";
    case Algorithm::kLevenbergMarquardt:
      return "LevenbergMarquardt";
    case Algorithm::kDogleg:
      return "Dogleg";
  }
  return "";
}

Graph ring_2d(int size, double noise) {
  std::mt19937 engine(1);
  std::normal_distribution<double> normal(0.0, noise);
  Graph graph;
  std::vector<VertexId<VertexSE2>> ids;
  SE2<double> pose;
  const SE2<double> motion(1.0, 0.0, 2.0 * std::numbers::pi / size);
  std::vector<SE2<double>> truth;
  for (int i = 0; i < size; ++i) {
    truth.push_back(pose);
    pose = pose * motion;
    const SE2<double> wrong(normal(engine), normal(engine), normal(engine));
    ids.push_back(graph.add_vertex(i, VertexSE2(i == 0 ? truth[0] : truth.back() * wrong)));
  }
  const auto tie = [&](int a, int b) {
    EdgeSE2 edge;
    edge.measurement =
        truth[a].inverse() * truth[b] * SE2<double>(normal(engine), normal(engine), normal(engine));
    edge.information = Eigen::Vector3d(10.0, 20.0, 50.0).asDiagonal();
    graph.add_edge(edge, ids[a], ids[b]);
  };
  for (int i = 0; i < size; ++i) tie(i, (i + 1) % size);
  tie(0, size / 2);
  graph.set_fixed(ids[0], true);
  return graph;
}

Graph helix_3d(int size, double noise) {
  std::mt19937 engine(2);
  std::normal_distribution<double> normal(0.0, noise);
  const auto small_motion = [&] {
    const Eigen::Vector3d t(normal(engine), normal(engine), normal(engine));
    const Eigen::Vector3d r(normal(engine), normal(engine), normal(engine));
    return SE3<double>(t, quaternion_exp<double>(r));
  };
  Graph graph;
  std::vector<VertexId<VertexSE3>> ids;
  std::vector<SE3<double>> truth;
  SE3<double> pose;
  const SE3<double> motion({1.0, 0.0, 0.1}, quaternion_exp<double>(Eigen::Vector3d(0.1, 0.2, 0.9)));
  for (int i = 0; i < size; ++i) {
    truth.push_back(pose);
    pose = pose * motion;
    ids.push_back(graph.add_vertex(i, VertexSE3(i == 0 ? pose : truth.back() * small_motion())));
  }
  graph.vertex(ids[0]) = VertexSE3(truth[0]);
  for (const int apart : {1, 6}) {
    for (int i = 0; i + apart < size; ++i) {
      EdgeSE3 edge;
      edge.measurement = truth[i].inverse() * truth[i + apart] * small_motion();
      edge.information.diagonal() << 10.0, 20.0, 30.0, 100.0, 200.0, 300.0;
      graph.add_edge(edge, ids[i], ids[i + apart]);
    }
  }
  graph.set_fixed(ids[0], true);
  return graph;
}

template <Derivatives D>
Graph mixed_graph() {
  std::mt19937 engine(3);
  std::normal_distribution<double> normal;
  Graph graph;
  std::vector<VertexId<VertexXY>> points;
  std::vector<VertexId<VertexSE2>> poses;
  for (int i = 0; i < 12; ++i) {
    points.push_back(graph.add_vertex(i, VertexXY({normal(engine), normal(engine)})));
    poses.push_back(graph.add_vertex(
        100 + i, VertexSE2(SE2<double>(normal(engine), normal(engine), normal(engine)))));
    EdgePriorSE2 prior;
    prior.measurement = SE2<double>(normal(engine), normal(engine), normal(engine));
    graph.add_edge(prior, poses.back());
  }
  for (int i = 0; i < 12; ++i) {
    ToyRange<D> range;
    range.measurement << 2.0, 0.5;
    graph.add_edge(range, poses[i], points[(i + 1) % 12]);
    ToyView<D> view;
    view.measurement << 1.0, 2.0, 3.0;
    graph.add_dynamic_edge(view, {points[i], points[(i + 3) % 12], points[(i + 5) % 12]}, poses[i]);
    ToyMoments<D> moments;
    graph.add_dynamic_edge(moments, {points[i], points[(i + 6) % 12]});
  }
  graph.set_fixed(poses[0], true);
  return graph;
}

template Graph mixed_graph<Derivatives::kByHand>();
template Graph mixed_graph<Derivatives::kDual>();
template Graph mixed_graph<Derivatives::kNumeric>();

Graph sized_graph() {
  Graph graph;
  for (int i = 0; i < 5; ++i) {
    const auto arm = graph.add_vertex(i, VertexJoints(Eigen::VectorXd::Constant(4 + i, 0.3)));
    const auto point = graph.add_vertex(100 + i, VertexXY({2.0, 1.0 + i}));
    ToyReach<Derivatives::kByHand> reach;
    graph.add_edge(reach, arm, point);
    ToySignal signal;
    signal.measurement = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);
    signal.information = Eigen::MatrixXd::Identity(6, 6);
    graph.add_dynamic_edge(signal, {point});
  }
  return graph;
}

OptimiserResult run(Graph& graph, const OptimiserOptions& options, const std::string& solver) {
  return optimise(graph, options, *make_linear_solver(solver));
}

}  // namespace locograph::test
