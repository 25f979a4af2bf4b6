#include <locograph/apps/about_file.h>
#include <locograph/apps/diagnosis_json.h>
#include <locograph/apps/gauge.h>
#include <locograph/apps/graph_types.h>
#include <locograph/apps/optimize_command.h>
#include <locograph/apps/output.h>
#include <locograph/apps/plan_file.h>
#include <locograph/apps/progress.h>
#include <locograph/apps/violations_json.h>
#include <locograph/common/deadline.h>
#include <locograph/common/stop_signals.h>
#include <locograph/core/graduated_non_convexity.h>
#include <locograph/core/graph_file.h>
#include <locograph/core/initial_guess.h>
#include <locograph/core/optimiser.h>
#include <locograph/planners/plan/carried_wrenches.h>
#include <locograph/planners/plan/plan.h>
#include <locograph/planners/plan/slope_limits.h>
#include <locograph/plugins/configuration/plan_parameters.h>
#include <locograph/solvers/linear_solvers.h>
#ifdef LOCOGRAPH_WITH_CERES_BACKEND
#include <locograph/solvers/ceres_backend.h>
#endif
#include <locograph/types/best_guess.h>
#include <locograph/types/bundle/bal_file.h>
#include <locograph/types/chordal_guess.h>
#include <locograph/types/doubtful_closures.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace locograph {
namespace {

struct OptimizeOptions {
  std::string input, output;
  std::string algorithm = "lm";
  std::string linear_solver = "auto";
  std::string kernel = "none";
  std::string initial_guess = "auto";
  OptimiserOptions optimiser;
  int threads = 1;
  std::vector<std::string> plugins;
  bool graduated = false, lenient = false, json = false, diagnose = false;
  bool bal = false;  ///< the input is a file of bundle adjustment in the large
};

struct Times {
  double load = 0.0, guess = 0.0, compile = 0.0, optimize = 0.0, total = 0.0;
};

/// The graph compiled, and what its first values are.
struct Start {
  Problem problem;
  Workspace workspace;
  std::string guess;         ///< as --initial-guess names it, never auto
  std::vector<int> doubted;  ///< loop closures that nothing confirms, left out of the guess
};

const std::map<std::string, Algorithm> kAlgorithms = {
    {"lm", Algorithm::kLevenbergMarquardt},
    {"gn", Algorithm::kGaussNewton},
    {"dogleg", Algorithm::kDogleg},
};

/// What the values that --initial-guess names are.
const std::map<std::string, std::string> kStarts = {
    {"none", "the values of the file"},
    {"odometry", "odometry"},
    {"spanning-tree", "a spanning tree"},
    {"chordal", "the chordal guess"},
};

/// By its extension, or by its first line.
bool is_bal_file(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".g2o") return false;
  if (extension == ".bal") return true;
  // What begins in a pipe cannot be read twice.
  std::error_code too_long;
  if (!std::filesystem::is_regular_file(path, too_long)) return false;
  std::ifstream in(path);
  std::string begin(200, '\0');
  in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(in.gcount()));
  return looks_like_bal(begin);
}

Graph load(const OptimizeOptions& options, ReadReport& report) {
  Progress progress("reading " + input_name(options.input));
  if (options.bal) return read_bal(options.input);
  const ReadOptions read = {.lenient = options.lenient,
                            .progress = [&progress](double read) { progress.show(read); }};
  const TypeRegistry types = graph_types(options.plugins);
  Graph graph = read_input_graph(options.input, types, read, &report);
  if (graph.vertex_count() == 0) {
    throw Error(input_name(options.input), 0, "holds no vertex of a known type", "VERTEX_… lines");
  }
  for (const std::string& unknown : report.unknown) print_warning(unknown + ": line left out");
  if (report.indefinite_information > 0) {
    print_warning(input_name(options.input) + ":" + std::to_string(report.first_indefinite_line) +
                  ": the first of " + std::to_string(report.indefinite_information) +
                  " indefinite information matrices, all projected to the nearest positive "
                  "semi-definite ones");
  }
  return graph;
}

/// A plan as it was: its curve goes on through its configurations when they are moved.
struct PlanBefore {
  Plan plan;
  Motion motion;
};

/// Nothing for a graph that does not say it is a plan of a motion. Throws Error for one that says
/// so and is none.
std::optional<PlanBefore> plan_before(const Graph& graph, const std::string& file) {
  if (!graph.parameters().find<PlanParameter>()) return {};
  PlanBefore before{plan_of_file(graph, file), {}};
  require_plan(before.plan, file);
  if (before.plan.stances_only) return {};
  before.motion = motion_of_slopes(graph, before.plan);
  return before;
}

/// Fills start.guess and start.doubted; there is none without a kernel or graduation to bring the
/// doubted closures back.
void guess(Graph& graph, const OptimizeOptions& options, const ReadReport& report,
           LinearSolver& solver, Start& start) {
  // What graduation starts from is trusted odometry, and its cost counts the wrong closures in
  // full.
  start.guess = options.initial_guess != "auto"    ? options.initial_guess
                : options.bal || options.graduated ? "none"
                                                   : "auto";
  const bool chordal = start.guess == "auto" || start.guess == "chordal";
  if (chordal && (options.graduated || options.kernel != "none")) {
    start.doubted = doubtful_closures(graph, odometry_edges(graph));
  }
  int unreached = 0;
  if (start.guess == "odometry") unreached = guess_from_odometry(graph);
  if (start.guess == "spanning-tree") unreached = guess_from_spanning_tree(graph);
  if (start.guess == "chordal") unreached = guess_chordal(graph, solver, start.doubted);
  if (start.guess == "auto") {
    const BestGuess best =
        take_best_guess(start.workspace, solver,
                        {.use_present = !report.vertices_from_edges, .left_out = start.doubted});
    start.guess = best.taken;
    unreached = best.unreached;
  }
  if (unreached > 0) {
    print_warning(counted(unreached, "vertex", "vertices") +
                  " cannot be predicted from any edge: first values kept");
  }
}

/// Scalar unknowns of the graph.
int unknowns(const Graph& graph) {
  int sum = 0;
  for (int v = 0; v < graph.vertex_slots(); ++v) {
    if (graph.vertex_alive(v) && !graph.vertex_record(v).fixed) sum += graph.dimension(v);
  }
  return sum;
}

OptimiserResult run_graduated(Graph& graph, const OptimizeOptions& options, LinearSolver& solver,
                              const Start& start, int& rejected, Times& times) {
  const Stopwatch watch;
  ThreadPool threads(options.threads);
  solver.use_threads(&threads);
  GraduationOptions graduation;
  graduation.optimiser = options.optimiser;
  graduation.for_all = start.guess == "chordal";
  GraduationResult result =
      optimise_graduated(graph, graduation, solver, odometry_edges(graph), start.doubted, &threads);
  solver.use_threads(nullptr);
  times.optimize = watch.seconds();
  rejected = result.rejected;
  result.optimiser.iterations = result.iterations;
  return result.optimiser;
}

OptimiserResult run(Start& start, const OptimizeOptions& options, LinearSolver& solver,
                    Times& times) {
  Stopwatch watch;
  ThreadPool threads(options.threads);
  Workspace& workspace = start.workspace;
  workspace.use_threads(&threads);
  workspace.load_state();
  solver.use_threads(&threads);
  Optimiser optimiser(options.optimiser);
  optimiser.start(workspace, solver);
  times.compile += watch.lap();
  Progress progress("optimising " + input_name(options.input));
  while (optimiser.iterate()) {
    progress.show({}, [&] {
      const OptimiserResult& so_far = optimiser.result();
      return "iteration " + std::to_string(so_far.iterations) + ", chi2 " +
             short_number(so_far.final.chi2);
    });
  }
  workspace.store_state();
  workspace.use_threads(nullptr);
  solver.use_threads(nullptr);
  times.optimize = watch.seconds();
  return optimiser.result();
}

/// The whole graph by Ceres.
OptimiserResult run_ceres([[maybe_unused]] Graph& graph,
                          [[maybe_unused]] const OptimizeOptions& options,
                          [[maybe_unused]] Times& times) {
#ifdef LOCOGRAPH_WITH_CERES_BACKEND
  const Stopwatch watch;
  const OptimiserResult result = optimise_with_ceres(graph, options.optimiser, options.threads);
  times.optimize = watch.seconds();
  return result;
#else
  throw Error("this locograph was built without Ceres", "another --linear-solver");
#endif
}

/// Whether the numbers ask for an explanation.
bool calls_for_diagnosis(const OptimiserResult& result) {
  using Reason = OptimiserResult::Reason;
  return result.reason == Reason::kNotFinite || result.reason == Reason::kSingular ||
         result.reason == Reason::kNoProgress || (result.singular_vertex >= 0 && !result.converged);
}

Json iterations_json(const OptimiserResult& result) {
  Json all = Json::array();
  for (const IterationStatistics& now : result.statistics) {
    all.push_back({{"cost", now.cost},
                   {"chi2", now.chi2},
                   {"gain_ratio", now.gain_ratio},
                   {"lambda", now.lambda},
                   {"step_norm", now.step_norm},
                   {"refusals", now.refusals},
                   {"time",
                    {{"linearise", now.time_linearise},
                     {"solve", now.time_solve},
                     {"evaluate", now.time_evaluate}}}});
  }
  return all;
}

std::string reason(const OptimiserResult& result, const Graph& graph) {
  std::string text = result.reason_text();
  if (result.reason == OptimiserResult::Reason::kSingular && result.singular_vertex >= 0) {
    text += " at vertex " + std::to_string(graph.vertex_record(result.singular_vertex).id);
  }
  return text;
}

/// JSON has no NaN: a cost that is none is null.
Json finite(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

void print_summary(const OptimizeOptions& options, const Json& result) {
  const auto number = [&result](const char* key) {
    return result[key].is_null() ? "not a number" : short_number(result[key].get<double>());
  };
  std::string text = input_name(options.input) + ": " +
                     counted(result["vertices"], "vertex", "vertices") + ", " +
                     counted(result["edges"], "edge", "edges") + ", " +
                     counted(result["dimension"], "unknown", "unknowns") + ", " +
                     result["gauge"].get<std::string>() + '\n';
  text += "starts from " + kStarts.at(result["initial_guess"].get<std::string>()) + '\n';
  text += "chi2 " + number("initial_chi2") + " -> " + number("final_chi2");
  if (options.kernel != "none") {
    text += ", robust cost " + number("initial_cost") + " -> " + number("final_cost") + " (" +
            options.kernel + ")";
  }
  text += ", " + counted(result["iterations"], "iteration", "iterations") + ", " +
          short_number(result["time"]["total"]) + " s (" + result["algorithm"].get<std::string>() +
          ", " + result["linear_solver"].get<std::string>() + ")\n";
  if (result.contains("rejected_edges")) {
    text += counted(result["rejected_edges"], "edge", "edges") + " rejected as wrong\n";
  }
  text += std::string(result["converged"] ? "" : "not converged: ") +
          result["reason"].get<std::string>() + '\n';
  if (result.contains("violations")) {
    text += counted(result["constraints"], "constraint", "constraints") + ", " +
            counted(result["violated_rows"], "row", "rows") + " violated\n";
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(kMost, result["violations"].size()); ++i) {
      text += "  " + result["violations"][i]["text"].get<std::string>() + '\n';
    }
  }
  if (result.contains("diagnosis_text")) text += result["diagnosis_text"].get<std::string>();
  if (result.contains("output")) {
    text += "written: " + result["output"].get<std::string>() + '\n';
  }
  print_text(text);
}

ExitCode optimize(const OptimizeOptions& options) {
  if (!options.output.empty()) check_output(options.output, {options.input}, options.json);
  options.optimiser.validate();
  const bool ceres = options.linear_solver == "ceres";
  if (ceres && options.graduated) throw Error("Ceres does not graduate", "--gnc without ceres");
  const std::unique_ptr<LinearSolver> solver =
      make_linear_solver(ceres ? "auto" : options.linear_solver);
  const RobustKernel kernel = RobustKernel::parse(options.kernel);

  Times times;
  const Stopwatch total;
  ReadReport report;
  Graph graph = load(options, report);
  times.load = total.seconds();
  if (kernel.kind != RobustKernel::Kind::kNone) graph.set_kernel(kernel);
  const std::optional<PlanBefore> before = plan_before(graph, input_name(options.input));
  Gauge gauge;
  if (options.bal) {
    gauge.text = "free, held by damping";
  } else {
    gauge = hold_gauge(graph, input_name(options.input), options.lenient);
    mark_points_for_elimination(graph);
  }
  Stopwatch watch;
  Start start;
  start.problem.compile(graph);
  start.workspace.allocate(start.problem);
  times.compile = watch.lap();
  about_file(input_name(options.input), [&] { guess(graph, options, report, *solver, start); });
  times.guess = watch.lap();
  const int dimension = unknowns(graph);
  int rejected = 0;
  const FinishOnSignal finish;
  const OptimiserResult result =
      ceres ? run_ceres(graph, options, times) : about_file(input_name(options.input), [&] {
        return options.graduated ? run_graduated(graph, options, *solver, start, rejected, times)
                                 : run(start, options, *solver, times);
      });
  Json diagnosis;
  std::string diagnosis_text;
  bool interrupted = result.reason == OptimiserResult::Reason::kStopped;
  if (options.diagnose || calls_for_diagnosis(result)) {
    const Progress progress("diagnosing " + input_name(options.input));
    const Diagnosis found = diagnose(graph, {}, {.stop = &stop_flag()});
    interrupted = interrupted || !found.complete;
    diagnosis = diagnosis_json(found, graph);
    diagnosis_text = found.text(graph);
  }
  gauge.release(graph);
  times.total = total.seconds();

  Json json = {
      {"vertices", graph.vertex_count()},
      {"edges", graph.edge_count()},
      {"dimension", dimension},
      {"gauge", gauge.text},
      {"information_projected", report.indefinite_information},
      {"lines_left_out", report.unknown.size()},
      {"initial_chi2", finite(result.initial.chi2)},
      {"final_chi2", finite(result.final.chi2)},
      {"initial_cost", finite(result.initial.robust)},
      {"final_cost", finite(result.final.robust)},
      {"kernel", options.kernel},
      {"iterations", result.iterations},
      {"converged", result.converged},
      {"reason", interrupted ? "interrupted" : reason(result, graph)},
      {"initial_guess", start.guess},
      {"algorithm", options.algorithm},
      {"linear_solver", ceres ? "ceres" : solver->name()},
      {"threads", options.threads},
      {"time",
       {{"load", times.load},
        {"guess", times.guess},
        {"compile", times.compile},
        {"optimize", times.optimize},
        {"total", times.total}}},
      {"iterations_detail", iterations_json(result)},
  };
  if (options.graduated) json["rejected_edges"] = rejected;
  add_violations(json, graph);
  if (!diagnosis.is_null()) {
    json["diagnosis"] = diagnosis;
    json["diagnosis_text"] = diagnosis_text;
  }
  if (before) {
    carry_slopes(before->motion, before->plan, graph);
    carry_wrenches(before->motion, before->plan, graph);
  }
  if (!options.output.empty() && std::isfinite(result.final.robust)) {
    const Progress progress("writing " + options.output);
    write_graph(graph, options.output);
    json["output"] = options.output;
  }
  if (options.json) {
    print_result(json, true);
  } else {
    print_summary(options, json);
  }
  return result.converged && !interrupted ? kDone : kNo;
}

}  // namespace

Command add_optimize(OptionParser& app) {
  const auto options = std::make_shared<OptimizeOptions>();
  OptimizeOptions& o = *options;
  OptionParser parser = app.add_subcommand("optimize", "Optimise a graph file");
  parser
      .add_option("IN", o.input,
                  "Graph file (.g2o) or bundle adjustment in the large (.txt, .bal); - reads "
                  "standard input")
      .required();
  parser.add_option("-o,--output", o.output,
                    "Where to write the optimised graph; - is standard output");
  parser.add_option("--algorithm", o.algorithm, "lm, gn or dogleg")
      .one_of({"lm", "gn", "dogleg"})
      .show_default();
  parser
      .add_option("--linear-solver", o.linear_solver,
                  "NAME (see: locograph list solvers), auto, or ceres: the whole graph by Ceres")
      .show_default();
  parser
      .add_option("--kernel", o.kernel,
                  "Robust kernel of every edge, NAME[:WIDTH][:second-order] or barron:WIDTH:ALPHA "
                  "(see: locograph list kernels)")
      .show_default();
  parser
      .add_option("--initial-guess", o.initial_guess,
                  "auto (the one of least cost; chordal only where the others are poor; with --gnc "
                  "none), none (the values of the file), odometry, spanning-tree or chordal; "
                  "chordal with --gnc or --kernel does without the loop closures that no short "
                  "cycle confirms")
      .one_of({"auto", "none", "odometry", "spanning-tree", "chordal"})
      .show_default();
  parser.add_flag(
      "--gnc", o.graduated,
      "Find wrong loop closures by graduated non-convexity and leave them out; odometry "
      "(edges between consecutive ids) is trusted");
  parser.add_option("--iterations", o.optimiser.max_iterations, "Most iterations to make")
      .show_default();
  parser
      .add_option("--gain", o.optimiser.gain,
                  "Converged when a step lowers the cost by less than this fraction")
      .show_default();
  parser.add_option("--threads", o.threads, "Most threads to use; the result never depends on it")
      .between(1, 64)
      .show_default();
  add_plugin_option(parser, o.plugins);
  parser.add_flag("--lenient", o.lenient,
                  "Leave out unknown tags, project indefinite information, hold unconnected parts");
  parser.add_flag(
      "--diagnose", o.diagnose,
      "Tell what the measurements leave free, which matrices are not positive and which "
      "Jacobians not the derivatives of their errors; done unasked when the system is "
      "singular or no step lowers the cost");
  parser.add_flag("--json", o.json, "Print one JSON object");
  return {parser, [options] {
            OptimiserOptions& optimiser = options->optimiser;
            options->bal = options->input != "-" && is_bal_file(options->input);
            if (options->bal) {
              // Rotations, pixels and distortions have no common unit.
              optimiser.scale_by_diagonal = true;
              optimiser.initial_lambda = 1e-4;
            } else if (!options->graduated) {
              OptimiserOptions any = OptimiserOptions::for_any_start();
              any.max_iterations = optimiser.max_iterations;
              any.gain = optimiser.gain;
              optimiser = any;
            }
            optimiser.algorithm = kAlgorithms.at(options->algorithm);
            optimiser.on_iteration = [](const OptimiserResult&) { return !stop_requested(); };
            return optimize(*options);
          }};
}

}  // namespace locograph
