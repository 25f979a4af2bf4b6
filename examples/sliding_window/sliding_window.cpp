/// A planar pose graph replayed pose by pose through a window of fixed length: poses that leave it
/// are marginalised into a prior, then the result is compared with the batch solution.
///
///     sliding_window map.g2o [POSES IN THE WINDOW, 50]
///
/// Measurements of poses that left the window before they came are dropped, as a robot without
/// memory would have to; the batch solution has the same measurements.

#include <locograph/common/deadline.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/marginalisation.h>
#include <locograph/core/optimiser.h>
#include <locograph/solvers/linear_solvers.h>
#include <locograph/types/slam2d/edges.h>
#include <locograph/types/standard_types.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>

using namespace locograph;

namespace {

struct Measurement {
  int from = 0, to = 0;  ///< ids
  EdgeSE2 edge;
  int last() const { return std::max(from, to); }
};

std::vector<Measurement> measurements_by_time(const Graph& map) {
  std::vector<Measurement> all;
  for (const EdgeSE2& edge : map.edges_of<EdgeSE2>()) {
    const int from = map.vertex_record(edge.vertices[0]).id;
    const int to = map.vertex_record(edge.vertices[1]).id;
    all.push_back({from, to, edge});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Measurement& a, const Measurement& b) { return a.last() < b.last(); });
  return all;
}

/// The graph of the poses in the window; compiled anew after each pose, everything else is kept.
class SlidingWindow {
 public:
  explicit SlidingWindow(std::size_t length) : length_(length) {}

  /// Adds a pose with its measurements; those of poses that have left are dropped.
  void add_pose(int id, std::vector<Measurement> measurements) {
    std::erase_if(measurements, [&](const Measurement& m) {
      return !slot_.contains(m.from == id ? m.to : m.from);
    });
    SE2<double> guess;
    for (const Measurement& m : measurements) {
      const int other = m.from == id ? m.to : m.from;
      const SE2<double> there = graph_.vertex(VertexId<VertexSE2>{slot_.at(other)}).pose();
      guess = m.to == id ? m.edge.predict_second(there) : m.edge.predict_first(there);
      if (std::abs(other - id) == 1) break;  // odometry
    }
    const VertexId<VertexSE2> pose = graph_.add_vertex(id, VertexSE2(guess));
    if (slot_.empty()) graph_.set_fixed(pose, true);
    slot_[id] = pose.slot;
    window_.push_back(id);
    for (const Measurement& m : measurements) {
      graph_.add_edge(m.edge, VertexId<VertexSE2>{slot_.at(m.from)},
                      VertexId<VertexSE2>{slot_.at(m.to)});
      used.push_back(m);
    }
    optimise_window();
    if (window_.size() > length_) {
      marginalise(graph_, {slot_.at(window_.front())});
      slot_.erase(window_.front());
      window_.pop_front();
    }
  }

  SE2<double> pose(int id) const { return graph_.vertex(VertexId<VertexSE2>{slot_.at(id)}).pose(); }
  const std::deque<int>& window() const { return window_; }

  std::vector<Measurement> used;
  int iterations = 0;

 private:
  void optimise_window() {
    std::vector<int> slots;
    for (const int id : window_) slots.push_back(slot_.at(id));
    problem_.compile(graph_, slots);
    workspace_.allocate(problem_);
    workspace_.load_state();
    optimiser_.start(workspace_, *solver_);
    while (optimiser_.iterate()) {
    }
    workspace_.store_state();
    iterations += optimiser_.result().iterations;
  }

  std::size_t length_;
  Graph graph_;
  std::map<int, int> slot_;  ///< by id
  std::deque<int> window_;   ///< ids, the oldest first
  Problem problem_;
  Workspace workspace_;
  Optimiser optimiser_{OptimiserOptions{}};
  std::unique_ptr<LinearSolver> solver_ = make_linear_solver("auto");
};

Graph batch_solution(const std::vector<Measurement>& measurements) {
  Graph graph;
  std::map<int, VertexId<VertexSE2>> ids;
  for (const Measurement& m : measurements) {
    // In the order of time: one of the two is known.
    for (const int id : {m.from, m.to}) {
      if (ids.contains(id)) continue;
      const int other = id == m.from ? m.to : m.from;
      SE2<double> guess;
      if (ids.contains(other)) {
        const SE2<double> there = graph.vertex(ids[other]).pose();
        guess = id == m.to ? m.edge.predict_second(there) : m.edge.predict_first(there);
      }
      ids[id] = graph.add_vertex(id, VertexSE2(guess));
    }
    graph.add_edge(m.edge, ids[m.from], ids[m.to]);
  }
  graph.set_fixed(ids.begin()->second, true);
  const OptimiserResult result = optimise(graph, {}, *make_linear_solver("auto"));
  std::printf("batch: chi2 %.6g, %s\n", result.final.chi2, result.reason_text().c_str());
  return graph;
}

int run(const char* file, std::size_t length) {
  const std::vector<Measurement> all = measurements_by_time(read_graph(file, standard_types()));
  if (all.empty()) throw Error(std::string(file) + " holds no EDGE_SE2");
  SlidingWindow window(length);
  std::vector<double> seconds;
  std::size_t next = 0;
  int first = all[0].last();
  for (const Measurement& m : all) first = std::min({first, m.from, m.to});
  window.add_pose(first, {});
  while (next < all.size()) {
    const int id = all[next].last();
    std::vector<Measurement> now;
    while (next < all.size() && all[next].last() == id) now.push_back(all[next++]);
    const Stopwatch watch;
    window.add_pose(id, now);
    seconds.push_back(watch.seconds());
  }
  std::printf("window of %zu poses: %zu poses, %zu of %zu measurements used\n", length,
              seconds.size() + 1, window.used.size(), all.size());
  std::sort(seconds.begin(), seconds.end());
  std::printf("update: median %.3f ms, slowest %.3f ms, %.2f iterations\n",
              1e3 * seconds[seconds.size() / 2], 1e3 * seconds.back(),
              static_cast<double>(window.iterations) / static_cast<double>(seconds.size()));

  Graph batch = batch_solution(window.used);
  double position = 0.0, heading = 0.0;
  const SE2<double> ours = window.pose(window.window().front());
  const SE2<double> theirs = batch.vertex(batch.find<VertexSE2>(window.window().front())).pose();
  double shape = 0.0;
  for (const int id : window.window()) {
    const SE2<double> a = window.pose(id), b = batch.vertex(batch.find<VertexSE2>(id)).pose();
    position += (a.translation() - b.translation()).squaredNorm();
    heading += std::pow(wrap_angle(a.angle() - b.angle()), 2);
    shape +=
        ((ours.inverse() * a).translation() - (theirs.inverse() * b).translation()).squaredNorm();
  }
  const double n = static_cast<double>(window.window().size());
  std::printf(
      "window against batch: %.4g m and %.4g rad apart; relative to its first pose %.4g m\n",
      std::sqrt(position / n), std::sqrt(heading / n), std::sqrt(shape / n));
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 2) {
    std::fprintf(stderr, "usage: sliding_window map.g2o [POSES]\n");
    return 2;
  }
  try {
    const int length = count > 2 ? std::atoi(arguments[2]) : 50;
    if (length < 2) throw Error("a window of fewer than 2 poses", "2 or more");
    return run(arguments[1], static_cast<std::size_t>(length));
  } catch (const Error& error) {
    std::fprintf(stderr, "sliding_window: %s\n", error.what());
    return 1;
  }
}
