#include <locograph/common/check_option.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/weighted_square.h>

#include <algorithm>
#include <cmath>

namespace locograph {
namespace {

/// P(X ≤ x): the regularised incomplete gamma function P(freedom/2, x/2), by its recurrence
/// P(a + 1, y) = P(a, y) − yᵃe⁻ʸ/Γ(a + 1) from P(½, y) = erf √y or P(1, y) = 1 − e⁻ʸ.
double chi_squared_probability(int freedom, double x) {
  const double y = 0.5 * x;
  double a = freedom % 2 == 0 ? 1.0 : 0.5;
  double p = freedom % 2 == 0 ? -std::expm1(-y) : std::erf(std::sqrt(y));
  for (; a < 0.5 * freedom; a += 1.0) {
    p -= std::exp(a * std::log(y) - y - std::lgamma(a + 1.0));
  }
  return p;
}

struct Suspect {
  int slot;         ///< of the edge in the graph
  int pool, index;  ///< in that pool
  int compiled;     ///< its number among the compiled edges of the pool
  double width;
  RobustKernel own;
};

class Rounds {
 public:
  Rounds(Workspace& workspace, const GraduationOptions& options, std::span<const int> trusted)
      : workspace_(workspace), graph_(workspace.problem().graph()), options_(options) {
    std::vector<bool> is_trusted(graph_.edge_slots(), false);
    for (const int slot : trusted) is_trusted[slot] = true;
    const std::span<const CompiledEdges> compiled = workspace.problem().edges();
    std::vector<std::vector<int>> number(compiled.size());  // by pool and index, -1 for none
    for (std::size_t p = 0; p < compiled.size(); ++p) {
      number[p].assign(graph_.edge_pools()[p]->size(), -1);
      for (std::size_t k = 0; k < compiled[p].edges.size(); ++k) {
        if (!compiled[p].constraint_row.empty() && compiled[p].constraint_row[k] >= 0) continue;
        number[p][compiled[p].edges[k]] = static_cast<int>(k);
      }
    }
    double each = options.inlier_probability;
    if (options.for_all) {
      int count = 0;
      for (int slot = 0; slot < graph_.edge_slots(); ++slot) {
        if (graph_.edge_alive(slot) && !is_trusted[slot]) ++count;
      }
      each = 1.0 - (1.0 - each) / std::max(count, 1);
    }
    for (int slot = 0; slot < graph_.edge_slots(); ++slot) {
      if (!graph_.edge_alive(slot) || is_trusted[slot]) continue;
      const Graph::EdgeRecord& record = graph_.edge_record(slot);
      const int k = number[record.pool][record.index];
      if (k < 0) continue;
      EdgePool& pool = *graph_.edge_pools()[record.pool];
      const double width =
          options.width > 0.0 ? options.width
                              : std::sqrt(chi_squared_quantile(pool.dimension(record.index), each));
      suspects_.push_back({slot, record.pool, record.index, k, width, pool.kernel(record.index)});
    }
    squared_.resize(suspects_.size());
  }
  ~Rounds() {
    for (const Suspect& suspect : suspects_) kernel(suspect) = suspect.own;
  }
  Rounds(const Rounds&) = delete;
  Rounds& operator=(const Rounds&) = delete;

  /// The first control parameter, for which the kernel is convex at all errors there are: Yang et
  /// al. 2020, remark 5.
  void begin() {
    measure();
    double worst = 0.0;
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
      worst = std::max(worst, squared_[i] / (suspects_[i].width * suspects_[i].width));
    }
    if (options_.kind == Graduation::kTruncated) {
      control_ = worst > 1.0 ? 1.0 / (2.0 * worst - 1.0) : kSharp;
    } else {
      control_ = std::max(2.0 * worst, 1.0);
    }
    set_kernels();
  }
  /// Sharpens the kernels; false when they were as sharp as they get.
  bool next() {
    if (last()) return false;
    if (options_.kind == Graduation::kTruncated) {
      control_ *= options_.factor;
      measure();
      // Once no error lies in the transition band a sharper kernel weighs the same.
      if (control_ > 1e6 || !between()) control_ = kSharp;
    } else {
      control_ = std::max(control_ / options_.factor, 1.0);
    }
    set_kernels();
    return true;
  }
  bool last() const {
    return options_.kind == Graduation::kTruncated ? control_ == kSharp : control_ <= 1.0;
  }
  void sharpen() {
    control_ = options_.kind == Graduation::kTruncated ? kSharp : 1.0;
    set_kernels();
  }
  void report(GraduationResult& result) {
    measure();
    result.weight.assign(graph_.edge_slots(), 1.0);
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
      const double weight = kernel(suspects_[i]).weights(squared_[i]).weight;
      result.weight[suspects_[i].slot] = weight;
      if (!(weight >= 0.5)) ++result.rejected;
    }
  }

 private:
  static constexpr double kSharp = std::numeric_limits<double>::infinity();

  RobustKernel& kernel(const Suspect& suspect) {
    return graph_.edge_pools()[suspect.pool]->kernel(suspect.index);
  }
  void set_kernels() {
    for (const Suspect& s : suspects_) {
      kernel(s) =
          options_.kind == Graduation::kTruncated
              ? RobustKernel(RobustKernel::Kind::kSaturated, s.width, control_)
              : RobustKernel(RobustKernel::Kind::kGemanMcClure, s.width * std::sqrt(control_));
    }
  }
  bool between() {
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
      const double u = squared_[i] / (suspects_[i].width * suspects_[i].width);
      if (u > control_ / (control_ + 1.0) && u < (control_ + 1.0) / control_) return true;
    }
    return false;
  }
  /// eᵀΩe of the suspects at the present state.
  void measure() {
    workspace_.evaluate(workspace_.state());
    for (std::size_t i = 0; i < suspects_.size(); ++i) {
      const EdgePool& pool = *graph_.edge_pools()[suspects_[i].pool];
      error_.resize(pool.dimension(suspects_[i].index));
      workspace_.error(suspects_[i].pool, suspects_[i].compiled, error_.data());
      squared_[i] = weighted_square(pool, suspects_[i].index, error_);
    }
  }

  Workspace& workspace_;
  Graph& graph_;
  GraduationOptions options_;
  std::vector<Suspect> suspects_;
  std::vector<double> squared_;
  Eigen::VectorXd error_;
  double control_ = kSharp;  ///< μ
};

/// On the edges that are not `out`. The others are rejected.
GraduationResult optimise_without(Graph& graph, const std::vector<bool>& out,
                                  const GraduationOptions& options, LinearSolver& solver,
                                  std::span<const int> trusted, ThreadPool* threads) {
  std::vector<int> used;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (graph.edge_alive(slot) && !out[slot]) used.push_back(slot);
  }
  Problem problem;
  if (static_cast<int>(used.size()) == graph.edge_count()) {
    problem.compile(graph);
  } else {
    problem.compile_on(graph, used);
  }
  Workspace workspace;
  workspace.allocate(problem);
  workspace.use_threads(threads);
  workspace.load_state();
  GraduationResult result = optimise_graduated(workspace, options, solver, trusted);
  workspace.store_state();
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!out[slot]) continue;
    result.weight[slot] = 0.0;
    ++result.rejected;
  }
  return result;
}

/// `out` becomes what is rejected at the present state. False when nothing comes back.
bool bring_back(Graph& graph, std::vector<bool>& out, const GraduationOptions& options,
                std::span<const int> trusted, const GraduationResult& result) {
  std::vector<int> doubted;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (out[slot]) doubted.push_back(slot);
  }
  if (doubted.empty()) return false;
  Problem problem;
  problem.compile_on(graph, doubted);
  Workspace workspace;
  workspace.allocate(problem);
  workspace.load_state();
  GraduationResult back;
  Rounds rounds(workspace, options, trusted);
  rounds.sharpen();
  rounds.report(back);
  if (back.rejected == static_cast<int>(doubted.size())) return false;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (graph.edge_alive(slot)) out[slot] = (out[slot] ? back : result).weight[slot] < 0.5;
  }
  return true;
}

}  // namespace

void GraduationOptions::validate() const {
  check_option(inlier_probability > 0.0 && inlier_probability < 1.0, "inlier_probability",
               "a probability in (0, 1)");
  check_option(width >= 0.0 && std::isfinite(width), "width", "0 or a positive number");
  check_option(factor > 1.0 && std::isfinite(factor), "factor", "a number above 1");
  check_option(max_rounds >= 1, "max_rounds", "1 or more");
  check_option(iterations_per_round >= 1, "iterations_per_round", "1 or more");
  optimiser.validate();
}

double chi_squared_quantile(int freedom, double probability) {
  double low = 0.0, high = 1.0;
  while (chi_squared_probability(freedom, high) < probability) high *= 2.0;
  for (double middle = 0.5 * high; middle > low && middle < high; middle = 0.5 * (low + high)) {
    (chi_squared_probability(freedom, middle) < probability ? low : high) = middle;
  }
  return high;
}

std::vector<int> odometry_edges(const Graph& graph) {
  std::vector<int> found;
  for (int slot = 0; slot < graph.edge_slots(); ++slot) {
    if (!graph.edge_alive(slot)) continue;
    const std::span<const int> vertices = graph.edge_vertices(slot);
    bool trusted = vertices.size() == 1;
    if (vertices.size() == 2) {
      const long long apart = static_cast<long long>(graph.vertex_record(vertices[0]).id) -
                              graph.vertex_record(vertices[1]).id;
      trusted = apart == 1 || apart == -1 || graph.incident_edges(vertices[0]).size() == 1 ||
                graph.incident_edges(vertices[1]).size() == 1;
    }
    if (trusted) found.push_back(slot);
  }
  return found;
}

GraduationResult optimise_graduated(Workspace& workspace, const GraduationOptions& options,
                                    LinearSolver& solver, std::span<const int> trusted) {
  options.validate();
  GraduationResult result;
  OptimiserOptions inner = options.optimiser;
  inner.max_iterations = std::min(inner.max_iterations, options.iterations_per_round);
  Optimiser some(inner), all(options.optimiser);
  Rounds rounds(workspace, options, trusted);
  rounds.begin();
  Cost initial;
  for (;;) {
    ++result.rounds;
    if (result.rounds >= options.max_rounds) rounds.sharpen();
    Optimiser& optimiser = rounds.last() ? all : some;
    optimiser.start(workspace, solver);
    if (result.rounds == 1) initial = optimiser.result().initial;
    while (optimiser.iterate()) {
    }
    result.iterations += optimiser.result().iterations;
    const OptimiserResult::Reason reason = optimiser.result().reason;
    const bool broken = reason == OptimiserResult::Reason::kDeadline ||
                        reason == OptimiserResult::Reason::kStopped ||
                        reason == OptimiserResult::Reason::kNotFinite ||
                        reason == OptimiserResult::Reason::kNothingToDo;
    if (broken || !rounds.next()) {
      result.optimiser = optimiser.result();
      break;
    }
  }
  result.optimiser.initial = initial;
  rounds.report(result);
  return result;
}

GraduationResult optimise_graduated(Graph& graph, const GraduationOptions& options,
                                    LinearSolver& solver, std::span<const int> trusted,
                                    std::span<const int> doubted, ThreadPool* threads) {
  constexpr int kMostPasses = 20;
  std::vector<bool> out(graph.edge_slots(), false);
  for (const int slot : doubted) out[slot] = graph.edge_alive(slot);
  GraduationResult result;
  for (int pass = 1;; ++pass) {
    GraduationResult now = optimise_without(graph, out, options, solver, trusted, threads);
    if (pass > 1) now.optimiser.initial = result.optimiser.initial;
    now.rounds += result.rounds;
    now.iterations += result.iterations;
    result = std::move(now);
    if (doubted.empty() || pass == kMostPasses ||
        result.optimiser.reason == OptimiserResult::Reason::kDeadline ||
        result.optimiser.reason == OptimiserResult::Reason::kStopped ||
        !bring_back(graph, out, options, trusted, result)) {
      break;
    }
  }
  return result;
}

}  // namespace locograph
