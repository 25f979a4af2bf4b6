#include <locograph/apps/json_file.h>
#include <locograph/apps/plot.h>
#include <locograph/apps/statistics.h>
#include <locograph/common/error.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

namespace locograph {
namespace {

const char kBlue[] = "'#2f6fb5'", kRed[] = "'#c8372d'", kGreen[] = "'#3a9a5b'";

/// Three significant digits, for labels.
std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value);
  return text;
}

std::string rows(const std::vector<std::pair<double, double>>& points) {
  std::string text;
  for (const auto& [x, y] : points) text += short_number(x) + ' ' + short_number(y) + '\n';
  return text;
}

/// chi2 after each iteration, on a logarithmic axis.
PlotScript convergence(const Json& result) {
  std::vector<std::pair<double, double>> points;
  const auto add = [&points](double iteration, const Json& chi2) {
    if (chi2.is_number() && chi2.get<double>() > 0.0) points.emplace_back(iteration, chi2);
  };
  add(0.0, result.value("initial_chi2", Json()));
  double iteration = 0.0;
  for (const Json& now : result["iterations_detail"]) add(++iteration, now.value("chi2", Json()));
  if (points.empty()) throw Error("no chi2 above zero to plot", "an optimisation with a cost");
  PlotScript plot;
  plot.line("set title " + PlotScript::label("Convergence: " + result.value("algorithm", "") +
                                             ", " + result.value("linear_solver", "") + ", " +
                                             result.value("reason", "")));
  plot.line("set xlabel 'iteration'");
  plot.line("set ylabel 'chi2 (lower is better)'");
  plot.line("set logscale y");
  plot.line("set format y '%.3g'");
  plot.line("set xrange [-0.5:" + short_number(std::max(1.0, iteration) + 0.5) + "]");
  plot.line("set offsets 0, 0, 0, 0");
  plot.data("chi2", rows(points));
  plot.line(std::string("plot $chi2 with linespoints linewidth 2 pointtype 7 pointsize 0.6 "
                        "linecolor ") +
            kBlue + " notitle");
  return plot;
}

/// Histogram of the cycles' times, with the percentiles that a real-time loop asks about.
PlotScript cycle_times(const Json& result) {
  std::vector<double> times_ms;
  for (const Json& time : result["cycle_times"]) {
    if (time.is_number()) times_ms.push_back(1e3 * time.get<double>());
  }
  if (times_ms.empty()) throw Error("no cycle times", "a refine with at least one cycle");
  std::sort(times_ms.begin(), times_ms.end());
  const double first = times_ms.front(), last = times_ms.back();
  const int bins = std::clamp(static_cast<int>(2.0 * std::sqrt(times_ms.size())), 8, 60);
  const double width = std::max((last - first) / bins, 1e-6 * std::max(last, 1.0));
  std::map<int, int> counts;
  for (const double time : times_ms) {
    counts[std::min(bins - 1, static_cast<int>((time - first) / width))] += 1;
  }
  std::vector<std::pair<double, double>> bars;
  for (const auto& [bin, count] : counts) bars.emplace_back(first + (bin + 0.5) * width, count);

  PlotScript plot;
  plot.line("set title " +
            PlotScript::label(
                "Cycle time: " + counted(static_cast<long>(times_ms.size()), "cycle", "cycles") +
                ", horizon " + result.value("horizon", Json("?")).dump()));
  plot.line("set xlabel 'cycle time [ms] (lower is better)'");
  plot.line("set ylabel 'cycles'");
  plot.line("set boxwidth " + short_number(0.92 * width) + " absolute");
  plot.line("set yrange [0:*]");
  plot.line("set xrange [0:" + short_number(1.08 * last + width) + "]");
  plot.line("set key above horizontal right");
  plot.data("bars", rows(bars));
  std::string command = std::string("plot $bars with boxes linecolor ") + kBlue + " notitle";
  struct Mark {
    const char* name;
    double p;
    const char* color;
  };
  for (const Mark& mark :
       {Mark{"p50", 0.50, kGreen}, Mark{"p95", 0.95, "'#d98a1f'"}, Mark{"p99", 0.99, kRed}}) {
    const double at = percentile(times_ms, mark.p);
    plot.line("set arrow from " + short_number(at) + ", graph 0 to " + short_number(at) +
              ", graph 1 nohead linewidth 1.6 dashtype 2 linecolor " + mark.color);
    command += ", NaN with lines linewidth 1.6 dashtype 2 linecolor " + std::string(mark.color) +
               " title " + PlotScript::label(std::string(mark.name) + " = " + brief(at) + " ms");
  }
  plot.line(command);
  return plot;
}

struct Bar {
  std::string name;
  double worst, limit;
  bool violated;
};

/// Where values are allowed, as seen from the limit: 1 above, -1 below; 0 where the numbers do not
/// tell.
double allowed_side(const Bar& bar) {
  if (bar.worst == bar.limit) return 0.0;
  return (bar.worst > bar.limit) == bar.violated ? -1.0 : 1.0;
}

/// Bars of one unit, its own axis: worst value and limit of each constraint, and the side of the
/// limit that is allowed.
void add_panel(PlotScript& plot, const std::string& unit, const std::vector<Bar>& bars, int panel) {
  // Lengths of a few millimetres and sizes of metres on one axis: small units read better.
  const bool metres = unit == "m";
  const double scale = metres ? 1e3 : 1.0;
  std::string good, bad, limits;
  double lowest = 0.0, highest = 0.0;
  const int count = static_cast<int>(bars.size());
  for (int i = 0; i < count; ++i) {
    const Bar& bar = bars[static_cast<std::size_t>(i)];
    const double worst = scale * bar.worst, limit = scale * bar.limit;
    const int y = count - i;
    std::string& rows = bar.violated ? bad : good;
    rows += short_number(0.5 * worst) + ' ' + std::to_string(y) + ' ' +
            short_number(0.5 * std::abs(worst)) + '\n';
    limits += short_number(limit) + ' ' + std::to_string(y) + '\n';
    lowest = std::min({lowest, worst, limit});
    highest = std::max({highest, worst, limit});
    plot.line("set label " + std::to_string(i + 1) + ' ' + PlotScript::label(brief(worst)) +
              " at " + short_number(std::max({0.0, worst, limit})) + "," + std::to_string(y) +
              " left offset 0.5,0 font ',11' noenhanced");
  }
  const double room = 0.18 * std::max(highest - lowest, 1e-9);
  std::string arrows;
  for (int i = 0; i < count; ++i) {
    const Bar& bar = bars[static_cast<std::size_t>(i)];
    arrows += short_number(scale * bar.limit) + ' ' + std::to_string(count - i) + ' ' +
              short_number(0.4 * room * allowed_side(bar)) + '\n';
  }
  const std::string id = std::to_string(panel);
  // An empty block is no block to gnuplot: NaN draws nothing.
  plot.data("good" + id, good.empty() ? "NaN NaN NaN\n" : good);
  plot.data("bad" + id, bad.empty() ? "NaN NaN NaN\n" : bad);
  plot.data("limit" + id, limits);
  plot.data("allowed" + id, arrows);
  std::string tics;
  for (int i = 0; i < count; ++i) {
    tics += (i > 0 ? ", " : "") + PlotScript::label(bars[static_cast<std::size_t>(i)].name) + ' ' +
            std::to_string(count - i);
  }
  plot.line("set ytics (" + tics + ")");
  plot.line("set yrange [0.4:" + short_number(count + 0.6) + "]");
  plot.line("set xrange [" + short_number(lowest - (lowest < 0.0 ? room : 0.5 * room)) + ":" +
            short_number(highest + room) + "]");
  plot.line("set xlabel " + PlotScript::label(metres ? "mm" : unit) + " offset 0,0.5");
  plot.line("plot $good" + id + " using 1:2:3:(0.32) with boxxyerror linecolor " + kBlue +
            " notitle, $bad" + id + " using 1:2:3:(0.32) with boxxyerror linecolor " + kRed +
            " notitle, $limit" + id +
            " using 1:($2-0.42):(0):(0.84) with vectors nohead linewidth 2.5 linecolor '#202428' "
            "notitle, $allowed" +
            id + " using 1:($2+0.3):3:(0) with vectors head filled size screen 0.008,20 " +
            "linewidth 1.8 linecolor " + kGreen + " notitle");
  for (int i = 0; i < count; ++i) plot.line("unset label " + std::to_string(i + 1));
}

/// By what share each may change, and the push, by stance.
void add_robustness(PlotScript& plot, const Json& robustness) {
  const std::pair<const char*, const char*> lines[] = {{"friction", "'#c8372d'"},
                                                       {"area", "'#2f6fb5'"},
                                                       {"torque", "'#3a9a5b'"},
                                                       {"mass", "'#7a4fa3'"},
                                                       {"push_N", "'#202428'"}};
  std::string command;
  for (const auto& [name, color] : lines) {
    std::string rows;
    for (const Json& stance : robustness["by_stance"]) {
      const Json value = stance.value(name, Json());
      if (!value.is_number()) continue;
      for (const char* end : {"from_s", "until_s"})
        rows += short_number(stance.at(end).get<double>()) + ' ' +
                short_number(value.get<double>()) + '\n';
    }
    if (rows.empty()) continue;
    const bool push = std::string(name) == "push_N";
    plot.data(name, rows);
    command += std::string(command.empty() ? "plot $" : ", $") + name + (push ? " axes x1y2" : "") +
               " with lines linewidth 2" + (push ? " dashtype 2" : "") + " linecolor " + color +
               " title " + PlotScript::label(push ? "push, N (right)" : name);
  }
  if (command.empty()) return;
  plot.line("set ytics auto");
  plot.line("set y2tics auto");
  plot.line("set yrange [0:1]");
  plot.line("set y2range [0:*]");
  plot.line("set xrange [*:*]");
  plot.line("set key outside right top font ',11'");
  plot.line("set rmargin screen 0.80");
  plot.line("set lmargin screen 0.10");
  plot.line("set xlabel 'time [s]'");
  plot.line("set title 'how far from falling (share by which each may change; higher is better)'");
  plot.line(command);
}

/// The worst value of every constraint against its limit, one panel for each unit.
PlotScript constraints(const Json& result) {
  std::vector<std::pair<std::string, std::vector<Bar>>> panels;
  std::size_t rows = 0;
  for (const Json& v : result["violations"]) {
    if (!v.value("worst", Json()).is_number() || !v.value("limit", Json()).is_number()) continue;
    const std::string unit = v.value("unit", "");
    auto panel = std::find_if(panels.begin(), panels.end(),
                              [&unit](const auto& p) { return p.first == unit; });
    if (panel == panels.end()) panel = panels.insert(panels.end(), {unit, {}});
    panel->second.push_back({v.value("constraint", "?"), v["worst"].get<double>(),
                             v["limit"].get<double>(), v.value("violated", false)});
    ++rows;
  }
  if (panels.empty()) throw Error("no constraints with numbers", "the JSON of locograph check");
  const Json robustness = result.value("robustness", Json());
  const bool has_robustness = robustness.is_object() && robustness.contains("by_stance");
  const int bar_px = 30, panel_px = 62, head_px = 64, robustness_px = has_robustness ? 300 : 0;
  const int height = head_px + static_cast<int>(panels.size()) * panel_px +
                     static_cast<int>(rows) * bar_px + robustness_px;
  PlotScript plot(900, height);
  const bool feasible = result.value("feasible", false);
  plot.line("set multiplot title " +
            PlotScript::label(std::string(feasible ? "Feasible" : "NOT feasible") +
                              ": worst value of each constraint (bar; red: violated), its limit "
                              "(black) and where it holds (green)"));
  plot.line("set lmargin screen 0.30");
  plot.line("set rmargin screen 0.96");
  double top = height - head_px + 14.0;
  int number = 0;
  for (const auto& [unit, bars] : panels) {
    const double bottom = top - bar_px * static_cast<double>(bars.size());
    plot.line("set tmargin screen " + short_number(top / height));
    plot.line("set bmargin screen " + short_number(bottom / height));
    add_panel(plot, unit, bars, ++number);
    top = bottom - panel_px;
  }
  if (has_robustness) {
    plot.line("set tmargin screen " + short_number((top - 24.0) / height));
    plot.line("set bmargin screen " + short_number(60.0 / height));
    add_robustness(plot, robustness);
  }
  plot.line("unset multiplot");
  return plot;
}

}  // namespace

PlotScript plot_result(const std::filesystem::path& result,
                       const std::vector<std::string>& plugins) {
  if (result.extension() == ".g2o") return plot_plan(result, plugins);
  if (result.extension() == ".csv") return plot_table(result);
  const std::string expected =
      "JSON that optimize, refine or check printed with --json, a plan (.g2o) or a table (.csv)";
  const Json json = read_json(result, expected);
  const auto has = [&json](const char* key) {
    return json.is_object() && json.contains(key) && json[key].is_array();
  };
  try {
    if (has("iterations_detail")) return convergence(json);
    if (has("cycle_times")) return cycle_times(json);
    if (has("violations")) return constraints(json);
  } catch (const Error& error) {
    throw Error(result.string(), 0, error.what(), "");
  } catch (const Json::exception& failure) {
    throw Error(result.string(), 0, std::string("has a field of another type: ") + failure.what(),
                expected);
  }
  throw Error(result.string(), 0, "holds nothing to plot", expected);
}

}  // namespace locograph
